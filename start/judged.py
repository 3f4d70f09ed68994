"""How far contact laws are from finite elements: of the published pair nearest to one's own.

Laws and finite elements answer for that same pair, over the depths that were asked for: force on
loading, permanent depth and restitution, the root of the work given back over the work taken. The
largest departure of the three is the law's number.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from ..campaigns import CaseRecord, read_curves
from ..campaigns.parts import published_parts
from ..core.arrays import Array
from ..core.errors import InputError
from ..core.material import Material, Pair
from ..models import LAWS
from ..models.base import ContactLaw, unwarned
from .measured import loading_work
from .rules import RULES

# limit: points of an integral of the work [-]
_WORK_POINTS = 400

# limit: plastic strain at which a curve's rise is compared [-]; what a dent of a/R = 0.5 strains
_RISE_STRAIN = 0.1

# limit: ratio of strengths beyond which the stronger body hardly matters [-]
_UNEVEN_STRENGTHS = 2.5

# limit: largest departure of a law that may be used [-]: of a dent whose strength is off by a tenth
USABLE = 0.10

# limit: distance from which the nearest pair is called far [-]
_FAR = 0.5

# limit: points of a law's curve [-]; a figure's width
CURVE_POINTS = 120

# limit: times too little or too much that are not told in times [-]
_NO_FACTOR = 100.0

ELASTIC = "Hertz's force, finite strain added"
"""The judge while nothing yields: within 1 % of finite elements at Delta/R = 0.04."""

_HARDENS = ("hardening", "validation-hardening")


class Departure(NamedTuple):
    """How far a law is from finite elements: largest |ln(law/finite elements)| of each."""

    force: float
    dent: float
    restitution: float
    at: tuple[float, float, float] = (math.nan, math.nan, math.nan)  # their approaches over R

    @property
    def worst(self) -> float:
        """The largest of the three; infinite where a law has no finite number."""
        return max(x if math.isfinite(x) else math.inf for x in self[:3])

    @property
    def told(self) -> str:
        """In words: `within 3 %`, or by how many times, in what and how deep."""
        if self.worst <= math.log(1.5):
            return f"within {max(math.ceil(100.0 * math.expm1(self.worst)), 1)} %"
        if not math.isfinite(self.worst):
            return "no number"
        k = max(range(3), key=lambda k: self[k])
        times = f"more than {_NO_FACTOR:g}"
        if self.worst <= math.log(_NO_FACTOR):
            times = f"{math.exp(self.worst):.2g}"
        where = f" at {self.at[k]:.2g} R" if math.isfinite(self.at[k]) else ""
        return f"off by {times} times in {self._fields[k]}{where}"


class Reference(NamedTuple):
    """A solved pair, and how unlike one's own it is."""

    pair: Pair
    name: str
    distance: float
    depth: Array  # of loading [m]
    force: Array  # [N]
    turns: tuple[tuple[float, float, float], ...]  # depth [m], permanent depth [m], restitution
    deepest: float  # Delta/R to which it was solved

    @property
    def told(self) -> str:
        """Which pair it is, in the numbers that a contact depends on."""
        p = self.pair
        far = "; no published pair is like yours" if self.distance > _FAR else ""
        return (
            f"finite elements of E'/S = {p.E_reduced / p.Sy_min:.3g}, Sy* = {p.Sy_ratio:.3g}, "
            f"elastic share of the sphere {p.elastic_share:.2g}{far}"
        )


def nearest(pair: Pair, *, last: float) -> Reference | None:
    """Return the published pair most like this one, with its results up to Delta/R = `last`.

    None where nothing yields up to there: every law is then Hertz's.
    """
    if not pair.first_yield < last:
        return None
    records = _published(pair.perfectly_plastic)
    own = _groups(pair)
    away = [float(np.linalg.norm(_groups(r.case.pair) - own)) for r in records]
    best = int(np.argmin(away))
    return _reference(records[best], away[best], last)


def departure(law: ContactLaw, reference: Reference) -> Departure:
    """Return how far a law is from the finite elements of a pair; a law of another is refused."""
    pair = reference.pair
    with unwarned(), np.errstate(all="ignore"):
        force = law.loading(pair, reference.depth)
        peaks, dents, given = np.array(reference.turns).reshape(-1, 3).T
        left = np.add(*law.residual(pair, peaks))
        back = [_restitution(law, pair, d, float(r)) for d, r in zip(peaks, left, strict=True)]
        seen = dents > RULES.least_dent * peaks
        return _departure(
            pair.R, (force, reference.force, reference.depth),
            (left[seen], dents[seen], peaks[seen]), (np.array(back), given, peaks),
        )  # fmt: skip


