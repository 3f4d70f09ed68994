"""The slide of a stress point along the yield circle, towards the strain increment.

It is the exact solution of the flow rule for a constant direction of the increment in the rotated
frame (Krieg and Krieg, J. Press. Vessel Technol. 99 (1977) 510): tan(psi/2), psi the angle between
point and increment, decays exponentially.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from ...core.arrays import Array
from .tensor import dot, norm

Four = tuple[float, float, float, float] | Array
"""A symmetric tensor, (rr, zz, rz, tt)."""

RADIAL = 0
"""Radial return (backward Euler)."""

EXACT = 1
"""Exact integration along a constant strain-rate direction."""

# limit: squared strain increment over the squared radius that has no direction [-]: round-off of
# the increment
_STILL = 1e-24


class Slide(NamedTuple):
    """A slide along the yield circle.

    Parameters
    ----------
    x, d
        Where it begins, and the whole strain increment.
    turning
        Change of the turned old point with the angle.
    t
        Elastic fraction of the increment.
    slope
        Derivative of |r + t d|^2/2 by t; 0: the circle is not crossed.
    n, length
        |x|, and length of the rest of the increment.
    c
        Cosine between x and d.
    xd, dd
        x . d and d . d.
    """

    x: Four
    d: Four
    turning: Four
    t: float
    slope: float
    n: float
    length: float
    c: float
    xd: float
    dd: float


_NOUGHT = (0.0, 0.0, 0.0, 0.0)
NO_SLIDE = Slide(_NOUGHT, _NOUGHT, _NOUGHT, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@njit(cache=True)
def turned(f, e):
    """Old elastic strain deviator turned by the increment's in-plane rotation."""
    x = f[0] + f[3]
    y = f[2] - f[1]
    turn = math.sqrt(x * x + y * y)
    cosine = x / turn
    sine = y / turn
    cc = cosine * cosine
    ss = sine * sine
    cs = cosine * sine
    return (
        cc * e[0] - 2.0 * cs * e[2] + ss * e[1],
        ss * e[0] + 2.0 * cs * e[2] + cc * e[1],
        cs * (e[0] - e[1]) + (cc - ss) * e[2],
        e[3],
    )


@njit(cache=True)
def is_directed(d, radius):
    """Whether an increment is long enough to have a direction."""
    return dot(d, d) > _STILL * radius * radius


@njit(cache=True)
def elastic_part(r, d, radius):
    """Fraction of the increment `d` after which the point `r` meets the yield circle."""
    dd = dot(d, d)
    along = dot(r, d)
    reach = math.sqrt(max(along * along - dd * (dot(r, r) - radius * radius), 0.0))
    return (reach - along) / dd


@njit(cache=True)
def slid(x, d, radius):
    """Slide from the point x of the yield circle along the strain increment d; new point."""
    length = norm(d)
    if length == 0.0:
        return x
    size = norm(x)
    cosine = dot(x, d) / (size * length)
    decay = math.exp(-length / radius)
    scale = radius / (1.0 + decay * decay + (1.0 - decay * decay) * cosine)
    kx = scale * 2.0 * decay / size
    kd = scale * (1.0 - decay * decay + (1.0 - decay) ** 2 * cosine) / length
    return (
        kx * x[0] + kd * d[0],
        kx * x[1] + kd * d[1],
        kx * x[2] + kd * d[2],
        kx * x[3] + kd * d[3],
    )


@njit(cache=True)
def _slide_of(r, d, t, slope):
    """The slide from the turned old point r along the increment d, elastic up to t."""
    dd = dot(d, d)
    t = min(max(t, 0.0), 1.0)
    x = (r[0] + t * d[0], r[1] + t * d[1], r[2] + t * d[2], r[3] + t * d[3])
    n = math.sqrt(dot(x, x))
    xd = dot(x, d)
    length = (1.0 - t) * math.sqrt(dd)
    turning = (-2.0 * r[2], 2.0 * r[2], r[0] - r[1], 0.0)
    return Slide(x, d, turning, t, slope, n, length, xd / (n * math.sqrt(dd)), xd, dd)


@njit(cache=True)
def find_slide(step, f, trial, radius):
    """Whether the step slides along the circle (else it returns radially), and the slide."""
    if step.rule != EXACT:
        return False, NO_SLIDE
    r = turned(f, step.e_old)
    d = (trial[0] - r[0], trial[1] - r[1], trial[2] - r[2], trial[3] - r[3])
    if not is_directed(d, radius):
        return False, NO_SLIDE
    if step.hard and dot(r, r) >= radius * radius:
        return True, _slide_of(r, d, 0.0, 0.0)  # rate held the point outside: it flows at once
    t = elastic_part(r, d, radius)
    slope = dot(r, d) + t * dot(d, d) if 0.0 < t < 1.0 else 0.0
    return True, _slide_of(r, d, t, slope)


@njit(cache=True)
def slid_far(slide, circle):
    """Point that slid along a circle whose radius changes: on the mean one, to the end's size."""
    x = slide.x
    d = slide.d
    a = circle.decay
    scale = circle.end / (1.0 + a * a + (1.0 - a * a) * slide.c)
    kx = 2.0 * a * scale / slide.n
    kd = scale * (1.0 - a * a + (1.0 - a) ** 2 * slide.c) * (1.0 - slide.t) / slide.length
    return (
        kx * x[0] + kd * d[0],
        kx * x[1] + kd * d[1],
        kx * x[2] + kd * d[2],
        kx * x[3] + kd * d[3],
    )
