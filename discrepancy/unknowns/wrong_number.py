"""Numbers of the sheet that may be wrong, as explanations that compete with physics.

A stated number with its standard deviation is a nuisance: it moves a little. A number that was
mistyped, misread or belongs to another temper of the metal is off by a factor, or a height by an
offset, that no standard deviation holds. Each is an explanation with one parameter, the factor; its
prior is flat in the logarithm over four times either way (a diameter for a radius is 2, hot-rolled
for cold-drawn steel 1.9, a hardness for a strength 3).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeGuard

import numpy as np

from ...core.arrays import Array
from ...core.observables import OBSERVABLES
from ...core.rig import StrikerTable
from ...dynamics.mechanisms.base import (
    Constants,
    Mechanism,
    Parameter,
    Situation,
    Surroundings,
    Values,
)
from ...dynamics.mechanisms.half_space_waves import HalfSpaceWaves
from ...dynamics.scene import Scene
from ...recordings.checks.limits import geometric_mass
from ..rules import RULES

WRONG = "wrong-input:"
"""Begins the name of every such explanation; the rest is the number's key."""

SPEED = "speed.scale"
"""Key of the factor on all speeds of approach."""

# limit: how well a density is known [-]: alloys of a kind
_DENSITY = 0.02

_SOURCE = "slips of sheets: units, a diameter for a radius, another temper"
_OF_TARGET = {
    "Sy_Pa": ("strength", "Pa"), "E_Pa": ("modulus", "Pa"), "radius_m": ("radius", "m"),
    "mass_kg": ("mass", "kg"),
}  # fmt: skip
_OF_STRIKER = {**_OF_TARGET, "tip_radius_m": _OF_TARGET["radius_m"]}
del _OF_STRIKER["radius_m"]  # of a rod's shank, which moves no reading by much
_SETTLED = {
    "strength": "a hardness test: if it gives what is stated, the metal feels the rate of the "
    "blows",
    "modulus": "the metal's name or certificate", "radius": "a calliper, or a picture of the tip",
    "mass": "a scale", "thickness": "a calliper on the flat's edge",
    "speed": "a second way to measure the speed: a height, a ruler in the film",
    "friction": "a slope or a pull with a spring balance",
    "height": "a ruler from the flat to the ball's lowest point",
    "angle": "a square on the flat: 90 degrees is upright",
    "power": "how they were worked out: the root of a ratio of heights is the restitution",
    "reading": "a gauge block, or the same mark by another instrument",
}  # fmt: skip
# limit: how far off a prediction is beside a power of ten [-]
NEAR_UNIT = 2.5

_SLIPS = (
    ("radius", 0.5, "a diameter stands for the radius"),
    ("radius", 2.0, "half of the radius stands for it"),
    ("strength", 1.0 / 2.8, "a hardness stands for the strength"),
    ("strength", 1.9, "another temper of the metal: cold-drawn for hot-rolled"),
    ("strength", 1.0 / 1.9, "another temper of the metal: hot-rolled for cold-drawn"),
    ("speed", 0.5, "half of the speed"),
    ("speed", 1.0 / 3.6, "km/h stand for m/s"),
    ("speed", 0.447, "miles an hour stand for m/s"),
    ("reading", 2.0, "half of the reading, as a radius for a diameter"),
    ("reading", 0.5, "twice the reading, as a diameter for a radius"),
)  # fmt: skip
"""Kind, factor that mends it, and the slip."""


