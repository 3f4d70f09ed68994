"""`[sweep]` of a set-up: what runs through values, every combination simulated.

Conditions of one rig are simulated together. Any other number of the file, by its key, makes a rig
of its own for each value: a file that states it.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field

from ...core.approach import speeds_at_touch
from ...core.arrays import Array
from ...core.errors import InputErrors, Mistake, amiss
from ...core.inputs.toml_input import InputTable, parse_model
from ...core.rig import Friction, Height, Mass, Quantity, Speed
from ..batch import scenes_over
from ..scene import Scene

# limit: largest number of combinations [-]
_COMBINATIONS = 10_000_000

# limit: most rigs of a sweep [-]: each is read as a file, in 2 ms
_RIGS = 10_000

_ALLOWED = (
    'a list of numbers, or { from = ..., to = ..., count = ..., spacing = "linear" or "log" }'
)


class _Range(InputTable):
    first: float = Field(alias="from")
    last: float = Field(alias="to")
    count: int = Field(ge=2, le=1_000_000, strict=True)
    spacing: Literal["linear", "log"] = "linear"


def _spread(given: Any) -> Any:
    """Return the numbers of a list or of a range."""
    if isinstance(given, dict):
        try:
            span = parse_model(given, _Range, source="")
        except InputErrors as mistakes:
            raise ValueError("; ".join(map(str, mistakes.errors))) from None
        if span.spacing == "linear":
            return tuple(np.linspace(span.first, span.last, span.count).tolist())
        if not (span.first > 0.0 and span.last > 0.0):
            ends = f"{span.first:g} to {span.last:g}"
            raise ValueError(f"both ends above 0 for logarithmic spacing, not {ends}")
        return tuple(np.geomspace(span.first, span.last, span.count).tolist())
    whole = isinstance(given, list | tuple) and len(given) > 0
    if not whole or any(isinstance(x, bool) or not isinstance(x, int | float) for x in given):
        raise ValueError(_ALLOWED)
    try:
        return tuple(float(x) for x in given)
    except OverflowError:  # a whole number of 400 digits
        raise ValueError(_ALLOWED) from None


def _slanted(values: tuple[float, ...]) -> tuple[float, ...]:
    if not all(0.0 < x <= 90.0 for x in values):
        raise ValueError("each above 0 and up to 90")
    return values


def _as_one(kind: Any) -> AfterValidator:
    """Hold every value to the range of the number that it stands for."""
    within = get_args(kind)[1].func

    def check(values: tuple[float, ...]) -> tuple[float, ...]:
        for x in (min(values), max(values)):
            within(Quantity(value=x))
        return values

    return AfterValidator(check)


_Values = Annotated[tuple[float, ...], BeforeValidator(_spread)]


class SweepTable(InputTable):
    """`[sweep]`: values of the conditions named; each a list or a range."""

    impact_speed_m_s: Annotated[_Values, _as_one(Speed)] = ()
    """Speeds along the flat's normal."""
    drop_height_m: Annotated[_Values, _as_one(Height)] = ()
    """Heights of fall."""
    angle_deg: Annotated[_Values, AfterValidator(_slanted)] = ()
    """Angles, as in [impact]."""
    friction: Annotated[_Values, _as_one(Friction)] = ()
    """Coefficients of friction."""
    mass_kg: Annotated[_Values, _as_one(Mass)] = ()
    """Masses of the striker."""
    approach_tangential_m_s: _Values = ()
    """Speeds along the flat."""
    approach_spin_rad_s: _Values = ()
    """Spins before the touch."""

    @property
    def swept(self) -> dict[str, tuple[float, ...]]:
        """The conditions that the file names, in the order of the keys."""
        return {name: tuple(v) for name, v in self.model_dump().items() if v}

    @property
    def count(self) -> int:
        """Number of combinations; 0 without any condition."""
        return math.prod(len(v) for v in self.swept.values()) if self.swept else 0

    @property
    def columns(self) -> dict[str, Array]:
        """Each of `swept`, shape (count,): a row a combination, the first condition slowest."""
        grid = np.meshgrid(*self.swept.values(), indexing="ij")
        return {name: g.ravel() for name, g in zip(self.swept, grid, strict=True)}


class _Keys(InputTable):
    sweep: dict[str, _Values]


