"""Finite-strain, logarithmic, perfectly plastic von Mises material: stress update and tangents.

The state of a material point is the deformation gradient `Fn` of the last accepted step and the
elastic left Cauchy-Green tensor `bn` there. Components of an axisymmetric tensor are ordered
(rr, rz, zr, zz, tt) for a deformation gradient and (rr, zz, rz, tt) for a symmetric tensor.

The stress follows from the elastic logarithmic strain e = 1/2 ln b: tau = 2 G dev e + p J I. The
pressure belongs to the element (mean dilatation); this file holds the deviatoric part. Yield is
|dev sigma| = sqrt(2/3) Sy in the Cauchy stress, so that the radius in dev e is
sqrt(2/3) Sy J / (2 G).

Two stress updates are offered by number (`RADIAL`, `EXACT`). The radial return is first order in
the step when the strain path bends, and under a growing contact it bends everywhere. The exact
update integrates the flow rule for a constant direction of the strain increment in the rotated
frame (Krieg and Krieg, J. Press. Vessel Technol. 99 (1977) 510): the stress point slides along the
yield circle towards that direction, tan(psi/2) decaying exponentially; its error is of second
order.
"""

from __future__ import annotations

import math

from numba import njit

RADIAL = 0
"""Radial return (backward Euler)."""

EXACT = 1
"""Exact integration along a constant strain-rate direction."""

# keeps round-off from calling converged plastic points plastic again on unloading
_MARGIN = 1.0 + 1e-10
_STILL = 1e-24  # a smaller increment (squared, over the radius) has no direction: radial return


@njit(cache=True)
def spectral(a, b, c):
    """Eigenvalues of [[a, c], [c, b]] and cosine, sine of the first eigenvector's angle."""
    mean = 0.5 * (a + b)
    half = 0.5 * (a - b)
    radius = math.sqrt(half * half + c * c)
    if radius == 0.0:
        return mean, mean, 1.0, 0.0
    # half-angle formulas, each in the form that subtracts nothing
    if half >= 0.0:
        cosine = math.sqrt(0.5 * (1.0 + half / radius))
        sine = 0.5 * c / (radius * cosine)
    else:
        sine = math.copysign(math.sqrt(0.5 * (1.0 - half / radius)), c)
        cosine = 0.5 * c / (radius * sine)
    return mean + radius, mean - radius, cosine, sine


@njit(cache=True)
def log_strain(brr, bzz, brz, btt):
    """Deviator (rr, zz, rz, tt) and mean of 1/2 ln b."""
    l1, l2, c, s = spectral(brr, bzz, brz)
    e1 = 0.5 * math.log(l1)
    e2 = 0.5 * math.log(l2)
    e3 = 0.5 * math.log(btt)
    m = (e1 + e2 + e3) / 3.0
    e1 -= m
    e2 -= m
    return e1 * c * c + e2 * s * s, e1 * s * s + e2 * c * c, (e1 - e2) * c * s, e3 - m, m


@njit(cache=True)
def exponential(err, ezz, erz, ett):
    """Return b = exp(2 e), components (rr, zz, rz, tt)."""
    e1, e2, c, s = spectral(err, ezz, erz)
    b1 = math.exp(2.0 * e1)
    b2 = math.exp(2.0 * e2)
    return b1 * c * c + b2 * s * s, b1 * s * s + b2 * c * c, (b1 - b2) * c * s, math.exp(2.0 * ett)


@njit(cache=True)
def _norm(rr, zz, rz, tt):
    return math.sqrt(rr * rr + zz * zz + tt * tt + 2.0 * rz * rz)


