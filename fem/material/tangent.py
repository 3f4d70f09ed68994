"""The consistent tangent: how the deviatoric stress after a step changes with the deformation.

Column by column: the change of F turns into that of the trial strain (through the principal axes of
the trial b), of the mean strain and of the rotation, these into that of the updated point, and that
into the change of P = tau F^-T.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from .flow import NO_CIRCLE, linear_circle
from .slide import NO_SLIDE, Four
from .tensor import dot, spectral
from .update import MARGIN, returned, stress_of, trial_of


class _Axes(NamedTuple):
    """The trial strain: principal values of b, cosine and sine of its first axis, and so on.

    `mixed` is the factor of the shear between the two axes.
    """

    l1: float
    l2: float
    c: float
    s: float
    mixed: float


class _Turn(NamedTuple):
    """In-plane f of the step and its rotation (x, y)/sqrt(square)."""

    f: Four
    x: float
    y: float
    square: float


@njit(cache=True)
def _principal(b):
    """Axes of the trial b, its logarithmic deviator and the mean."""
    l1, l2, c, s = spectral(b[0], b[1], b[2])
    h1 = 0.5 * math.log(l1)
    h2 = 0.5 * math.log(l2)
    h3 = 0.5 * math.log(b[3])
    m = (h1 + h2 + h3) / 3.0
    mixed = (h1 - h2) / (l1 - l2) if abs(l1 - l2) > 1e-7 * l1 else 1.0 / (l1 + l2)
    trial = (
        (h1 - m) * c * c + (h2 - m) * s * s,
        (h1 - m) * s * s + (h2 - m) * c * c,
        (h1 - h2) * c * s,
        h3 - m,
    )
    return _Axes(l1, l2, c, s, mixed), trial, m


@njit(cache=True)
def _linear_slide(slide, circle, dm, dangle, dtrial):
    """Change of a point that slid, from those of mean strain, angle and trial point."""
    x, d, turn, t, slope, n, length, c, xd, dd = slide
    if length == 0.0:
        return dtrial
    mean = circle.mean
    end = circle.end
    a = circle.decay
    rest = 1.0 - t
    # changes of the old point, dangle turn, and of the increment, dtrial - dangle turn
    x_turn = dangle * dot(x, turn)
    d_turn = dangle * dot(d, turn)
    x_inc = dot(x, dtrial) - x_turn
    d_inc = dot(d, dtrial) - d_turn
    dt = 0.0
    if slope != 0.0:
        dt = (circle.start * (3.0 * circle.start * dm) - x_turn - t * x_inc) / slope
    dn = (x_turn + t * x_inc + dt * xd) / n
    dl = rest * (rest * d_inc - dt * dd) / length
    dc = (rest * (d_turn + t * d_inc + dt * dd + x_inc) - dt * xd) / (n * length)
    dc -= c * (dn / n + dl / length)
    dmean = 3.0 * mean * dm
    dend = dmean
    if circle.hard:
        dmean, dend = linear_circle(circle, c, (dn, dl, dc, dm))
    da = -a * (dl - length * dmean / mean) / mean
    den = 1.0 + a * a + (1.0 - a * a) * c
    dden = (2.0 * a * da * (1.0 - c) + (1.0 - a * a) * dc) / den
    top = 1.0 - a * a + (1.0 - a) ** 2 * c
    dtop = (1.0 - a) ** 2 * dc - 2.0 * da * (a + (1.0 - a) * c)
    scale = end / den
    kx = 2.0 * a * scale / n
    kd = top * scale / length
    grow = dend / end - dden
    dkx = kx * (grow - dn / n) + 2.0 * da * scale / n
    dkd = kd * (grow - dl / length) + dtop * scale / length
    inc = kx * t + kd * rest
    old = (kx - inc) * dangle
    along = dt * (kx - kd) + rest * dkd
    return (
        old * turn[0] + inc * dtrial[0] + dkx * x[0] + along * d[0],
        old * turn[1] + inc * dtrial[1] + dkx * x[1] + along * d[1],
        old * turn[2] + inc * dtrial[2] + dkx * x[2] + along * d[2],
        old * turn[3] + inc * dtrial[3] + dkx * x[3] + along * d[3],
    )


@njit(cache=True)
def _linear_return(trial, size, circle, dm, dtrial):
    """Change of a radially returned point."""
    k = circle.end / size
    along = dot(trial, dtrial) / (size * size)
    grow = 3.0 * dm - along
    if circle.hard:
        _, dend = linear_circle(circle, 1.0, (along * size, 0.0, 0.0, dm))
        grow = dend / circle.end - along
    return (
        k * (dtrial[0] + grow * trial[0]),
        k * (dtrial[1] + grow * trial[1]),
        k * (dtrial[2] + grow * trial[2]),
        k * (dtrial[3] + grow * trial[3]),
    )


@njit(cache=True)
def _gradient_of_column(j, inverse, F):
    """Displacement gradient l = dF F^-1 (rr, rz, zr, zz, tt) of a unit change of F_j."""
    g00, g01, g10, g11 = inverse
    return (
        g00 if j == 0 else (g10 if j == 1 else 0.0),
        g01 if j == 0 else (g11 if j == 1 else 0.0),
        g00 if j == 2 else (g10 if j == 3 else 0.0),
        g01 if j == 2 else (g11 if j == 3 else 0.0),
        1.0 / F[4] if j == 4 else 0.0,
    )


@njit(cache=True)
def _linear_trial(axes, change, dm):
    """Change of the trial strain deviator under a displacement gradient."""
    l00, l01, l10, l11, ltt = change
    l1, l2, c, s, mixed = axes
    p00 = c * (l00 * c + l01 * s) + s * (l10 * c + l11 * s)
    p01 = c * (-l00 * s + l01 * c) + s * (-l10 * s + l11 * c)
    p10 = -s * (l00 * c + l01 * s) + c * (l10 * c + l11 * s)
    p11 = -s * (-l00 * s + l01 * c) + c * (-l10 * s + l11 * c)
    e11 = p00 - dm
    e22 = p11 - dm
    e12 = mixed * (l2 * p01 + l1 * p10)
    return (
        e11 * c * c + e22 * s * s - 2.0 * e12 * c * s,
        e11 * s * s + e22 * c * c + 2.0 * e12 * c * s,
        (e11 - e22) * c * s + e12 * (c * c - s * s),
        ltt - dm,
    )


@njit(cache=True)
def _angle_change(change, turn):
    """Change of the step's in-plane rotation under a displacement gradient."""
    l00, l01, l10, l11, _ = change
    f00, f01, f10, f11 = turn.f
    df00 = l00 * f00 + l01 * f10
    df01 = l00 * f01 + l01 * f11
    df10 = l10 * f00 + l11 * f10
    df11 = l10 * f01 + l11 * f11
    return (turn.x * (df10 - df01) - turn.y * (df00 + df11)) / turn.square


