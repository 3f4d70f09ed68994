"""Motion capture to what an impact did to a rigid body: velocities, spin, friction, restitution.

As chapter 5 of the thesis measures it: markers on the striker give the velocity of its centre of
mass and its spin on both sides of the contact, and the mean coefficient of friction is the ratio of
the changes of velocity, |ΔV_x / ΔV_y| (Eq. 5.13; the printed sign holds for one direction only).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array
from ...core.errors import InputError
from ...recordings.columns import TRIAL_COLUMNS
from ..bounces.options import GRAVITY
from ..measured import Measured, Trial, labels, propagate
from ..rules import RULES
from .body import Body
from .checks import check_fall, check_shape, possible, widened
from .flight import Flights, fall_acceleration
from .flight_search import find_flights
from .motion import Motion
from .rigid import Poses

_UPRIGHT = math.radians(1.0)
"""Lean below which the plane of motion is that of the impulse, not that of the rod."""

_NAMES = (
    "time_s", "angle_deg", "impact_speed_m_s", "approach_tangential_m_s", "approach_normal_m_s",
    "approach_spin_rad_s", "restitution", "friction_impulse_ratio", "rebound_spin_rad_s",
    "rebound_speed_m_s", "tangential_rebound_m_s", "tip_slip_before_m_s", "tip_slip_after_m_s",
    "out_of_plane_ratio", "spin_out_of_plane_rad_s", "spin_change_by_momentum_rad_s",
)  # fmt: skip


def columns_of(measured: Mapping[str, Measured]) -> dict[str, Measured]:
    """Return what of the numbers of an impact trials.csv has a column for."""
    return {name: value for name, value in measured.items() if name in TRIAL_COLUMNS}


@dataclass(frozen=True)
class MocapScene:
    """Up (3,) out of the flat in the file's axes, gravity [m/s²], relative error of all lengths."""

    up: Array
    gravity: float = GRAVITY
    length_scale_std: float = 0.0

    def measured(self, names: Sequence[str], found: Sequence[Measured]) -> dict[str, Measured]:
        """Return numbers of an impact by name: speeds as unsure as lengths, friction unsigned."""
        values = dict(zip(names, found, strict=True))
        for name, value in values.items():
            if name.endswith("_m_s"):
                values[name] = value.widened(value.value * self.length_scale_std)
        ratio = values["friction_impulse_ratio"]
        values["friction_impulse_ratio"] = Measured(abs(ratio.value), ratio.std)
        return values


@dataclass(frozen=True)
class Hit:
    """One impact between two flights: what was measured, by name, and its plane.

    `x` is the horizontal direction in which tangential velocities count, `flights` the numbers of
    the flights before and after.
    """

    flights: tuple[int, int]
    measured: dict[str, Measured]
    x: Array
    gap: int


@dataclass(frozen=True)
class MocapReduction:
    """Poses, flights and impacts of one recording."""

    poses: Poses
    flights: Flights
    body: Body
    scene: MocapScene
    hits: tuple[Hit, ...]
    fall: Measured
    rate: float
    notes: tuple[str, ...]

    def centre(self) -> Array:
        """Centre of mass in every pose, (k, 3) [m]."""
        return np.asarray(self.poses.origin + self.poses.turn @ self.flights.offset)

    def trials(self) -> tuple[Trial, ...]:
        """Return a row of trials.csv for each impact; none for a body of no known shape."""
        if self.body.shape == "body":
            return ()
        return tuple(
            Trial(columns_of(hit.measured), trace=self._trace(hit), label=label)
            for hit, label in zip(self.hits, labels(len(self.hits)), strict=True)
        )

    def _trace(self, hit: Hit) -> dict[str, Array]:
        before, after = (self.flights.spans[f] for f in hit.flights)
        part = slice(before[0], after[1] + 1)
        up, turn = self.scene.up, self.poses.turn[part]
        axis = self.body.upward(turn, up)
        tip = self.centre()[part] + self.body.tip(axis, up)
        time = hit.measured["time_s"].value
        touch = self.flights.motions[hit.flights[0]]
        there = touch.turn_at(np.array([time]))
        lowest = touch.place_at(np.array([time])) + self.body.tip(self.body.upward(there, up), up)
        trace = {
            "time_s": self.poses.time[part] - time,
            "tip_height_m": (tip - lowest) @ up,
            "tip_x_m": (tip - lowest) @ hit.x,
        }
        if self.body.shape == "rod":
            trace["angle_rad"] = np.arcsin(np.clip(axis @ up, -1.0, 1.0))
        return trace


