"""Figures 2.9-2.13: the steps by which the thesis came to its model, walked again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps

from ....campaigns import CaseRecord
from ....campaigns.cases.pairs import table_2_1
from ....core.material import Material, Pair
from ....models import LAWS, critical_depth
from ....models.fitted import ClosedForm
from ....models.published.ghaednia import updated_jackson_green
from ...plot import Picture, at_depth, bare_sheet, finish, look, percent, sheet
from .claims import judged
from .quantities import case_records, model_share, of_record, radius

_DEPTHS = (0.01, 0.02, 0.04, 0.06, 0.08)
_RATIOS = np.geomspace(0.1, 10.0, 121)
_CRITICAL = 408.0  # delta_n at which the correction turns, by the thesis


def pictures(records: Sequence[CaseRecord]) -> list[Picture]:
    """Redraw the figures; `records` are the stored finite-element cases, possibly none."""
    return [
        _depths(records),
        _surface(),
        _modulus(records),
        _updated(records),
        _difference(records),
    ]


def _fitted() -> ClosedForm | None:
    found = LAWS.get("fitted")
    return found if isinstance(found, ClosedForm) else None


def _depths(records: Sequence[CaseRecord]) -> Picture:
    made, axes = sheet(2)
    colours = colormaps["viridis"](np.linspace(0.05, 0.9, len(_DEPTHS)))
    fitted = _fitted()
    pairs = [table_2_1(4, float(s)) for s in _RATIOS]
    for colour, D in zip(colours, _DEPTHS, strict=True):
        label = f"Delta/R = {D:g}"
        axes[0].semilogx(_RATIOS, [model_share(p, D) for p in pairs], color=colour, label=label)
        if fitted is not None:
            ours = [float(fitted.share(p, D * p.R)) for p in pairs]
            axes[1].semilogx(_RATIOS, ours, color=colour, label=label)
    for axis, name in zip(axes, ("2.13-2.16", "our fitted law"), strict=True):
        axis.set_title(name, fontsize=9)
        axis.set_ylim(-0.05, 1.05)
        finish(axis, x="Sy* = Sy_sphere/Sy_flat", y="share of the sphere delta_s*")
    note = f"The thesis: at most about 10 % between the depths. 2.13-2.16: {_spread(model_share)}"
    if fitted is not None:
        ours_at = _spread(lambda p, D: float(fitted.share(p, D * p.R)))
        note += f"; ours: {ours_at}. Ours joins the two sides smoothly, the thesis's jumps at 1"
    return Picture("2.9", "Share of the sphere at several depths, case 4", made, f"{note}.")


def _spread(share: Any) -> str:
    """Largest difference of the share between Delta/R = 0.01 and 0.08, on either side of 1."""
    told = []
    for name, ratio in (("Sy* = 0.1", 0.1), ("Sy* = 10", 10.0)):
        values = [share(table_2_1(4, ratio), D) for D in _DEPTHS]
        told.append(f"{max(values) - min(values):.3f} at {name}")
    return ", ".join(told)


def _surface() -> Picture:
    made = bare_sheet((6.4, 5.0))
    axis: Any = made.add_subplot(projection="3d")
    depths = np.linspace(0.005, 0.08, 40)
    x, y = np.meshgrid(np.log10(_RATIOS), depths)
    z = np.array([[model_share(table_2_1(4, float(s)), float(D)) for s in _RATIOS] for D in depths])
    axis.plot_surface(x, y, z, cmap="viridis", rcount=40, ccount=121, linewidth=0.0)
    axis.set_xticks([-1.0, -0.5, 0.0, 0.5, 1.0])
    axis.set_yticks([0.02, 0.04, 0.06, 0.08])
    axis.set_xlabel("log10 Sy*", labelpad=9)
    axis.set_ylabel("Delta/R", labelpad=9)
    axis.set_zlabel("delta_s*")
    axis.view_init(elev=28.0, azim=-50.0)
    step = [
        model_share(table_2_1(4, 1.0), D) - model_share(table_2_1(4, 1.0 + 1e-9), D)
        for D in (0.005, 0.04, 0.08)
    ]
    note = (
        f"2.13-2.16 for case 4. The step at Sy* = 1 falls with the depth, as the text says: "
        f"{step[0]:.2f}, {step[1]:.2f} and {step[2]:.2f} at Delta/R = 0.005, 0.04 and 0.08."
    )
    return Picture("2.10", "Share of the sphere over strength ratio and depth", made, note)


def _modulus(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    q = np.geomspace(60.0, 3000.0, 60)
    D = 0.04
    pairs = [_steel_pair(float(v)) for v in q]
    model = np.array([model_share(p, D) for p in pairs])
    axis.loglog(q, model, "C3", lw=2.0, label="2.15-2.16, (E'/Sy)^-0.7")
    fitted = _fitted()
    if fitted is not None:
        ours = np.array([float(fitted.share(p, D * p.R)) for p in pairs])
        axis.loglog(q, ours, "k", lw=2.0, label="our fitted law")
    elastic = np.array([_elastic_share(p, D) for p in pairs])
    axis.loglog(q, elastic, "0.6", ls="--", label="elastic sphere under the slip-line pressure")
    count = 0
    kinds = {"alike": "o", "softer": "^", "stiffer": "v"}
    for record in records:
        pair, found = record.case.pair, at_depth(record, D)
        if found and abs(math.log(max(pair.Sy_ratio, 1e-9) / 10.0)) < 0.05:
            value = found["sphere"] / (D * pair.R)
            ratio = pair.sphere.E / pair.flat.E
            kind = "alike" if 0.9 < ratio < 1.1 else "softer" if ratio < 1.0 else "stiffer"
            axis.plot(pair.E_reduced / pair.Sy_min, value, "k" + kinds[kind], ms=5, mfc="w")
            count += 1
    for kind, marker in kinds.items():
        what = "moduli alike" if kind == "alike" else f"{kind} sphere"
        axis.plot([], [], "k" + marker, ms=5, mfc="w", label=f"finite elements, {what}")
    finish(axis, x="E'/Sy_min", y="delta_s*")
    slope = float(np.polyfit(np.log(q), np.log(elastic), 1)[0])
    note = (
        f"Sy* = 10, Delta/R = 0.04; {count} of our cases. The thesis's exponent is -0.7; an "
        f"elastic sphere pressed by the plastic pressure of the flat gives {slope:.2f}."
    )
    if count:
        note += " The curves are for equal moduli; E'/Sy alone does not decide."
    return Picture("2.11", "Share of the sphere over E'/Sy, indentation", made, note)


def _steel_pair(q: float) -> Pair:
    """Two bodies of one modulus, nu = 0.3, Sy* = 10 and the E'/Sy_min asked for."""
    S = 0.5 * 200e9 / (1.0 - 0.3**2) / q
    return Pair(Material(E=200e9, nu=0.3, Sy=10.0 * S), Material(E=200e9, nu=0.3, Sy=S), 1e-3)