@njit(cache=True)
def _trial(F, Fn, bn):
    """In-plane f = F Fn^-1 (rr, rz, zr, zz) and the trial b = f bn f^T (rr, zz, rz, tt)."""
    det = Fn[0] * Fn[3] - Fn[1] * Fn[2]
    i00 = Fn[3] / det
    i01 = -Fn[1] / det
    i10 = -Fn[2] / det
    i11 = Fn[0] / det
    f00 = F[0] * i00 + F[1] * i10
    f01 = F[0] * i01 + F[1] * i11
    f10 = F[2] * i00 + F[3] * i10
    f11 = F[2] * i01 + F[3] * i11
    ftt = F[4] / Fn[4]
    t00 = f00 * bn[0] + f01 * bn[2]
    t01 = f00 * bn[2] + f01 * bn[1]
    t10 = f10 * bn[0] + f11 * bn[2]
    t11 = f10 * bn[2] + f11 * bn[1]
    return (
        (f00, f01, f10, f11),
        (t00 * f00 + t01 * f01, t10 * f10 + t11 * f11, t00 * f10 + t01 * f11, ftt * ftt * bn[3]),
    )


@njit(cache=True)
def _slide(x0, x1, x2, x3, d0, d1, d2, d3, radius):
    """Slide from the point x of the yield circle along the strain increment d; new point."""
    length = _norm(d0, d1, d2, d3)
    if length == 0.0:
        return x0, x1, x2, x3
    norm = _norm(x0, x1, x2, x3)
    cosine = (x0 * d0 + x1 * d1 + x3 * d3 + 2.0 * x2 * d2) / (norm * length)
    decay = math.exp(-length / radius)
    scale = radius / (1.0 + decay * decay + (1.0 - decay * decay) * cosine)
    kx = scale * 2.0 * decay / norm
    kd = scale * (1.0 - decay * decay + (1.0 - decay) ** 2 * cosine) / length
    return kx * x0 + kd * d0, kx * x1 + kd * d1, kx * x2 + kd * d2, kx * x3 + kd * d3


@njit(cache=True)
def _turned(cosine, sine, en):
    """Old elastic strain deviator turned by the increment's in-plane rotation."""
    cc = cosine * cosine
    ss = sine * sine
    cs = cosine * sine
    return (
        cc * en[0] - 2.0 * cs * en[2] + ss * en[1],
        ss * en[0] + 2.0 * cs * en[2] + cc * en[1],
        cs * (en[0] - en[1]) + (cc - ss) * en[2],
        en[3],
    )


@njit(cache=True)
def _return(f, a0, a1, a2, a3, trial, radius, en, rule):
    """Updated point from the trial point `a` outside the yield circle."""
    k = radius / trial
    if rule == RADIAL:
        return k * a0, k * a1, k * a2, k * a3
    x = f[0] + f[3]
    y = f[2] - f[1]
    turn = math.sqrt(x * x + y * y)
    r0, r1, r2, r3 = _turned(x / turn, y / turn, en)
    d0 = a0 - r0
    d1 = a1 - r1
    d2 = a2 - r2
    d3 = a3 - r3
    dd = d0 * d0 + d1 * d1 + d3 * d3 + 2.0 * d2 * d2
    if dd <= _STILL * radius * radius:
        return k * a0, k * a1, k * a2, k * a3
    od = r0 * d0 + r1 * d1 + r3 * d3 + 2.0 * r2 * d2
    oo = r0 * r0 + r1 * r1 + r3 * r3 + 2.0 * r2 * r2
    elastic = (-od + math.sqrt(max(od * od - dd * (oo - radius * radius), 0.0))) / dd
    elastic = min(max(elastic, 0.0), 1.0)
    rest = 1.0 - elastic
    return _slide(
        r0 + elastic * d0,
        r1 + elastic * d1,
        r2 + elastic * d2,
        r3 + elastic * d3,
        rest * d0,
        rest * d1,
        rest * d2,
        rest * d3,
        radius,
    )


