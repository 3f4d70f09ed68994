"""The stress update: the elastic strain at a material point after a step, and the stress.

Two updates are offered by number (`RADIAL`, `EXACT`). The radial return is first order in the step
when the strain path bends, and under a growing contact it bends everywhere. The exact update
integrates the flow rule for a constant direction of the strain increment in the rotated frame
(Krieg and Krieg, J. Press. Vessel Technol. 99 (1977) 510): the stress point slides along the yield
circle towards that direction, tan(psi/2) decaying exponentially; its error is of second order.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from .tensor import dot, log_strain, norm

Four = tuple[float, float, float, float] | npt.NDArray[np.float64]
"""A symmetric tensor, (rr, zz, rz, tt)."""

Five = tuple[float, float, float, float, float] | npt.NDArray[np.float64]
"""A deformation gradient, (rr, rz, zr, zz, tt)."""

RADIAL = 0
"""Radial return (backward Euler)."""

EXACT = 1
"""Exact integration along a constant strain-rate direction."""

# keeps round-off from calling converged plastic points plastic again on unloading
MARGIN = 1.0 + 1e-10
_STILL = 1e-24  # a smaller increment (squared, over the radius) has no direction: radial return


class Step(NamedTuple):
    """One step of a material point.

    Parameters
    ----------
    F, F_old
        Deformation gradient now and at the last accepted step [-].
    b_old, e_old
        Elastic left Cauchy-Green tensor at the last accepted step, and the deviator of its
        logarithmic strain [-].
    radius
        sqrt(2/3) Sy / (2 G), radius of the yield circle at J = 1 [-]; `inf` if elastic.
    rule
        `RADIAL` or `EXACT`.
    """

    F: Five
    F_old: Five
    b_old: Four
    e_old: Four
    radius: float
    rule: int


@njit(cache=True)
def trial_of(step):
    """In-plane f = F F_old^-1 (rr, rz, zr, zz) and the trial b = f b_old f^T (rr, zz, rz, tt)."""
    F = step.F
    old = step.F_old
    b = step.b_old
    det = old[0] * old[3] - old[1] * old[2]
    i00 = old[3] / det
    i01 = -old[1] / det
    i10 = -old[2] / det
    i11 = old[0] / det
    f00 = F[0] * i00 + F[1] * i10
    f01 = F[0] * i01 + F[1] * i11
    f10 = F[2] * i00 + F[3] * i10
    f11 = F[2] * i01 + F[3] * i11
    ftt = F[4] / old[4]
    t00 = f00 * b[0] + f01 * b[2]
    t01 = f00 * b[2] + f01 * b[1]
    t10 = f10 * b[0] + f11 * b[2]
    t11 = f10 * b[2] + f11 * b[1]
    return (
        (f00, f01, f10, f11),
        (t00 * f00 + t01 * f01, t10 * f10 + t11 * f11, t00 * f10 + t01 * f11, ftt * ftt * b[3]),
    )


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
def _slid(x, d, radius):
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
def returned(step, f, a, size, radius):
    """Updated point from the trial point `a`, of length `size`, outside the yield circle."""
    k = radius / size
    if step.rule == RADIAL:
        return k * a[0], k * a[1], k * a[2], k * a[3]
    r = turned(f, step.e_old)
    d = (a[0] - r[0], a[1] - r[1], a[2] - r[2], a[3] - r[3])
    if not is_directed(d, radius):
        return k * a[0], k * a[1], k * a[2], k * a[3]
    t = min(max(elastic_part(r, d, radius), 0.0), 1.0)
    rest = 1.0 - t
    return _slid(
        (r[0] + t * d[0], r[1] + t * d[1], r[2] + t * d[2], r[3] + t * d[3]),
        (rest * d[0], rest * d[1], rest * d[2], rest * d[3]),
        radius,
    )


@njit(cache=True)
def elastic_deviator(step):
    """Elastic deviatoric strain after a step.

    Returns
    -------
    tuple
        dev e (rr, zz, rz, tt), mean of e, 1 if plastic else 0, length of the plastic increment
        |dev e_trial - dev e|.
    """
    f, b = trial_of(step)
    a, m = log_strain(b)
    size = norm(a)
    radius = step.radius * math.exp(3.0 * m)
    if size <= radius * MARGIN:
        return a, m, 0, 0.0
    q = returned(step, f, a, size, radius)
    return q, m, 1, norm((a[0] - q[0], a[1] - q[1], a[2] - q[2], a[3] - q[3]))


@njit(cache=True)
def stress_of(F, G, e, P):
    """Write P = 2 G dev e F^-T into `P` (5,)."""
    g = 2.0 * G / (F[0] * F[3] - F[1] * F[2])
    P[0] = g * (e[0] * F[3] - e[2] * F[1])
    P[1] = g * (e[2] * F[0] - e[0] * F[2])
    P[2] = g * (e[2] * F[3] - e[1] * F[1])
    P[3] = g * (e[1] * F[0] - e[2] * F[2])
    P[4] = 2.0 * G * e[3] / F[4]


@njit(cache=True)
def deviatoric_pk1(step, G, P):
    """Write the deviatoric first Piola-Kirchhoff stress into `P` (5,); return 1 if plastic."""
    e, _, plastic, _ = elastic_deviator(step)
    stress_of(step.F, G, e, P)
    return plastic