def reduce_mocap(poses: Poses, body: Body, scene: MocapScene, *, source: str) -> MocapReduction:
    """Return every impact between two free flights of a body, in the axes of its mean shape.

    A body without one, with a flight on both sides, is refused.
    """
    flights = find_flights(poses, -scene.gravity * scene.up, body.centre)
    if flights is None or len(flights.spans) < 2:
        found = 0 if flights is None else len(flights.spans)
        raise InputError(
            f"{found} free flights of the markers", source=source,
            allowed="a flight before and one after an impact (units, up and gravity right?)",
        )  # fmt: skip
    rate = float(1.0 / np.median(np.diff(poses.time)))
    body = replace(body, centre=replace(body.centre, value=flights.offset))
    hits = []
    for f in range(len(flights.spans) - 1):
        gap = int(poses.frame[flights.spans[f + 1][0]] - poses.frame[flights.spans[f][1]]) - 1
        if gap <= RULES.window:
            hits.append(_hit(poses, flights, f, gap, body, scene))
    hits = [h for h in hits if h.measured["impact_speed_m_s"].value > 0.0]
    fall = fall_acceleration(poses, flights)
    check_fall(fall, scene.gravity, source)
    check_shape(poses, source)
    hits = [
        replace(h, measured=widened(h.measured, poses, flights, fall, scene.gravity))
        for h in hits
        if possible(h.measured["restitution"], body)
    ]
    if not hits:
        raise InputError(
            "no impact with a free flight just before and just after it", source=source,
            allowed="frames of free flight on both sides, without a second contact",
        )  # fmt: skip
    notes = (*_flight_notes(poses, flights, fall, scene), *_hit_notes(hits, body, rate))
    return MocapReduction(poses, flights, body, scene, tuple(hits), fall, rate, notes)


def _hit(poses: Poses, flights: Flights, f: int, gap: int, body: Body, scene: MocapScene) -> Hit:
    before, after = flights.motions[f], flights.motions[f + 1]
    extent = max(poses.extent, 1e-3)
    low, high = poses.time[flights.spans[f][1]], poses.time[flights.spans[f + 1][0]]
    time = float(np.clip(_meeting(before, after, float(0.5 * (low + high)), extent), low, high))
    plane = _plane(before, after, time, body, scene.up)

    def numbers(step: Array) -> Array:
        one, two = before.moved(step[3:15]), after.moved(step[15:27])
        when = _meeting(one, two, time, extent)
        return _numbers(one, two, float(np.clip(when, low, high)), body, scene.up, plane)

    found = scene.measured(_NAMES, propagate(numbers, np.zeros(27), flights.part((f, f + 1))))
    if math.isinf(body.inertia_over_mass):  # not known: nothing to hold the spin against
        del found["spin_change_by_momentum_rad_s"]
    return Hit((f, f + 1), found, plane[0], gap)


def _meeting(before: Motion, after: Motion, guess: float, extent: float) -> float:
    """Return the instant in which both motions come nearest to the same place and rotation."""
    time = guess
    for _ in range(4):
        t = np.array([time])
        place = (after.place_at(t) - before.place_at(t))[0]
        turn = after.turn_at(t)[0] @ before.turn_at(t)[0].T
        off = np.concatenate([place, extent * Rotation.from_matrix(turn).as_rotvec()])
        rate = np.concatenate(
            [after.speed_at(time) - before.speed_at(time), extent * (after.spin - before.spin)]
        )
        size = float(rate @ rate)
        if size == 0.0:
            break
        time -= float(rate @ off) / size
    return time