@njit(cache=True)
def elastic_deviator(F, Fn, bn, en, radius0, rule):
    """Elastic deviatoric strain after the update.

    Parameters
    ----------
    F, Fn
        Deformation gradient now and at the last accepted step, shape (5,) [-].
    bn, en
        Elastic left Cauchy-Green tensor at the last accepted step, and the deviator of its
        logarithmic strain, shape (4,) [-].
    radius0
        sqrt(2/3) Sy / (2 G), radius of the yield circle at J = 1 [-]; `inf` if elastic.
    rule
        `RADIAL` or `EXACT`.

    Returns
    -------
    tuple
        dev e (rr, zz, rz, tt), mean of e, 1 if plastic else 0, length of the plastic increment
        |dev e_trial - dev e|.
    """
    f, (b0, b1, b2, b3) = _trial(F, Fn, bn)
    a0, a1, a2, a3, m = log_strain(b0, b1, b2, b3)
    trial = _norm(a0, a1, a2, a3)
    radius = radius0 * math.exp(3.0 * m)
    if trial <= radius * _MARGIN:
        return a0, a1, a2, a3, m, 0, 0.0
    q0, q1, q2, q3 = _return(f, a0, a1, a2, a3, trial, radius, en, rule)
    return q0, q1, q2, q3, m, 1, _norm(a0 - q0, a1 - q1, a2 - q2, a3 - q3)


@njit(cache=True)
def _stress(F, G, e0, e1, e2, e3, P):
    """Write P = 2 G dev e F^-T into `P` (5,)."""
    g = 2.0 * G / (F[0] * F[3] - F[1] * F[2])
    P[0] = g * (e0 * F[3] - e2 * F[1])
    P[1] = g * (e2 * F[0] - e0 * F[2])
    P[2] = g * (e2 * F[3] - e1 * F[1])
    P[3] = g * (e1 * F[0] - e2 * F[2])
    P[4] = 2.0 * G * e3 / F[4]


@njit(cache=True)
def deviatoric_pk1(F, Fn, bn, en, G, radius0, rule, P):
    """Write the deviatoric first Piola-Kirchhoff stress into `P` (5,); return 1 if plastic."""
    e0, e1, e2, e3, _, plastic, _ = elastic_deviator(F, Fn, bn, en, radius0, rule)
    _stress(F, G, e0, e1, e2, e3, P)
    return plastic


@njit(cache=True)
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[3] * b[3] + 2.0 * a[2] * b[2]


@njit(cache=True)
def _slide_terms(r, d, radius, x):
    """What `_linear_slide` needs; the point where the circle is reached goes to `x` (4,).

    Returns
    -------
    tuple
        Elastic fraction t of the increment, derivative of |r + t d|^2/2 by t (0: not crossed),
        |x|, length of the rest of the increment, cosine between x and d, decay exp(-length/radius),
        x . d and d . d.
    """
    dd = _dot(d, d)
    along = _dot(r, d)
    root = math.sqrt(max(along * along - dd * (_dot(r, r) - radius * radius), 0.0))
    t = (root - along) / dd
    slope = along + t * dd if 0.0 < t < 1.0 else 0.0
    t = min(max(t, 0.0), 1.0)
    for i in range(4):
        x[i] = r[i] + t * d[i]
    n = math.sqrt(_dot(x, x))
    xd = _dot(x, d)
    length = (1.0 - t) * math.sqrt(dd)
    cosine = xd / (n * math.sqrt(dd))
    return t, slope, n, length, cosine, math.exp(-length / radius), xd, dd


