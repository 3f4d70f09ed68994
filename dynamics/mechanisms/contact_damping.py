"""The contact loses energy by viscosity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..force import DAMPING_DEPTH
from ..scene import Scene
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


class ContactDamping(Mechanism):
    """A viscous part of the contact force."""

    name = "contact-damping"
    title = "the contact loses energy by viscosity"
    equations = (
        "F (1 + chi d'), chi = chi_10 (4/3 E' a 10 um/F)^q, elastically (10 um/d)^q; from q = 1 on "
        "10 um becomes the elastic depth at 1 m/s"
    )
    parameters = (
        Parameter(
            "damping_s_m", "s/m", 0.003, 1.0, "log", 0.0,
            "Hunt and Crossley 1975 (e = 1 - alpha v, alpha 0.08-0.32 s/m for metals)",
            literature=Literature(0.15, "alpha near 0.1 s/m (Hunt and Crossley), times 3/2"),
        ),
        Parameter(
            "damping_depth_exponent", "-", 0.0, 1.25, "linear", 0.0,
            "0 for a loss that follows the speed alone (Hunt and Crossley 1975), 1 for a time of "
            "retardation, 2 E' a tau d' (Kuwabara and Kono, Jpn. J. Appl. Phys. 26, 1230), 1.25 "
            "for one restitution at all speeds and masses (Tsuji and others, Powder Technol. 71, "
            "239)",
            nodes=3,
            literature=Literature(0.0, "Hunt and Crossley 1975"),
        ),
    )  # fmt: skip
    direction = {"restitution": -1, "permanent_depth_m": -1}

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Where a modulus is not stated, the loss follows the speed alone: a depth rests on it."""
        chi, exponent = self.parameters
        if all(around.moduli_stated for _, around in situations):
            return self.parameters
        return chi, replace(exponent, high=exponent.low, nodes=2)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        chi, exponent = (values[p.name] for p in self.parameters)
        # chi_10 is the metal's up to its time of retardation, 1; Tsuji's, 1.25, goes with
        # sqrt(m/k), which is the elastic depth at 1 m/s to the power of 1.25
        stiffness = 4.0 / 3.0 * scene.pair.E_reduced * scene.pair.R**0.5
        depth = (1.25 * scene.striker.mass / stiffness) ** 0.4
        chi *= (depth / DAMPING_DEPTH) ** max(5.0 * (exponent - 1.0), 0.0)
        return scene.with_(force=replace(scene.force, damping=chi, damping_exponent=exponent))
