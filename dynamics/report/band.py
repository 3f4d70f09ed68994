"""How sure the numbers of a blow are: inputs, contact law and metal, each with its part.

The inputs' part takes every quantity that the file states with a standard deviation one of these up
and down. The law's is how far it lies from finite elements of the same two bodies, the metal's how
far real metals are from elastic and perfectly plastic ones: both act on force, recovery and crater
as a diagnosis has them, and grow with the share of the work that the contact keeps.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import reduce
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.material import Pair
from ...core.rig import BodyTable, Quantity
from ...models import law_named
from ...models.base import ContactLaw
from ...models.choose import demand, follows_flow
from ...models.uncertainty import METAL, RECOVERY_EXPONENT, WITH_CURVE
from ..batch import Change, unchanged
from ..columns import Impacts
from ..files.mechanism_tables import asked_of
from ..files.sweep import with_value
from ..integrate import Settings, strike
from ..mechanisms.arithmetic import times
from ..result import Impact
from ..rules import RULES
from ..scene import ForceTransform, Scene
from ..strength import NODES
from .beside import error_of
from .onset import largest_mean_pressure

if TYPE_CHECKING:
    from ..files.setup import Setup

from ...core.inputs.ranges import LEAST_KNOWN

# limit: largest error of a law, of a logarithm [-]; beyond it a law is off by a factor
_LARGEST_ERROR = 1.0

# limit: most steps of a blow that is made for a band alone [-]; usual blows take some 200, a
# vibrating rod 2000; tools/benchmarks/fuzz_keys.py ended in no 30 s with five times that
_BAND_STEPS = 4000

LAW, METALS = "contact law", "metal"
"""Names of the parts that are no input."""

_NUMBERS = (*(f.name for f in fields(Impact) if f.type == "float"), "mean_force_N")
_CRATER = "permanent_depth_m"
SWEPT = ("restitution", _CRATER, "contact_time_s", "peak_force_N")
"""The numbers of a sweep that have a band."""
# limit: conditions up to which a sweep has a band [-]: each takes some ten impacts in steps
MOST_SWEPT = 400
PRESSURE = "largest_mean_pressure_Pa"
"""The one number beside those of `Impact`."""


class _Sizes(NamedTuple):
    """Standard deviations of the logarithms, of exponent and sphere's share absolute."""

    force: float
    recovery: float
    exponent: float
    crater: float
    radius: float
    share: float = 0.0


@dataclass(frozen=True)
class Band:
    """Standard deviations of an impact's numbers, by part and field of `Impact`."""

    # change of each field by one standard deviation of the part: keys of the file, `LAW`, `METALS`
    parts: Mapping[str, Mapping[str, float]]

    def std(self, name: str) -> float:
        """Standard deviation of one field, all parts together."""
        return math.sqrt(sum(part.get(name, 0.0) ** 2 for part in self.parts.values()))

    def rules(self, name: str) -> str:
        """The part with the largest share, and how much of the variance it has; empty: none."""
        whole = self.std(name)
        if not whole > 0.0:
            return ""
        first = max(self.parts, key=lambda part: abs(self.parts[part].get(name, 0.0)))
        return f"{first} {100.0 * (self.parts[first].get(name, 0.0) / whole) ** 2:.0f} %"


def band_of(setup: Setup, law: ContactLaw) -> Band:
    """Return the band of a set-up's last blow by one law; an empty one if that did not end."""
    found = last_blow(setup, law)
    if not found.outcome.completed:
        return Band({})

    def ended(one: Setup) -> dict[str, float]:
        blow = last_blow(one, law)
        return {**_values(blow), PRESSURE: largest_mean_pressure(one.scene(law), blow)}

    scene = setup.scene(law)
    sizes = _sizes_of(setup, scene, found)
    parts = _of_inputs(setup, law, (*_NUMBERS, PRESSURE), ended) | _of_law(
        np.array(sizes), _NUMBERS, lambda change: _values(last_blow(setup, law, change)),
        {name: getattr(found, name) for name in ("residual_flat_m", "residual_sphere_m")},
        found.peak_depth_m,
    )  # fmt: skip
    pressure = largest_mean_pressure(scene, found)
    for name, own in zip((LAW, METALS), sizes, strict=True):
        parts[name][PRESSURE] = pressure * math.hypot(own.force, 2.0 * own.radius)
    return Band({
        part: {n: float(x) for n, x in changes.items() if math.isfinite(x)}
        for part, changes in parts.items()
    })  # fmt: skip


