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

_DIFFERENCE = 1e-7  # step of the tangent's difference quotient in F; round-off stays near 1e-9


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
    a0, a1, a2, a3, m = log_strain(
        t00 * f00 + t01 * f01, t10 * f10 + t11 * f11, t00 * f10 + t01 * f11, ftt * ftt * bn[3]
    )
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
def tangent_by_difference(F, Fn, bn, G, radius0, rule, P, work_F, work_P, A):
    """Write dP/dF (5, 5) of the deviatoric part into `A` by forward differences.

    Only plastic points need it: the exact update has no short closed tangent, and the quotient's
    error of 1e-7 leaves Newton's method quadratic down to its tolerance.
    """
    for i in range(5):
        work_F[i] = F[i]
    for j in range(5):
        work_F[j] = F[j] + _DIFFERENCE
        deviatoric_pk1(work_F, Fn, bn, G, radius0, rule, work_P)
        for i in range(5):
            A[i, j] = (work_P[i] - P[i]) / _DIFFERENCE
        work_F[j] = F[j]


@njit(cache=True)
def elastic_tangent(F, Fn, bn, G, S, M, A):
    """Write dP/dF (5, 5) of the deviatoric part of an elastic point into `A`, in closed form.

    `S` and `M` (5, 5) are working space. The spatial moduli of the logarithmic law are
    c_AABB = 2 G (delta_AB - 1/3) - 2 tau_A delta_AB and, for the shear of the two in-plane axes,
    (tau_1 l_2 - tau_2 l_1)/(l_1 - l_2) with l = lambda^2; dP/dF is their pull-back with the
    initial-stress term added.
    """
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
    l1, l2, c, s = spectral(t00 * f00 + t01 * f01, t10 * f10 + t11 * f11, t00 * f10 + t01 * f11)
    h1 = 0.5 * math.log(l1)
    h2 = 0.5 * math.log(l2)
    h3 = 0.5 * math.log(ftt * ftt * bn[3])
    m = (h1 + h2 + h3) / 3.0
    t1 = 2.0 * G * (h1 - m)
    t2 = 2.0 * G * (h2 - m)
    t3 = 2.0 * G * (h3 - m)
    if abs(l1 - l2) > 1e-6 * l1:
        shear = (t1 * l2 - t2 * l1) / (l1 - l2)
    else:
        shear = G - 0.5 * (t1 + t2)
    k = -2.0 * G / 3.0
    n = 4.0 * G / 3.0
    # tensor in the principal frame acting on the displacement gradient (11, 12, 21, 22, 33)
    for i in range(5):
        for j in range(5):
            S[i, j] = 0.0
    S[0, 0] = n - t1
    S[3, 3] = n - t2
    S[4, 4] = n - t3
    S[0, 3] = S[3, 0] = S[0, 4] = S[4, 0] = S[3, 4] = S[4, 3] = k
    S[1, 1] = shear + t2
    S[2, 2] = shear + t1
    S[1, 2] = S[2, 1] = shear
    # columns of the pull-back: l = dF F^-1, rotated to the principal frame
    detF = F[0] * F[3] - F[1] * F[2]
    g00 = F[3] / detF
    g01 = -F[1] / detF
    g10 = -F[2] / detF
    g11 = F[0] / detF
    # M[i, j]: principal displacement gradient i caused by dF_j, built from u = Q^T dF (F^-1 Q)
    p00 = g00 * c + g01 * s
    p01 = -g00 * s + g01 * c
    p10 = g10 * c + g11 * s
    p11 = -g10 * s + g11 * c
    for i in range(5):
        for j in range(5):
            M[i, j] = 0.0
    M[0, 0] = c * p00
    M[0, 1] = c * p10
    M[0, 2] = s * p00
    M[0, 3] = s * p10
    M[1, 0] = c * p01
    M[1, 1] = c * p11
    M[1, 2] = s * p01
    M[1, 3] = s * p11
    M[2, 0] = -s * p00
    M[2, 1] = -s * p10
    M[2, 2] = c * p00
    M[2, 3] = c * p10
    M[3, 0] = -s * p01
    M[3, 1] = -s * p11
    M[3, 2] = c * p01
    M[3, 3] = c * p11
    M[4, 4] = 1.0 / F[4]
    for i in range(5):
        for j in range(i, 5):
            value = 0.0
            for a in range(5):
                if M[a, i] != 0.0:
                    for b in range(5):
                        value += M[a, i] * S[a, b] * M[b, j]
            A[i, j] = value
            A[j, i] = value