def _departure(R: float, *compared: tuple[Array, Array, Array]) -> Departure:
    """The largest ratios of a law's numbers and solved ones, each over its depths."""
    found = [(0.0, math.nan)] * 3
    for k, (law, solved, depth) in enumerate(compared):
        if len(solved):
            off = np.abs(np.log(np.maximum(law, 1e-12 * solved) / solved))
            worst = int(np.argmax(off))  # of nan the first
            found[k] = float(off[worst]), float(depth[worst] / R)
    (force, there), (dent, left), (back, turned) = found
    return Departure(force, dent, back, (there, left, turned))


def _restitution(law: ContactLaw, pair: Pair, peak: float, left: float) -> float:
    taken = peak * np.linspace(0.0, 1.0, _WORK_POINTS) ** 2
    given = left + (peak - left) * np.linspace(0.0, 1.0, _WORK_POINTS)
    spent = np.trapezoid(law.loading(pair, taken), taken)
    returned = np.trapezoid(law.unloading(pair, given, np.full(_WORK_POINTS, peak)), given)
    return math.sqrt(max(float(returned / spent), 0.0))


@cache
def _published(perfectly_plastic: bool) -> tuple[CaseRecord, ...]:
    """Completed cases of metals that harden, or of those that do not, none of them coarse."""
    parts = published_parts(lambda name: name.startswith(_HARDENS) != perfectly_plastic)
    return tuple(
        record for path in parts for record in read_curves(path)
        if record.unloadings and record.case.pair.perfectly_plastic == perfectly_plastic
        and math.isfinite(record.case.pair.Sy_min)
    )  # fmt: skip


def _groups(pair: Pair) -> Array:
    """What a contact depends on, each about one wide over the published pairs."""
    ratio = min(max(pair.Sy_ratio, 1.0 / _UNEVEN_STRENGTHS), _UNEVEN_STRENGTHS)
    return np.array([
        math.log(pair.E_reduced / pair.Sy_min) / 1.2, 2.0 * math.log(ratio) / 1.2,
        (pair.elastic_share - 0.5) / 0.22, (pair.weaker.nu - 0.3) / 0.1, 5.0 * _rise(pair.weaker),
    ])  # fmt: skip


def _rise(body: Material) -> float:
    curve = body.flow.curve if body.flow else None
    return math.log(curve(_RISE_STRAIN) / curve.strength) if curve else 0.0


def _reference(record: CaseRecord, distance: float, last: float) -> Reference:
    pair, c = record.case.pair, record.curve
    inside = c["delta"] <= last * pair.R * (1.0 + 1e-9)
    inside[: min(5, len(inside))] = True
    yielded = [u for u in record.unloadings if u.depth > pair.first_yield]
    # one turn beyond the range where none lies in it
    turns = [u for u in yielded if u.depth <= last * (1.0 + 1e-9)] or yielded[:1]
    spent = loading_work(c["delta"], c["force"])
    rows = []
    for u in turns:
        depth = u.depth * pair.R
        delta, force = u.curve["delta"], u.curve["force"]
        order = np.argsort(delta)
        returned = float(np.trapezoid(force[order], delta[order]))
        taken = float(np.interp(depth, c["delta"], spent))
        left = u.residual_sphere + u.residual_flat
        rows.append((depth, left, math.sqrt(max(returned, 0.0) / taken)))
    deepest = float(c["delta"][-1]) / pair.R * (1.0 + 1e-9)
    loaded, carried = c["delta"][inside], c["force"][inside]
    return Reference(pair, record.case.name, distance, loaded, carried, tuple(rows), deepest)


def judged(
    pair: Pair, laws: Sequence[ContactLaw], *, last: float
) -> tuple[Reference | None, dict[str, Departure]]:
    """Return the solved pair nearest to one's own, and how far each law is from it.

    While nothing yields there is none, and the laws are judged by `ELASTIC`. A law that was made
    for one's own pair alone (law.json) has no number.
    """
    reference = nearest(pair, last=last)
    found: dict[str, Departure] = {}
    for law in laws:
        try:
            far = departure(law, reference) if reference else _from_elastic(law, pair, last)
        except InputError:  # the table of another pair
            continue
        found[law.name] = far
    return reference, found


def _from_elastic(law: ContactLaw, pair: Pair, last: float) -> Departure:
    """How far a law's force is from Hertz's with finite strain added, up to Delta/R = `last`."""
    depth = pair.R * last * np.geomspace(1e-2, 1.0, CURVE_POINTS)
    with unwarned():
        force, judge = law.loading(pair, depth), LAWS["fitted"].loading(pair, depth)
    return _departure(pair.R, (force, judge, depth))