def idle(setup: Setup, band: Band) -> list[tuple[str, float]]:
    """Return the quantities stated as uncertain that change nothing, and how uncertain they are."""
    stated = (
        (".".join(path), quantity.relative)
        for path, quantity in _uncertain(setup)
        if path[-1] in reduce(lambda table, part: table.get(part, {}), path[:-1], setup.content)
    )
    return [(key, share) for key, share in stated if not any(band.parts.get(key, {}).values())]


def vague(setup: Setup) -> Iterator[tuple[str, float]]:
    """Yield the quantities whose standard deviation is larger than they are, and how much."""
    for path, quantity in _uncertain(setup):
        if quantity.relative > 1.0:
            yield ".".join(path), quantity.relative


def compared(law: ContactLaw, pair: Pair, depth: float) -> bool:
    """Whether the law's error is known at this depth: where a law states no reach, the fitted's."""
    need = demand(pair, depth)
    own = law.domain.a_over_R_max
    reach = own if math.isfinite(own) else law_named("fitted").domain.a_over_R_max
    return need.regime == "elastic" or need.a_over_R <= reach


def too_deep(
    law: ContactLaw, blows: Iterable[tuple[Pair, Sequence[float] | Array]]
) -> Iterator[str]:
    """Say how many blows go beyond, by the depths (n,) [m] of each pair."""
    count, far = 0, list[float]()
    for pair, depths in blows:
        found = [d for d in depths if math.isfinite(d)]
        count += len(depths)
        if found and not compared(law, pair, max(found)):
            far += [d / pair.R for d in found if not compared(law, pair, d)]
    if far:
        yield (
            f"{law.name}: {len(far)} of {count} impacts go so deep, to {max(far):.2g} R, that no "
            "law was compared with finite elements there"
        )


def last_blow(setup: Setup, law: ContactLaw, change: Change = unchanged) -> Impact:
    """Return the last of the set-up's repeats, each on the spot of the one before.

    `change` is done to the scene's force; such a blow, for a band, has fewer steps to end in.
    """
    scene = setup.scene(law)
    settings = setup.settings
    if change is not unchanged:
        steps = min(settings.max_steps, _BAND_STEPS)
        scene, settings = scene.with_(force=change(scene.force)), replace(settings, max_steps=steps)
    return repeated(setup, scene, settings)


def repeated(setup: Setup, scene: Scene, settings: Settings | None = None) -> Impact:
    """Return the last of a scene's repeats, read as the set-up's and within its budgets."""
    for _ in range(setup.repeats):
        found = strike(scene, settings or setup.settings)
        scene = scene.with_(spot=found.spot)
    return setup.read(scene.law, found)


def _values(impact: Impact) -> dict[str, float]:
    return {name: float(getattr(impact, name)) for name in _NUMBERS}


def _shifted(setup: Setup, law: ContactLaw) -> Iterator[tuple[str, float, Setup, Setup]]:
    """Yield key, share of a standard deviation, and the set-ups one up and one down."""
    from ..files.setup import setup_of

    def at(path: tuple[str, ...], value: float) -> Setup | None:
        try:
            found = setup_of(with_value(setup.content, path, value), source=setup.source)
            found.scene(law)
        except InputError:  # a Poisson's ratio beyond 0.5
            return None
        return found

    for path, quantity in _uncertain(setup):
        for share in RULES.held:
            up, down = (at(path, _moved(quantity, sign * share)) for sign in (1.0, -1.0))
            if up is not None and down is not None:
                yield ".".join(path), share, up, down
                break
        else:  # at a bound: to one side
            if up is not None or down is not None:
                yield ".".join(path), 0.5 * share, up or setup, down or setup


