"""What a mechanism is: a piece of physics that the baseline leaves out, as one replaced seam.

To add your own, write one file like its neighbours here: a subclass of `Mechanism` with its name,
equations, parameters with ranges and sources, `attach` that returns a scene with one seam
replaced, and, if it can be ruled out by arithmetic, `applies`; then put it into `MECHANISMS`.
What every mechanism must keep to is tested in tests/contract/test_mechanism_contract.py.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from ...core.arrays import Array, Mask
from ...core.inputs.flow_curve import Rise
from ...core.inputs.second_sphere import StruckSphere
from ...core.unstated import unstated_equal
from ..scene import Scene

Values = Mapping[str, float]
"""Numbers of one mechanism, by the names of its parameters."""
Constants = Mapping[str, Values]
"""Numbers of several mechanisms, by their names; two may use the same word for a parameter."""


class Literature(NamedTuple):
    """A value that was published before any recording was seen, and where."""

    value: float
    source: str


@dataclass(frozen=True, slots=True)
class Parameter:
    """One free number of a mechanism.

    - `name`, `unit`: as they stand in the verdict.
    - `low`, `high`: range within which the source (or physics) puts it; the prior is flat over it.
    - `scale`: whether flat means in the number or in its logarithm; or `half-low`, where the low
      end is a state that occurs: half of the prior is there, the rest flat in the angle whose
      squared sine the share of the range is; or `either`: one of the two ends, as likely.
    - `neutral`: the value at which the mechanism does nothing.
    - `source`: where the range comes from.
    - `nodes`: points of the grid on which the mechanism is simulated.
    - `power_of`: share in `Surroundings` that it is a power of; where that is 1 for all, nothing
      tells it.
    - `literature`: a published value for mild steel and common rigs, at which the mechanism can be
      tried without fitting; none where there is no such value.
    """

    name: str
    unit: str
    low: float
    high: float
    scale: Literal["log", "linear", "half-low", "either"]
    neutral: float
    source: str
    nodes: int = 9
    literature: Literature | None = None
    power_of: str = ""

    def value(self, place: float | Array) -> Array:
        """Return the value at a place in (0, 1) of the prior."""
        p = np.asarray(place, dtype=float)
        if self.scale == "log":
            return np.asarray(self.low * (self.high / self.low) ** p)
        if self.scale == "half-low":
            p = np.sin(0.5 * np.pi * np.maximum(2.0 * p - 1.0, 0.0)) ** 2
        if self.scale == "either":
            p = np.round(p)
        return np.asarray(self.low + (self.high - self.low) * p)


@unstated_equal
@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a mechanism may know of the rig besides the scene of a condition.

    - `thickness`: of the flat [m]; nan when not stated.
    - `support_mass`, `support_stiffness`: as stated [kg, N/m]; nan when not.
    - `roughness`: Ra of the two surfaces together [m]; nan when not stated.
    - `viscosity`, `density`, `pressure`, `fluid`: of what is between and around the bodies [Pa s,
      kg/m^3, Pa]; nan and "" when not stated.
    - `heat_capacity`, `melting`: of the weaker body [J/(kg K), K]; nan when not stated.
    - `temperature`, `ambient`: of the bodies in this condition, and the reference [K].
    - `layer_thickness`: stated thickness of a surface layer [m]; nan when not.
    - `moduli_stated`: whether the set gives Young's modulus of both bodies.
    - `from_height`: whether the speed of this condition was computed from a height of fall.
    - `height_share`: height of fall over the largest of the set.
    - `mass_share`, `tip_share`: mass and tip radius of the rig's lightest striker and sharpest tip
      over those of this one.
    - `rises`: how the weaker body's stress rises with the rate of strain, where its flow curve was
      measured at several.
    - `struck`: the second sphere; none where a flat is struck.
    """

    thickness: float = math.nan
    support_mass: float = math.nan
    support_stiffness: float = math.nan
    roughness: float = math.nan
    viscosity: float = math.nan
    density: float = math.nan
    pressure: float = math.nan
    fluid: str = ""
    heat_capacity: float = math.nan
    melting: float = math.nan
    temperature: float = 293.0
    ambient: float = 293.0
    layer_thickness: float = math.nan
    moduli_stated: bool = True
    from_height: bool = False
    height_share: float = 1.0
    mass_share: float = 1.0
    tip_share: float = 1.0
    rises: tuple[Rise, ...] = ()
    struck: StruckSphere | None = None


Situation = tuple[Scene, Surroundings]


