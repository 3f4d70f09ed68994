"""The set-up file of an impact: the keys of a recording set's set.toml, and `[impact]`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from ...core.errors import InputError, InputErrors, Mistake, amiss, in_file
from ...core.inputs.flow_tables import HardeningTable
from ...core.inputs.rig_numbers import RigNumbers
from ...core.inputs.second_sphere import second_sphere_mistakes
from ...core.inputs.toml_input import InputTable, parse_model, read_toml, table_in
from ...core.material import Pair
from ...core.rig import (
    Height,
    Quantity,
    Rig,
    Speed,
    StrikerTable,
    TargetTable,
    Temperature,
    quantities,
)
from ...models.base import ContactLaw
from ...models.choose import follows_flow
from ..batch import Change, impacts, unchanged
from ..columns import Impacts
from ..integrate import Settings
from ..mechanisms.approach import Tilt
from ..mechanisms.asked import Asked
from ..result import Impact
from ..rules import RULES
from ..scene import Scene
from .mechanism_tables import MechanismsTable, added_in, asked_in, mistakes_of
from .scenes import curves_in, scene_in
from .second import SecondSphere, second_of
from .sweep import Stated, SweepTable, combinations, mistakes_in, rigs, swept_scenes
from .taken import not_taken, taken_elsewhere

DEFAULT_LAWS = ("fitted", "hertz", "jackson-green", "ghaednia")
"""Ours first, then published ones beside it."""

FOLLOWING = "hardening"
"""Ours of metals with a flow curve; it comes first where there is one."""

# limit: speeds at neither of which a mechanism that is refused acts [m/s]
_OTHER_SPEEDS = (1e-3, 1e2)

_TEXTS = ("format", "name", "description", "source", "licence")


class FlowingTarget(TargetTable):
    """`[target]` of an impact: also with a law of hardening."""

    hardening: HardeningTable | None = None
    """The flow stress grows with plastic strain."""


class FlowingStriker(StrikerTable):
    """`[strikers.NAME]` of an impact: also with a law of hardening."""

    hardening: HardeningTable | None = None
    """The flow stress grows with plastic strain."""


class ImpactTable(InputTable):
    """`[impact]`: what is dropped, how, with which laws and which of the options."""

    striker: str = ""
    """Which striker; needed where there are several."""
    angle_deg: float = Field(default=90.0, gt=0.0, le=90.0)
    """Between a rod's axis, or a sphere's velocity, and the flat."""
    impact_speed_m_s: Speed | None = None
    """Speed of the tip along the flat's normal; or drop_height_m."""
    drop_height_m: Height | None = None
    """Height of fall; or impact_speed_m_s."""
    approach_tangential_m_s: Quantity | None = None
    """Speed along the flat."""
    approach_spin_rad_s: Quantity = Quantity(value=0.0)
    """Spin before the touch, counter-clockwise."""
    laws: tuple[str, ...] = Field(default=DEFAULT_LAWS, min_length=1, strict=False)
    """Contact laws, as in `dentscope laws list`; with a flow curve, hardening comes first."""
    modes: int = Field(default=0, ge=0, le=60)
    """Vibrations of the rod that are simulated, lowest first; 0: a rigid rod."""
    loss_factor: float = Field(default=0.0, ge=0.0, lt=1.0)
    """Their damping."""
    support: Literal["rigid", "sprung", "plate", "half-space", "rod"] = "rigid"
    """How the flat rests; "rod": it is the end of a long one, struck along its axis."""
    support_radius_m: float = Field(default=0.0, ge=0.0)
    """Radius of that rod."""
    support_damping_N_s_m: float = Field(default=0.0, ge=0.0)
    """Damping of a sprung support."""
    finite_tip: bool = False
    """Whether the curvature of a rod's tip ends at its shank."""
    repeats: int = Field(default=1, ge=1, le=100)
    """Blows on the same spot."""
    flight_s: float | None = Field(default=None, ge=0.0)
    """How long a flight between two touches may last."""
    temperature_K: Temperature | None = None
    """Of the bodies, whose strength is that at environment.temperature_K; for thermal-softening."""
    max_steps: int = Field(default=20_000, ge=10)
    """Steps after which an impact is given up."""
    max_contacts: int = Field(default=50, ge=1)
    """Touches after which an impact is given up."""


