"""A ball followed as one point in space: velocities on both sides of a bounce, without its spin.

Drag and the Magnus force bend the flight, so each coordinate is a parabola of its own, over a
short part of the flight next to the contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ..bounces.flights import Piece
from ..bounces.sides import sides_of
from ..bounces.track import Track, on_the_body, turning_points
from ..bounces.view import Stage
from ..measured import Measured, Trial, labels, propagate
from ..rules import RULES
from ..shared.regression import robust_regression
from .checks import check_fall
from .file import Markers
from .reduction import MocapScene, columns_of

_NAMES = (
    "angle_deg", "impact_speed_m_s", "approach_tangential_m_s", "restitution",
    "friction_impulse_ratio", "rebound_speed_m_s", "tangential_rebound_m_s", "out_of_plane_ratio",
)  # fmt: skip


@dataclass(frozen=True)
class Side:
    """One side of a contact: velocity at the contact, its covariance, and the fitted parabola."""

    velocity: Array
    covariance: Array
    time: Array
    coefficients: Array


@dataclass(frozen=True)
class PointBounce:
    """One bounce of a ball: what was measured, by name, its sides and its instant."""

    measured: dict[str, Measured]
    sides: tuple[Side, Side]
    time: float


@dataclass(frozen=True)
class PointReduction:
    """A followed ball, its bounces, the error of a place [m], and its fall [m/s²]."""

    time: Array
    position: Array
    bounces: tuple[PointBounce, ...]
    noise: float
    fall: Measured
    notes: tuple[str, ...]

    def trials(self) -> tuple[Trial, ...]:
        """Return a row of trials.csv for each bounce."""
        return tuple(
            Trial(columns_of(b.measured), label=label)
            for b, label in zip(self.bounces, labels(len(self.bounces)), strict=True)
        )


def reduce_point(markers: Markers, scene: MocapScene, *, spin: Array | None) -> PointReduction:
    """Return the bounces of a ball whose centre, the one marker, is followed.

    `spin` is that before the first bounce, (3,) [rad/s], measured otherwise; gravity is fitted with
    the drag. Refuses what has no bounce with a flight on both sides, or no fall.
    """
    seen = np.isfinite(markers.position[:, 0]).all(axis=1)
    time, position = markers.time[seen], markers.position[seen, 0]
    if time.size < 2 * RULES.fewest:
        raise InputError(
            f"the ball is seen in {time.size} frames", source=markers.source,
            allowed=f"{2 * RULES.fewest} or more",
        )  # fmt: skip
    measured, noise = [], []
    for number, (instant, flights) in enumerate(_contacts(time, position @ scene.up)):
        before, after = (
            _side(time, position, instant, flight, way)
            for flight, way in zip(flights, (-1, 1), strict=True)
        )
        if before is None or after is None:
            continue
        sides = (before[0], after[0])
        noise += [before[1], after[1]]
        values = _measured(sides, scene, spin if number == 0 else None)
        measured.append(PointBounce(values, sides, instant))
    if not measured:
        raise InputError(
            "no bounce with a flight before and after it", source=markers.source,
            allowed=f"{RULES.fewest} frames or more on both sides, and the right direction "
            "of up",
        )  # fmt: skip
    falls = [-2.0 * float(s.coefficients[:, 2] @ scene.up) for b in measured for s in b.sides]
    # drag and lift differ from flight to flight, a wrong unit does not
    fall = Measured(float(np.mean(falls)), 0.5 * float(np.ptp(falls)))
    check_fall(fall, scene.gravity, markers.source)
    notes = (f"one point: no spin is measured; position error {np.mean(noise) * 1e3:.2g} mm",)
    return PointReduction(time, position, tuple(measured), float(np.mean(noise)), fall, notes)


def _contacts(time: Array, height: Array) -> Iterator[tuple[float, tuple[Piece, Piece]]]:
    """Find each contact: its instant, and the flights on both sides.

    A spinning ball is lifted, otherwise before a bounce than after it: the flights share no fall.
    """
    chosen = on_the_body(Track(time, height))
    track = Track(time[chosen], height[chosen])
    turning = turning_points(track)
    if not turning:
        return
    floor = float(np.median(track.height[turning]))
    stage = Stage(floor, float(np.ptp(track.height)), float(time[0]), float(np.ptp(time)))
    sides = sides_of(track, turning, stage, None)
    for contact, before, after in zip(turning, sides[::2], sides[1::2], strict=True):
        if before is None or after is None:
            continue
        at = float(track.time[contact])
        near = [
            p.index[np.abs(track.time[p.index] - at) < RULES.drag_even] for p in (before, after)
        ]
        if min(n.size for n in near) < 3:
            continue
        one, two = (np.polyfit(track.time[n] - at, track.height[n], 2) for n in near)
        meet = np.roots(one - two)
        meet = meet[np.isreal(meet)].real
        if meet.size:
            instant = at + float(meet[np.argmin(np.abs(meet))])
            yield instant, (replace(before, index=chosen[before.index]),
                            replace(after, index=chosen[after.index]))  # fmt: skip


def _side(
    time: Array, position: Array, instant: float, flight: Piece, way: int
) -> tuple[Side, float] | None:
    """Fit the flight next to a contact; the frame nearest to it may be within it."""
    tau = time - instant
    index = flight.index
    index = index[(way * tau[index] > 0.0) & (np.abs(tau[index]) < RULES.drag_even)]
    if index.size < RULES.fewest:
        return None
    design = np.stack([np.ones(index.size), tau[index], tau[index] ** 2], axis=1)
    fits = [robust_regression(design, position[index, k]) for k in range(3)]
    velocity = np.array([f.coefficients[1] for f in fits])
    covariance = np.diag([f.covariance[1, 1] for f in fits])
    side = Side(velocity, covariance, time[index], np.array([f.coefficients for f in fits]))
    return side, float(np.mean([f.sigma for f in fits]))


def _measured(
    sides: tuple[Side, Side], scene: MocapScene, spin: Array | None
) -> dict[str, Measured]:
    up = scene.up
    before, after = (s.velocity for s in sides)
    flat = before - (before @ up) * up
    size = float(np.linalg.norm(flat))
    x = -flat / size if size > 1e-9 else np.cross(up, np.roll(up, 1))
    z = np.cross(x, up)

    def numbers(v: Array) -> Array:
        one, two = v[:3], v[3:]
        push, down = two - one, -float(one @ up)
        return np.array([
            math.degrees(math.atan2(down, abs(float(one @ x)))), down, one @ x,
            float(two @ up) / down, (push @ x) / (push @ up), two @ up, two @ x,
            (push @ z) / (push @ up),
        ])  # fmt: skip

    covariance = np.zeros((6, 6))
    covariance[:3, :3], covariance[3:, 3:] = (s.covariance for s in sides)
    found = propagate(numbers, np.concatenate([before, after]), covariance)
    values = scene.measured(_NAMES, found)
    height = 0.5 * float((sides[0].coefficients[:, 0] + sides[1].coefficients[:, 0]) @ up)
    values["contact_height_m"] = Measured(height, math.nan)
    if spin is not None:
        values["approach_spin_rad_s"] = Measured(float(spin @ z), 0.0)
    return values