class WrongNumber(Mechanism):
    """A number of the sheet that is off by a factor.

    - `key`, `unit`: of set.toml, as in the parameters of a verdict; the SI unit, "-" of what is a
      factor itself. `keys`: of every striker, where one slip is in all.
    - `kind`: strength, modulus, radius, mass, speed, friction, height, power or reading: numbers of
      one kind share a prior.
    - `title`: as a clause.
    - `times`: a power of ten that it is off by beside a factor near 1, where nothing less would do.
    """

    static = True
    form = 0.0
    measure = "factor"
    """Of how far it is off, as in verdict.json; `told` is it in words, around the number."""
    told = "By a factor of {}"

    def __init__(
        self, key: str, kind: str, title: str, unit: str = "-", *, times: float = 1.0,
        keys: tuple[str, ...] = (),
    ) -> None:  # fmt: skip
        self.key, self.kind, self.title, self.unit, self.times = key, kind, title, unit, times
        self.keys = keys or (key,)
        self.name = WRONG + key
        self.equations = f"{key} times the factor"
        most = RULES.wrong_most if times == 1.0 else NEAR_UNIT
        self.parameters = (
            Parameter(f"{key}_factor", "-", times / most, times * most, "log", times, _SOURCE),
        )  # fmt: skip

    @property
    def of_rig(self) -> bool:
        """Whether it is a number of the rig, times the factor."""
        return self.measure == "factor" and self.kind != "reading"

    @property
    def settled_by(self) -> str:
        """What would settle it."""
        return _SETTLED[self.kind]

    def slip(self, low: float, high: float) -> str:
        """Return the usual slip that gives a factor within an interval, or ""."""
        if self.times != 1.0:
            return "another unit, by a power of ten"
        found = (words for kind, factor, words in _SLIPS
                 if kind == self.kind and low <= factor <= high)  # fmt: skip
        return next(found, "")

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Return the scene as it is: the number is changed before scenes are made."""
        return scene


class WrongThickness(WrongNumber):
    """The flat's, by the waves that run off into it: as theory says, of another plate."""

    static = False
    form, rests_on = HalfSpaceWaves.form, HalfSpaceWaves.rests_on

    def __init__(self) -> None:
        title = "the stated thickness of the flat is wrong, by the waves that run off into it"
        super().__init__("target.thickness_m", "thickness", title, "m")
        self.equations = "waves of scale 1 into a plate of thickness_m times the factor"
        # at 1 the waves act: no factor does nothing
        self.parameters = (replace(self.parameters[0], neutral=math.inf),)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Return the scene with the waves into the other plate."""
        other = around.thickness * values[self.parameters[0].name]
        waves = HalfSpaceWaves()
        return waves.attach(scene, waves.usual(around), replace(around, thickness=other))


class WrongReading(WrongNumber):
    """All readings of one observable off by a factor: a calibration, a unit, a definition."""

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Return the observables with this one times the factor."""
        return {**seen, self.key: seen[self.key] * values[self.parameters[0].name]}


class Squared(WrongNumber):
    """Restitutions that are their squares: ratios of heights, or of energies."""

    measure, told = "power", "To the power of {}"

    def __init__(self) -> None:
        super().__init__("restitution_power", "power", "all restitutions stand squared")
        self.equations = "restitution to the power of p"
        told = "2; heights are read to the ball's middle or its foot"
        self.parameters = (
            Parameter(self.key, "-", 1.9, 2.1, "linear", 1.0, told, nodes=3),
        )  # fmt: skip

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Return the observables with the restitution to the power."""
        return {**seen, "restitution": seen["restitution"] ** values[self.key]}


class WrongHeight(WrongNumber):
    """All heights of fall off by one length: read to the ball's centre or top, or from a table."""

    measure, told = "offset", "By {}"

    def __init__(
        self, most: float, key: str = "drop_height_m", which: str = "heights of fall"
    ) -> None:
        super().__init__(key, "height", f"all {which} are off by one length")
        self.equations = f"{key} plus the offset"
        told = "within two diameters"
        self.parameters = (Parameter(f"{key}_offset", "m", -most, most, "linear", 0.0, told),)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Return the scene with the speed of the other height."""
        if not around.from_height or scene.press is not None:
            return scene
        a = scene.approach
        fallen = a.speed**2 + 2.0 * scene.gravity * values[self.parameters[0].name]
        return scene.with_(approach=replace(a, speed=math.sqrt(max(fallen, 0.04 * a.speed**2))))


class WrongHeights(WrongHeight):
    """Those of the rebounds too: restitutions are roots of ratios of heights so read."""

    def __init__(self, most: float) -> None:
        super().__init__(most, "heights_m", "heights, of fall and of rebound,")

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Return the observables with the restitution that such heights give."""
        off = values[self.parameters[0].name]
        fallen = np.array([
            s.approach.speed**2 / (2.0 * s.gravity) if a.from_height and s.press is None else np.inf
            for s, a in situations
        ])  # fmt: skip
        e, part = seen["restitution"], off / fallen
        return {**seen, "restitution": np.sqrt(np.maximum(e**2 + (e**2 - 1.0) * part, 0.0))}