def _moved(quantity: Quantity, by: float) -> float:
    """The value `by` standard deviations off; what is positive stays so."""
    if quantity.value > 0.0:
        return quantity.value * math.exp(min(by * quantity.relative, LEAST_KNOWN))
    return quantity.value + by * quantity.std


def _uncertain(setup: Setup) -> Iterator[tuple[tuple[str, ...], Quantity]]:
    """Yield the quantities that stand with a standard deviation, and where they stand."""
    file, content = setup.file, setup.content
    name = setup.file.striker
    tables: dict[tuple[str, ...], Any] = {
        (): file, ("target",): file.target, ("strikers", name): file.strikers[name],
        ("friction",): file.friction, ("impact",): file.impact,
        ("environment",): file.environment,
        **{("mechanisms", name): table for name, table in asked_of(file).items()},
    }  # fmt: skip
    for place, table in tables.items():
        given = content
        for part in place:
            given = given.get(part, {}) if isinstance(given, dict) else {}
        for key in type(table).model_fields:
            value = getattr(table, key)
            # the mass of a solid sphere moves with its radius and density
            derived = key == "mass_kg" and key not in given
            follows = key == "hardness_Pa" and table.Sy_Pa is None
            if isinstance(value, Quantity) and value.std > 0.0 and not derived and not follows:
                # the radius of a sphere may stand as `radius_m`
                other = key == "tip_radius_m" and key not in given
                yield (*place, "radius_m" if other else key), value
        if isinstance(table, BodyTable) and table.Sy_Pa is None and table.strength is not None:
            yield (*place, "Sy_Pa"), table.strength


def _sizes_of(setup: Setup, scene: Scene, found: Any) -> tuple[_Sizes, _Sizes]:
    """`_sizes`, and what the flat in place of a second sphere adds."""
    of_law, of_metal = _sizes(scene, found)
    if setup.second is not None:
        at = scene.pair, found.peak_depth_m
        off = setup.second.departure(scene.law, *at)
        of_law = of_law._replace(
            force=math.hypot(of_law.force, float(off)),
            crater=math.hypot(of_law.crater, float(setup.second.crater_departure(*at))),
        )
    return of_law, of_metal


def _sizes(scene: Scene, found: Any) -> tuple[_Sizes, _Sizes]:
    """How far off the law is from finite elements, and these from a metal, at this depth.

    `found` has the observables of an impact as attributes.
    """
    pair, law = scene.pair, scene.law
    kept = 1.0 - found.energetic_restitution**2
    lost = min(max(kept, 0.0), 1.0) if kept > 1e-6 else 0.0
    if not math.isfinite(pair.Sy_min):
        x = math.sqrt(max(found.peak_depth_m, 0.0) / pair.R)
        first, second = RULES.hertz_sphere
        error = RULES.hertz_error + pair.elastic_share * x * (first + second * x)
        return _Sizes(error, 0.0, 0.0, 0.0, 0.0), _Sizes(0.0, 0.0, 0.0, 0.0, 0.0)
    known = error_of(law, pair, np.array([found.peak_depth_m]))
    force, radius, dent, back, share = (
        min(float(np.nan_to_num(x[0], nan=_LARGEST_ERROR)), _LARGEST_ERROR)
        for x in (known.force, known.radius, known.dent, known.given_back, known.share)
    )
    sizes = WITH_CURVE if follows_flow(law) and not pair.perfectly_plastic else METAL
    if not found.residual_flat_m + found.residual_sphere_m > 0.0:
        # a law that leaves no crater has none that could be off, nor a recovery of its own
        return _Sizes(force, 0.0, 0.0, 0.0, radius), _Sizes(0.0, 0.0, 0.0, 0.0, 0.0)
    return (
        _Sizes(force, back, RECOVERY_EXPONENT * lost, dent, radius, share),
        _Sizes(
            sizes["force"] * lost, sizes["recovery"] * lost, sizes["recovery exponent"] * lost,
            sizes["crater"] if lost else 0.0, 0.0,
        ),
    )  # fmt: skip


