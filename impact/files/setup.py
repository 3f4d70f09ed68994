"""The set-up file of an impact: the keys of a recording set's set.toml, and `[impact]`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from ...core.approach import speeds_at_touch
from ...core.errors import InputError, InputErrors
from ...core.inputs.flow_tables import HardeningTable
from ...core.inputs.rig_numbers import RigNumbers
from ...core.inputs.toml_input import InputTable, parse_model, read_toml
from ...core.material import Pair
from ...core.rig import (
    Height,
    Mass,
    Quantity,
    Rig,
    Speed,
    StrikerTable,
    TargetTable,
    Within,
    quantities,
)
from ...models.base import ContactLaw
from ...models.choose import follows_flow
from ..beam import rod_modes
from ..columns import Impacts
from ..integrate import Settings
from ..scene import Approach, ForceTransform, Friction, Scene, Support
from ..support import half_space_radiation, plate_support, sprung_support
from .bodies import bodies_of, flowing
from .second import SecondSphere
from .sweep import SweepTable, mistakes_in, run_sweep
from .taken import not_taken, taken_elsewhere

DEFAULT_LAWS = ("fitted", "hertz", "jackson-green", "ghaednia")
"""Ours first, then published ones beside it."""

FOLLOWING = "hardening"
"""Ours of metals with a flow curve; it comes first where there is one."""


def _is_radius(x: float) -> bool:
    return 1e-9 <= abs(x) <= 1e3


_TEXTS = ("format", "name", "description", "source", "licence")


class FlowingTarget(TargetTable):
    """`[target]` of an impact: also with a law of hardening, and a sphere in place of the flat."""

    hardening: HardeningTable | None = None
    """The flow stress grows with plastic strain."""
    shape: Literal["flat", "sphere"] = "flat"  # type: ignore[assignment]
    """The struck body is flat, or a second sphere."""
    radius_m: Annotated[Quantity, Within(_is_radius, "a radius, or below 0 a seat's")] | None = None
    """Radius of a second sphere; below 0 of a concave seat."""
    mass_kg: Mass | None = None
    """Mass of a second sphere that is free; left out: it is held."""


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
    support: Literal["rigid", "sprung", "plate", "half-space"] = "rigid"
    """How the flat rests."""
    support_damping_N_s_m: float = Field(default=0.0, ge=0.0)
    """Damping of a sprung support."""
    finite_tip: bool = False
    """Whether the curvature of a rod's tip ends at its shank."""
    repeats: int = Field(default=1, ge=1, le=100)
    """Blows on the same spot."""
    flight_s: float | None = Field(default=None, ge=0.0)
    """How long a flight between two touches may last."""
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
    pair: Pair | None = None
    """In place of the file's two bodies."""

    def scene(self, law: ContactLaw, *, speed: float | None = None) -> Scene:
        """Return the scene of one law; `speed` replaces the file's normal approach speed [m/s]."""
        found = _scene(self.file, self.numbers, law, source=self.source, speed=speed)
        return found if self.pair is None else found.with_(pair=self.pair)

    @property
    def second(self) -> SecondSphere | None:
        """The second sphere, where one is struck."""
        return _second_of(self.numbers)

    @property
    def about(self) -> dict[str, str]:
        """What the file says for people."""
        texts = {key: getattr(self.file, key) for key in _TEXTS}
        named = {f"{key}.material": body.material for key, body in self.file.bodies.items()}
        return {key: text for key, text in {**texts, **named}.items() if text}

    def check_laws(self, laws: Sequence[ContactLaw]) -> None:
        """Refuse a flow curve that none of the laws follows.

        Raises
        ------
        InputError
            There is one.
        """
        curves = _curves(self.file)
        if self.pair is not None and not self.pair.perfectly_plastic:
            curves = ["pair.flow"]
        if curves and not any(follows_flow(law) for law in laws):
            raise InputError(
                f"none of {', '.join(law.name for law in laws)} follows it", source=self.source,
                key=curves[0], allowed=f"{FOLLOWING} or a law.json among the laws",
            )  # fmt: skip

    def swept(self, law: ContactLaw, *, force: ForceTransform | None = None) -> Impacts:
        """Return the impacts of `[sweep]` by one law; `force` takes the place of the scene's."""
        scene = self.scene(law)
        return run_sweep(
            self.sweep, scene if force is None else scene.with_(force=force), self.settings,
            angle=math.radians(self.file.impact.angle_deg),
        )  # fmt: skip


