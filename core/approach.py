"""How a striker arrives, from what a file states: a speed or a height of fall, and an angle."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .arrays import Array


def speeds_at_touch(
    speed: npt.ArrayLike, height: npt.ArrayLike, angle: npt.ArrayLike, rod: npt.ArrayLike, *,
    gravity: float,
) -> tuple[Array, Array]:  # fmt: skip
    """Return the speeds of the contact point along the flat's normal and along the flat.

    A rod's angle is that of its axis, and it falls straight; a sphere's is that of its velocity,
    against +x.

    - `speed`: stated normal speed, shape (...) [m/s]; NaN where the fall gives it.
    - `height`: of the fall, shape (...) [m].
    - `angle`: from the flat, shape (...) [rad].
    - `rod`: whether the striker is a rod, shape (...).
    - `gravity`: [m/s^2].

    Examples
    --------
    >>> normal, along = speeds_at_touch(np.nan, 0.5, np.radians(30.0), False, gravity=10.0)
    >>> round(float(normal), 3), round(float(along), 3)
    (1.581, -2.739)
    """
    stated, rods, angles = np.asarray(speed, float), np.asarray(rod, bool), np.asarray(angle, float)
    fall = np.sqrt(2.0 * gravity * np.asarray(height, float)) * np.where(rods, 1.0, np.sin(angles))
    normal = np.where(np.isnan(stated), fall, stated)
    straight = rods | (np.abs(angles - 0.5 * np.pi) < 1e-12)
    return normal, np.where(straight, 0.0, -normal / np.tan(angles))