class SetupFile(Rig):
    """The whole file."""

    target: FlowingTarget
    """The flat."""
    strikers: dict[str, FlowingStriker] = Field(min_length=1)  # type: ignore[assignment]
    """What strikes, by name: `[strikers.NAME]`."""
    impact: ImpactTable
    """The blow."""
    sweep: SweepTable = SweepTable()
    """Conditions that run through values; every combination is simulated."""
    mechanisms: MechanismsTable = MechanismsTable()
    """Physics beyond the laws, by the names of a verdict: true, false or a table of numbers."""

    @property
    def striker(self) -> str:
        """Name of the striker: the one that `[impact]` chooses, or the only one."""
        return self.impact.striker or next(iter(self.strikers))


@dataclass(frozen=True, slots=True)
class Setup:
    """What a set-up file asks for, ready to run."""

    name: str
    laws: tuple[str, ...]
    repeats: int
    sweep: SweepTable
    settings: Settings
    file: SetupFile
    content: dict[str, Any]
    source: str
    numbers: RigNumbers
    pair: Pair | None = None  # in place of the file's two bodies
    # numbers of the file that `[sweep]` lets run through values
    keys: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    rigs: tuple[Setup, ...] = ()  # the same with each combination of these, the first slowest

    def __repr__(self) -> str:
        return f"Setup({self.name!r}, of {self.source}, by {', '.join(self.laws)})"

    def plain(self, law: ContactLaw) -> Scene:
        """Return the scene of one law."""
        found = scene_in(self.file, self.numbers, law, source=self.source)
        return found if self.pair is None else found.with_(pair=self.pair)

    def scene(self, law: ContactLaw) -> Scene:
        """Return the scene of `plain` with the mechanisms that act in it."""
        plain = self.plain(law)
        (scene,) = self.acting(plain).attached([plain])
        return scene

    def acting(self, *plain: Scene) -> Asked:
        """Return the mechanisms asked for, without those that change nothing of these scenes."""
        asked = self.asked
        return asked.without(*asked.idle(plain))

    def read(self, law: ContactLaw, found: Impact) -> Impact:
        """Return an impact of `scene` as it is read: with what a mechanism takes after it."""
        if not self.asked and self.second is None:
            return found
        plain = self.plain(law)
        found = self.acting(plain).read(plain, found)
        spin = self._own_spin(plain, found.rebound_spin_rad_s)
        return replace(found, rebound_spin_rad_s=float(spin))

    def _own_spin(self, plain: Scene, spin: Any) -> Any:
        """The striking sphere's own spin; of one on a flat it is what was simulated."""
        R, mass, before = plain.pair.R, plain.striker.mass, plain.approach.spin
        return spin if self.second is None else self.second.own_spin(spin, before, R, mass)

    def with_mechanism(self, name: str, numbers: Mapping[str, float] | None) -> Setup:
        """Return the same with these numbers of a mechanism, or without it."""
        table = None
        if numbers is not None:
            kind = table_in(type(self.file.mechanisms).model_fields[name].annotation)
            assert kind is not None
            stated: dict[str, Any] = {k: Quantity(value=x) for k, x in numbers.items()}
            table = kind.model_construct(**stated)
        mechanisms = self.file.mechanisms.model_copy(update={name: table})
        return replace(self, file=self.file.model_copy(update={"mechanisms": mechanisms}))

    @property
    def asked(self) -> Asked:
        """The mechanisms of the file."""
        return asked_in(self.file)

    @property
    def asked_of_sweep(self) -> Asked:
        """The same as the blows of `[sweep]` arrive: from heights, where the blow may not."""
        return asked_in(self.file, swept=True)

    @property
    def second(self) -> SecondSphere | None:
        """The second sphere, where one is struck."""
        return second_of(self.numbers)

    @property
    def about(self) -> dict[str, str]:
        """What the file says for people."""
        texts = {key: getattr(self.file, key) for key in _TEXTS}
        named = {f"{key}.material": body.material for key, body in self.file.bodies.items()}
        return {key: text for key, text in {**texts, **named}.items() if text}

    def check_laws(self, laws: Sequence[ContactLaw]) -> None:
        """Refuse a flow curve that none of the laws follows, a mechanism that acts by none."""
        curves = curves_in(self.file)
        if self.pair is not None and not self.pair.perfectly_plastic:
            curves = ["pair.flow"]
        if curves and not any(follows_flow(law) for law in laws):
            raise InputError(
                f"none of {', '.join(law.name for law in laws)} follows it", source=self.source,
                key=curves[0], allowed=f"{FOLLOWING} or a law.json among the laws",
            )  # fmt: skip
        self._check_weight(self.plain(laws[0]))
        self._check_mechanisms(laws)

    def _check_weight(self, scene: Scene) -> None:
        """Refuse a speed that is round-off beside what the weight alone does (Hertz)."""
        E, R, weight = scene.pair.E_reduced, scene.pair.R, scene.striker.mass * scene.gravity
        pressed = (0.75 * weight / (E * math.sqrt(R))) ** (2.0 / 3.0)
        slowest = min((scene.approach.speed, *self.sweep.swept.get("impact_speed_m_s", ())))
        if slowest**2 < RULES.put_down * scene.gravity * pressed:
            raise InputError(
                f"{slowest:.3g} m/s is no blow: the weight alone presses the tip "
                f"{pressed:.2g} m in", source=self.source, key="impact_speed_m_s",
                allowed="more, or gravity_m_s2 = 0",
            )  # fmt: skip

    def _check_mechanisms(self, laws: Sequence[ContactLaw]) -> None:
        for rig in (self, *self.rigs):
            rig._check_tilt(laws[0])
        never = self._never(laws) if self.asked else {}
        for rig in self.rigs if never else ():  # a number of the sweep may let it act
            never = {name: why for name, why in never.items() if name in rig._never(laws)}
        if never:
            told = ((f"mechanisms.{name}", never[name], "left out") for name in sorted(never))
            raise InputErrors(in_file(told, self.source))

    def _check_tilt(self, law: ContactLaw) -> None:
        """Refuse what would be cut in silence."""
        if (tilt := self.asked.constants.get("tilt")) is None:
            return
        scenes = swept_scenes(self.sweep, self.plain(law), stated=self.stated)
        if any(Tilt.cut(scene, tilt) for scene in scenes):
            raise InputError(
                f"{tilt['tilt_deg']:g} turns the striker onto the flat", source=self.source,
                key="mechanisms.tilt.tilt_deg",
                allowed="what leaves a rod 0.02 rad and a ball 0.001 m/s towards it",
            )  # fmt: skip

    def _never(self, laws: Sequence[ContactLaw]) -> dict[str, str]:
        """Return why, for the mechanisms that act by none of the laws, in no blow of this rig.

        What acts at another speed is told of at this one.
        """
        asked, found = self.asked, list[dict[str, str]]()
        for plain in (self.plain(law) for law in laws):
            others = [plain.with_(approach=replace(plain.approach, speed=v)) for v in _OTHER_SPEEDS]
            swept = swept_scenes(self.sweep, plain, stated=self.stated)
            ways = asked.idle(others), self.asked_of_sweep.idle(swept)
            here = asked.idle([plain])
            found.append({k: why for k, why in here.items() if all(k in way for way in ways)})
        return {k: why for k, why in found[0].items() if all(k in one for one in found)}

    @property
    def varied(self) -> dict[str, tuple[float, ...]]:
        """All that `[sweep]` lets run through values."""
        return {**self.keys, **self.sweep.swept}

    @property
    def stated(self) -> Stated:
        """How the striker arrives, as far as no sweep changes it."""
        impact, of = self.file.impact, self.numbers.of
        height = of.get("impact.drop_height_m", math.nan)
        return Stated(math.radians(impact.angle_deg), height, of["gravity_m_s2"])

    def swept(self, law: ContactLaw, *, change: Change = unchanged) -> Impacts:
        """Return the impacts of `[sweep]` by one law, what is done to the force changed."""
        if self.rigs:
            first, *others = (one.swept(law, change=change) for one in self.rigs)
            grid = np.meshgrid(*self.keys.values(), indexing="ij")
            each = zip(self.keys, (np.repeat(x.ravel(), len(first)) for x in grid), strict=True)
            return Impacts({**dict(each), **first.joined(*others).columns})
        plain = self.plain(law)
        given = combinations(self.sweep, plain, stated=self.stated)
        asked = self.asked_of_sweep
        found = impacts(plain, **given, settings=self.settings, asked=asked, change=change)
        # a height of fall is a speed to `impacts`
        heights = {k: v for k, v in self.sweep.columns.items() if k not in found.columns}
        found = Impacts({**heights, **found.columns})
        if self.second is None:
            return found
        columns, speed = ("approach_spin_rad_s", "rebound_spin_rad_s"), found["impact_speed_m_s"]
        relative, both = found["rebound_speed_m_s"], plain.striker.mass
        own = np.full(len(found), self.file.strikers[self.file.striker].mass_kg.value)
        before, after = found["approach_tangential_m_s"], found["tangential_rebound_m_s"]
        return Impacts({
            **found.columns, **{name: self._own_spin(plain, found[name]) for name in columns},
            "rebound_speed_m_s": self.second.own_rebound(relative, speed, both), "mass_kg": own,
            "tangential_rebound_m_s": self.second.own_tangential(after, before, both),
        })  # fmt: skip