def _plane(
    before: Motion, after: Motion, time: float, body: Body, up: Array
) -> tuple[Array, Array]:
    """Return x and z of the plane of motion.

    x is the way the rod's upper end leans; for a body without an axis against its tangential
    velocity; where neither is clear, the way the contact pushed it.
    """
    ways = []
    if body.shape == "rod":
        axis = body.upward(before.turn_at(np.array([time])), up)[0]
        ways.append((axis - (axis @ up) * up, math.sin(_UPRIGHT)))
    else:
        speed = before.speed_at(time)
        ways.append((-(speed - (speed @ up) * up), 0.02 * float(np.linalg.norm(speed))))
    push = after.speed_at(time) - before.speed_at(time)
    ways.append((push - (push @ up) * up, 1e-9))
    for way, least in ways:
        size = float(np.linalg.norm(way))
        if size > least:
            return way / size, np.cross(way / size, up)
    x = np.cross(up, [1.0, 0.0, 0.0] if abs(up[0]) < 0.5 else [0.0, 1.0, 0.0])
    x = x / np.linalg.norm(x)
    return x, np.cross(x, up)


def _numbers(
    before: Motion, after: Motion, time: float, body: Body, up: Array, plane: tuple[Array, Array]
) -> Array:
    x, z = plane
    turn = before.turn_at(np.array([time]))
    axis = body.upward(turn, up)
    arm = body.tip(axis, up)[0] if body.shape != "body" else body.lowest(turn[0], up)
    vb, va = before.speed_at(time), after.speed_at(time)
    tip_b, tip_a = vb + np.cross(before.spin, arm), va + np.cross(after.spin, arm)
    push = va - vb
    c, s = -float(arm @ x), -float(arm @ up)
    if body.shape == "rod":
        angle = math.asin(float(np.clip(axis[0] @ up, -1.0, 1.0)))
    else:
        angle = math.atan2(-float(vb @ up), abs(float(vb @ x)))
    turned = (s * float(push @ x) - c * float(push @ up)) / body.inertia_over_mass
    down = -float(tip_b @ up)
    return np.array([
        time, math.degrees(angle), down, vb @ x, vb @ up, before.spin @ z,
        (tip_a @ up) / down, (push @ x) / (push @ up), after.spin @ z, va @ up, va @ x,
        tip_b @ x, tip_a @ x, (push @ z) / (push @ up),
        math.hypot(float(after.spin @ x), float(after.spin @ up)), turned,
    ])  # fmt: skip


def _flight_notes(poses: Poses, flights: Flights, fall: Measured, scene: MocapScene) -> list[str]:
    lengths = ", ".join(str(b - a + 1) for a, b in flights.spans)
    notes = [
        f"flights of {lengths} frames; marker error {flights.sigma * 1e3:.3g} mm by the motion, "
        f"{poses.spread * 1e3:.3g} mm by the shape"
    ]
    if poses.dropped:
        notes.append(f"{poses.dropped} marker positions do not fit the body and were left out")
    if poses.collinear:
        notes.append("the markers lie on one line: no roll about it is seen")
    off = abs(fall.value - scene.gravity)
    if off > max(3.0 * fall.std, 0.01 * scene.gravity):
        notes.append(
            f"the markers fall with {fall} m/s2, not {scene.gravity:g}: check unit, rate and up"
        )
    return notes


def _hit_notes(hits: list[Hit], body: Body, rate: float) -> list[str]:
    notes = []
    for number, hit in enumerate(hits, start=1):
        m = hit.measured
        notes.append(
            f"impact {number} at {m['time_s'].value:.4f} s: {hit.gap} frames left out, contact "
            f"shorter than {(hit.gap + 1) / rate * 1e3:.3g} ms"
        )
        out = m["out_of_plane_ratio"]
        if abs(out.value) > max(3.0 * out.std, 0.05):
            notes.append(f"impact {number}: {out} of the impulse is out of the plane of motion")
        if body.shape == "rod":
            change = m["rebound_spin_rad_s"].minus(m["approach_spin_rad_s"])
            notes.append(
                f"impact {number}: spin changed by {change} rad/s; momentum at the tip asks for "
                f"{m['spin_change_by_momentum_rad_s']}"
            )
    return notes
