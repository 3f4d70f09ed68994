"""Figures 3.2-3.6: the measurements of chapter 3 on rendered pictures, whose truth is known.

The thesis's photographs, films and scans are not published. Rendered ones of the stated size, with
noise, go through our reduction, and where the thesis's own way differs through that as well.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from ....core.arrays import Array
from ....dynamics.integrate import strike
from ....models import LAWS
from ....reduce.images.clip import Clip
from ....reduce.measured import Measured
from ....reduce.tip.reduction import reduce_tip
from ....reduce.video.reduction import Optics, VideoReduction, reduce_video
from ...plot import Picture, finish, sheet
from ...synthetic.clips import ClipTruth, render
from ...synthetic.tip import TipTruth, photograph
from .. import chapter3

_PIXEL, _SPAN = 24.7e-6, 4.94e-3  # of the tip's photograph [m]
_FRAME_PIXEL, _RATE = 8e-5, 80_000.0  # of the film, the first chosen so that the flight fits
_ROUGHNESS = 0.4e-6
_TRIES = 25


def pictures() -> list[Picture]:
    """The five figures."""
    return [_tip(), _grey_values(), _threshold(), _track(), _profile()]


def _tip_truth(seed: int) -> TipTruth:
    R = chapter3.bench().striker.tip_radius
    return TipTruth(
        radius=R / _PIXEL, half_width=4.5e-3 / _PIXEL, rows=150, columns=420, noise=4.0, seed=seed
    )


def _edge(grey: Array, half: float) -> tuple[Array, Array]:
    """Columns near the middle, and the row at which each crosses half grey."""
    middle = 0.5 * grey.shape[1]
    columns = np.arange(int(middle - half), int(middle + half) + 1)
    dark = grey[:, columns] < 0.5 * (float(grey.min()) + float(grey.max()))
    rows = grey.shape[0] - np.argmax(dark[::-1], axis=0)
    return columns.astype(float), rows.astype(float)


def _polynomial_radius(columns: Array, rows: Array, order: int = 8) -> float:
    """Mean radius of curvature of a polynomial through the edge, over its points [pixel]."""
    x = (columns - columns.mean()) / np.ptp(columns)
    fit = np.polynomial.Polynomial.fit(x, rows, order)
    first, second = fit.deriv()(x) / np.ptp(columns), fit.deriv(2)(x) / np.ptp(columns) ** 2
    radius = (1.0 + first**2) ** 1.5 / np.abs(second)
    return float(np.mean(radius))


def _tip() -> Picture:
    made, axes = sheet(2, size=(5.6, 3.6))
    half = 0.5 * _SPAN / _PIXEL
    grey = photograph(_tip_truth(1)).astype(float)
    columns, rows = _edge(grey, half)
    axes[0].imshow(grey, cmap="gray", aspect="equal")
    axes[0].set_title("rendered photograph", fontsize=9)
    finish(axes[0], x="column [pixel]", y="row [pixel]")
    fit = np.polynomial.Polynomial.fit(columns, rows, 8)
    axes[1].plot(columns, rows, "C0.", ms=3, label="edge at half grey")
    axes[1].plot(columns, fit(columns), "k:", label="polynomial of order 8")
    axes[1].invert_yaxis()
    finish(axes[1], x="column [pixel]", y="row [pixel]")
    truth = _tip_truth(1).radius
    tries = [
        _polynomial_radius(*_edge(photograph(_tip_truth(seed)).astype(float), half)) / truth
        for seed in range(1, _TRIES + 1)
    ]
    ours = reduce_tip(photograph(_tip_truth(1)), shape="rod", scale=Measured(_PIXEL, 0.0))
    radius = ours.tip_radius
    low, high = np.quantile(tries, (0.05, 0.95))
    note = (
        f"A tip of 136.5 mm rises by {_SPAN**2 / 8.0 / 0.1365 * 1e6:.1f} um over 4.94 mm, 0.90 of "
        f"a pixel. The polynomial of order 8 through a thresholded edge reads {low:.2g} to "
        f"{high:.2g} times the true radius in 90 % of {_TRIES} photographs; our fit of the "
        "whole outline with its grey values reads "
        f"{1e3 * radius.value:.0f} +- {1e3 * radius.std:.0f} mm."
    )
    return Picture("3.2", "Radius of the tip from a photograph", made, note)


@cache
def _film() -> tuple[ClipTruth, Any, VideoReduction]:
    found = chapter3.bench()
    impact = strike(found.scene(LAWS["ghaednia"], height=1.43, mass=found.mass_that_fits))
    speed = math.sqrt(2.0 * 9.81 * 1.43)
    truth = ClipTruth(
        rows=256, columns=48, frames=240, scale=_FRAME_PIXEL, rate=_RATE, approach=speed,
        rebound=impact.restitution * speed, contact_time=impact.contact_time_s, half_width=18.0,
        tip_radius=18.0, surface=226.3, touch=120.37, seed=3,
    )  # fmt: skip
    frames = render(truth)
    clip = Clip(frames, math.nan, 0, np.empty(0, np.int64), "rendered film")
    optics = Optics(_RATE, scale=Measured(_FRAME_PIXEL, 0.0))
    return truth, frames, reduce_video(clip, optics, shape="rod")


def _grey_values() -> Picture:
    _, frames, found = _film()
    made, axes = sheet(2, size=(5.2, 3.8))
    levels = np.linspace(0.0, 256.0, 65)
    counts = np.array([np.histogram(f, levels)[0] for f in frames])
    drawn = axes[0].imshow(np.log10(counts.T + 1.0), origin="lower", aspect="auto",
                           extent=(0, len(frames), 0, 256), cmap="viridis")  # fmt: skip
    made.colorbar(drawn, ax=axes[0], label="log10(pixels + 1)")
    axes[0].axvline(found.critical_frame, color="w", ls=":")
    axes[0].set_title("(a) all frames", fontsize=9)
    finish(axes[0], x="frame", y="grey value")
    axes[1].bar(levels[:-1], counts[found.critical_frame], width=4.0, align="edge", color="C0")
    axes[1].axvline(found.threshold, color="C3", label=f"threshold {found.threshold:.0f}")
    axes[1].set_yscale("log")
    axes[1].set_title(f"(b) critical frame, {found.critical_frame}", fontsize=9)
    finish(axes[1], x="grey value", y="pixels")
    dark = [int(np.count_nonzero(f < found.threshold)) for f in frames]
    note = (
        f"Rendered film of {len(frames)} frames. Fewest dark pixels in frame "
        f"{int(np.argmin(dark))}, the critical frame as the thesis defines it; first touch was "
        "at 120.4. The thesis's film: 1000 frames of 512 by 48 pixels, critical frame 426."
    )
    return Picture("3.3", "Grey values of the film", made, note)


def _threshold() -> Picture:
    _, frames, found = _film()
    made, axes = sheet(2, size=(2.6, 5.0))
    frame = frames[found.critical_frame]
    place = int(np.argmin(np.abs(found.frame - found.critical_frame)))
    for axis, picture, name in zip(
        axes, (frame, frame > found.threshold), ("as filmed", "black and white"), strict=True
    ):
        axis.imshow(picture, cmap="gray", aspect="equal")
        axis.plot(found.column[place], found.row[place], "r+", ms=9)
        axis.set_title(name, fontsize=9)
        finish(axis, x="column [pixel]", y="row [pixel]")
    note = (
        f"Critical frame with the tip found at row {found.row[place]:.2f} +- "
        f"{found.row_std[place]:.2f} (cross) from the grey edge; black and white, as the thesis "
        f"has it, the lowest white row is {_lowest(frame > found.threshold)}. The thesis takes "
        "white for what is above 240; here it is the threshold of figure 3.3. Light bent around "
        "the edge shifts both before and after, as the text says, and not the restitution."
    )
    return Picture("3.4", "Critical frame and tracked tip", made, note)


def _lowest(white: Any) -> int:
    """Last row in which something is white."""
    return int(np.flatnonzero(np.any(white, axis=1))[-1])


def _track() -> Picture:
    truth, _, found = _film()
    made, (axis,) = sheet()
    time = 1e3 * (found.frame - truth.touch) / _RATE
    height = 1e3 * _FRAME_PIXEL * (truth.surface - found.row)
    axis.plot(time, height, "C0", lw=1.0)
    axis.plot(time[::40], height[::40], "ko", ms=5, label="every 40th frame")
    finish(axis, x="time from first touch [ms]", y="height of the tip [mm]")
    bounce = found.bounces[0]
    note = (
        f"Rendered with e = {truth.restitution:.4f}; the reduction reads {bounce.restitution}. "
        "From the slopes before and after, as in the thesis."
    )
    return Picture("3.5", "Height of the tip before and after", made, note)


def _profile() -> Picture:
    made, axes = sheet(2, size=(5.2, 4.2))
    depth, a = 118e-6, 5.1e-3  # measured at 1.43 m; radius of the model's contact there
    random = np.random.default_rng(6)
    grid = np.linspace(-8e-3, 8e-3, 161)
    r2 = grid[:, None] ** 2 + grid[None, :] ** 2
    scan = -depth * np.maximum(1.0 - r2 / a**2, 0.0)
    scan = scan + random.normal(0.0, 1.25 * _ROUGHNESS, scan.shape)  # Ra is 0.8 of the deviation
    drawn = axes[0].pcolormesh(1e3 * grid, 1e3 * grid, 1e6 * scan, cmap="viridis", rasterized=True)
    made.colorbar(drawn, ax=axes[0], label="height [um]")
    axes[0].set_aspect("equal")
    axes[0].set_title("(a) rendered scan", fontsize=9)
    finish(axes[0], x="x [mm]", y="y [mm]")
    section = scan[80]
    fit = np.polynomial.Polynomial.fit(grid, section, 7)
    axes[1].plot(1e3 * grid, 1e6 * section, "C0", lw=1.0, label="section")
    axes[1].plot(1e3 * grid, 1e6 * fit(grid), "k--", label="polynomial of order 7")
    axes[1].set_title("(b) section", fontsize=9)
    finish(axes[1], x="x [mm]", y="height [um]")
    inside = np.abs(grid) < a
    crater = np.polynomial.Polynomial.fit(grid[inside], section[inside], 7)
    whole, within = (
        float(f(g).min()) / -depth - 1.0 for f, g in ((fit, grid), (crater, grid[inside]))
    )
    note = (
        f"A cap of 118 um and {1e3 * a:.1f} mm radius with Ra = 0.4 um. The text fits a polynomial "
        "of order 7 to the section of the deformed area: kept inside the dent, its minimum reads "
        f"{within:+.1%}; drawn over the surface around it too (dashed), {whole:+.1%}. The text "
        "calls roughness of 1/100 of the dent a cause of error: 0.4 um are "
        f"{_ROUGHNESS / depth:.1%} of 118 um and {_ROUGHNESS / 42e-6:.1%} of the shallowest, 42 um."
    )
    return Picture("3.6", "Scan of a dent and its section", made, note)