@njit(cache=True)
def _linear_slide(x, d, radius, terms, turn, dangle, dtrial, dradius, dq):
    """Write the change of the exactly updated point into `dq` (4,).

    Parameters
    ----------
    x, d, radius, terms
        The point where the circle is reached, the increment, the circle's radius and their
        `_slide_terms`.
    turn, dangle
        Change of the rotated old point with the angle, shape (4,), and of the angle.
    dtrial, dradius
        Changes of the trial point and of the radius.
    """
    t, slope, n, length, c, a, xd, dd = terms
    if length == 0.0:
        for i in range(4):
            dq[i] = dtrial[i]
        return
    rest = 1.0 - t
    # changes of the old point, dangle turn, and of the increment, dtrial - dangle turn
    x_turn = dangle * _dot(x, turn)
    d_turn = dangle * _dot(d, turn)
    x_inc = _dot(x, dtrial) - x_turn
    d_inc = _dot(d, dtrial) - d_turn
    dt = 0.0
    if slope != 0.0:
        dt = (radius * dradius - x_turn - t * x_inc) / slope
    dn = (x_turn + t * x_inc + dt * xd) / n
    dl = rest * (rest * d_inc - dt * dd) / length
    dc = (rest * (d_turn + t * d_inc + dt * dd + x_inc) - dt * xd) / (n * length)
    dc -= c * (dn / n + dl / length)
    da = -a * (dl - length * dradius / radius) / radius
    den = 1.0 + a * a + (1.0 - a * a) * c
    dden = (2.0 * a * da * (1.0 - c) + (1.0 - a * a) * dc) / den
    top = 1.0 - a * a + (1.0 - a) ** 2 * c
    dtop = (1.0 - a) ** 2 * dc - 2.0 * da * (a + (1.0 - a) * c)
    scale = radius / den
    kx = 2.0 * a * scale / n
    kd = top * scale / length
    grow = dradius / radius - dden
    dkx = kx * (grow - dn / n) + 2.0 * da * scale / n
    dkd = kd * (grow - dl / length) + dtop * scale / length
    inc = kx * t + kd * rest
    old = (kx - inc) * dangle
    along = dt * (kx - kd) + rest * dkd
    for i in range(4):
        dq[i] = old * turn[i] + inc * dtrial[i] + dkx * x[i] + along * d[i]