def _elastic_share(pair: Pair, D: float) -> float:
    """Mean sinking of an elastic body under the law's own mean pressure, 2 p a (1 - nu^2)/E."""
    law, depth = LAWS["ghaednia"], D * pair.R
    pressure, a = float(law.hardness(pair, depth)), float(law.contact_radius(pair, depth))
    return 2.0 * pressure * a / (pair.sphere.plane_strain_modulus * depth)


def _updated(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    D, R = 0.04, 1e-3
    pairs = [table_2_1(4, float(s)) for s in _RATIOS]
    updated = np.array([updated_jackson_green(p, D * R)[0] for p in pairs]) / R
    model = np.array([float(LAWS["ghaednia"].contact_radius(p, D * R)) for p in pairs]) / R
    plain = (
        np.array([float(LAWS["jackson-green-2007"].contact_radius(p, D * R)) for p in pairs]) / R
    )
    truncated = math.sqrt(1.0 - (1.0 - D) ** 2)
    axis.semilogx(_RATIOS, plain, color="C0", label="Jackson and Green")
    axis.semilogx(_RATIOS, updated, "C0--", label="Jackson and Green with delta_s* and R'")
    axis.semilogx(_RATIOS, model, "C3", lw=2.0, label="the thesis's model")
    if "fitted" in LAWS:
        ours = [float(LAWS["fitted"].contact_radius(p, D * R)) / R for p in pairs]
        axis.semilogx(_RATIOS, ours, **look(LAWS["fitted"]))
    axis.axhline(truncated, color="0.5", ls=":", label="truncated, sqrt(1 - (1 - D)^2)")
    radii = [(ratio, of_record(radius, r, D)) for ratio, r in case_records(records, 4)]
    points = sorted(one for one in radii if np.isfinite(one[1]))
    if points:
        axis.plot(*zip(*points, strict=True), "ko", ms=4, mfc="w", label="our finite elements")
    axis.set_ylim(0.22, 0.31)
    finish(axis, x="Sy*", y="contact radius a/R")
    x, beside = (np.array(v) for v in zip(*points, strict=True)) if points else (_RATIOS, model)
    off = np.interp(np.log(x), np.log(_RATIOS), updated) / beside - 1.0
    worst = int(np.argmax(np.abs(off)))
    first = plain[0] / beside[0] - 1.0
    note = (
        f"Against {'our finite elements' if points else 'the thesis model'}: Jackson and "
        f"Green {percent(first)} at Sy* = {x[0]:.2g} (the text: above by less than 2 %), with "
        f"delta_s* and R' at most {percent(float(off[worst]))}, at Sy* = {x[worst]:.2f} (the "
        "text: 3.2 % near 1); the truncated radius is "
        f"{percent(truncated / beside[0] - 1.0)}. "
    ) + judged(
        ("Jackson and Green is less than 2 % above", 0.0 < first < 0.02),
        ("the updated form has the same trend with a dip near 1", 0.9 < x[worst] < 1.3),
        ("the largest difference of that form is 3.2 %", abs(abs(off[worst]) - 0.032) < 0.005),
    )
    return Picture("2.12", "Contact radius of case 4 and the updated Jackson-Green", made, note)


def _difference(records: Sequence[CaseRecord]) -> Picture:
    made, (axis,) = sheet()
    off: list[tuple[float, float]] = []
    ends: list[tuple[float, float]] = []
    for record in records:
        pair = record.case.pair
        if abs(math.log(max(pair.Sy_ratio, 1e-9) / 0.1)) > 0.05:
            continue
        delta, radius = record.curve["delta"], record.curve["radius"]
        keep = delta > 3.0 * critical_depth(pair)
        x, y = _beside_updated(pair, delta[keep], radius[keep])
        axis.semilogx(x, y, ".", ms=3, color="0.7", zorder=1.0,
                      label=None if off else "our finite elements, all depths")  # fmt: skip
        off += list(zip(x, y, strict=True))
        there = at_depth(record, 0.04)
        if there:
            end = _beside_updated(pair, np.array([0.04 * pair.R]), np.array([there["radius"]]))
            ends.append((float(end[0][0]), float(end[1][0])))
    if ends:
        axis.semilogx(*zip(*ends, strict=True), "ko", ms=4, label="the same at Delta/R = 0.04")
    n = np.geomspace(8.0, 4000.0, 300)
    axis.semilogx(n, 100.0 * (_chi(n) - 1.0), "C3", lw=2.0, label="chi of 2.23 and 2.25")
    axis.axvline(_CRITICAL, color="0.5", ls=":")
    finish(axis, x="delta_n", y="radius over the updated Jackson-Green - 1 [%]")
    note = "The thesis's correction turns at delta_n = 408 (dotted)."
    if off:
        told = _by_depth(off, ((2, 10), (10, 100), (100, 400), (400, 2000)))
        note += f" Our finite elements of Sy* = 0.1 lie beside the updated law by {told} of delta_n"
    if len(ends) > 3:
        x, y = np.array(sorted(ends)).T
        before, after = x < _CRITICAL, x > _CRITICAL
        slopes = [
            float(np.polyfit(np.log(x[part]), y[part], 1)[0]) if np.sum(part) > 2 else float("nan")
            for part in (before, after)
        ]
        note += (
            f", and the {len(ends)} of them at Delta/R = 0.04, the thesis's depth, change by "
            f"{slopes[0]:+.1f} points for each factor e of delta_n before 408 and {slopes[1]:+.1f} "
            "after. "
        ) + judged(
            ("the difference rises up to 408", slopes[0] > 0.0),
            ("it falls beyond", slopes[1] < 0.0),
        )
    elif off:
        note += "."
    return Picture("2.13", "Finite elements against the updated Jackson-Green", made, note)


def _beside_updated(pair: Pair, depths: Any, radii: Any) -> tuple[Any, Any]:
    """delta_n, and radius over the updated Jackson and Green - 1 [%]."""
    found = [updated_jackson_green(pair, float(d)) for d in depths]
    x = np.array([n for _, n in found])
    return x, 100.0 * (radii / np.array([a for a, _ in found]) - 1.0)


def _by_depth(points: Sequence[tuple[float, float]], spans: Sequence[tuple[float, float]]) -> str:
    x, y = np.array(points).T
    return ", ".join(
        f"{np.mean(y[(x >= low) & (x < high)]):+.1f} % for {low:g} to {high:g}"
        for low, high in spans
        if np.any((x >= low) & (x < high))
    )


def _chi(n: Any) -> Any:
    """Correction of the radius at Sy* = 0.1, one pair for another: it depends on delta_n only."""
    pair = table_2_1(1, 0.1)
    depths = np.geomspace(1e-4, 0.12, 400) * pair.R
    found = np.array([updated_jackson_green(pair, float(d)) for d in depths])
    chi = LAWS["ghaednia"].contact_radius(pair, depths) / found[:, 0]
    return np.interp(np.log(n), np.log(found[:, 1]), chi)
