"""The rod rings along its axis, and bends where it leans."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from ...core.material import Material
from ..beam import Modes, axial_frequencies, rod_modes
from ..rules import RULES
from ..scene import Scene, Striker
from .arithmetic import density_of, is_oblique
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values
from .tangential_compliance import TangentialCompliance

_PARTICIPATION = Parameter(
    "modal_participation", "-", 0.5, 1.5, "linear", 0.0,
    "1 is the theory of the uniform rod; the ends' shape and the mass's spread move it", nodes=5,
    literature=Literature(1.0, "the uniform rod"),
)  # fmt: skip


class _Ringing(Mechanism):
    """A rod that is no rigid body: its modes take energy and give it back."""

    parameters: tuple[Parameter, ...] = (_PARTICIPATION,)
    form = 0.05
    jumps = True
    rests_on = ("striker",)

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a rod."""
        rods = any(scene.striker.length > 0.0 for scene, _ in situations)
        return "" if rods else "no striker is a rod"

    @abstractmethod
    def modes(self, striker: Striker, body: Material) -> Modes:
        """Return the modes of a rod of this material."""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid striker."""
        striker, body = scene.striker, scene.pair.sphere
        if striker.length == 0.0 or body.rigid:
            return scene
        modes = self.modes(striker, replace(body, density=density_of(body)))
        factor = math.sqrt(values["modal_participation"])
        return scene.with_(modes=modes.scaled(lambda x: factor * x))


class RodLongitudinalWaves(_Ringing):
    """The rod's axial modes store energy and shape the force."""

    name = "rod-longitudinal-waves"
    title = "the rod rings along its axis"
    equations = (
        "q_k'' + eta w_k q_k' + w_k^2 q_k = sqrt(2/m) F sin(theta), w_k = k pi sqrt(E/rho)/L"
    )
    direction = {"contact_time_s": 1}

    def modes(self, striker: Striker, body: Material) -> Modes:
        """Return the lowest axial modes."""
        return axial_modes(striker.length, body, striker.mass)


class RodFlexuralVibration(_Ringing):
    """The leaning rod bends as well: energy goes into bending, and the tip may touch again."""

    name = "rod-flexural-vibration"
    title = "the leaning rod bends and rings"
    equations = (
        "free-free Timoshenko beam and axial modes; the contact gives way sideways, k_t = "
        "s 2 E' a; re-contact while the tip returns"
    )
    parameters = (
        _PARTICIPATION,
        replace(
            TangentialCompliance.parameters[0], nodes=3, literature=Literature(0.82, "Mindlin 1949")
        ),
    )  # fmt: skip
    aslant = True
    holds = ("rod-longitudinal-waves", "tangential-compliance")

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a rod that leans."""
        if reason := super().applies(situations):
            return reason
        if not any(scene.striker.length > 0.0 and is_oblique(scene) for scene, _ in situations):
            return "every rod stands upright: a central blow along the axis does not bend it"
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid striker, and the rigid stick of its contact.

        A tip that a bending rod drives to and fro sticks and turns; what is rigid there would
        have to follow each mode.
        """
        found = super().attach(scene, values, around)
        if found is scene:
            return scene
        # it gives way as far as the rod takes part
        sideways = values["tangential_stiffness_ratio"] / values["modal_participation"]
        return found.with_(friction=replace(found.friction, stiffness=sideways))

    def modes(self, striker: Striker, body: Material) -> Modes:
        """Return the lowest axial and bending modes."""
        return rod_modes(
            striker.length, striker.radius, body, mass=striker.mass, count=RULES.bending_modes,
            loss_factor=RULES.rod_loss,
        )  # fmt: skip


@lru_cache(maxsize=256)
def axial_modes(length: float, material: Material, mass: float) -> Modes:
    """Return the lowest axial modes of a free rod with the stated mass."""
    omega = axial_frequencies(length, material, count=RULES.axial_modes)
    ends = tuple([math.sqrt(2.0 / mass)] * RULES.axial_modes)
    none = (0.0,) * RULES.axial_modes
    return Modes(tuple(float(w) for w in omega), ends, none, none, RULES.rod_loss)
