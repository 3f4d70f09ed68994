"""The picture of a blow: the rig to scale, what stays, force over depth, the histories."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ...core.output import panels
from ..integrate import Trace
from .crater import LeftSurface, surfaces_left
from .draw import looks
from .rig_shape import rig_shape

if TYPE_CHECKING:
    from ..files.blow import Blow

LOOP = ("penetration_m", "depth [um]", 1e6, "normal_force_N", "normal force [kN]", 1e-3)
AGAINST_TIME = (
    ("tip_height_m", "tip height [um]", 1e6, 1e-9),
    ("normal_force_N", "normal force [kN]", 1e-3, 0.0),
    ("normal_velocity_m_s", "normal velocity [m/s]", 1.0, 0.0),
    ("slip_m", "tangential displacement [um]", 1e6, 1e-9),
    ("sliding_velocity_m_s", "tangential velocity of the contact [m/s]", 1.0, 1e-9),
    ("spin_rad_s", "spin [rad/s]", 1.0, 1e-6),
)
"""Column, axis, scale, and what counts as nothing at all [SI]."""

# limit: time from which histories are in ms [s]; below, five digits of a tick would overlap
_SHORT = 1e-4


def picture(blow: Blow, *, exact: bool = False) -> Figure:
    """Return the rig, what the first law leaves that leaves anything, and the curves of all laws.

    What speaks against a law at this depth makes its curves thin and pale, as that it did not come
    to an end by it. `exact` leaves out the band of what stays.
    """
    traces = list(blow.traces.items())
    shown = [
        (name, label, scale) for name, label, scale, nothing in AGAINST_TIME
        if any(np.ptp(trace.column(name)) > nothing for _, trace in traces)
    ]  # fmt: skip
    law, left = _left(blow, exact=exact)
    made, axes = panels(2 + bool(left) + len(shown))
    _draw_rig(axes[0], blow, left)
    if left:
        _draw_left(axes[1], blow, law, left)
    stopped = {law: "did not end" for law, one in blow.impacts.items() if not one.outcome.completed}
    _draw_curves(axes[1 + bool(left) :], traces, shown, {**blow.doubts, **stopped})
    return made


def _left(blow: Blow, *, exact: bool) -> tuple[str, list[LeftSurface]]:
    """The surfaces of the first law that nothing speaks against and that leaves anything."""
    ended = [law for law in blow.laws if blow[law.name].outcome.completed]
    trusted = sorted(ended, key=lambda law: law.name in blow.doubts)
    for law in trusted:
        scene, found = blow.setup.scene(law), blow[law.name]
        left = surfaces_left(
            scene, found, blow.bands[law.name].std if law.name in blow.sure and not exact else None
        )
        if left:
            return law.name, left
    return "", []


def _scale(length: float) -> tuple[float, str]:
    return (1e3, "mm") if length >= 1e-3 else (1e6, "um")


def _draw_rig(axis: Any, blow: Blow, left: Sequence[LeftSurface]) -> None:
    setup = blow.setup
    of_flat = next((s for s in left if s.body == "flat" and s.shaped), None)
    none = np.zeros(0)
    place, height = (none, none) if of_flat is None else (of_flat.place, of_flat.height)
    rig = rig_shape(setup, place, height)
    scale, unit = _scale(rig.window)
    for outline, colour in ((rig.struck, "#e3dccf"), (rig.striker, "#c9d3df")):
        axis.fill(*(scale * outline).T, facecolor=colour, edgecolor="0.35", lw=0.8)
    for surface in left[:1]:
        axis.hlines(0.0, -scale * surface.radius, scale * surface.radius, color="C3", lw=2.5)
    w, name = scale * rig.window, setup.file.striker
    body = setup.file.strikers[name]
    approach = setup.scene(blow.laws[0]).approach
    direction = np.array([approach.tangential, -approach.speed])
    direction *= 0.5 * w / np.linalg.norm(direction)
    tip = np.array([0.0, scale * body.tip_radius_m.value]) + 0.5 * direction
    axis.annotate("", xy=tip, xytext=tip - direction, arrowprops={"arrowstyle": "-|>", "lw": 1.4})
    speed = math.hypot(approach.tangential, approach.speed)
    size = f"R {_length(body.tip_radius_m.value)}"
    size = size if body.shape == "sphere" else f"tip {size}, {_length(body.length)}"
    told = ["to scale", f"{name}: {size}, {_mass(body.mass_kg.value)}, {speed:.3g} m/s"]
    second = setup.second
    if second is not None:
        kind = "sphere" if second.radius > 0.0 else "seat"
        mass = f", {_mass(second.mass)}" if second.free else ", held"
        told.append(f"{kind}: R {_length(abs(second.radius))}{mass}")
    elif math.isinf(rig.thickness):
        told.append("flat: no thickness stated")
    else:
        told.append(f"flat: {_length(rig.thickness)} thick")
        low = -min(scale * rig.thickness, 0.75 * w)
        axis.annotate("", xy=(-0.8 * w, low), xytext=(-0.8 * w, 0.0),
                      arrowprops={"arrowstyle": "<->", "lw": 0.8})  # fmt: skip
    axis.set(
        xlim=(-w, w), ylim=(-0.8 * w, 1.2 * w), aspect="equal", title="\n".join(told),
        xlabel=f"along what is struck [{unit}]{'; red: the contact' * bool(left)}",
        ylabel=f"height [{unit}]",
    )  # fmt: skip
    axis.title.set_fontsize(8)


def _draw_left(axis: Any, blow: Blow, law: str, left: Sequence[LeftSurface]) -> None:
    names = {"flat": "flat" if blow.setup.second is None else "what is struck",
             "sphere": blow.setup.file.striker}  # fmt: skip
    scale, unit = _scale(2.0 * left[0].radius)
    for surface, colour in zip(left, ("C0", "C1"), strict=False):
        name = f"{names[surface.body]}: {_length(surface.depth)} deep"
        x, z, off = scale * surface.place, 1e6 * surface.height, 1e6 * surface.std
        if surface.shaped:
            axis.plot(x, z, color=colour, label=name)
            axis.fill_between(x, z - off, z + off, color=colour, alpha=0.25, lw=0.0)
        else:
            axis.errorbar([0.0], z[:1], yerr=off[:1], fmt="_", ms=14, color=colour, capsize=3,
                          label=f"{name}; its shape is not known")  # fmt: skip
    radius = scale * left[0].radius
    reach = max(1.05 * scale * max(np.abs(s.place).max() for s in left), 1.5 * radius)
    axis.axhline(0.0, color="0.35", ls="--", lw=0.8)
    for side in (-radius, radius):
        axis.axvline(side, color="0.35", ls=":", lw=0.8)
    heights = 1e6 * np.concatenate([[0.0], *(s.height for s in left)])
    low, high = float(heights.min()), float(heights.max())
    # what is flat is drawn higher than wide, in one digit
    stretch = max(float(f"{0.55 / ((high - low) / (2e6 / scale * reach)):.1g}"), 1.0)
    stretched = f"heights drawn {stretch:g} times too large"
    axis.set(
        xlim=(-reach, reach), xlabel=f"from the middle [{unit}]; dotted: the contact",
        ylabel="over the surface that was [um]",
        title=f"left by {law}; {stretched if stretch > 1.0 else 'to scale'}",
        aspect=stretch * scale / 1e6, ylim=(low - 0.45 * (high - low),
                                                        high + 0.25 * (high - low)),
    )  # fmt: skip
    axis.title.set_fontsize(8)
    axis.grid(alpha=0.3)
    axis.legend(fontsize=7, loc="lower right")


def _draw_curves(
    axes: Sequence[Any], traces: Sequence[tuple[str, Trace]], shown: Sequence[Any],
    doubts: Mapping[str, str],
) -> None:  # fmt: skip
    depth, depth_label, depth_scale, force, force_label, force_scale = LOOP
    look = looks([law for law, _ in traces], doubts)
    longest = max(trace.column("time_s").max() for _, trace in traces)
    per_s, time = (1e3, "ms") if longest >= _SHORT else (1e6, "us")
    for law, trace in traces:
        style = look[law]
        label = f"{law}: {doubts[law]}" if law in doubts else law
        axes[0].plot(
            depth_scale * trace.column(depth), force_scale * trace.column(force), label=label,
            **style,
        )  # fmt: skip
        for axis, (name, _, scale) in zip(axes[1:], shown, strict=True):
            axis.plot(per_s * trace.column("time_s"), scale * trace.column(name), **style)
    axes[0].set(xlabel=depth_label, ylabel=force_label)
    for axis, (_, label, _) in zip(axes[1:], shown, strict=True):
        axis.set(xlabel=f"time [{time}]", ylabel=label)
    for axis in axes:
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=7)


def _length(x: float) -> str:
    scale, unit = _scale(x)
    return f"{scale * x:.3g} {unit}"


def _mass(m: float) -> str:
    return f"{1e3 * m:.3g} g" if m < 1.0 else f"{m:.3g} kg"