def _moving(k: int, step: float) -> Change:
    """Move the logarithm of the force, of the recovery, or the recovery's exponent by `step`."""
    by = [0.0, 0.0, 0.0]
    by[k] = step

    def change(stated: ForceTransform) -> ForceTransform:
        loading, back = (
            times(now, np.full(NODES, math.exp(x)))
            for now, x in zip((stated.factors, stated.recovery_factors), by[:2], strict=True)
        )
        return replace(stated, factors=loading, recovery_factors=back, shape=stated.shape + by[2])

    return change


def _of_inputs(
    setup: Setup, law: ContactLaw, names: Sequence[str], ended: Callable[[Setup], Any]
) -> dict[str, dict[str, Any]]:
    """Change of the numbers that `ended` gives by one standard deviation of each input, by key."""
    parts = {}
    for key, share, up, down in _shifted(setup, law):
        high, low = ended(up), ended(down)
        parts[key] = {n: 0.5 * (high[n] - low[n]) / share for n in names}
    return parts


def _of_law(
    sizes: Array, names: Sequence[str], moved: Callable[[Change], Any], left: Mapping[str, Any],
    peak: Any,
) -> dict[str, dict[str, Any]]:  # fmt: skip
    """Standard deviation of each number by the law and by the metal.

    `sizes` (2, 6, ...) are `_Sizes` of both; `moved` gives the numbers (...) by name with the force
    changed; `left` (...) are the dents among them, at the depths `peak`. Force, recovery, exponent
    and crater are independent; a law gives a body of no strength no dent.
    """
    slopes: list[dict[str, Any]] = [dict.fromkeys(names, 0.0)] * 3
    for k in np.flatnonzero([(sizes[:, k] > 0.0).any() for k in range(3)]).tolist():
        high, low = (moved(_moving(k, step)) for step in (RULES.band_step, -RULES.band_step))
        slopes[k] = {n: (high[n] - low[n]) / (2.0 * RULES.band_step) for n in names}
    parts: dict[str, dict[str, Any]] = {}
    for part, own in zip((LAW, METALS), map(_Sizes._make, sizes), strict=True):
        by = list(zip(own[:3], slopes, strict=True))
        parts[part] = {n: np.sqrt(sum((s * slope[n]) ** 2 for s, slope in by)) for n in names}
        for name, dent in left.items():
            off = np.where(dent > 0.0, np.hypot(own.crater * dent, own.share * peak), 0.0)
            parts[part][name] = np.hypot(parts[part][name], off)
    return parts


def swept_stds(setup: Setup, law: ContactLaw, found: Impacts) -> dict[str, Array]:
    """Return standard deviations along a sweep by one law, (n,); none where a blow did not end."""
    if not all(found["outcome"] == "completed"):
        return {}
    if setup.rigs:
        rows = np.split(np.arange(len(found)), len(setup.rigs))
        stds = [swept_stds(s, law, found.at(r)) for s, r in zip(setup.rigs, rows, strict=True)]
        return {name: np.concatenate([one[name] for one in stds]) for name in SWEPT}
    scene, peak = setup.scene(law), found["peak_depth_m"]
    each = (SimpleNamespace(**row, residual_flat_m=row[_CRATER]) for row in found.rows())
    sizes = np.stack([_sizes_of(setup, scene, one) for one in each], axis=-1)
    parts = _of_inputs(setup, law, SWEPT, lambda one: one.swept(law)) | _of_law(
        sizes, SWEPT, lambda change: setup.swept(law, change=change), {_CRATER: found[_CRATER]},
        peak,
    )  # fmt: skip
    known = [compared(law, scene.pair, depth) for depth in peak.tolist()]
    return {
        name: np.where(known, np.sqrt(sum(part[name] ** 2 for part in parts.values())), math.nan)
        for name in SWEPT
    }