class Mechanism(ABC):
    """One mechanism; subclasses are stateless and hold class attributes.

    - `name`, `title`, `equations`: as in the list of verdict names; a few words for people; what is
      added to the baseline, in one or two lines.
    - `parameters`: its free numbers. The first is the size of the effect: at its neutral value
      nothing happens, whatever the others.
    - `direction`: observable to the sign of its change: +1, -1.
    - `form`: how far published forms of this physics differ, as a share of its effect, when they
      are fitted to each other over a decade of speed: 0.15 for constitutive laws (a power against a
      logarithm or an exponential), less where the equations are those of rigid or elastic bodies.
    - `law_error`: how many times larger the contact law's own error is with this mechanism: above 1
      where the law is used for a contact that it was not made for.
    - `scale_error`: standard deviation of the logarithm of what the first parameter multiplies,
      where that is taken from the contact law and is none of the numbers whose error the law's own
      holds: a contact radius. The parameter is known no better.
    - `jumps`: whether the outcome jumps with the first parameter, because a tip may or may not
      touch again.
    - `named`: whether a verdict has a name for it. What has none counts as something outside the
      library, and the report says that it behaves like this.
    - `static`: whether it acts without motion, and so on a quasi-static press as well.
    - `aslant`: whether it moves the line between sticking and sliding: two of these decide
      together where that is, so that what they do is no sum.
    - `holds`: mechanisms that it is made of: none of them has an effect of its own beside it.
    - `mutual`: whether what it takes of the approach goes to the struck body: of both it keeps the
      momentum.
    - `in_flight`: whether it acts before the touch: the others meet what it has left of the
      approach.
    - `rests_on`: bodies whose elastic modulus its numbers rest on: "target", "striker". Where a set
      does not state one, the mechanism is not tried: its constants would be those of the
      assumption.
    - `reads`: keys of a set-up, beyond those of the bodies' motion, that it takes numbers from:
      with a table in front (`environment.pressure_Pa`), or of the bodies.
    """

    name: str
    title: str
    equations: str
    parameters: tuple[Parameter, ...]
    direction: ClassVar[Mapping[str, int]] = {}
    form: ClassVar[float] = 0.15
    law_error: ClassVar[float] = 1.0
    scale_error: ClassVar[float] = 0.0
    jumps: ClassVar[bool] = False
    named: ClassVar[bool] = True
    static: ClassVar[bool] = False
    aslant: ClassVar[bool] = False
    holds: ClassVar[tuple[str, ...]] = ()
    mutual: ClassVar[bool] = False
    in_flight: ClassVar[bool] = False
    rests_on: ClassVar[tuple[str, ...]] = ()
    reads: ClassVar[tuple[str, ...]] = ()

    def acts_on(self, scene: Scene) -> bool:
        """Whether it can act in a scene at all: nothing that needs motion acts in a press."""
        return self.static or scene.press is None

    def ruled_out(self, situations: Sequence[Situation]) -> str:
        """Return why these conditions, presses among them, cannot show the mechanism, or ""."""
        moving = [(scene, around) for scene, around in situations if self.acts_on(scene)]
        if not moving:
            return "every trial is a quasi-static press: nothing moves"
        return self.applies(moving)

    def applies(self, situations: Sequence[Situation]) -> str:
        """Return why arithmetic rules the mechanism out for these conditions, or "".

        Of presses it is asked only if it acts without motion.
        """
        return ""

    def idle(self, situations: Sequence[Situation]) -> str:
        """Return why it would change nothing of these conditions, or "".

        What only comparing trials with each other rules out is no reason here.
        """
        return self.ruled_out(situations)

    def stated(self, around: Surroundings) -> Values:
        """Return the parameters that the rig itself states."""
        return {}

    def usual(self, around: Surroundings, *, sized: bool = False) -> Values:
        """Return the parameters that a source has for usual rigs; `sized`: the first is stated."""
        return {p.name: p.literature.value for p in self.parameters if p.literature}

    def certain(self, around: Surroundings) -> bool:
        """Whether it acts by all that is known, so that it is only looked for how much."""
        return False

    def published(self, around: Surroundings, *, sized: bool = False) -> Values:
        """Return all parameters as stated or usual; neutral where there is neither."""
        neutral = {p.name: p.neutral for p in self.parameters}
        return neutral | dict(self.usual(around, sized=sized)) | dict(self.stated(around))

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Return the parameters that this rig can tell, with the ranges that it allows."""
        return tuple(
            p for p in self.parameters
            if not p.power_of or any(getattr(a, p.power_of) != 1.0 for _, a in situations)
        )  # fmt: skip

    @abstractmethod
    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Return the scene with the mechanism's seam replaced; not called at the neutral size."""

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Return the observables, arrays over the situations, with what no seam carries.

        Not called at the neutral size.
        """
        return seen


def _acting(mechanisms: Sequence[Mechanism], constants: Constants) -> list[Mechanism]:
    """Those that are not neutral, in the order in which they act: flight first."""
    sizes = [(m, m.parameters[0]) for m in mechanisms]
    acting = [m for m, size in sizes if constants[m.name][size.name] != size.neutral]
    return sorted(acting, key=lambda m: not m.in_flight)


def attached(
    mechanisms: Sequence[Mechanism], scene: Scene, constants: Constants, around: Surroundings
) -> Scene:
    """Return the scene with mechanisms attached one after the other."""
    for m in _acting(mechanisms, constants):
        if m.acts_on(scene):
            scene = m.attach(scene, constants[m.name], around)
    return scene


def observed(
    mechanisms: Sequence[Mechanism], situations: Sequence[Situation], constants: Constants,
    seen: Mapping[str, Array],
) -> Mapping[str, Array]:  # fmt: skip
    """Return the observables after the motion, with what attached mechanisms change of them.

    Undone in the order of attachment: the last change of the approach was the innermost. Each is
    shown the approach that those in flight before it have left.
    """
    met: list[tuple[Mechanism, Sequence[Situation]]] = []
    for m in _acting(mechanisms, constants):
        met.append((m, situations))
        if m.in_flight:
            values = constants[m.name]
            situations = [
                (m.attach(s, values, around) if m.acts_on(s) else s, around)
                for s, around in situations
            ]
    for m, here in reversed(met):
        moved = np.array([m.acts_on(scene) for scene, _ in here])
        if moved.all():
            seen = m.after(here, constants[m.name], seen)
            continue
        some = [one for one, acts in zip(here, moved, strict=True) if acts]
        after = m.after(some, constants[m.name], {k: v[moved] for k, v in seen.items()})
        seen = {k: _placed(v, moved, after[k]) for k, v in seen.items()}
    return seen


def _placed(whole: Array, here: Mask, part: Array) -> Array:
    found = whole.copy()
    found[here] = part
    return found