def rigs(
    content: dict[str, Any], tables: Container[str], *, source: str
) -> tuple[dict[str, Any], dict[str, tuple[float, ...]], Iterator[dict[str, Any]]]:
    """Return the file with the conditions of `[sweep]` alone, its other keys, and each rig's file.

    Of every combination, the first key slowest; `tables` are those of a file.
    """
    given = content.get("sweep")
    found = dict(_leaves(given)) if isinstance(given, dict) else {}
    paths = {
        key: path for path in found
        if (key := ".".join(path)) not in SweepTable.model_fields and path[0] in tables
    }  # fmt: skip
    if not paths:
        return content, {}, iter(())
    kept = {".".join(path): x for path, x in found.items() if path not in paths.values()}
    stated = {"sweep": {key: found[path] for key, path in paths.items()}}
    keys = parse_model(stated, _Keys, source=source).sweep
    return {**content, "sweep": kept}, keys, _files({**content, "sweep": kept}, paths, keys)


def _files(
    content: dict[str, Any], paths: Mapping[str, tuple[str, ...]],
    keys: Mapping[str, tuple[float, ...]],
) -> Iterator[dict[str, Any]]:  # fmt: skip
    for values in product(*keys.values()):
        for path, x in zip(paths.values(), values, strict=True):
            # a whole number may be a count
            content = with_value(content, path, int(x) if x.is_integer() else x)
        yield content


def _leaves(
    table: Mapping[str, Any], before: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Any]]:
    for name, value in table.items():
        path = (*before, name) if before else tuple(name.split("."))
        if isinstance(value, dict) and value and value.keys().isdisjoint(("from", "to", "count")):
            yield from _leaves(value, path)
        else:
            yield path, value


def with_value(content: Any, path: tuple[str, ...], value: float) -> dict[str, Any]:
    """Return a file with a number at its place, by its tables and key, in place of what it says."""
    # a mechanism that is `true` is a table without numbers
    table = content if isinstance(content, dict) else {}
    name, *inner = path
    return {**table, name: with_value(table.get(name), tuple(inner), value) if inner else value}


def mistakes_in(sweep: SweepTable, *, rigs: int) -> Iterator[Mistake]:
    """Return what the single keys cannot show."""
    both, count = sweep.impact_speed_m_s and sweep.drop_height_m, max(sweep.count, 1) * rigs
    return amiss((
        (both, "sweep", "both speed and height", "impact_speed_m_s or drop_height_m"),
        (count > _COMBINATIONS, "sweep", f"{count} combinations", f"up to {_COMBINATIONS}"),
        (rigs > _RIGS, "sweep", f"{rigs} combinations of numbers of the file", f"up to {_RIGS}"),
    ))  # fmt: skip


@dataclass(frozen=True, slots=True)
class Stated:
    """How the file has the striker arrive, which a sweep changes in part."""

    angle: float  # of a rod's axis or of a sphere's velocity [rad]
    height: float  # of the fall [m]; NaN where the normal speed is stated
    gravity: float  # the file's [m/s^2]; a scene of two free spheres has none


def swept_scenes(sweep: SweepTable, plain: Scene, *, stated: Stated) -> list[Scene]:
    """Return the scene, and that of every combination."""
    if not sweep.count:
        return [plain]
    return [plain, *scenes_over(plain, **combinations(sweep, plain, stated=stated))]


def combinations(sweep: SweepTable, scene: Scene, *, stated: Stated) -> dict[str, Any]:
    """Return every combination as the arrays of `impacts`; what is not swept is the scene's.

    Each row arrives as a file with its numbers has it.
    """
    given = sweep.columns
    rod = scene.striker.length > 0.0
    angles = np.radians(given["angle_deg"]) if "angle_deg" in given else np.asarray(stated.angle)
    heights = np.asarray(given.get("drop_height_m", stated.height))
    speed = given.get("impact_speed_m_s")
    if speed is None:
        fallen = "drop_height_m" in given or math.isfinite(stated.height)
        speed = np.asarray(math.nan if fallen else scene.approach.speed)
    speeds, along = speeds_at_touch(speed, heights, angles, rod, gravity=stated.gravity)
    tangential = given.get("approach_tangential_m_s")
    if tangential is None:
        # a slanted sphere's follows from the angle; it is stated of all others
        slanted = not rod and ("angle_deg" in given or not math.isclose(stated.angle, math.pi / 2))
        tangential = along if slanted else np.asarray(scene.approach.tangential)
    return {
        "speeds": speeds, "angles": angles, "friction": given.get("friction"),
        "masses": given.get("mass_kg"), "tangential": tangential,
        "spins": given.get("approach_spin_rad_s"),
    }  # fmt: skip
