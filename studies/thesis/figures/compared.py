"""Figures 2.17-2.21: the published laws and the thesis's model beside our finite elements."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....core.arrays import Array
from ....core.material import Material, Pair
from ...plot import Picture, finish, laws, look, same, sheet
from .claims import apart, judged
from .quantities import (
    DEPTH,
    RATIOS,
    Quantity,
    along,
    beside_points,
    case_records,
    force,
    of_record,
    pressure,
    radius,
)

_FIGURE_2_17 = Pair(Material(E=300e9, nu=0.3, Sy=1e9), Material(E=300e9, nu=0.3, Sy=1e8), 1e-3)
_COMPARED = ("jackson-green-2007", "kogut-etsion", "kogut-etsion-continued", "kogut-komvopoulos",
             "ye-komvopoulos", "ghaednia", "fitted")  # fmt: skip
_JG, _KE, _KK, _YK = (_COMPARED[k] for k in (0, 2, 3, 4))
"""What the text calls JG, KE, KK and YK; KE as it must have been used, see figure 2.20."""


def pictures(records: Sequence[CaseRecord]) -> list[Picture]:
    """Redraw the figures; `records` are the stored finite-element cases, possibly none."""
    return [
        _over_depth("2.17", "Contact radius over the depth", "a/R", radius, records),
        _over_ratio("2.18", 5, "Contact radius over Sy*", "a/R", radius, records),
        _over_ratio("2.19", 1, "Mean pressure over Sy*", "p/Sy_min", pressure, records),
        _over_depth("2.20", "Contact force over the depth", "F/(E' R^2)", force, records),
        _over_ratio("2.21", 3, "Contact force over Sy*", "F/(E' R^2)", force, records),
    ]


def _over_depth(
    number: str, title: str, y: str, quantity: Quantity, records: Sequence[CaseRecord]
) -> Picture:
    made, (axis,) = sheet()
    pair = _FIGURE_2_17
    D = np.linspace(2e-4, 0.06, 300)
    for law in laws(*_COMPARED):
        axis.plot(D, quantity(law, pair, D), **look(law))
    ours = float("nan")
    for record in records:
        if same(record, pair):
            ours = of_record(quantity, record, _DEEP)
            x = np.linspace(2e-3, record.curve["delta"][-1] / record.case.pair.R, 15)
            axis.plot(x, [of_record(quantity, record, float(d)) for d in x], "ko", ms=4,
                      label="our finite elements")  # fmt: skip
    finish(axis, x="Delta/R", y=y)
    at = np.array([_DEEP])
    found = {law.name: float(quantity(law, pair, at)[0]) for law in laws(*_COMPARED)}
    beside = "our finite elements" if np.isfinite(ours) else "the thesis's model"
    reference = ours if np.isfinite(ours) else found["ghaednia"]
    told = apart(found, [name for name in found if found[name] != reference], reference)
    off = {name: value / reference - 1.0 for name, value in found.items()}
    note = f"Beside {beside} at Delta/R = {_DEEP:g}: {told}. {_SAID[number](off)}"
    return Picture(number, title, made, note)


_DEEP = 0.06


def _radii_said(off: dict[str, float]) -> str:
    return judged(
        ("both flattening laws are larger", off[_JG] > 0.0 and off[_KE] > 0.0),
        ("of the flattening laws Jackson and Green is nearer", abs(off[_JG]) < abs(off[_KE])),
        ("both indentation laws are smaller", off[_KK] < 0.0 and off[_YK] < 0.0),
        ("of the indentation laws Ye and Komvopoulos is nearer", abs(off[_YK]) < abs(off[_KK])),
    )


def _forces_said(off: dict[str, float]) -> str:
    return judged(
        ("Ye and Komvopoulos agrees well", abs(off[_YK]) < 0.05),
        ("Kogut and Etsion is larger (with its powers continued beyond w = 110; with 2.8 S there "
         "it would be smaller)", off[_KE] > 0.0),
        ("Jackson and Green is nearly 30 % smaller", abs(off[_JG] + 0.3) < 0.05),
        ("Kogut and Komvopoulos is nearly 20 % smaller", abs(off[_KK] + 0.2) < 0.05),
    )  # fmt: skip


_SAID = {"2.17": _radii_said, "2.20": _forces_said}


def _over_ratio(
    number: str, case: int, title: str, y: str, quantity: Quantity, records: Sequence[CaseRecord]
) -> Picture:
    made, (axis,) = sheet()
    for law in laws(*_COMPARED):
        axis.semilogx(RATIOS, along(law, case, quantity), **look(law))
    points = []
    for ratio, record in case_records(records, case):
        value = of_record(quantity, record, DEPTH)
        if np.isfinite(value):
            axis.plot(ratio, value, "ko", ms=4)
            points.append((ratio, value, record.case.pair))
    finish(axis, x="Sy*", y=y, legend="circles: our finite elements")
    note = beside_points(points, quantity)
    if number in _SAID_OF_RATIO and points:
        said = _SAID_OF_RATIO[number]
        note += f" {said(np.array([s for s, _, _ in points]), _off(points, quantity))}"
    return Picture(number, f"{title}, case {case}, Delta/R = 0.04", made, note)


Off = dict[str, Array]


def _off(points: Sequence[tuple[float, float, Pair]], quantity: Quantity) -> Off:
    """By law, deviation from the stored cases."""
    at = np.array([DEPTH])
    return {
        law.name: np.array([float(quantity(law, p, at)[0]) / value - 1.0 for _, value, p in points])
        for law in laws(*_COMPARED)
    }


def _radius_said(ratio: Array, off: Off) -> str:
    mean = {name: float(np.mean(values)) for name, values in off.items()}
    size = {name: float(np.mean(np.abs(values))) for name, values in off.items()}
    four = (_JG, _KE, _KK, _YK)
    best = min(four, key=lambda name: size[name])
    own = float(np.max(np.abs(off["ghaednia"])))
    return judged(
        (f"the thesis's model is within 1 % (here {own:.1%} at most)", own < 0.01),
        ("all previous ones are smaller in the mean", all(mean[n] < 0.0 for n in four)),
        ("the flattening laws are larger than the indentation laws",
         min(mean[_JG], mean[_KE]) > max(mean[_KK], mean[_YK])),
        (f"Jackson and Green works best of them (here {best})", best == _JG),
    )  # fmt: skip


def _force_said(ratio: Array, off: Off) -> str:
    soft, hard = ratio < 1.0, ratio > 1.0
    flat = float(np.mean(np.abs(off[_JG][soft])))
    return judged(
        (f"Jackson and Green agrees for Sy* < 1 ({flat:.1%} in the mean)", flat < 0.03),
        ("Kogut and Etsion is larger in the mean", float(np.mean(off[_KE])) > 0.0),
        ("both indentation laws are smaller for Sy* > 1",
         max(float(np.mean(off[n][hard])) for n in (_KK, _YK)) < 0.0),
    )  # fmt: skip


_SAID_OF_RATIO = {"2.18": _radius_said, "2.21": _force_said}