def read_setup(path: Path) -> Setup:
    """Read and check a set-up file.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.
    """
    return setup_of(read_toml(path), source=str(path))


def setup_of(content: dict[str, Any], *, source: str) -> Setup:
    """Check the content of a set-up file; `source` names it in errors.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.
    """
    known = tuple(taken_elsewhere(content, source=source))
    if known:
        raise InputErrors(known)
    found = parse_model(content, SetupFile, source=source)
    errors = (
        *_mistakes(found, source), *not_taken(found, content, source=source),
        *mistakes_in(found.sweep, source),
    )  # fmt: skip
    if errors:
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
    return (FOLLOWING, *laws) if _curves(found) and not chosen else laws


def _curves(found: SetupFile) -> list[str]:
    """Keys that give a body a flow curve."""
    return [
        f"{key}.{name}"
        for key, body in found.bodies.items()
        for name in ("flow_curve", "hardening")
        if getattr(body, name)
    ]


def _mistakes(found: SetupFile, source: str) -> list[InputError]:
    """What the single keys cannot show."""
    errors = []

    def add(key: str, message: str, allowed: str) -> None:
        errors.append(InputError(message, source=source, key=key, allowed=allowed))

    impact, names = found.impact, ", ".join(found.strikers)
    if not impact.striker and len(found.strikers) > 1:
        add("impact.striker", "missing", f"one of {names}")
    if impact.striker and impact.striker not in found.strikers:
        add("impact.striker", f"no striker {impact.striker!r}", f"one of {names}")
    if (impact.impact_speed_m_s is None) == (impact.drop_height_m is None):
        add("impact.impact_speed_m_s", "give one of speed and height", "or impact.drop_height_m")
    if found.gravity_m_s2.value == 0.0:
        heights = (("impact", impact.drop_height_m), ("sweep", found.sweep.drop_height_m or None))
        for table, height in heights:
            if height is not None:
                add(f"{table}.drop_height_m", "nothing falls where gravity_m_s2 is 0",
                    "impact_speed_m_s")  # fmt: skip
    if impact.support == "sprung" and found.target.support_mass_kg is None:
        add("target.support_mass_kg", "missing", "the mass of a sprung support")
    if impact.support == "plate" and found.target.thickness_m is None:
        add("target.thickness_m", "missing", "the thickness of the plate")
    if impact.support in ("plate", "half-space") and found.target.density_kg_m3 is None:
        add("target.density_kg_m3", "missing", "the density of a support that carries waves off")
    errors += _of_a_second_sphere(found, source)
    return errors


def _of_a_second_sphere(found: SetupFile, source: str) -> Iterator[InputError]:
    """Yield what a second sphere needs, and what only a flat has."""
    target, impact = found.target, found.impact
    name = impact.striker or next(iter(found.strikers))
    two = target.shape == "sphere"
    rod = name in found.strikers and found.strikers[name].shape == "rod"
    wrong = (
        (two and target.radius_m is None, "target.radius_m", "missing", "of the second sphere"),
        (two and rod, f"strikers.{name}.shape", "a rod on a sphere", '"sphere"'),
        (two and impact.support != "rigid", "impact.support", repr(impact.support),
         '"rigid": a second sphere is held, or free with target.mass_kg'),
        (two and target.thickness_m is not None, "target.thickness_m", "of a sphere", "of a flat"),
        (two and bool(found.sweep.mass_kg), "sweep.mass_kg", "with two spheres",
         "strikers.NAME.mass_kg"),
        (two and bool(found.sweep.approach_spin_rad_s), "sweep.approach_spin_rad_s",
         "with two spheres", "impact.approach_spin_rad_s"),
        (not two and target.radius_m is not None, "target.radius_m", "of a flat",
         'with target.shape = "sphere"'),
        (not two and target.mass_kg is not None, "target.mass_kg", "of a flat",
         'with target.shape = "sphere"; support_mass_kg of a sprung support'),
    )  # fmt: skip
    for amiss, key, message, allowed in wrong:
        if amiss:
            yield InputError(message, source=source, key=key, allowed=allowed)


