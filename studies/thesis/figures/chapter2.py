"""Figures 2.5-2.8 and 2.14-2.21: the thesis's model, the published laws and our finite elements."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....campaigns.cases.pairs import table_2_1
from ....core.arrays import Array
from ....core.material import Pair
from ....models import LAWS, critical_depth
from ....models.published import hardness
from ...plot import Entry, Picture, at_depth, finish, sheet
from . import compared, fields, steps, tables
from .claims import judged
from .quantities import (
    DEPTH,
    RATIOS,
    Quantity,
    along,
    beside_points,
    case_records,
    force,
    model_share,
    of_record,
    pressure,
    radius,
)


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """Redraw the figures; `records` are the stored finite-element cases, possibly none."""
    return [
        *fields.chapter_2(),
        tables.table_2_1_again(),
        _share_five_cases(records),
        *steps.pictures(records),
        _five_cases("2.6", "Contact radius of the five cases", "a/R", radius, records),
        _five_cases("2.7", "Mean pressure of the five cases", "p/Sy_min", pressure, records),
        _five_cases("2.8", "Contact force of the five cases", "F/(E' R^2)", force, records),
        _pressure_over_depth(records),
        _hardness_over_radius(records),
        _share_case(records),
        *compared.pictures(records),
    ]


def _five_cases(
    number: str, title: str, y: str, quantity: Quantity, records: Sequence[CaseRecord]
) -> Picture:
    made, (axis,) = sheet()
    points: list[tuple[float, float, Pair]] = []
    for case in range(1, 6):
        axis.semilogx(
            RATIOS, along(LAWS["ghaednia"], case, quantity), color=f"C{case}",
            label=f"case {case}, the thesis's model",
        )  # fmt: skip
        for ratio, record in case_records(records, case):
            value = of_record(quantity, record, DEPTH)
            if np.isfinite(value):
                axis.plot(ratio, value, "o", ms=4, color=f"C{case}")
                points.append((ratio, value, record.case.pair))
    finish(axis, x="Sy* = Sy_sphere/Sy_flat", y=y, legend="circles: our finite elements")
    return Picture(number, f"{title}, Delta/R = 0.04", made, beside_points(points, quantity))


def _share_five_cases(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    off = []
    for case in range(1, 6):
        shares = [model_share(table_2_1(case, s)) for s in RATIOS]
        axis.semilogx(RATIOS, shares, color=f"C{case}", label=f"case {case}, 2.13-2.16")
        for ratio, record in case_records(records, case):
            found = at_depth(record, DEPTH)
            if found:
                value = found["sphere"] / (DEPTH * record.case.pair.R)
                axis.plot(ratio, value, "o", ms=4, color=f"C{case}")
                off.append(abs(model_share(record.case.pair) - value))
    finish(axis, x="Sy*", y="delta_s*", legend="circles: our finite elements")
    note = "The curves have the thesis's plateau near 0.9 and its step at Sy* = 1."
    if off:
        note += f" Mean difference from {len(off)} of our points: {np.mean(off):.3f}."
    return Picture("2.5", "Share of the sphere, Delta/R = 0.04", made, note)


def _pressure_over_depth(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    for colour, ratio in zip(("C0", "C1", "C3"), (0.1, 1.0, 10.0), strict=True):
        pair = table_2_1(1, ratio)
        D = np.geomspace(2.0 * critical_depth(pair) / pair.R, 0.06, 200)
        w = D * pair.R / critical_depth(pair)
        axis.semilogx(
            w, pressure(LAWS["ghaednia"], pair, D), color=colour, label=f"Sy* = {ratio:g}"
        )
        for record in records:
            if abs(np.log(max(record.case.pair.Sy_ratio, 1e-9) / ratio)) < 0.05:
                _scatter(axis, record, colour)
    axis.axvline(110.0, color="0.5", ls=":", lw=1.0)
    finish(axis, x="Delta/delta_c", y="p/Sy_min", legend="lines: the thesis's model; dots: ours")
    top = pressure(LAWS["ghaednia"], table_2_1(1, 10.0), np.geomspace(1e-4, 0.04, 400))
    note = (
        f"The model's pressure at Sy* = 10 peaks at {top.max():.2f} Sy; the text puts the peak "
        "near delta_n = 110 (dotted)."
    )
    return Picture("2.14", "Mean pressure over the depth", made, note)


def _scatter(axis: object, record: CaseRecord, colour: str) -> None:
    pair, curve = record.case.pair, record.curve
    keep = curve["delta"] > 1.5 * critical_depth(pair)
    axis.plot(  # type: ignore[attr-defined]
        curve["delta"][keep] / critical_depth(pair), curve["hardness"][keep] / pair.Sy_min, ".",
        ms=3, color=colour, alpha=0.5,
    )  # fmt: skip


def _hardness_over_radius(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    x = np.linspace(1e-3, 0.6, 300)
    for name, function in {**hardness.FLATTENING, **hardness.INDENTATION}.items():
        axis.plot(x, function(x), label=name)
    axis.axhline(2.8, color="0.4", ls=":", label="Kogut and Etsion, 2.8")
    found: dict[float, list[Array]] = {0.1: [], 1.0: [], 10.0: []}
    for record in records:
        pair, curve = record.case.pair, record.curve
        ratio = min(found, key=lambda s: abs(np.log(max(pair.Sy_ratio, 1e-9) / s)))
        if abs(np.log(max(pair.Sy_ratio, 1e-9) / ratio)) > 0.05:
            continue
        keep = curve["delta"] > 110.0 * critical_depth(pair)
        points = np.array([curve["radius"][keep] / pair.R, curve["hardness"][keep] / pair.Sy_min])
        axis.plot(*points, ".", ms=3, color=_DOTS[ratio], zorder=1.0,
                  label=None if found[ratio] else f"ours, Sy* = {ratio:g}")  # fmt: skip
        found[ratio].append(points)
    axis.set_ylim(1.0, 3.6)
    finish(axis, x="a/R", y="p/Sy_min", legend="dots: finite elements, w > 110")
    note = "No finite-element campaign was found to draw beside them."
    if all(found.values()):
        off = {s: np.concatenate(p, axis=1) for s, p in found.items()}
        flat = [_off(hardness.jackson_green, off[s]) for s in (0.1, 1.0)]
        slip = _off(hardness.slip_line, off[10.0])
        deep = off[10.0][:, np.abs(off[10.0][0] - 0.5) < 0.03]
        at_end = f"{np.mean(hardness.slip_line(deep[0]) / deep[1] - 1.0):+.0%} at a/R = 0.5"
        note = judged(
            (f"Sy* = 0.1 agrees with Jackson and Green (1.14: {flat[0]:.1%} in the mean)",
             flat[0] < _GOOD),
            (f"so does Sy* = 1 ({flat[1]:.1%})", flat[1] < _GOOD),
            (f"Sy* = 10 agrees with Jackson, Ghaednia and Pope (1.13: {slip:.1%} in the mean, "
             f"{at_end})", slip < _GOOD),
        )  # fmt: skip
    return Picture("2.15", "Finite elements and hardness laws", made, note)


_GOOD = 0.03  # mean deviation that still is a good agreement, as the thesis says of its own law
_DOTS = {0.1: "#9ecae1", 1.0: "0.75", 10.0: "#f4a6a6"}


def _off(law: Callable[[Array], Array], points: Array) -> float:
    return float(np.mean(np.abs(law(points[0]) / points[1] - 1.0)))


def _share_case(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    axis.semilogx(RATIOS, [model_share(table_2_1(3, s)) for s in RATIOS], "C3", label="2.13-2.16")
    if "fitted" in LAWS and hasattr(LAWS["fitted"], "share"):
        D = DEPTH * 1e-3
        ours = [float(LAWS["fitted"].share(table_2_1(3, s), D)) for s in RATIOS]
        axis.semilogx(RATIOS, ours, "k", label="fitted")
    count = 0
    for ratio, record in case_records(records, 3):
        found = at_depth(record, DEPTH)
        if found:
            axis.plot(ratio, found["sphere"] / (DEPTH * record.case.pair.R), "ko", ms=4)
            count += 1
    finish(axis, x="Sy*", y="delta_s*", legend="circles: our finite elements")
    note = f"Case 3 of table 2.1 at Delta/R = 0.04; {count} of our cases beside it."
    return Picture("2.16", "Share of the sphere over Sy*", made, note)