def read_setup(path: Path) -> Setup:
    """Read and check a set-up file; every mistake is a line."""
    return setup_of(read_toml(path), source=str(path))


def setup_of(content: dict[str, Any], *, source: str) -> Setup:
    """Check the content of a set-up file; `source` names it in errors, a line each."""
    plain, keys, files = rigs(content, SetupFile.model_fields, source=source)
    setup = _alone(plain, source=source, rigs=math.prod(map(len, keys.values())))
    try:
        each = tuple(_alone(one, source=source) for one in files)
    except InputError as wrong:
        mistakes = wrong.errors if isinstance(wrong, InputErrors) else (wrong,)
        raise InputErrors(tuple(x.at(source, f"sweep.{x.key}") for x in mistakes)) from None
    return replace(setup, keys=keys, rigs=each)


def _alone(content: dict[str, Any], *, source: str, rigs: int = 1) -> Setup:
    """One rig, of `rigs` of its sweep."""
    if known := in_file(taken_elsewhere(content), source):
        raise InputErrors(known)
    found = parse_model({**content, **added_in(content, source=source)}, SetupFile, source=source)
    parts = _mistakes(found), not_taken(found, content), mistakes_in(found.sweep, rigs=rigs)
    if errors := in_file(chain.from_iterable(parts), source):
        raise InputErrors(errors)
    impact = found.impact
    flight = math.nan if impact.flight_s is None else impact.flight_s
    settings = Settings(max_steps=impact.max_steps, max_contacts=impact.max_contacts, flight=flight)
    return Setup(
        found.name or Path(source).stem, _laws(found), impact.repeats, found.sweep, settings, found,
        content, source, _numbers(found, source),
    )  # fmt: skip


