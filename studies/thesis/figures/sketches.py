"""Figures 1.1, 1.4, 3.1, 4.1-4.3, 5.1 and 5.2: the sketches, drawn to the scale of the numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.patches import Arc, Circle, Polygon, Rectangle

from ....core.arrays import Array
from ....dynamics.inverse import mobility
from ....dynamics.scene import Striker
from ...plot import Picture, sheet
from .. import chapter3, chapter5

_METAL, _FLAT, _INK = "#c9d6e8", "#e6dccb", "0.15"


def chapter_1() -> list[Picture]:
    """Figures 1.1 and 1.4."""
    return [
        _indentation("1.1", "A rigid sphere in a flat that deforms"),
        _flattening("1.4", "A sphere that deforms on a rigid flat"),
    ]


def chapter_3() -> list[Picture]:
    """Figure 3.1."""
    return [_drop()]


def chapters_4_and_5() -> list[Picture]:
    """Figures 4.1-4.3, 5.1 and 5.2."""
    return [
        _rod("4.1", "The rod during the impact", forces=True),
        _again(_flattening("4.2", "Deformed bodies of the flattening laws"), "1.4"),
        _again(_indentation("4.3", "Deformed flat of the indentation laws"), "1.1"),
        _rod("5.1", "The rod of chapter 5", forces=False),
        _setup(),
    ]


def _again(picture: Picture, number: str) -> Picture:
    """Return a picture that was shown before, with a note that says so."""
    return replace(picture, note=f"As [figure {number}](chapter-{number[0]}.md).")


def _axis(size: tuple[float, float] = (6.4, 4.6)) -> tuple[Any, Any]:
    made, (axis,) = sheet(size=size)
    axis.set_aspect("equal")
    axis.set_axis_off()
    return made, axis


def _span(axis: Any, x: tuple[float, float], y: tuple[float, float], text: str) -> None:
    """Dimension line with its name beside its middle."""
    axis.annotate(
        "", xy=(x[1], y[1]), xytext=(x[0], y[0]),
        arrowprops={"arrowstyle": "<->", "lw": 0.9, "shrinkA": 0.0, "shrinkB": 0.0},
    )  # fmt: skip
    upright = x[0] == x[1]
    axis.annotate(
        text, xy=(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])), fontsize=9,
        xytext=(4.0, 0.0) if upright else (0.0, -5.0), textcoords="offset points",
        ha="left" if upright else "center", va="center" if upright else "top",
    )  # fmt: skip


def _arrow(axis: Any, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    axis.annotate(
        "", xy=end, xytext=start,
        arrowprops={"arrowstyle": "-|>", "lw": 1.6, "color": "C3", "shrinkA": 0.0, "shrinkB": 0.0},
    )  # fmt: skip
    away = np.subtract(end, start) / math.dist(start, end)
    axis.annotate(text, xy=end, xytext=tuple(9.0 * away), textcoords="offset points", color="C3",
                  ha="center", va="center", fontsize=9)  # fmt: skip


def _indentation(number: str, title: str) -> Picture:
    """Sphere of R = 1 at the depth 0.15, with a pile-up that puts the edge above the surface."""
    made, axis = _axis()
    depth, rim = 0.15, 0.025
    a_cut = math.sqrt(depth * (2.0 - depth))
    a = math.sqrt((depth + rim) * (2.0 - depth - rim))
    inside = np.linspace(0.0, a, 80)
    bottom = 1.0 - depth - np.sqrt(1.0 - inside**2)
    outside = np.linspace(a, 1.25, 80)[1:]
    hill = rim * np.exp(-((outside - a) / 0.16))
    x, z = np.concatenate([inside, outside]), np.concatenate([bottom, hill])
    _body(axis, x, z, floor=-0.75)
    axis.add_patch(Circle((0.0, 1.0 - depth), 1.0, fc=_METAL, ec=_INK, lw=1.2))
    axis.plot([0.0, 0.0], [-0.7, 1.05], "-.", color="0.6", lw=0.7)
    axis.text(0.0, 1.15, "rigid sphere", ha="center", fontsize=9)
    axis.text(-1.2, -0.62, "elastic-plastic flat", fontsize=9)
    _span(axis, (0.0, a), (-0.30, -0.30), "a, real contact")
    _span(axis, (0.0, a_cut), (-0.48, -0.48), "a', truncated")
    _span(axis, (1.32, 1.32), (-depth, 0.0), "delta")
    for z_line in (-depth, 0.0):
        axis.plot([0.0, 1.35], [z_line, z_line], color="0.5", lw=0.6)
    axis.annotate("", xy=(-0.8, 0.25), xytext=(0.0, 1.0 - depth),
                  arrowprops={"arrowstyle": "-|>", "lw": 0.9})  # fmt: skip
    axis.text(-0.45, 0.62, "R", fontsize=9)
    axis.set_xlim(-1.3, 1.65)
    axis.set_ylim(-0.8, 1.9)
    note = (
        f"Drawn for delta/R = {depth:g} and a pile-up of {rim:g} R: the truncated radius "
        f"a' = sqrt(2 R delta - delta^2) is {a_cut:.3f} R, the real one {a:.3f} R."
    )
    return Picture(number, title, made, note)


def _body(axis: Any, x: Array, z: Array, *, floor: float) -> None:
    """Half-space below the surface (x, z), drawn on both sides of the axis."""
    right = np.column_stack([x, z])
    left = np.column_stack([-x[::-1], z[::-1]])
    edge = np.vstack([left, right])
    bottom = [[x[-1], floor], [-x[-1], floor]]
    axis.add_patch(Polygon(np.vstack([edge, bottom]), fc=_FLAT, ec="none"))
    axis.plot(edge[:, 0], edge[:, 1], color=_INK, lw=1.2)


def _flattening(number: str, title: str) -> Picture:
    """Sphere pressed flat by 0.15 R; the metal that is pushed aside widens its foot."""
    made, axis = _axis()
    depth, bulge = 0.15, 0.03
    a_cut = math.sqrt(depth * (2.0 - depth))
    a = a_cut + bulge
    angle = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 200)
    x, z = np.cos(angle), 1.0 - depth + np.sin(angle)
    wide = np.maximum(x, 0.0) + bulge * np.exp(-((z / 0.35) ** 2))
    keep = z > 0.0
    right = np.column_stack([np.concatenate([[a], wide[keep]]), np.concatenate([[0.0], z[keep]])])
    outline = np.vstack([right, np.column_stack([-right[::-1, 0], right[::-1, 1]])])
    axis.add_patch(Rectangle((-1.25, -0.3), 2.5, 0.3, fc=_FLAT, ec=_INK, lw=1.0))
    axis.add_patch(Polygon(outline, fc=_METAL, ec=_INK, lw=1.2))
    below = np.linspace(-math.asin(1.0 - depth) - 1e-9, -math.pi + math.asin(1.0 - depth), 60)
    axis.plot(np.cos(below), 1.0 - depth + np.sin(below), ":", color="0.35", lw=1.0)
    axis.plot([0.0, 0.0], [-0.28, 1.05], "-.", color="0.6", lw=0.7)
    axis.text(0.0, 1.15, "elastic-plastic sphere", ha="center", fontsize=9)
    axis.text(-1.2, -0.24, "rigid flat", fontsize=9)
    _span(axis, (0.0, a), (0.10, 0.10), "a")
    for z_line in (-depth, 0.0):
        axis.plot([0.0, 1.35], [z_line, z_line], color="0.5", lw=0.6)
    _span(axis, (1.32, 1.32), (-depth, 0.0), "delta")
    axis.annotate("", xy=(-0.93, 0.5), xytext=(0.0, 1.0 - depth),
                  arrowprops={"arrowstyle": "-|>", "lw": 0.9})  # fmt: skip
    axis.text(-0.5, 0.76, "R", fontsize=9)
    axis.set_xlim(-1.3, 1.65)
    axis.set_ylim(-0.4, 1.9)
    note = (
        f"Drawn for delta/R = {depth:g}: the real radius of {a:.2f} R exceeds the truncated "
        f"one of {a_cut:.2f} R by what the flat has pushed aside (dotted), drawn freely here."
    )
    return Picture(number, title, made, note)


def _capsule(rod: Striker, angle: float) -> Array:
    """Outline of a round-ended rod that touches the origin, shape (n, 2) [m]."""
    R, L = rod.tip_radius, rod.length
    t = np.linspace(0.5 * math.pi, 1.5 * math.pi, 60)
    end = R * np.column_stack([np.cos(t), np.sin(t)])
    outline = np.vstack([end, [L, 0.0] - end])
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(outline @ np.array([[c, s], [-s, c]]) + [0.0, R])


def _rod(number: str, title: str, *, forces: bool) -> Picture:
    made, axis = _axis((6.4, 5.2))
    rod, angle = chapter5.thesis_rod(), math.radians(45.0)
    L, R = rod.length, rod.tip_radius
    axis.add_patch(Rectangle((-0.10, -0.03), 0.40, 0.03, fc=_FLAT, ec=_INK, lw=1.0))
    axis.add_patch(Polygon(_capsule(rod, angle), fc=_METAL, ec=_INK, lw=1.2))
    c, s = rod.arm(angle)
    axis.plot([c], [s], "ko", ms=4)
    axis.annotate("C", (c, s), xytext=(8, -8), textcoords="offset points", fontsize=10)
    axis.plot([0.0], [0.0], "ko", ms=4)
    axis.annotate("T", (0.0, 0.0), xytext=(-9, -11), textcoords="offset points", fontsize=10)
    axis.add_patch(Arc((0.0, R), 0.12, 0.12, theta1=0.0, theta2=45.0, lw=0.9))
    axis.plot([0.0, 0.10], [R, R], color="0.5", lw=0.7)
    axis.text(0.068, R + 0.018, "theta", fontsize=9)
    if forces:
        _arrow(axis, (0.0, 0.0), (0.0, 0.09), "F_n")
        _arrow(axis, (0.0, 0.0), (0.075, 0.0), "F_f")
        _arrow(axis, (c, s), (c, s - 0.075), "G")
        note = (
            "The chapter's rod to scale at 45 degrees. The tip slides to -x, so that friction "
            f"points to +x; C lies {c * 1e3:.0f} mm beside and {s * 1e3:.0f} mm above T. The "
            "normal is y, as in 4.1-4.2: 4.6 and 4.7 exchange the two unit vectors."
        )
    else:
        far = (L * math.cos(angle), R + L * math.sin(angle))
        off = np.array([-math.sin(angle), math.cos(angle)]) * 3.0 * R
        _span(axis, (off[0], far[0] + off[0]), (R + off[1], far[1] + off[1]), "")
        axis.text(0.5 * far[0] + 1.7 * off[0], 0.5 * far[1] + 1.5 * off[1], "L", fontsize=10)
        axis.annotate("R", far, xytext=(6, 4), textcoords="offset points", fontsize=9)
        axis.plot(*far, "k+", ms=6)
        _arrow(axis, (0.0, 0.0), (0.0, -0.06), "v_i")
        found = mobility(rod, angle)
        note = (
            f"The chapter's rod to scale: L = {L * 1e3:.1f} mm between the tip centres, R = "
            f"{R * 1e3:.1f} mm. Its tip moves as a mass of {1.0 / found.yy:.3f} kg along the "
            f"normal ({1.0 / found.normal(0.13):.3f} kg while it slides with friction 0.13)."
        )
    axis.set_xlim(-0.11, 0.31)
    axis.set_ylim(-0.075, 0.27)
    return Picture(number, title, made, note)


def _drop() -> Picture:
    made, axis = _axis((5.2, 6.4))
    found = chapter3.bench()
    rod = found.striker
    low, high = found.heights
    axis.add_patch(Rectangle((-0.35, -0.08), 0.9, 0.08, fc="0.75", ec=_INK))
    axis.add_patch(Rectangle((-0.06, 0.0), 0.12, 0.03, fc=_FLAT, ec=_INK))
    for height, shade in ((low, "0.55"), (1.43, _INK)):
        bottom = 0.03 + height
        axis.add_patch(Rectangle((-rod.radius * 2, bottom), 4 * rod.radius, rod.length, fc=_METAL,
                                 ec=shade))  # fmt: skip
    _span(axis, (0.16, 0.16), (0.03, 0.03 + 1.43), f"H = {low:g} to {high:g} m")
    axis.add_patch(Rectangle((-0.33, 0.02), 0.12, 0.09, fc="0.35", ec=_INK))
    axis.plot([-0.21, -0.06], [0.065, 0.045], ":", color="0.4")
    axis.text(-0.34, 0.14, "camera\n80 000 1/s", fontsize=8)
    axis.text(0.08, 0.012, "flat, 1070 iron", fontsize=8)
    axis.text(-0.32, -0.055, "rigid table", fontsize=8)
    axis.text(0.05, 0.03 + 1.43 + 0.5 * rod.length, "rod, held by a robot arm", fontsize=8)
    axis.set_xlim(-0.4, 0.75)
    axis.set_ylim(-0.1, 1.85)
    note = (
        f"To scale, the rod drawn twice as thick. Length {rod.length * 1e3:.0f} mm, diameter "
        f"{2e3 * rod.radius:.0f} mm, {rod.mass:g} kg as printed; at {high:g} m it arrives with "
        f"{math.sqrt(2 * 9.81 * high):.2f} m/s."
    )
    return Picture("3.1", "The drop test", made, note)


def _setup() -> Picture:
    made, axes = sheet(2, size=(4.6, 4.6))
    rod = chapter5.thesis_rod()
    for axis, name, side in zip(axes, ("(a) right view", "(b) front view"), (False, True),
                                strict=True):  # fmt: skip
        axis.set_aspect("equal")
        axis.set_axis_off()
        axis.set_title(name, fontsize=9)
        axis.add_patch(Rectangle((-0.12, -0.09), 0.45, 0.05, fc="0.75", ec=_INK))
        axis.add_patch(Rectangle((-0.10, -0.04), 0.40, 0.03, fc=_FLAT, ec=_INK))
        axis.text(-0.10, -0.075, "clamped to a massive table", fontsize=8)
        if side:
            x, R = 0.10, rod.tip_radius
            end = rod.length * math.sin(math.radians(45.0)) + 2.0 * R
            axis.add_patch(Rectangle((x - R, 0.05), 2.0 * R, end, fc=_METAL, ec=_INK))
            for k in (0.25, 0.5, 0.75):
                axis.plot(x, 0.05 + k * end, "o", color="C3", ms=5)
            axis.text(x + 0.03, 0.05 + 0.5 * end, "three markers,\n500 frames/s", fontsize=8)
        else:
            outline = _capsule(rod, math.radians(45.0)) + np.array([0.0, 0.05])
            axis.add_patch(Polygon(outline, fc=_METAL, ec=_INK, lw=1.2))
            for k in (0.4, 0.7):
                x, y = k * rod.length * math.sqrt(0.5), 0.05 + k * rod.length * math.sqrt(0.5)
                axis.add_patch(Rectangle((x - 0.035, y + 0.03), 0.03, 0.03, fc="C0", ec=_INK))
            axis.text(-0.11, 0.22, "two solenoids\nhold the rod", fontsize=8)
        axis.set_xlim(-0.13, 0.34)
        axis.set_ylim(-0.10, 0.33)
    note = (
        "Rod, flat and angle to scale; solenoids and table are placed freely, the text gives no "
        "size of theirs."
    )
    return Picture("5.2", "The oblique drop test", made, note)


def pictures(records: Sequence[Any]) -> list[Picture]:
    """All sketches, in the order of their numbers."""
    return [*chapter_1(), *chapter_3(), *chapters_4_and_5()]