@njit(cache=True)
def deviatoric_tangent(F, Fn, bn, en, G, radius0, rule, P, work, A):
    """Write the deviatoric stress into `P` (5,) and its dP/dF (5, 5) into `A`; 1 if plastic.

    The stress is that of `deviatoric_pk1`; `work` (6, 4) is room.

    Column by column: the change of F turns into that of the trial strain (through the principal
    axes of the trial b), of the mean strain and of the rotation, these into that of the updated
    point, and that into the change of P = tau F^-T.
    """
    trial, reached, step, dtrial, turning, dpoint = work
    f, (b0, b1, b2, b3) = _trial(F, Fn, bn)
    f00, f01, f10, f11 = f
    l1, l2, c, s = spectral(b0, b1, b2)
    h1 = 0.5 * math.log(l1)
    h2 = 0.5 * math.log(l2)
    h3 = 0.5 * math.log(b3)
    m = (h1 + h2 + h3) / 3.0
    mixed = (h1 - h2) / (l1 - l2) if abs(l1 - l2) > 1e-7 * l1 else 1.0 / (l1 + l2)
    trial[0] = (h1 - m) * c * c + (h2 - m) * s * s
    trial[1] = (h1 - m) * s * s + (h2 - m) * c * c
    trial[2] = (h1 - h2) * c * s
    trial[3] = h3 - m
    radius = radius0 * math.exp(3.0 * m)
    size = math.sqrt(_dot(trial, trial))
    plastic = size > radius * _MARGIN
    x = f00 + f11
    y = f10 - f01
    turn2 = x * x + y * y
    directed = False
    terms = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if not plastic:
        _stress(F, G, trial[0], trial[1], trial[2], trial[3], P)
    else:
        q0, q1, q2, q3 = _return(f, trial[0], trial[1], trial[2], trial[3], size, radius, en, rule)
        _stress(F, G, q0, q1, q2, q3, P)
        if rule == EXACT:
            turn = math.sqrt(turn2)
            r0, r1, r2, r3 = _turned(x / turn, y / turn, en)
            step[0] = trial[0] - r0
            step[1] = trial[1] - r1
            step[2] = trial[2] - r2
            step[3] = trial[3] - r3
            directed = _dot(step, step) > _STILL * radius * radius
            if directed:
                turning[0] = -2.0 * r2
                turning[1] = 2.0 * r2
                turning[2] = r0 - r1
                turning[3] = 0.0
                old = (r0, r1, r2, r3)
                terms = _slide_terms(old, step, radius, reached)
    detF = F[0] * F[3] - F[1] * F[2]
    g00 = F[3] / detF
    g01 = -F[1] / detF
    g10 = -F[2] / detF
    g11 = F[0] / detF
    for j in range(5):
        # displacement gradient l = dF F^-1 of a unit change of F_j
        l00 = g00 if j == 0 else (g10 if j == 1 else 0.0)
        l01 = g01 if j == 0 else (g11 if j == 1 else 0.0)
        l10 = g00 if j == 2 else (g10 if j == 3 else 0.0)
        l11 = g01 if j == 2 else (g11 if j == 3 else 0.0)
        ltt = 1.0 / F[4] if j == 4 else 0.0
        dm = (l00 + l11 + ltt) / 3.0
        p00 = c * (l00 * c + l01 * s) + s * (l10 * c + l11 * s)
        p01 = c * (-l00 * s + l01 * c) + s * (-l10 * s + l11 * c)
        p10 = -s * (l00 * c + l01 * s) + c * (l10 * c + l11 * s)
        p11 = -s * (-l00 * s + l01 * c) + c * (-l10 * s + l11 * c)
        e11 = p00 - dm
        e22 = p11 - dm
        e12 = mixed * (l2 * p01 + l1 * p10)
        dtrial[0] = e11 * c * c + e22 * s * s - 2.0 * e12 * c * s
        dtrial[1] = e11 * s * s + e22 * c * c + 2.0 * e12 * c * s
        dtrial[2] = (e11 - e22) * c * s + e12 * (c * c - s * s)
        dtrial[3] = ltt - dm
        if not plastic:
            for i in range(4):
                dpoint[i] = dtrial[i]
        elif not directed:
            along = _dot(trial, dtrial) / (size * size)
            for i in range(4):
                dpoint[i] = radius / size * (dtrial[i] + (3.0 * dm - along) * trial[i])
        else:
            df00 = l00 * f00 + l01 * f10
            df01 = l00 * f01 + l01 * f11
            df10 = l10 * f00 + l11 * f10
            df11 = l10 * f01 + l11 * f11
            dangle = (x * (df10 - df01) - y * (df00 + df11)) / turn2
            _linear_slide(
                reached, step, radius, terms, turning, dangle, dtrial, 3.0 * radius * dm, dpoint
            )
        t0 = 2.0 * G * dpoint[0]
        t1 = 2.0 * G * dpoint[1]
        t2 = 2.0 * G * dpoint[2]
        # d(tau F^-T) = dtau F^-T - P (F^-1 dF)^T
        w00 = g00 if j == 0 else (g01 if j == 2 else 0.0)
        w01 = g00 if j == 1 else (g01 if j == 3 else 0.0)
        w10 = g10 if j == 0 else (g11 if j == 2 else 0.0)
        w11 = g10 if j == 1 else (g11 if j == 3 else 0.0)
        A[0, j] = t0 * g00 + t2 * g01 - (P[0] * w00 + P[1] * w01)
        A[1, j] = t0 * g10 + t2 * g11 - (P[0] * w10 + P[1] * w11)
        A[2, j] = t2 * g00 + t1 * g01 - (P[2] * w00 + P[3] * w01)
        A[3, j] = t2 * g10 + t1 * g11 - (P[2] * w10 + P[3] * w11)
        A[4, j] = 2.0 * G * dpoint[3] / F[4] - (P[4] / F[4] if j == 4 else 0.0)
    return 1 if plastic else 0