def _numbers(found: SetupFile, source: str) -> RigNumbers:
    """The file's numbers, those of the blow among them; nothing yields in an elastic baseline."""
    numbers = found.numbers(source=source)
    elastic = found.bodies if found.target.law == "elastic" else ()
    return numbers.with_(
        {**quantities(found.impact, "impact."), **{f"{k}.Sy_Pa": math.inf for k in elastic}}
    )


def _laws(found: SetupFile) -> tuple[str, ...]:
    """The laws of the file; by default with the one that follows a flow curve, if there is one."""
    laws = tuple(found.impact.laws)
    chosen = "laws" in found.impact.model_fields_set
    return (FOLLOWING, *laws) if curves_in(found) and not chosen else laws


def _mistakes(found: SetupFile) -> Iterator[Mistake]:
    """Yield what the single keys cannot show."""
    impact, target, sweep = found.impact, found.target, found.sweep
    names, striker = ", ".join(found.strikers), found.strikers.get(found.striker)
    speed, height, on = impact.impact_speed_m_s, impact.drop_height_m, impact.support
    weighed = striker is not None and striker.inertia_kg_m2 is not None
    waves = on in ("plate", "half-space", "rod")
    yield from amiss((
        (not impact.striker and len(found.strikers) > 1, "impact.striker", "missing",
         f"one of {names}"),
        (striker is None, "impact.striker", f"no striker {impact.striker!r}", f"one of {names}"),
        ((speed is None) == (height is None), "impact.impact_speed_m_s",
         "missing" if speed is None else "given beside impact.drop_height_m",
         "this or impact.drop_height_m, one of the two"),
        *(
            (falls and found.gravity_m_s2.value == 0.0, f"{table}.drop_height_m",
             "nothing falls where gravity_m_s2 is 0", "impact_speed_m_s")
            for table, falls in (("impact", height is not None), ("sweep", sweep.drop_height_m))
        ),
        (on == "sprung" and target.support_mass_kg is None, "target.support_mass_kg", "missing",
         "the mass of a sprung support"),
        (on == "plate" and target.thickness_m is None, "target.thickness_m", "missing",
         "the thickness of the plate"),
        (on == "rod" and not impact.support_radius_m > 0.0, "impact.support_radius_m", "missing",
         "the radius of the rod whose end is struck"),
        (waves and target.density_kg_m3 is None, "target.density_kg_m3", "missing",
         "the density of a support that carries waves off"),
        (sweep.mass_kg and weighed, "sweep.mass_kg",
         f"given beside strikers.{found.striker}.inertia_kg_m2",
         "one of the two: the inertia follows a swept mass"),
    ))  # fmt: skip
    if striker is not None:
        yield from _of_a_slanted_sphere(found, striker)
    yield from _of_a_second_sphere(found)
    if striker is not None:
        yield from mistakes_of(found)


