"""The surfaces that an unloading leaves, as a table and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...core.output import csv_text, write_figure, write_file
from ..rules import RULES
from ..solution import Profile, Unloading


def write_dent(unloading: Unloading, path: Path) -> Path:
    """Write the force-free surfaces of both bodies, a node a row: body, r_m, z_m.

    The flat was at z = 0, the sphere's pole too.
    """
    u = unloading
    rows = [
        (name, r, z)
        for name, *of in (("sphere", u.tip_r, u.tip_z), ("flat", u.crater_r, u.crater_z))
        for r, z in zip(*of, strict=True)
    ]
    return write_file(path, csv_text(rows, header=("body", "r_m", "z_m")))


def draw_dent(
    unloading: Unloading, path: Path, *, R: float, under_load: Profile | None, rim: float
) -> Path:
    """Draw by how much the surface of every body that keeps something has moved.

    Radius of the sphere and diameter of the rim [m], nan where there is none; `under_load` are the
    surfaces at the depth that it was unloaded from.
    """
    from matplotlib.figure import Figure

    u = unloading
    keeps = {
        "flat": u.residual_flat > RULES.least_dent * u.residual,
        "sphere": u.residual_sphere > RULES.least_dent * u.residual,
    }
    bodies = [name for name, kept in keeps.items() if kept] or ["flat"]
    figure = Figure(figsize=(8.0, 3.6 * len(bodies)), layout="constrained")
    contact = 2.0 * float(u.curve.radius[0])
    unit, scale = ("mm", 1e3) if contact >= 1e-3 else ("um", 1e6)
    for axis, name in zip(figure.subplots(len(bodies), squeeze=False).flat, bodies, strict=True):
        extent = 1.25 * max(contact, 0.0 if np.isnan(rim) else rim)
        for r, z, label, style in _profiles(u, under_load, name, R):
            at = np.concatenate([-r[::-1], r])
            seen = np.abs(at) <= extent
            axis.plot(scale * at[seen], 1e6 * np.concatenate([z[::-1], z])[seen], style,
                      label=label)  # fmt: skip
        _mark(axis, scale * contact, f"contact {scale * contact:.4g} {unit}", "C1-")
        if name == "flat" and not np.isnan(rim):
            _mark(axis, scale * rim, f"rim {scale * rim:.4g} {unit}", "C2--")
        axis.set(
            title=f"{name}: unloaded from Delta/R = {u.depth:.3g}", xlabel=f"r [{unit}]",
            ylabel="over the surface that was [um]",
        )  # fmt: skip
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8, loc="best")
    return write_figure(figure, path, dpi=140)


def _profiles(u: Unloading, loaded: Profile | None, name: str, R: float) -> list[Any]:
    """Radius, height over the surface that was, words and line: before, under load and after."""
    if name == "sphere":
        r = np.minimum(u.tip_r, R)
        # towards the flat is down
        after = u.tip_z - (R - np.sqrt(R**2 - r**2))
        return [(r, 0.0 * r, "before", "k--"), (r, after, "after", "C0-")]
    found = [(u.crater_r, 0.0 * u.crater_r, "before", "k--")]
    if loaded is not None:
        found.append((loaded.flat_r, loaded.flat_z, "under load", "C3:"))
    return [*found, (u.crater_r, u.crater_z, "after", "C0-")]


def _mark(axis: Any, diameter: float, label: str, style: str) -> None:
    for side, told in ((-0.5, label), (0.5, None)):
        axis.axvline(side * diameter, color=style[:2], ls=style[2:], lw=0.9, label=told)