def _second_of(numbers: RigNumbers) -> SecondSphere | None:
    """Return the second sphere; none where a flat is struck."""
    radius = numbers.of.get("target.radius_m")
    if radius is None:
        return None
    return SecondSphere(radius, numbers.of.get("target.mass_kg", math.inf))


def _scene(
    found: SetupFile, numbers: RigNumbers, law: ContactLaw, *, source: str, speed: float | None
) -> Scene:
    impact, target, of = found.impact, found.target, numbers.of
    name = impact.striker or next(iter(found.strikers))
    rod = found.strikers[name].shape == "rod"
    pair, striker = bodies_of(numbers, name, source=source)
    if target.law == "elastic" and _curves(found):
        raise InputError(
            "a flow curve in an elastic baseline", source=source, key=_curves(found)[0],
            allowed='left out with target.law = "elastic"',
        )  # fmt: skip
    if _curves(found):
        ball, key = found.strikers[name], f"strikers.{name}"
        pair = replace(
            pair, sphere=flowing(pair.sphere, ball, key, source=source),
            flat=flowing(pair.flat, target, "target", source=source),
        )  # fmt: skip
    support, radiation = Support(), 0.0
    if impact.support == "sprung":
        support = sprung_support(
            of["target.support_mass_kg"], of.get("target.support_stiffness_N_m", 0.0),
            damping=impact.support_damping_N_s_m,
        )  # fmt: skip
    elif impact.support == "plate":
        support = plate_support(pair.flat, thickness=of["target.thickness_m"])
    elif impact.support == "half-space":
        radiation = half_space_radiation(pair.flat)
    edge = striker.radius if impact.finite_tip and rod else math.inf
    try:
        modes = rod_modes(
            striker.length, striker.radius, pair.sphere, mass=striker.mass, count=impact.modes,
            loss_factor=impact.loss_factor,
        )  # fmt: skip
    except InputError as error:
        raise InputError(
            error.message, source=source, key="impact.modes", allowed=error.allowed
        ) from None
    scene = Scene(
        law, pair, striker, _approach(impact, of, rod=rod, speed=speed),
        gravity=of["gravity_m_s2"], friction=Friction(of.get("friction.coefficient", 0.0)),
        force=ForceTransform(radiation=radiation, edge=edge), modes=modes, support=support,
    )  # fmt: skip
    second = _second_of(numbers)
    try:
        return scene if second is None else second.facing(scene)
    except InputError as error:
        raise InputError(
            error.message, source=source, key=error.key, allowed=error.allowed
        ) from None


def _approach(
    impact: ImpactTable, of: Mapping[str, float], *, rod: bool, speed: float | None
) -> Approach:
    """The motion at touch; a sphere's angle is that of its velocity, a rod's that of its axis."""
    angle = math.radians(impact.angle_deg)
    stated = of.get("impact.impact_speed_m_s", math.nan) if speed is None else speed
    normal, along = speeds_at_touch(
        stated, of.get("impact.drop_height_m", math.nan), angle, rod, gravity=of["gravity_m_s2"]
    )
    return Approach(
        float(normal), angle if rod else math.pi / 2.0,
        of.get("impact.approach_tangential_m_s", float(along)), of["impact.approach_spin_rad_s"],
    )  # fmt: skip