def _of_a_slanted_sphere(found: SetupFile, striker: StrikerTable) -> Iterator[Mistake]:
    """Yield a speed along the flat that is given beside the angle which says it."""
    impact, sweep, key = found.impact, found.sweep, "approach_tangential_m_s"
    slanted = striker.shape != "rod" and (sweep.angle_deg or impact.angle_deg != 90.0)
    for table, along in (
        ("impact", impact.approach_tangential_m_s),
        ("sweep", sweep.swept.get(key)),
    ):
        if slanted and along is not None:
            allowed = "one of the two: the angle of a sphere's velocity says its speed along"
            yield f"{table}.{key}", "given beside angle_deg", allowed


def _of_a_second_sphere(found: SetupFile) -> Iterator[Mistake]:
    """Yield what a second sphere needs, and what only a flat has."""
    used = {k: t for k, t in found.strikers.items() if k == found.striker}
    yield from second_sphere_mistakes(found.target, used)
    impact, sweep, two = found.impact, found.sweep, "with two spheres"
    if found.target.shape == "sphere":
        yield from amiss((
            (impact.support != "rigid", "impact.support", repr(impact.support),
             '"rigid": a second sphere is held, or free with target.mass_kg'),
            (sweep.mass_kg, "sweep.mass_kg", two, "strikers.NAME.mass_kg"),
            (sweep.approach_spin_rad_s, "sweep.approach_spin_rad_s", two,
             "impact.approach_spin_rad_s"),
        ))  # fmt: skip
