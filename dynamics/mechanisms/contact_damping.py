"""The contact loses energy by viscosity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..scene import Scene
from ..strength import strength_table
from .arithmetic import energy
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values

_REFERENCE_DEPTH = 1e-5  # [m], at which the damping is stated


class ContactDamping(Mechanism):
    """A viscous part of the contact force."""

    name = "contact-damping"
    title = "the contact loses energy by viscosity"
    equations = "F (1 + chi d'), chi = chi_10 (10 um/d_m)^q at a largest depth d_m"
    parameters = (
        Parameter(
            "damping_s_m", "s/m", 0.003, 0.3, "log", 0.0,
            "Hunt and Crossley 1975 (e = 1 - alpha v, alpha 0.08-0.32 s/m for metals)",
            literature=Literature(0.15, "alpha near 0.1 s/m (Hunt and Crossley), times 3/2"),
        ),
        Parameter(
            "damping_depth_exponent", "-", 0.0, 1.0, "linear", 0.0,
            "0 for a loss that follows the speed alone (Hunt and Crossley 1975), 1 for a time of "
            "retardation, chi = 3 tau/(2 d) (Kuwabara and Kono, Jpn. J. Appl. Phys. 26, 1230)",
            nodes=3,
            literature=Literature(0.0, "Hunt and Crossley 1975"),
        ),
    )  # fmt: skip
    direction = {"restitution": -1, "permanent_depth_m": -1}
    form = 0.25
    """A force in proportion to the load against one in proportion to the width, fitted to each
    other over a decade of speed: 2 to 8 % of the effect in restitution and depth, 25 to 45 % in
    contact time and peak force."""

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Where a modulus is not stated, the loss follows the speed alone: a depth rests on it."""
        chi, exponent = self.parameters
        if all(around.moduli_stated for _, around in situations):
            return self.parameters
        return chi, replace(exponent, high=exponent.low, nodes=2)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        added = values["damping_s_m"]
        if values["damping_depth_exponent"] > 0.0:
            deepest = strength_table(scene.law, scene.pair).peak(energy(scene))
            added *= (_REFERENCE_DEPTH / deepest) ** values["damping_depth_exponent"]
        return scene.with_(force=replace(scene.force, damping=scene.force.damping + added))
