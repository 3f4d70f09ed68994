"""Chapter 3: the upright rod, its dent and its rebound, and the updated laws."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....core.material import Pair
from ....impact.integrate import strike
from ....impact.result import Impact
from ....models import LAWS, critical_depth, critical_force, law_named
from ....models.base import ContactLaw
from ...plot import Entry, Picture, finish, laws, look, percent, sheet
from .. import chapter3
from . import fields, rendered, sketches

_ORIGINAL = ("jackson-green-2007", "kogut-etsion", "kogut-komvopoulos", "ghaednia", "fitted")
_UPDATED = ("jackson-green-2007+ghaednia", "kogut-etsion+ghaednia", "kogut-komvopoulos+ghaednia")


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """Redraw the figures; the finite elements of figure 3.8 come with the campaign."""
    found = chapter3.bench()
    updated = [law_named(name) for name in _UPDATED] + [LAWS["ghaednia"]]
    first = laws(*_ORIGINAL, "thornton-ning")
    return [
        *sketches.chapter_3(),
        *rendered.pictures(),
        *fields.chapter_3_again(records),
        _force(found),
        _residual(found),
        _cycle(found),
        _heights("3.11", "Residual depth over drop height", found, first, "residual_depth"),
        _heights("3.12", "Restitution over drop height", found, laws(*_ORIGINAL), "restitution"),
        _heights("3.13", "Residual depth, updated laws", found, updated, "residual_depth"),
        _heights("3.14", "Restitution, updated laws", found, updated, "restitution"),
    ]


def _pair(found: chapter3.Bench) -> Pair:
    return Pair(found.sphere, found.flat, found.striker.tip_radius)


def _force(found: chapter3.Bench) -> Picture:
    made, (axis,) = sheet()
    pair = _pair(found)
    w = np.geomspace(0.5, 2500.0, 400)
    d = w * critical_depth(pair)
    for law in laws("jackson-green-2007", "ghaednia", "fitted"):
        axis.loglog(w, law.loading(pair, d) / critical_force(pair), **look(law))
    axis.axvline(148e-6 / critical_depth(pair), color="0.5", ls=":")
    finish(axis, x="delta/delta_y", y="F/F_y")
    here = 148e-6 / critical_depth(pair)
    note = (
        f"The depth of 148 um is at {here:.0f} (dotted) with the stated tip radius, while the "
        "figure runs to 2500."
    )
    return Picture("3.8", "Normalised force of the chapter's pair", made, note)


def _residual(found: chapter3.Bench) -> Picture:
    made, (axis,) = sheet()
    pair = _pair(found)
    peak = np.geomspace(2.0 * critical_depth(pair), 300e-6, 200)
    for law in laws(*_ORIGINAL, "thornton-ning"):
        axis.loglog(peak * 1e6, sum(law.residual(pair, peak)) * 1e6, **look(law))
    axis.plot(148.0, 118.0, "kx", ms=9, mew=2, label="measured 118 um at the thesis's 148 um")
    axis.set_xticks([20, 50, 100, 200, 300], ["20", "50", "100", "200", "300"])
    axis.set_xticks([], minor=True)
    finish(axis, x="largest depth [um]", y="residual depth [um]")
    left = float(sum(LAWS["ghaednia"].residual(pair, 148e-6))) * 1e6
    note = f"3.7 leaves {left:.0f} um of 148 um; figure 3.10 says 107 um, the measurement 118 um."
    return Picture("3.9", "Residual over largest depth", made, note)


def _cycle(found: chapter3.Bench) -> Picture:
    made, axes = sheet(2)
    told = []
    for axis, mass in zip(axes, (found.striker.mass, found.mass_that_fits), strict=True):
        for law in laws(*_ORIGINAL):
            scene = found.scene(law, height=1.43, mass=mass)
            impact = strike(scene)
            peak, rest = impact.peak_depth_m, impact.residual_m
            d = np.linspace(0.0, peak, 200)
            back = np.linspace(rest, peak, 200)
            line = look(law)
            axis.plot(d * 1e6, law.loading(scene.pair, d) / 1e3, **line)
            line["label"] = None
            axis.plot(back * 1e6, law.unloading(scene.pair, back, peak) / 1e3, ls="--", **line)
            if law.name == "ghaednia":
                told.append(f"{peak * 1e6:.0f} and {rest * 1e6:.0f} um with {mass:g} kg")
        axis.plot(148.0, 80.85, "kx", ms=9, mew=2, label="thesis, peak")
        axis.set_title(f"{mass:g} kg", fontsize=9)
        finish(axis, x="depth [um]", y="force [kN]", legend="dashed: unloading")
    note = f"Largest and residual depth of the thesis's model: {'; '.join(told)}; "
    note += "thesis: 148 and 107 um."
    return Picture("3.10", "Force over depth, 1.43 m", made, note)


def _heights(
    number: str, title: str, found: chapter3.Bench, chosen: list[ContactLaw], observable: str
) -> Picture:
    made, axes = sheet(2)
    read: Callable[[Impact], float] = (
        (lambda i: i.restitution) if observable == "restitution" else (lambda i: 1e6 * i.residual_m)
    )
    rows = [row for row in found.measured if row["observable"] == observable]
    told = []
    for axis, mass in zip(axes, (found.striker.mass, found.mass_that_fits), strict=True):
        curves = chapter3.curves(found, chosen, masses=(mass,), count=7)
        for curve in curves:
            axis.plot(curve.heights, [read(i) for i in curve.impacts], **look(curve.law))
        for row in rows:
            scale = 1.0 if observable == "restitution" else 1e6
            axis.plot(row["drop_height_m"], scale * row["value"], "kx", ms=9, mew=2)
        axis.set_title(f"{mass:g} kg", fontsize=9)
        axis.set_ylim(0.0, None)
        label = "restitution" if observable == "restitution" else "residual depth [um]"
        finish(axis, x="drop height [m]", y=label, legend="crosses: measured")
        worst = {
            c.law.name: max((chapter3.deviation(c, r)[1] for r in rows), key=abs) for c in curves
        }
        told.append(
            f"{mass:g} kg: " + ", ".join(f"{name} {percent(off)}" for name, off in worst.items())
        )
    note = f"Largest deviation from the measured values; {'; '.join(told)}."
    if "updated" in title:
        note += f" {_mean_deviations(found, chosen, observable)}"
    return Picture(
        number, title, made,
        note,
    )  # fmt: skip


MASSES = (0.151, 0.255, 0.33, 0.345, 0.355)
"""Readings of the rod's mass [kg]: from its size, as printed, and the range that fits."""


def mean_deviation(
    found: chapter3.Bench, law: ContactLaw, *, mass: float, observable: str
) -> float:
    """Mean absolute deviation from the measured values, the measure that the thesis uses (3.3)."""
    off = []
    for row in found.measured:
        if row["observable"] == observable:
            impact = strike(found.scene(law, height=row["drop_height_m"], mass=mass))
            ours = impact.restitution if observable == "restitution" else impact.residual_m
            off.append(abs(ours / row["value"] - 1.0))
    return float(np.mean(off))


def _mean_deviations(found: chapter3.Bench, chosen: list[ContactLaw], observable: str) -> str:
    told, holds = [], []
    for mass in MASSES:
        off = {
            law.name: mean_deviation(found, law, mass=mass, observable=observable) for law in chosen
        }
        told.append(f"{mass:g} kg: " + ", ".join(f"{n} {v:.1%}" for n, v in off.items()))
        if max(off.values()) <= 0.10:
            holds.append(f"{mass:g}")
    return (
        f"In the mean, as the thesis measures: {'; '.join(told)}. Its statement of at most 10 % "
        f"for every updated law holds for {', '.join(holds) or 'none'} kg."
    )
