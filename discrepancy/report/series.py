"""What a report draws: measured beside simulated, a row a number of the comparison."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.observables import OBSERVABLES
from ..comparison.conditions import Condition
from ..findings import Verdict
from ..rules import RULES

STATED, WITHOUT, WITH = "as stated", "best without anything missing", "with the verdict"
"""The three simulations that are drawn, as every legend names them."""


class Against(NamedTuple):
    """Something that varies over the conditions."""

    key: str  # name in files
    label: str  # text of an axis
    values: Array  # (conditions,) in the label's unit


@dataclass(frozen=True, slots=True)
class SeriesPoint:
    """One number of the comparison, in the units that people read."""

    observable: str
    unit: str
    striker: str
    condition: int  # from 1
    trials: int  # behind the mean
    x: dict[str, float]  # what varies, by the key of `Against`
    measured: float  # mean of the repeats
    low: float  # it less its standard error
    high: float
    as_stated: float  # simulated with every number as stated
    best_without: float  # with the numbers moved as far as it takes, nothing added
    with_verdict: float  # the same with what is named, its form moved too; nan without any
    weight: bool  # whether it counts: a value far off everything else does not

    def row(self) -> dict[str, Any]:
        """Return the point as one flat row of a table."""
        content = asdict(self)
        return {**content.pop("x"), **content}


def againsts(v: Verdict) -> tuple[Against, ...]:
    """Return what varies over the conditions, the speed first even if it does not.

    Presses stand at the speed at which their striker's impact goes as deep; they alone, at their
    load.
    """
    c, of = v.problem.conditions, v.problem.rig.of
    total = np.array([math.hypot(one.speed, one.tangential) for one in c])
    loads = [one.press.load for one in c if one.press is not None]
    beside = " (of presses: as deep)" if loads else ""

    def of_striker(key: str) -> Array:
        return np.array([1e3 * of[f"strikers.{one.striker}.{key}"] for one in c])

    speeds = np.array([one.speed for one in c])
    driven = Against("speed_m_s", f"approach speed [m/s]{beside}", speeds)
    if len(loads) == len(c):
        driven = Against("load_N", "load [N]", np.array(loads))
    along = np.array([one.tangential for one in c])
    heat = np.array([one.around.temperature for one in c])
    known = (
        driven,
        Against("angle_deg", "angle [deg]", np.degrees([one.incidence for one in c])),
        Against("tangential_m_s", "tangential speed [m/s]", along),
        Against("tip_radius_mm", "radius of the tip [mm]", of_striker("tip_radius_m")),
        Against("length_mm", "length of the rod [mm]", of_striker("length_m")),
        Against("mass_g", "mass of the striker [g]", of_striker("mass_kg")),
        Against("temperature_K", "temperature [K]", heat),
    )
    varying = [a for a in known if np.ptp(a.values) > 1e-3 * np.max(np.abs(a.values))]
    if np.ptp(total) < 0.01 * total.max() and len(varying) > 1:
        # one speed at several angles: its parts are not what was chosen
        varying.sort(key=lambda a: a.key != "angle_deg")
    return tuple(varying or known[:1])


def series_of(c: Condition) -> str:
    """Return what struck or pressed: a series of its own for each."""
    return c.striker if c.press is None else f"{c.striker}, pressed"


def points_of(v: Verdict) -> tuple[SeriesPoint, ...]:
    """Return every number of the comparison."""
    cells, conditions = v.problem.cells, v.problem.conditions
    base, stated, best = v.ranking.base, v.stated, v.best
    # what the fit made of it: a form that is known within a factor takes much of a large effect
    named = best.prediction + best.linear.form @ best.form
    along = againsts(v)
    counts = np.array([i not in v.problem.weightless for i in range(len(cells))])
    std = np.where(counts, cells.std, cells.std / RULES.outlier_wider)
    found = []
    for i, name in enumerate(cells.observable):
        row, log = OBSERVABLES[name], bool(cells.is_log[i])
        k = int(cells.condition[i])

        def shown(x: float, log: bool = log, scale: float = row.scale) -> float:
            return scale * (math.exp(x) if log else float(x))

        at = shown(cells.value[i])
        # of a reading near 0 the error is many times the reading: no exponential of that
        off = float(std[i]) * (at if log else row.scale)
        found.append(
            SeriesPoint(
                name, row.unit, series_of(conditions[k]), k + 1, int(cells.count[i]),
                {a.key: float(a.values[k]) for a in along},
                at, max(at - off, 0.0) if log else at - off, at + off,
                shown(stated[i]), shown(base.prediction[i]),
                shown(named[i]) if best.mechanisms else math.nan,
                bool(counts[i]),
            )
        )  # fmt: skip
    return tuple(found)
