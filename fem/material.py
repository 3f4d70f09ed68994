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

_STILL = 1e-24  # a smaller increment (squared, over the radius) has no direction: radial return


@njit(cache=True)
def spectral(a, b, c):
    """Eigenvalues of [[a, c], [c, b]] and cosine, sine of the first eigenvector's angle."""
    mean = 0.5 * (a + b)
    half = 0.5 * (a - b)
    radius = math.sqrt(half * half + c * c)
    angle = 0.5 * math.atan2(c, half) if radius > 0.0 else 0.0
    return mean + radius, mean - radius, math.cos(angle), math.sin(angle)


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
def elastic_deviator(F, Fn, bn, radius0, rule):
    """Elastic deviatoric strain after the update.

    Parameters
    ----------
    F, Fn
        Deformation gradient now and at the last accepted step, shape (5,) [-].
    bn
        Elastic left Cauchy-Green tensor at the last accepted step, shape (4,) [-].
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
    (f00, f01, f10, f11), (b0, b1, b2, b3) = _trial(F, Fn, bn)
    a0, a1, a2, a3, m = log_strain(b0, b1, b2, b3)
    trial = _norm(a0, a1, a2, a3)
    radius = radius0 * math.exp(3.0 * m)
    # the margin keeps round-off from calling converged plastic points plastic again on unloading
    if trial <= radius * (1.0 + 1e-10):
        return a0, a1, a2, a3, m, 0, 0.0
    if rule == RADIAL:
        k = radius / trial
        return k * a0, k * a1, k * a2, k * a3, m, 1, trial - radius
    o0, o1, o2, o3, _ = log_strain(bn[0], bn[1], bn[2], bn[3])
    angle = math.atan2(f10 - f01, f00 + f11)
    c = math.cos(angle)
    s = math.sin(angle)
    r0 = c * c * o0 - 2.0 * c * s * o2 + s * s * o1
    r1 = s * s * o0 + 2.0 * c * s * o2 + c * c * o1
    r2 = c * s * (o0 - o1) + (c * c - s * s) * o2
    d0 = a0 - r0
    d1 = a1 - r1
    d2 = a2 - r2
    d3 = a3 - o3
    dd = d0 * d0 + d1 * d1 + d3 * d3 + 2.0 * d2 * d2
    if dd <= _STILL * radius * radius:
        k = radius / trial
        return k * a0, k * a1, k * a2, k * a3, m, 1, trial - radius
    od = r0 * d0 + r1 * d1 + o3 * d3 + 2.0 * r2 * d2
    oo = r0 * r0 + r1 * r1 + o3 * o3 + 2.0 * r2 * r2
    elastic = (-od + math.sqrt(max(od * od - dd * (oo - radius * radius), 0.0))) / dd
    elastic = min(max(elastic, 0.0), 1.0)
    rest = 1.0 - elastic
    q0, q1, q2, q3 = _slide(
        r0 + elastic * d0,
        r1 + elastic * d1,
        r2 + elastic * d2,
        o3 + elastic * d3,
        rest * d0,
        rest * d1,
        rest * d2,
        rest * d3,
        radius,
    )
    return q0, q1, q2, q3, m, 1, _norm(a0 - q0, a1 - q1, a2 - q2, a3 - q3)


@njit(cache=True)
def deviatoric_pk1(F, Fn, bn, G, radius0, rule, P):
    """Write the deviatoric first Piola-Kirchhoff stress into `P` (5,); return 1 if plastic."""
    e0, e1, e2, e3, _, plastic, _ = elastic_deviator(F, Fn, bn, radius0, rule)
    det = F[0] * F[3] - F[1] * F[2]
    g = 2.0 * G / det
    P[0] = g * (e0 * F[3] - e2 * F[1])
    P[1] = g * (e2 * F[0] - e0 * F[2])
    P[2] = g * (e2 * F[3] - e1 * F[1])
    P[3] = g * (e1 * F[0] - e2 * F[2])
    P[4] = 2.0 * G * e3 / F[4]
    return plastic


@njit(cache=True)
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[3] * b[3] + 2.0 * a[2] * b[2]


@njit(cache=True)
def _linear_slide(r, d, radius, dr, dd, dradius, dq):
    """Write the change of the exactly updated point into `dq` (4,).

    Parameters
    ----------
    r, d
        Rotated old point and strain increment, shape (4,).
    radius
        Radius of the yield circle.
    dr, dd, dradius
        Their changes.
    """
    length2 = _dot(d, d)
    along = _dot(r, d)
    root = math.sqrt(max(along * along - length2 * (_dot(r, r) - radius * radius), 0.0))
    elastic = (root - along) / length2
    delastic = 0.0
    if 0.0 < elastic < 1.0:
        slope = along + elastic * length2
        change = _dot(r, dr) + elastic * (_dot(r, dd) + _dot(d, dr))
        change += elastic * elastic * _dot(d, dd) - radius * dradius
        delastic = -change / slope if slope != 0.0 else 0.0
    else:
        elastic = min(max(elastic, 0.0), 1.0)
    rest = 1.0 - elastic
    n2 = 0.0
    l2 = 0.0
    xd = 0.0
    dn = 0.0
    dl = 0.0
    dc = 0.0
    for i in range(4):
        k = 2.0 if i == 2 else 1.0
        x = r[i] + elastic * d[i]
        D = rest * d[i]
        dx = dr[i] + elastic * dd[i] + delastic * d[i]
        dD = rest * dd[i] - delastic * d[i]
        n2 += k * x * x
        l2 += k * D * D
        xd += k * x * D
        dn += k * x * dx
        dl += k * D * dD
        dc += k * (dx * D + x * dD)
    n = math.sqrt(n2)
    length = math.sqrt(l2)
    if length == 0.0:
        for i in range(4):
            dq[i] = dr[i] + dd[i]
        return
    dn /= n
    dl /= length
    c = xd / (n * length)
    dc = dc / (n * length) - c * (dn / n + dl / length)
    a = math.exp(-length / radius)
    da = -a * (dl / radius - length * dradius / (radius * radius))
    den = 1.0 + a * a + (1.0 - a * a) * c
    dden = 2.0 * a * da * (1.0 - c) + (1.0 - a * a) * dc
    top = 1.0 - a * a + (1.0 - a) ** 2 * c
    dtop = -2.0 * a * da - 2.0 * (1.0 - a) * da * c + (1.0 - a) ** 2 * dc
    kx = radius * 2.0 * a / (den * n)
    dkx = kx * (dradius / radius - dden / den - dn / n) + 2.0 * radius * da / (den * n)
    kd = radius * top / (den * length)
    dkd = kd * (dradius / radius - dden / den - dl / length) + radius * dtop / (den * length)
    for i in range(4):
        x = r[i] + elastic * d[i]
        D = rest * d[i]
        dx = dr[i] + elastic * dd[i] + delastic * d[i]
        dD = rest * dd[i] - delastic * d[i]
        dq[i] = kx * dx + x * dkx + kd * dD + D * dkd


@njit(cache=True)
def deviatoric_tangent(F, Fn, bn, G, radius0, rule, P, work, A):
    """Write dP/dF (5, 5) of the deviatoric part into `A`; `P` is its stress, `work` (6, 4) room.

    Column by column: the change of F turns into that of the trial strain (through the principal
    axes of the trial b), of the mean strain and of the rotation, these into that of the updated
    point, and that into the change of P = tau F^-T.
    """
    trial, old, step, dtrial, dold, dpoint = work
    (f00, f01, f10, f11), (b0, b1, b2, b3) = _trial(F, Fn, bn)
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
    plastic = size > radius * (1.0 + 1e-10)
    x = f00 + f11
    y = f10 - f01
    turn2 = x * x + y * y
    for i in range(4):
        step[i] = 0.0
    if plastic and rule == EXACT:
        o0, o1, o2, o3, _ = log_strain(bn[0], bn[1], bn[2], bn[3])
        ca = x / math.sqrt(turn2)
        sa = y / math.sqrt(turn2)
        old[0] = ca * ca * o0 - 2.0 * ca * sa * o2 + sa * sa * o1
        old[1] = sa * sa * o0 + 2.0 * ca * sa * o2 + ca * ca * o1
        old[2] = ca * sa * (o0 - o1) + (ca * ca - sa * sa) * o2
        old[3] = o3
        for i in range(4):
            step[i] = trial[i] - old[i]
    directed = rule == EXACT and plastic and _dot(step, step) > _STILL * radius * radius
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
            dold[0] = -2.0 * old[2] * dangle
            dold[1] = 2.0 * old[2] * dangle
            dold[2] = (old[0] - old[1]) * dangle
            dold[3] = 0.0
            for i in range(4):
                dtrial[i] -= dold[i]
            _linear_slide(old, step, radius, dold, dtrial, 3.0 * radius * dm, dpoint)
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