@njit(cache=True)
def _put_column(j, F, G, inverse, de, P, A):
    """Write column j of dP/dF, from the change `de` of the elastic strain deviator."""
    g00, g01, g10, g11 = inverse
    t0 = 2.0 * G * de[0]
    t1 = 2.0 * G * de[1]
    t2 = 2.0 * G * de[2]
    # d(tau F^-T) = dtau F^-T - P (F^-1 dF)^T
    w00 = g00 if j == 0 else (g01 if j == 2 else 0.0)
    w01 = g00 if j == 1 else (g01 if j == 3 else 0.0)
    w10 = g10 if j == 0 else (g11 if j == 2 else 0.0)
    w11 = g10 if j == 1 else (g11 if j == 3 else 0.0)
    A[0, j] = t0 * g00 + t2 * g01 - (P[0] * w00 + P[1] * w01)
    A[1, j] = t0 * g10 + t2 * g11 - (P[0] * w10 + P[1] * w11)
    A[2, j] = t2 * g00 + t1 * g01 - (P[2] * w00 + P[3] * w01)
    A[3, j] = t2 * g10 + t1 * g11 - (P[2] * w10 + P[3] * w11)
    A[4, j] = 2.0 * G * de[3] / F[4] - (P[4] / F[4] if j == 4 else 0.0)


@njit(cache=True)
def deviatoric_tangent(step, curve, G, P, A):
    """Write the deviatoric stress into `P` (5,) and its dP/dF (5, 5) into `A`; 1 if plastic.

    The stress is that of `deviatoric_pk1`.
    """
    F = step.F
    f, b = trial_of(step)
    axes, trial, m = _principal(b)
    radius = step.radius * math.exp(3.0 * m)
    size = math.sqrt(dot(trial, trial))
    plastic = size > radius * MARGIN
    x = f[0] + f[3]
    y = f[2] - f[1]
    turn = _Turn(f, x, y, x * x + y * y)
    e, circle, directed, slide = trial, NO_CIRCLE, False, NO_SLIDE
    if plastic:
        e, circle, directed, slide = returned(step, curve, f, trial, size, radius)
    stress_of(F, G, e, P)
    det = F[0] * F[3] - F[1] * F[2]
    inverse = (F[3] / det, -F[1] / det, -F[2] / det, F[0] / det)
    for j in range(5):
        change = _gradient_of_column(j, inverse, F)
        dm = (change[0] + change[3] + change[4]) / 3.0
        de = _linear_trial(axes, change, dm)
        if directed:
            dangle = _angle_change(change, turn)
            de = _linear_slide(slide, circle, dm, dangle, de)
        elif plastic:
            de = _linear_return(trial, size, circle, dm, de)
        _put_column(j, F, G, inverse, de, P, A)
    return 1 if plastic else 0
