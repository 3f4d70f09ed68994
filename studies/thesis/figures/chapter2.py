"""Figures 2.5-2.8 and 2.14-2.21: the thesis's model, the published laws and our finite elements."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....core.material import Material, Pair
from ....models import LAWS, critical_depth
from ....models.base import ContactLaw
from ....models.published import hardness
from ....models.published.ghaednia import share_of_sphere
from ...plot import (
    Entry,
    Floats,
    Picture,
    at_depth,
    finish,
    laws,
    look,
    percent,
    same,
    sheet,
    table_2_1,
)
from . import fields, steps, tables

_D = 0.04
_RATIOS = np.geomspace(0.1, 10.0, 241)
_FIGURE_2_17 = Pair(Material(E=300e9, nu=0.3, Sy=1e9), Material(E=300e9, nu=0.3, Sy=1e8), 1e-3)
_COMPARED = ("jackson-green-2007", "kogut-etsion", "kogut-komvopoulos", "ye-komvopoulos",
             "ghaednia", "fitted")  # fmt: skip


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """Redraw the figures; `records` are the stored finite-element cases, possibly none."""
    return [
        *fields.chapter_2(records),
        tables.table_2_1_again(),
        _share_five_cases(records),
        *steps.pictures(records),
        _five_cases("2.6", "Contact radius of the five cases", "a/R", _radius, records),
        _five_cases("2.7", "Mean pressure of the five cases", "p/Sy_min", _pressure, records),
        _five_cases("2.8", "Contact force of the five cases", "F/(E' R^2)", _force, records),
        _pressure_over_depth(records),
        _hardness_over_radius(records),
        _share_case(records),
        _over_depth("2.17", "Contact radius over the depth", "a/R", _radius, records),
        _over_ratio("2.18", 5, "Contact radius over Sy*", "a/R", _radius, records),
        _over_ratio("2.19", 1, "Mean pressure over Sy*", "p/Sy_min", _pressure, records),
        _over_depth("2.20", "Contact force over the depth", "F/(E' R^2)", _force, records),
        _over_ratio("2.21", 3, "Contact force over Sy*", "F/(E' R^2)", _force, records),
    ]


Quantity = Callable[[ContactLaw, Pair, Floats], Floats]


def _radius(law: ContactLaw, pair: Pair, D: Floats) -> Floats:
    return law.contact_radius(pair, D * pair.R) / pair.R


def _force(law: ContactLaw, pair: Pair, D: Floats) -> Floats:
    return law.loading(pair, D * pair.R) / (pair.E_reduced * pair.R**2)


def _pressure(law: ContactLaw, pair: Pair, D: Floats) -> Floats:
    return law.hardness(pair, D * pair.R) / pair.Sy_min


def _of_record(quantity: Quantity, record: CaseRecord, D: float) -> float:
    found, pair = at_depth(record, D), record.case.pair
    if not found:
        return float("nan")
    if quantity is _radius:
        return found["radius"] / pair.R
    if quantity is _force:
        return found["force"] / (pair.E_reduced * pair.R**2)
    return found["hardness"] / pair.Sy_min


def _case_records(records: Sequence[CaseRecord], number: int) -> list[tuple[float, CaseRecord]]:
    """Stored cases of table 2.1's case `number`, with their Sy*."""
    found = []
    for record in records:
        ratio = record.case.pair.Sy_ratio
        if 0.05 <= ratio <= 20.0 and same(record, table_2_1(number, ratio)):
            found.append((ratio, record))
    return sorted(found, key=lambda item: item[0])


def _along(law: ContactLaw, number: int, quantity: Quantity) -> Floats:
    D = np.array([_D])
    return np.array([float(quantity(law, table_2_1(number, s), D)[0]) for s in _RATIOS])


def _compare(law: ContactLaw, points: list[tuple[float, float, Pair]], quantity: Quantity) -> str:
    D = np.array([_D])
    off = [abs(float(quantity(law, p, D)[0]) / y - 1.0) for _, y, p in points]
    return f"{law.name} {np.mean(off):.1%} (at most {max(off):.1%})"


def _five_cases(
    number: str, title: str, y: str, quantity: Quantity, records: Sequence[CaseRecord]
) -> Picture:
    made, (axis,) = sheet()
    points: list[tuple[float, float, Pair]] = []
    for case in range(1, 6):
        axis.semilogx(
            _RATIOS, _along(LAWS["ghaednia"], case, quantity), color=f"C{case}",
            label=f"case {case}, the thesis's model",
        )  # fmt: skip
        for ratio, record in _case_records(records, case):
            value = _of_record(quantity, record, _D)
            if np.isfinite(value):
                axis.plot(ratio, value, "o", ms=4, color=f"C{case}")
                points.append((ratio, value, record.case.pair))
    finish(axis, x="Sy* = Sy_sphere/Sy_flat", y=y, legend="circles: our finite elements")
    return Picture(number, f"{title}, Delta/R = 0.04", made, _note(points, quantity))


def _note(points: list[tuple[float, float, Pair]], quantity: Quantity) -> str:
    if not points:
        return "No finite-element case of table 2.1 was found; only the laws are drawn."
    told = ", ".join(_compare(law, points, quantity) for law in laws("ghaednia", "fitted"))
    return f"Mean deviation from {len(points)} of our points: {told}."