class WrongAngle(WrongNumber):
    """All angles are the complements of what is stated, or nearly: read from the other line."""

    measure, told = "complement", "By {} of the way to 90 degrees less each"

    def __init__(self) -> None:
        super().__init__("angle_deg", "angle", "all angles are measured from the normal")
        self.equations = "angle_deg + t (90 - 2 angle_deg)"
        told = "the complement; how a line is found by eye"
        self.parameters = (
            Parameter("angle_deg_turned", "-", 0.9, 1.0, "linear", 0.0, told, nodes=3),
        )

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Return the scene at the other angle, of the same normal speed."""
        stated = scene.approach.incidence
        if scene.press is not None or stated > math.pi / 2.0 - 1e-9:
            return scene
        angle = stated + values["angle_deg_turned"] * (math.pi / 2.0 - 2.0 * stated)
        return scene.with_(approach=scene.approach.inclined(angle))


def by_density(strikers: Mapping[str, StrikerTable]) -> dict[str, bool]:
    """Return keys of masses and radii to whether the balls' densities contradict them.

    Contradicted is what could be so far off; a mass that agrees (False) is not wrong by itself.
    """
    found: dict[str, bool] = {}
    for name, ball in strikers.items():
        mass = geometric_mass(ball)
        if mass is None or ball.shape == "rod":
            continue
        off = abs(math.log(ball.mass_kg.value / mass.low))
        far = off > 5.0 * math.hypot(_DENSITY, ball.mass_kg.relative, mass.relative)
        if not far:
            found[f"strikers.{name}.mass_kg"] = False
        for key, n in (("mass_kg", 1), ("tip_radius_m", 3)) if far else ():
            if off / n < math.log(RULES.wrong_most):
                found[f"strikers.{name}.{key}"] = True
    for key in ("mass_kg", "tip_radius_m") if len(strikers) > 1 else ():
        of = [found.get(f"strikers.{name}.{key}") for name in strikers]
        if None not in of and len(set(of)) == 1:
            found[f"strikers.{key}"] = bool(of[0])
    return found


def is_wrong(mechanism: Mechanism) -> TypeGuard[WrongNumber]:
    """Whether an explanation is a number of the sheet."""
    return isinstance(mechanism, WrongNumber)


def wrong_factors(mechanisms: Sequence[Mechanism], constants: Constants) -> dict[str, float]:
    """Return the factors on numbers of the rig, by key, of the explanations among mechanisms."""
    return {
        key: constants[m.name][m.parameters[0].name]
        for m in mechanisms
        if is_wrong(m) and m.of_rig
        for key in m.keys
    }


def wrong_numbers(
    known: frozenset[str],
    strikers: Sequence[str],
    observed: Sequence[str],
    *,
    fallen: float,
    oblique: bool,
    squares: bool,
    plate: bool,
    misread: Mapping[str, float],
) -> Iterator[WrongNumber]:
    """Yield every stated number of a set that may be wrong.

    - `known`: keys of numbers that readings hang on and that are not taken as unknown already.
    - `strikers`, `observed`: what strikes, and what was read.
    - `fallen`: largest radius of what falls from a stated height [m]; 0 where none does.
    - `oblique`: whether a rod leans, or a ball's path.
    - `squares`: whether a restitution is compared with a simulated one.
    - `plate`: whether a thickness is stated, and waves into the flat are none that act anyway.
    - `misread`: key to the power of ten by which it is off.
    """
    tables = {"target": ("the flat", _OF_TARGET)}
    tables |= {f"strikers.{s}": (f"striker {s}", _OF_STRIKER) for s in strikers}
    for table, (body, words) in tables.items():
        for word, (kind, unit) in words.items():
            if (key := f"{table}.{word}") in known:
                title, times = f"the stated {kind} of {body} is wrong", misread.get(key, 1.0)
                yield WrongNumber(key, kind, title, unit, times=times)
    for word in ("mass_kg", "tip_radius_m") if len(strikers) > 1 else ():
        if known.issuperset(keys := tuple(f"strikers.{s}.{word}" for s in strikers)):
            kind, title = _OF_STRIKER[word][0], "the stated {} of every striker is wrong"
            key, times = f"strikers.{word}", misread.get(f"strikers.{word}", 1.0)
            yield WrongNumber(key, kind, title.format(kind), times=times, keys=keys)
    if SPEED in known:
        title, times = "all speeds of approach are off by one factor", misread.get(SPEED, 1.0)
        yield WrongNumber(SPEED, "speed", title, times=times)
    if "friction.coefficient" in known:
        yield WrongNumber("friction.coefficient", "friction", "the stated friction is wrong")
    if fallen > 0.0:
        yield WrongHeight(4.0 * fallen)
        if "restitution" in observed and not oblique:
            yield WrongHeights(4.0 * fallen)
    if oblique:
        yield WrongAngle()
    if squares:
        yield Squared()
    if plate:
        yield WrongThickness()
    for name in observed if len(observed) > 1 else ():
        title = f"all readings of {OBSERVABLES[name].label} are off by one factor"
        yield WrongReading(name, "reading", title, times=misread.get(name, 1.0))
