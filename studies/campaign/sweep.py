"""The five cases of Table 2.1 over Sy*, read out of a campaign at the depth of the thesis."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...campaigns import CaseRecord
from ...campaigns.case import dimensionless_groups
from ...campaigns.cases.pairs import RATIOS, TABLE_2_1, table_2_1
from ...core.arrays import Array, Integers
from ...core.material import Pair
from ..thesis.figures.quantities import DEPTH

Values = tuple[float, float, float, float]
"""delta_s*, a/R, p/Sy_min and F/(E' R^2)."""


@dataclass(frozen=True)
class Sweep:
    """One case of Table 2.1 at DEPTH, over the strength ratios that were solved.

    - `number`: of the case, 1 to 5.
    - `ratio`: Sy*, increasing, shape (n,).
    - `share`, `radius`, `pressure`, `force`: delta_s*, a/R, p/Sy_min, F/(E' R^2), shape (n,).
    - `records`: what they were read from.
    """

    number: int
    ratio: Array
    share: Array
    radius: Array
    pressure: Array
    force: Array
    records: tuple[CaseRecord, ...]

    def at(self, ratio: float) -> int | None:
        """Place of a strength ratio; none if it was not solved."""
        found = np.flatnonzero(np.abs(np.log(self.ratio / ratio)) < 1e-6)
        return int(found[0]) if len(found) else None

    def between(self, low: float, high: float) -> Integers:
        """Places of the ratios from `low` to `high`, both included."""
        inside = (self.ratio > low * (1 - 1e-6)) & (self.ratio < high * (1 + 1e-6))
        return np.asarray(np.flatnonzero(inside), dtype=np.int64)


def by_pair(records: Sequence[CaseRecord]) -> dict[str, CaseRecord]:
    """Stored cases by their dimensionless groups; of several, the one with the finest mesh."""
    found: dict[str, CaseRecord] = {}
    for record in records:
        key = groups_of(record.case.pair)
        if key not in found or _element(record) < _element(found[key]):
            found[key] = record
    return found


def groups_of(pair: Pair) -> str:
    """Return what identifies a pair, as text."""
    return json.dumps(dimensionless_groups(pair))


def sweeps(records: Sequence[CaseRecord]) -> dict[int, Sweep]:
    """Read the five cases; one that has no strength ratio solved has no entry."""
    stored = by_pair(records)
    out = {}
    for number in TABLE_2_1:
        found: list[tuple[float, Values, CaseRecord]] = []
        for ratio in sorted(RATIOS):
            record = stored.get(groups_of(table_2_1(number, ratio)))
            values = at_depth(record, DEPTH) if record is not None else None
            if record is not None and values is not None:
                found.append((ratio, values, record))
        if found:
            share, radius, pressure, force = np.array([values for _, values, _ in found]).T
            ratios = np.array([ratio for ratio, _, _ in found])
            records_of = tuple(record for _, _, record in found)
            out[number] = Sweep(number, ratios, share, radius, pressure, force, records_of)
    return out


def at_depth(record: CaseRecord, depth: float) -> Values | None:
    """delta_s*, a/R, p/Sy_min and F/(E' R^2) at Delta/R = `depth`; none beyond the curve.

    Between recorded depths F and a are interpolated as powers of the depth.
    """
    pair, curve = record.case.pair, record.curve
    x = np.log(curve["delta"] / pair.R)
    at = float(np.log(depth))
    if not x[0] <= at <= x[-1] + 1e-9:
        return None
    share = float(np.interp(at, x, curve["sphere"] / (curve["sphere"] + curve["flat"])))
    force, radius, hardness = (
        float(np.exp(np.interp(at, x, np.log(curve[name]))))
        for name in ("force", "radius", "hardness")
    )
    return share, radius / pair.R, hardness / pair.Sy_min, force / (pair.E_reduced * pair.R**2)


def _element(record: CaseRecord) -> float:
    return float(record.accuracy.get("fine", record.case.accuracy.fine))
