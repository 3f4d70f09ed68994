"""Flight through a fluid before and after a contact: gravity, buoyancy, added mass and drag.

A speed is read some way above the flat, the contact takes place at the flat. Between the two

    (m + m_a) dv/dt = -(m - rho V) g j - D(v)

with the standard drag of a sphere or of a rod (`core.drag`; along and across its axis apart, the
axis keeping its direction), rho V the displaced fluid and m_a half of it for a sphere. Height by
height the motion is traced either way: a reading gives the speed at the flat, a rebound
that at the reading. The wake's memory, the body's own wind from its release and the flat's presence
are left out; they belong to the 4 % that the drag curve itself is uncertain by.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import float64, njit, types
from numpy.typing import ArrayLike

from ..core.arrays import Array
from ..core.drag import Fluid, drag_force, rod_drag_across, rod_drag_along
from ..core.errors import InputError
from .rules import RULES
from .scene import STANDARD_GRAVITY, Striker

_STEPS = RULES.fall_steps


@dataclass(frozen=True, slots=True)
class Flown:
    """Where a flight ends.

    - `normal`, `tangential`: velocity at the end, shape (n,) [m/s]; the normal one points up. nan
      where the striker does not get there.
    - `time`: from start to end, shape (n,) [s]; negative if the motion was traced back.
    """

    normal: Array
    tangential: Array
    time: Array


def flown(
    striker: Striker, fluid: Fluid, *, normal: ArrayLike, rise: ArrayLike,
    tangential: ArrayLike = 0.0, angle: float = math.pi / 2.0, gravity: float = STANDARD_GRAVITY,
) -> Flown:  # fmt: skip
    """Trace a flight over a height, with or against time.

    - `striker`, `fluid`: what flies through what.
    - `normal`, `tangential`: velocity at the start, shape (n,) [m/s]; normal points up, 0 means
      released from rest.
    - `rise`: height of the end above the start, shape (n,) [m]. Of the same sign as `normal`: what
      comes; of the other: what was.
    - `angle`: between a rod's axis and the flat [rad].
    - `gravity`: [m/s^2].

    Examples
    --------
    A ping-pong ball dropped from 1 m arrives with 4.15 instead of 4.43 m/s.

    >>> from dentscope.core.drag import air
    >>> ball = Striker(mass=0.0027, tip_radius=0.02)
    >>> round(float(flown(ball, air(), normal=0.0, rise=-1.0).normal), 2)
    -4.15
    """
    up, along, way = np.broadcast_arrays(
        np.asarray(normal, float), np.asarray(tangential, float), np.asarray(rise, float)
    )
    if not np.all(np.isfinite(up) & np.isfinite(along) & np.isfinite(way)):
        raise InputError("a speed or height is not a number", key="flight", allowed="finite ones")
    rows = np.empty((up.size, 3))
    _fly_all(
        _numbers(striker, fluid, angle, gravity),
        np.ascontiguousarray(up.ravel()), np.ascontiguousarray(along.ravel()),
        np.ascontiguousarray(way.ravel()), rows,
    )  # fmt: skip
    return Flown(*(rows[:, k].reshape(up.shape) for k in range(3)))


_MASS, _WEIGHT, _DIAMETER, _LENGTH, _DENSITY, _VISCOSITY, _COS, _SIN = range(8)


def _numbers(striker: Striker, fluid: Fluid, angle: float, gravity: float) -> Array:
    r = striker.radius
    volume = math.pi * r**2 * striker.length + 4.0 / 3.0 * math.pi * r**3
    pushed = fluid.density * volume
    added = 0.5 * pushed if striker.length == 0.0 else 0.0
    return np.array(
        [
            striker.mass + added, (striker.mass - pushed) * gravity, 2.0 * r, striker.length,
            fluid.density, fluid.viscosity, math.cos(angle), math.sin(angle),
        ]
    )  # fmt: skip


@njit(cache=True, _nrt=False)
def _drag(p, vx, vy):
    """Force of the fluid on the striker [N]; a rod's parts along and across its axis add up."""
    d = p[_DIAMETER]
    if p[_LENGTH] == 0.0:
        v = math.hypot(vx, vy)
        if v == 0.0:
            return 0.0, 0.0
        f = drag_force(v, d, p[_DENSITY], p[_VISCOSITY]) / v
        return -f * vx, -f * vy
    along, across = vx * p[_COS] + vy * p[_SIN], vy * p[_COS] - vx * p[_SIN]
    length = p[_LENGTH] + d
    half = 0.5 * p[_DENSITY]
    f_along = half * abs(along) * along * rod_drag_along(length / d) * 0.25 * math.pi * d * d
    rate = abs(across) * d * p[_DENSITY] / p[_VISCOSITY]
    f_across = half * abs(across) * across * rod_drag_across(rate, length / d) * length * d
    return -f_along * p[_COS] + f_across * p[_SIN], -f_along * p[_SIN] - f_across * p[_COS]


@njit(
    types.void(float64[::1], float64[::1], float64[::1], float64[::1], float64[:, ::1]),
    cache=True,
    _nrt=False,
)
def _fly_all(p, normal, tangential, rise, out):
    """Steps of equal height, each at the acceleration that its mean velocity brings.

    Exact without drag, of second order with it, and the same in both directions.
    """
    for i in range(len(normal)):
        vy, vx, dy = normal[i], tangential[i], rise[i] / _STEPS
        sign = math.copysign(1.0, vy) if vy != 0.0 else math.copysign(1.0, dy)
        # traced back to its release the striker rests: only round-off is left of its speed
        least = 1e-9 * (vy * vy + abs(rise[i]) * p[_WEIGHT] / p[_MASS])
        t = 0.0
        for _ in range(_STEPS if dy != 0.0 else 0):
            new_y, new_x, dt = vy, vx, 0.0
            for _ in range(6):
                fx, fy = _drag(p, 0.5 * (vx + new_x), 0.5 * (vy + new_y))
                w = vy * vy + 2.0 * dy * (fy - p[_WEIGHT]) / p[_MASS]
                last_x, last_y = new_x, new_y
                new_y = sign * math.sqrt(max(w, 0.0)) if w >= -least else math.nan
                dt = 2.0 * dy / (vy + new_y)
                new_x = vx + dt * fx / p[_MASS]
                if new_x == last_x and new_y == last_y:
                    break  # another turn would repeat this one
            vy, vx, t = new_y, new_x, t + dt
        out[i, 0], out[i, 1], out[i, 2] = vy, vx, t
        if not math.isfinite(vy + vx + t):
            out[i, :] = math.nan
