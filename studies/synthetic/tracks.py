"""Tracks of a bouncing ball as cameras and trackers give them, with known truth.

The ball falls, bounces and flies through air (integrated numerically with the drag curve of a
sphere). What is seen of it: pixels whose size drifts with height and with time, a picture that is
not level, a shutter that rolls, frames that were dropped, a share of positions that belong to
something else, noise that grows with the blur of motion, a dip next to the flat where the ball and
its reflection run together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_ivp

from ...core.arrays import Array
from ...core.drag import air, drag_force

_GRAVITY = 9.81
_BALLS = ((2.7e-3, 0.04, 4e-4, 1.2e-3), (5.5e-3, 0.016, 5e-5, 3e-4), (0.045, 0.045, 1e-3, 2e-3))
"""Mass [kg], diameter [m], shortest and longest contact [s]."""


@dataclass(frozen=True)
class TrackTruth:
    """What happens and how it is seen; lengths in metres unless pixels are named.

    - `mass`, `diameter`: of the ball [kg, m].
    - `drop`, `restitution`, `contact_time`: height of release, restitution of every bounce,
      duration of a contact [s].
    - `held`: time before the release, in which the ball is held [s].
    - `span`: length of the track [s].
    - `rate`, `pixel`: frames per second, size of a pixel at the flat.
    - `drift`: relative change of the scale from the flat to the height of release (bend, bow).
    - `growth`: relative change of the scale over the track.
    - `tilt`, `aside`: roll of the picture [rad], and speed to the side [m/s].
    - `line_time`: from one row to the next of a shutter that rolls down [s].
    - `noise`, `blur`: spread of a position [pixel]; more of it for each pixel moved in a frame.
    - `dropped`, `bad`, `lost`: share of frames that are missing, of positions that are something
      else's (in runs of one to four), and of time stamps that are late by a frame from there on (0
      or 1 in a track).
    - `dip`: by which a position falls within a diameter of the flat [pixel].
    """

    mass: float = 2.7e-3
    diameter: float = 0.04
    drop: float = 0.4
    restitution: float = 0.8
    contact_time: float = 1e-4
    held: float = 0.0
    span: float = 1.4
    rate: float = 240.0
    pixel: float = 8e-4
    drift: tuple[float, float] = (0.0, 0.0)
    growth: float = 0.0
    tilt: float = 0.0
    aside: float = 0.0
    line_time: float = 0.0
    noise: float = 0.15
    blur: float = 0.0
    dropped: float = 0.0
    bad: float = 0.0
    lost: int = 0
    dip: float = 0.0
    seed: int = 0


@dataclass(frozen=True)
class SeenTrack:
    """Time (n,) [s] and height (n,) upwards [pixel]; instants and approach speeds of contacts."""

    time: Array
    height: Array
    contacts: Array
    speeds: Array


def fly(truth: TrackTruth) -> tuple[list[tuple[float, float, object]], Array, Array]:
    """Return each flight (beginning, end, height as a function of time), contacts, speeds."""
    fluid = air()
    lifted = fluid.density * math.pi * truth.diameter**3 / 6.0
    moved = truth.mass + 0.5 * lifted

    def slope(_t: float, y: Array) -> list[float]:
        drag = drag_force(float(y[1]), truth.diameter, *fluid)
        return [y[1], -((truth.mass - lifted) * _GRAVITY + drag) / moved]

    def ground(_t: float, y: Array) -> float:
        return float(y[0])

    ground.terminal, ground.direction = True, -1  # type: ignore[attr-defined]
    flights, contacts, speeds = [], [], []
    time, start, speed = truth.held, truth.drop, 0.0
    while time < truth.span:
        run = solve_ivp(
            slope, (time, time + 5.0), (start, speed), events=ground, dense_output=True,
            rtol=1e-9, atol=1e-11,
        )  # fmt: skip
        end = float(run.t[-1])
        flights.append((time, end, run.sol))
        speed = -float(run.y[1, -1])
        if end >= truth.span or speed < 0.15:
            break
        contacts.append(end + 0.5 * truth.contact_time)
        speeds.append(speed)
        time, start, speed = end + truth.contact_time, 1e-12, truth.restitution * speed
    return flights, np.array(contacts), np.array(speeds)


def _dent(late: Array, speed: float, truth: TrackTruth) -> Array:
    """Return the height below the flat, (n,) [m], of a spring with damping that lasts as long.

    y = -(v/w) exp(-b t) sin(w t), b so that the body leaves with its restitution.
    """
    w = math.pi / truth.contact_time
    b = -math.log(truth.restitution) / truth.contact_time
    late = np.clip(late, 0.0, truth.contact_time)
    return -speed / w * np.exp(-b * late) * np.sin(w * late)


def seen(truth: TrackTruth) -> SeenTrack:
    """Return the track as the tracker gives it."""
    random = np.random.default_rng(truth.seed)
    flights, contacts, speeds = fly(truth)

    def height(t: Array) -> Array:
        y = np.where(t < truth.held, truth.drop, 0.0)
        for middle, speed in zip(contacts, speeds, strict=True):
            y += _dent(t - middle + 0.5 * truth.contact_time, speed, truth)
        for start, end, path in flights:
            inside = (t >= start) & (t <= end)
            if inside.any():
                y[inside] = path(t[inside])[0]  # type: ignore[operator]
        return y

    def pixels(t: Array) -> Array:
        y = height(t)
        z = y / truth.drop
        late = t / truth.span
        bent = y * (1.0 + truth.drift[0] * z + truth.drift[1] * z**2) * (1.0 + truth.growth * late)
        aside = truth.aside * t
        return (bent * math.cos(truth.tilt) + aside * math.sin(truth.tilt)) / truth.pixel

    frames = np.arange(int(truth.span * truth.rate), dtype=np.float64)
    time: Array = (frames + random.uniform()) / truth.rate
    rows = pixels(time).max() - pixels(time)
    for _ in range(4):  # a row is exposed when the shutter has come down to it
        rows = pixels(time).max() - pixels(time + truth.line_time * rows)
    h = pixels(time + truth.line_time * rows)
    moving = np.abs(np.gradient(h))
    h = h + random.normal(0.0, 1.0, h.size) * np.hypot(truth.noise, truth.blur * moving)
    near = height(time) < truth.diameter
    h[near] -= truth.dip * (1.0 - height(time)[near] / truth.diameter)
    h = _strayed(h, truth, random)
    kept = random.random(h.size) >= truth.dropped
    stamp = time.copy()
    if truth.lost:
        # a frame is dropped without a word: from there on the stamps are a frame early
        first = int(random.integers(h.size // 8, h.size - h.size // 8))
        kept[first] = False
        stamp[first:] -= 1.0 / truth.rate
    return SeenTrack(stamp[kept], h[kept], contacts, speeds)


def _strayed(h: Array, truth: TrackTruth, random: np.random.Generator) -> Array:
    """Put a share of the positions, in runs of one to four, somewhere else in the picture."""
    h = h.copy()
    left = round(truth.bad * h.size)
    while left > 0:
        run = min(int(random.integers(1, 5)), left)
        first = int(random.integers(0, h.size - run))
        h[first : first + run] = random.uniform(h.min(), h.max()) + random.normal(0.0, 0.3, run)
        left -= run
    return h


def random_track(seed: int, **given: object) -> TrackTruth:
    """Return a track with drawn ball, drop, camera and faults: all of them at once, mildly."""
    random = np.random.default_rng(seed)
    # a table-tennis ball on wood, a glass marble on stone, a rubber ball on a floor
    mass, diameter, shortest, longest = _BALLS[int(random.integers(3))]
    drift = random.uniform(-0.03, 0.03)
    truth = TrackTruth(
        mass=mass,
        diameter=diameter,
        drop=random.uniform(0.2, 0.8),
        restitution=random.uniform(0.4, 0.9),
        contact_time=random.uniform(shortest, longest),
        held=random.uniform(0.0, 0.15),
        span=random.uniform(1.0, 1.8),
        rate=float(random.choice([120.0, 200.0, 240.0, 500.0, 1000.0])),
        pixel=random.uniform(4e-4, 1.2e-3),
        drift=(drift, random.uniform(-0.5, 0.5) * drift),
        growth=random.uniform(-0.01, 0.01),
        tilt=random.uniform(-0.03, 0.03),
        aside=random.uniform(-0.1, 0.1),
        line_time=float(random.choice([0.0, 0.0, 1e-5])),
        noise=random.uniform(0.05, 0.4),
        blur=random.uniform(0.0, 0.01),
        dropped=random.uniform(0.0, 0.05),
        bad=float(random.choice([0.0, 0.02, 0.05])),
        lost=int(random.random() < 0.2),
        dip=random.uniform(0.0, 0.6),
        seed=seed,
    )
    return replace(truth, **given)  # type: ignore[arg-type]