def _share_five_cases(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    off = []
    for case in range(1, 6):
        shares = [_share(table_2_1(case, s)) for s in _RATIOS]
        axis.semilogx(_RATIOS, shares, color=f"C{case}", label=f"case {case}, 2.13-2.16")
        for ratio, record in _case_records(records, case):
            found = at_depth(record, _D)
            if found:
                value = found["sphere"] / (_D * record.case.pair.R)
                axis.plot(ratio, value, "o", ms=4, color=f"C{case}")
                off.append(abs(_share(record.case.pair) - value))
    finish(axis, x="Sy*", y="delta_s*", legend="circles: our finite elements")
    note = "The curves have the thesis's plateau near 0.9 and its step at Sy* = 1."
    if off:
        note += f" Mean difference from {len(off)} of our points: {np.mean(off):.3f}."
    return Picture("2.5", "Share of the sphere, Delta/R = 0.04", made, note)


def _share(pair: Pair) -> float:
    return share_of_sphere(_D, pair.E_reduced / pair.Sy_min, pair.Sy_ratio, 1.0)


def _pressure_over_depth(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    for colour, ratio in zip(("C0", "C1", "C3"), (0.1, 1.0, 10.0), strict=True):
        pair = table_2_1(1, ratio)
        D = np.geomspace(2.0 * critical_depth(pair) / pair.R, 0.06, 200)
        w = D * pair.R / critical_depth(pair)
        axis.semilogx(
            w, _pressure(LAWS["ghaednia"], pair, D), color=colour, label=f"Sy* = {ratio:g}"
        )
        for record in records:
            if abs(np.log(max(record.case.pair.Sy_ratio, 1e-9) / ratio)) < 0.05:
                _scatter(axis, record, colour)
    axis.axvline(110.0, color="0.5", ls=":", lw=1.0)
    finish(axis, x="Delta/delta_c", y="p/Sy_min", legend="lines: the thesis's model; dots: ours")
    top = _pressure(LAWS["ghaednia"], table_2_1(1, 10.0), np.geomspace(1e-4, 0.04, 400))
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
    for record in records:
        pair, curve = record.case.pair, record.curve
        colour = "C0" if pair.Sy_ratio < 0.6 else "C3" if pair.Sy_ratio > 1.7 else "C1"
        keep = curve["delta"] > 110.0 * critical_depth(pair)
        axis.plot(
            curve["radius"][keep] / pair.R, curve["hardness"][keep] / pair.Sy_min, ".",
            ms=3, color=colour, alpha=0.5,
        )  # fmt: skip
    axis.set_ylim(1.0, 3.6)
    finish(axis, x="a/R", y="p/Sy_min", legend="dots: ours, w > 110 (red: indentation)")
    note = "Indentation lies on the slip-line law and flattening on the laws of Jackson and Green."
    return Picture("2.15", "Finite elements and hardness laws", made, note if records else
                   "No finite-element campaign was found to draw beside them.")  # fmt: skip


def _share_case(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    axis.semilogx(_RATIOS, [_share(table_2_1(3, s)) for s in _RATIOS], "C3", label="2.13-2.16")
    if "fitted" in LAWS and hasattr(LAWS["fitted"], "share"):
        D = _D * 1e-3
        ours = [float(LAWS["fitted"].share(table_2_1(3, s), D)) for s in _RATIOS]
        axis.semilogx(_RATIOS, ours, "k", label="fitted")
    count = 0
    for ratio, record in _case_records(records, 3):
        found = at_depth(record, _D)
        if found:
            axis.plot(ratio, found["sphere"] / (_D * record.case.pair.R), "ko", ms=4)
            count += 1
    finish(axis, x="Sy*", y="delta_s*", legend="circles: our finite elements")
    note = f"Case 3 of table 2.1 at Delta/R = 0.04; {count} of our cases beside it."
    return Picture("2.16", "Share of the sphere over Sy*", made, note)


def _over_depth(
    number: str, title: str, y: str, quantity: Quantity, records: Sequence[CaseRecord]
) -> Picture:
    made, (axis,) = sheet()
    pair = _FIGURE_2_17
    D = np.linspace(2e-4, 0.06, 300)
    for law in laws(*_COMPARED):
        axis.plot(D, quantity(law, pair, D), **look(law))
    for record in records:
        if same(record, pair):
            x = np.linspace(2e-3, record.curve["delta"][-1] / record.case.pair.R, 15)
            axis.plot(x, [_of_record(quantity, record, float(d)) for d in x], "ko", ms=4,
                      label="our finite elements")  # fmt: skip
    finish(axis, x="Delta/R", y=y)
    at = np.array([0.05])
    model = float(quantity(LAWS["ghaednia"], pair, at)[0])
    told = ", ".join(
        f"{law.name} {percent(float(quantity(law, pair, at)[0]) / model - 1.0)}"
        for law in laws(*_COMPARED) if law.name != "ghaednia"
    )  # fmt: skip
    said = " The text: JG -30 %, KK -20 %, KE larger." if number == "2.20" else ""
    return Picture(
        number, title, made, f"Beside the thesis's model at Delta/R = 0.05: {told}.{said}"
    )


def _over_ratio(
    number: str, case: int, title: str, y: str, quantity: Quantity, records: Sequence[CaseRecord]
) -> Picture:
    made, (axis,) = sheet()
    for law in laws(*_COMPARED):
        axis.semilogx(_RATIOS, _along(law, case, quantity), **look(law))
    points = []
    for ratio, record in _case_records(records, case):
        value = _of_record(quantity, record, _D)
        if np.isfinite(value):
            axis.plot(ratio, value, "ko", ms=4)
            points.append((ratio, value, record.case.pair))
    finish(axis, x="Sy*", y=y, legend="circles: our finite elements")
    return Picture(number, f"{title}, case {case}, Delta/R = 0.04", made, _note(points, quantity))
