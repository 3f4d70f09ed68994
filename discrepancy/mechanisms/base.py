"""What a mechanism is: a piece of physics that the baseline leaves out, as one replaced seam.

To add your own, write one file like its neighbours here: a subclass of `Mechanism` with its name,
equations, parameters with ranges and sources, `attach` that returns a scene with one seam
replaced, and, if it can be ruled out by arithmetic, `applies`; then put it into `MECHANISMS`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from ...impact import Profiles, RateFree, Scene
from ...impact.scene import FlowStress

Array = NDArray[np.float64]
Values = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Parameter:
    """One free number of a mechanism.

    Parameters
    ----------
    name, unit
        As they stand in the verdict.
    low, high
        Range within which the source (or physics) puts it; the prior is flat over it.
    scale
        Whether flat means in the number, in its logarithm, or in the angle whose squared sine the
        share of the range is: `ends`, where both ends are states that occur.
    neutral
        The value at which the mechanism does nothing.
    source
        Where the range comes from.
    nodes
        Points of the grid on which the mechanism is simulated.
    """

    name: str
    unit: str
    low: float
    high: float
    scale: Literal["log", "linear", "ends"]
    neutral: float
    source: str
    nodes: int = 9

    def value(self, place: float | Array) -> Array:
        """Return the value at a place in (0, 1) of the prior."""
        p = np.asarray(place, dtype=float)
        if self.scale == "log":
            return np.asarray(self.low * (self.high / self.low) ** p)
        if self.scale == "ends":
            p = np.sin(0.5 * np.pi * p) ** 2
        return np.asarray(self.low + (self.high - self.low) * p)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a mechanism may know of the rig besides the scene of a condition.

    Parameters
    ----------
    thickness
        Of the flat [m]; nan when not stated.
    support_mass, support_stiffness
        As stated [kg, N/m]; nan when not.
    roughness
        Ra of the two surfaces together [m]; nan when not stated.
    viscosity, fluid
        Of what is between the bodies [Pa s]; nan and "" when not stated.
    heat_capacity, melting
        Of the weaker body [J/(kg K), K]; nan when not stated.
    temperature, ambient
        Of the bodies in this condition, and the reference [K].
    layer_thickness
        Stated thickness of a surface layer [m]; nan when not.
    from_height
        Whether the speed of this condition was computed from a height of fall.
    height_share
        Height of fall over the largest of the set.
    """

    thickness: float = math.nan
    support_mass: float = math.nan
    support_stiffness: float = math.nan
    roughness: float = math.nan
    viscosity: float = math.nan
    fluid: str = ""
    heat_capacity: float = math.nan
    melting: float = math.nan
    temperature: float = 293.0
    ambient: float = 293.0
    layer_thickness: float = math.nan
    from_height: bool = False
    height_share: float = 1.0


Situation = tuple[Scene, Surroundings]


class Mechanism(ABC):
    """One mechanism; subclasses are stateless and hold class attributes.

    Attributes
    ----------
    name
        As in the list of verdict names.
    title
        A few words for people.
    equations
        What is added to the baseline, in one or two lines.
    parameters
        Its free numbers.
    direction
        Observable to the sign of its change: +1, -1.
    form
        How far published forms of this physics differ, as a share of its effect, when they are
        fitted to each other over a decade of speed: 0.15 for constitutive laws (a power against a
        logarithm or an exponential), less where the equations are those of rigid or elastic bodies.
    law_error
        How many times larger the contact law's own error is with this mechanism: above 1 where the
        law is used for a contact that it was not made for.
    jumps
        Whether the outcome jumps with the first parameter, because a tip may or may not touch
        again.
    """

    name: str
    title: str
    equations: str
    parameters: tuple[Parameter, ...]
    direction: ClassVar[Mapping[str, int]] = {}
    form: ClassVar[float] = 0.15
    law_error: ClassVar[float] = 1.0
    jumps: ClassVar[bool] = False

    def applies(self, situations: Sequence[Situation]) -> str:
        """Return why arithmetic rules the mechanism out for these conditions, or ""."""
        return ""

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Return the parameters with the ranges that this rig allows."""
        return self.parameters

    @abstractmethod
    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Return the scene with the mechanism's seam replaced."""

    def after(
        self, situations: Sequence[Situation], values: Values, seen: dict[str, Array]
    ) -> None:
        """Change observables, arrays over the situations, that no seam of the motion carries."""
        return


def with_flow(scene: Scene, flow: FlowStress) -> Scene:
    """Return the scene with one more influence on the flow stress."""
    if isinstance(scene.flow, RateFree):
        return scene.with_(flow=flow)
    return scene.with_(flow=Profiles((scene.flow, flow)))


def effective_mass(scene: Scene) -> float:
    """Mass that the normal motion of the contact point meets, 1/(1/m + c^2/I) [kg]."""
    striker = scene.striker
    c = 0.5 * striker.length * math.cos(scene.approach.angle)
    return 1.0 / (1.0 / striker.mass + c * c / striker.inertia)


def is_oblique(scene: Scene) -> bool:
    """Whether the contact point has a tangential motion, or gets one from the rod's lean."""
    leaning = scene.striker.length > 0.0 and scene.approach.angle < math.pi / 2.0 - 1e-6
    return leaning or scene.approach.tangential != 0.0 or scene.approach.spin != 0.0


def energy(scene: Scene) -> float:
    """Kinetic energy that the contact must take up, m_eff v^2 / 2 [J]."""
    return 0.5 * effective_mass(scene) * scene.approach.speed**2
