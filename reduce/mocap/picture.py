"""The picture of a motion-capture reduction: places and residuals of the flights."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...core.output import figure
from ..pictures import save
from .motion import deviations
from .point import PointReduction
from .reduction import MocapReduction


def draw_mocap(result: MocapReduction, path: Path) -> None:
    """Draw height and tangential place with the fitted flights, and residuals of the poses."""
    made, axes = figure(1, 3, size=(15.0, 4.5))
    poses, hit = result.poses, result.hits[0]
    centre, up = result.centre(), result.scene.up
    time = 1e3 * poses.time
    for axis, way, label in ((axes[0, 0], up, "height"), (axes[0, 1], hit.x, "place along x")):
        axis.plot(time, centre @ way, "k.", ms=3)
        axis.set_ylabel(f"{label} of the centre of mass [m]")
    for f, (motion, (first, last)) in enumerate(
        zip(result.flights.motions, result.flights.spans, strict=True)
    ):
        # a little beyond, so that the meeting is seen
        ends = poses.time[[first, last]] + np.array([-2.0, 2.0]) / result.rate
        span = np.linspace(ends[0], ends[1], 100)
        for axis, way in ((axes[0, 0], up), (axes[0, 1], hit.x)):
            axis.plot(1e3 * span, motion.place_at(span) @ way, f"C{f % 8}", lw=1.3)
        index = np.arange(first, last + 1)
        off = deviations(poses, index, motion, result.flights.offset)
        axes[0, 2].plot(time[index], 1e3 * off, ".", color=f"C{f % 8}", ms=3)
    axes[0, 2].set_ylabel("residuals of the pose, as a marker's error [mm]")
    for axis in axes.flat:
        for each in result.hits:
            axis.axvline(1e3 * each.measured["time_s"].value, color="0.5", ls=":", lw=1.0)
        axis.set_xlabel("time [ms]")
    axes[0, 0].set_title(f"restitution {hit.measured['restitution']}")
    axes[0, 1].set_title(f"impulse ratio {hit.measured['friction_impulse_ratio']}")
    axes[0, 2].set_title(
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
