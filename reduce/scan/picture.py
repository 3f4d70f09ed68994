"""Pictures of a scan: crater with outline and sections, or ball with what is left."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import binary_opening

from ...core.output import figure
from ..pictures import save
from .ball import ScannedBall
from .crater import Crater

UM = 1e6


def draw_crater(result: Crater, path: Path) -> None:
    """Draw the levelled scan with the crater's outline, and the sections with the depth."""
    made, axes = figure(1, 2, size=(13.0, 5.5))
    _map(axes[0, 0], result, made)
    axis = axes[0, 1]
    reach = _reach(result)
    for line, colour, label in ((result.along, "C1", "along"), (result.across, "C2", "across")):
        axis.plot(UM * line.s, UM * line.z, colour, lw=1, label=label)
    axis.axhline(0.0, color="k", lw=0.6)
    axis.axhline(-UM * result.depth.value, color="k", lw=0.6, ls="--")
    sizes = {"length": (result.length, "C1"), "width": (result.width, "C2")}
    known = {name: one for name, one in sizes.items() if np.isfinite(one[0].value)}
    for size, colour in known.values():
        axis.axvline(0.5 * UM * size.value, color=colour, lw=0.5, ls=":")
    told = ", ".join(f"{name} {size.scaled(UM)} um" for name, (size, _) in known.items())
    axis.set(
        xlim=(-1.6 * reach, 1.6 * reach), xlabel="distance from the deepest point [um]",
        ylabel="height [um]",
        title=f"depth {result.depth.scaled(UM)} um, rim {result.pile_up.scaled(UM)} um\n"
        f"{told or 'its walls are too rough to tell its size'}",
    )  # fmt: skip
    axis.legend()
    save(made, path)


def _reach(result: Crater) -> float:
    cells = float(result.surface.crater.sum()) * float(np.prod(result.surface.step))
    return 0.75 * UM * max(float(np.nan_to_num(result.length.value)), float(np.sqrt(cells)))


def _map(axis: Any, result: Crater, made: Any) -> None:
    z, step = result.surface.z, result.surface.step
    size = np.array(z.shape) * step * UM
    limit = UM * max(result.pile_up.value, 0.3 * result.depth.value)
    image = axis.imshow(
        UM * z.T, origin="lower", extent=(0.0, size[0], 0.0, size[1]), cmap="RdBu_r",
        vmin=-limit, vmax=limit, interpolation="nearest",
    )  # fmt: skip
    x, y = (UM * h * np.arange(n) for h, n in zip(step, z.shape, strict=True))
    axis.contour(x, y, result.surface.crater.T.astype(float), [0.5], colors="k", linewidths=0.8)
    left_out = binary_opening(~result.surface.clear, iterations=2)  # without the spikes
    axis.contour(x, y, left_out.T.astype(float), [0.5], colors="g", linewidths=0.5)
    deep = UM * result.deepest
    axis.plot(*deep, "k+", ms=12)
    for angle, colour in ((result.direction, "C1"), (result.direction + np.pi / 2, "C2")):
        ends = _reach(result) * np.array([-1.0, 1.0])
        axis.plot(
            deep[0] + ends * np.cos(angle), deep[1] + ends * np.sin(angle), color=colour, lw=0.8
        )
    axis.set(
        xlim=(0, size[0]), ylim=(0, size[1]), xlabel="x [um]", ylabel="y [um]",
        title="height above the undisturbed surface [um]\nblack: crater, green: levelled outside",
    )  # fmt: skip
    made.colorbar(image, ax=axis)


def draw_ball(result: ScannedBall, path: Path) -> None:
    """Draw what is left of the heights when the sphere is taken off."""
    made, axes = figure(1, 2, size=(12.0, 5.5))
    nm = 1e9
    limit = 4.0 * nm * result.rest
    points = axes[0, 0].scatter(
        UM * result.x, UM * result.y, c=nm * result.off, s=2, cmap="RdBu_r", vmin=-limit, vmax=limit
    )
    axes[0, 0].plot(*(UM * result.top), "k+", ms=12)
    axes[0, 0].set(aspect="equal", xlabel="x [um]", ylabel="y [um]", title="above the sphere [nm]")
    made.colorbar(points, ax=axes[0, 0])
    from_top = UM * np.hypot(result.x - result.top[0], result.y - result.top[1])
    axes[0, 1].plot(from_top, nm * result.off, "k.", ms=1)
    axes[0, 1].set(
        xlabel="distance from the top [um]", ylabel="above the sphere [nm]",
        ylim=(-2 * limit, 2 * limit), title=f"radius {result.radius.scaled(UM)} um",
    )  # fmt: skip
    save(made, path)
