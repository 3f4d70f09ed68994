"""The picture of a motion-capture reduction: heights, turning, residuals of the flights."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array
from ...core.output import figure
from ..pictures import save
from .motion import deviations
from .point import PointReduction
from .reduction import MocapReduction


def draw_mocap(result: MocapReduction, path: Path) -> None:
    """Draw height, tangential place and rotation with the fitted flights, and residuals."""
    made, axes = figure(2, 2, size=(13.0, 8.0))
    poses, hit = result.poses, result.hits[0]
    centre, up = result.centre(), result.scene.up
    time = 1e3 * poses.time
    rows = (
        (axes[0, 0], centre @ up, "height of the centre of mass [m]", up),
        (axes[0, 1], centre @ hit.x, "centre of mass along x [m]", hit.x),
    )
    for axis, values, label, way in rows:
        axis.plot(time, values, "k.", ms=3)
        for f, motion in enumerate(result.flights.motions):
            span = _span(result, f)
            axis.plot(1e3 * span, motion.place_at(span) @ way, f"C{f % 8}", lw=1.3)
        axis.set_ylabel(label)
    _rotation(axes[1, 0], result)
    for f, (motion, (first, last)) in enumerate(
        zip(result.flights.motions, result.flights.spans, strict=True)
    ):
        index = np.arange(first, last + 1)
        off = deviations(poses, index, motion, result.flights.offset)
        axes[1, 1].plot(time[index], 1e3 * off, ".", color=f"C{f % 8}", ms=3)
    axes[1, 1].axhline(0.0, color="k", lw=0.5)
    axes[1, 1].set_ylabel("residuals of the pose, as a marker's error [mm]")
    for axis in axes.flat:
        for each in result.hits:
            axis.axvline(1e3 * each.measured["time_s"].value, color="0.5", ls=":", lw=1.0)
        axis.set_xlabel("time [ms]")
    axes[0, 0].set_title(f"restitution {hit.measured['restitution']}")
    axes[0, 1].set_title(f"impulse ratio {hit.measured['friction_impulse_ratio']}")
    axes[1, 0].set_title(
        f"spin {hit.measured['approach_spin_rad_s']} to {hit.measured['rebound_spin_rad_s']} rad/s"
    )
    save(made, path)


def draw_point(result: PointReduction, path: Path) -> None:
    """Draw the three coordinates of a followed ball with the parabolas next to each bounce."""
    made, axes = figure(1, 3, size=(14.0, 4.5))
    for k, axis in enumerate(axes[0]):
        axis.plot(result.time, result.position[:, k], "k.", ms=3)
        for bounce in result.bounces:
            axis.axvline(bounce.time, color="0.5", ls=":", lw=1.0)
            for side, colour in zip(bounce.sides, ("C0", "C1"), strict=True):
                reach = side.time - bounce.time
                tau = np.linspace(min(reach.min(), 0.0), max(reach.max(), 0.0), 60)
                axis.plot(
                    tau + bounce.time, np.polyval(side.coefficients[k, ::-1], tau), colour, lw=1.3
                )
        axis.set(xlabel="time [s]", ylabel=f"{'xyz'[k]} [m]")
    first = result.bounces[0].measured
    axes[0, 0].set_title(f"restitution {first['restitution']}")
    axes[0, 1].set_title(f"impulse ratio {first['friction_impulse_ratio']}")
    save(made, path)


def _span(result: MocapReduction, f: int) -> Array:
    """Return times over a flight and a little beyond, so that the meeting is seen."""
    first, last = result.flights.spans[f]
    ends = result.poses.time[[first, last]] + np.array([-2.0, 2.0]) / result.rate
    return np.linspace(ends[0], ends[1], 100)


def _rotation(axis: Any, result: MocapReduction) -> None:
    """Turn about the normal of the plane of motion, counted from the first impact."""
    hit = result.hits[0]
    normal = np.cross(hit.x, result.scene.up)
    steps = Rotation.from_matrix(
        result.poses.turn[1:] @ np.swapaxes(result.poses.turn[:-1], 1, 2)
    ).as_rotvec()
    turned = np.concatenate([[0.0], np.cumsum(steps @ normal)])
    axis.plot(1e3 * result.poses.time, np.degrees(turned), "k.", ms=3)
    for f, motion in enumerate(result.flights.motions):
        first, last = result.flights.spans[f]
        middle = np.arange(first, last + 1)
        time = result.poses.time[middle]
        line = float(motion.spin @ normal) * (time - time.mean())
        axis.plot(1e3 * time, np.degrees(line + turned[middle].mean()), f"C{f % 8}", lw=1.3)
    axis.set_ylabel("turned about the normal of the plane [deg]")
