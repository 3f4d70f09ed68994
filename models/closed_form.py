"""The arithmetic of our closed form, written once.

The same text is compiled into the law's kernels, runs on numpy arrays in the regression, on complex
numbers for derivatives, and is translated to C, Fortran and MATLAB (`models.export`). So it keeps
to assignments of + - * / **, exp, log and sqrt, and to plain numbers in and out; the arguments
after the inputs are pair numbers (`PAIR_NUMBERS`) and coefficients (`COEFFICIENTS`).

Symbols: k_i = (1 - nu_i^2)/E_i and q_i = 1/Sy_i of sphere (s) and flat (f), zero for a body that
does not deform or yield; E' = 1/(k_s + k_f); D = Delta/R. What each line means, and why, is in
docs/closed-form.md.
"""

from __future__ import annotations

from typing import Any

from numba.extending import register_jitable
from numpy import exp, log, sqrt

PI = 3.141592653589793
TINY = 1e-9  # keeps the strengths' ratio defined when a body does not yield

PAIR_NUMBERS = (
    "x_s", "W", "P", "g_a", "g_b", "k", "m", "lag", "fin", "even",
    "j_s", "j_f", "L", "L_C", "a_t", "p",
)  # fmt: skip
"""What `of_pair` returns, in this order."""

COEFFICIENTS = (
    "n", "wy", "c", "b0", "b1", "b2", "b3", "b4", "b5", "z", "c_s", "c_f", "t", "y1", "c_m",
    "h", "B_s", "B_d", "B_f", "r", "B_e", "B_q", "k0", "k1", "k2", "k3", "m0", "m1", "e0", "e1",
    "e2", "g0", "g1", "g2", "g3", "g4", "s0", "s1", "s2", "s3", "s4", "s5", "s6",
    "p0", "p1", "p2", "p3",
    "f1", "f2", "f3", "l1", "l2", "l3", "l4", "d1", "d2", "u1", "u2", "u3", "u4", "u5",
)  # fmt: skip
"""Every coefficient, in the order of the coefficients file."""


def of_pair(
    k_s, k_f, nu_s, nu_f, q_s, q_f,
    n, wy, b0, b1, b2, b3, b4, h, B_q, k0, k1, k2, m0, m1, e1, s0, s1, s2, s3, s4, s5, s6,
    p0, p1, p2, p3, d1, d2,
):  # fmt: skip
    """Numbers of a pair that do not change with the depth.

    Returns
    -------
    tuple
        `PAIR_NUMBERS`: elastic share of the sphere (2.3); W = w/D; P: E' over the pressure of first
        yield; g_a, g_b: transition of the radius, early and late; k, m: of the pressure; lag: of
        the elastic displacement; fin: finite strain of the stiffer body; even: rise of the full
        pressure over a/R where both bodies yield; j_s, j_f: E'/S of each body; L, L_C: logarithms
        of S_s/S_f and C_s/C_f; a_t, p: radius at which the sphere takes over, and how sharply.
    """
    stiff = 1.0 / (k_s + k_f)
    x_s = k_s * stiff
    x_f = k_f * stiff
    C_s = 1.295 * exp(0.736 * nu_s)
    C_f = 1.295 * exp(0.736 * nu_f)
    j_s = stiff * q_s + TINY
    j_f = stiff * q_f + TINY
    i_s = j_s / C_s
    i_f = j_f / C_f
    i_sum = i_s + i_f
    u_s = (i_s / i_sum) ** n
    u_f = (i_f / i_sum) ** n
    v_s = u_s / (u_s + u_f)
    v_f = u_f / (u_s + u_f)
    X = i_sum * (u_s + u_f) ** (1.0 / n) * 2.0 ** (-4.0 * v_s * v_f / n)
    W = (2.0 * X / PI) * (2.0 * X / PI)
    P = 1.5 * X / sqrt(wy)
    e = x_s * v_f * v_f * v_f + x_f * v_s * v_s * v_s
    nu = v_s * nu_s + v_f * nu_f - 0.3
    g_a = b0 * exp(b1 * e)
    g_b = g_a * b2 * exp(b3 * e + b4 * nu)
    k = k0 * exp(k1 * e + k2 * nu)
    m = m0 * exp(m1 * nu)
    lag = exp(d1 * e + d2 * e * e * e * e)
    fin = e1 * (x_s - 0.5)
    even = B_q * 4.0 * v_s * v_f * x_f
    L = log(j_f / j_s)
    L_C = log(C_s / C_f)
    plastic = log(1e-4 * W)
    a_even = s0 * exp(-s3 * plastic - s4 * plastic * plastic + s5 * (x_s - 0.5))
    lead = 0.5 * (L + sqrt(L * L + 9e-4))
    reach = s1 * exp(s2 * log(lead) + s6 * plastic) / a_even
    reach2 = reach * reach
    reach4 = reach2 * reach2
    grow = exp(log(1.0 + reach4 * reach4 * reach4) / 12.0)
    a_t = a_even * grow
    p = p0 * exp(-p2 * plastic - p3 * (x_s - 0.5) + p1 * log(grow))
    return x_s, W, P, g_a, g_b, k, m, lag, fin, even, j_s, j_f, L, L_C, a_t, p


@register_jitable
def plastic_depth(w, wy):
    """Depth beyond first yield in its own units: none before it, w/wy - 1 far beyond."""
    z2 = w / wy * (w / wy)
    z4 = z2 * z2
    return sqrt(sqrt(sqrt(1.0 + z4 * z4))) - 1.0


@register_jitable
def small_radius_at(D, y, g_a, g_b, c, b5):
    """a/R without finite deformation."""
    g = g_b + (g_a - g_b) / (1.0 + y / b5)
    return sqrt(D / (1.0 / c + (1.0 - 1.0 / c) / sqrt(1.0 + g * y)))


@register_jitable
def first_part_at(w, small, x_s, L, L_C, g0, g1, g2, g3, g4):
    """Sphere's part of what is not elastic, before it takes the flow over."""
    lead = L + L_C / (1.0 + w / g3) - g4 * small * sqrt(small)
    odds = g0 * (1.0 + w / g1) ** g2 * lead
    bounded = odds / sqrt(1.0 + 4e-6 * odds * odds)
    return x_s / (x_s + (1.0 - x_s) * exp(bounded))


@register_jitable
def still_flat_at(small, a_t, p):
    """Part of the flat's flow that goes on: 1 until the sphere takes over at a_t."""
    # (1 + (small/a_t)^(2 p))^(-1/p), so written that a sharp p overflows nothing
    power = 2.0 * p * log(small / a_t + 1e-300)
    size = sqrt(power * power + 1e-280)
    return exp(-(0.5 * (power + size) + log(1.0 + exp(-size))) / p)


@register_jitable
def radius_at(D, small, y, first, still, fin, z, c_s, c_f, t, y1, c_m, e2):
    """a/R from that without finite deformation."""
    zeta = c_f + (c_s - c_f) * (1.0 - (1.0 - first) * still)
    small_power = small**t
    large = zeta * small_power / (1.0 + 2.0 * small_power) * y / (y + y1)
    crater = c_m * (1.0 - still) * still * (1.0 - first)
    return small * exp(0.5 * (e2 * fin * D + large + (z * small - crater) * y / (y + 2.0)))


@register_jitable
def force_at(D, a, P, k, m, fin, even, j_s, j_f, h, B_s, B_d, B_f, r, B_e, k3, e0):
    """F/(E' R^2) from the contact radius."""
    elastic = 4.0 / (3.0 * PI) * a * exp(e0 * sqrt(D) + fin * D)
    load2 = P * elastic * (P * elastic)
    load4 = load2 * load2
    q = sqrt(sqrt(sqrt(1.0 + load4 * load4))) - 1.0
    a_power = a**r
    a2 = a * a
    a4 = a2 * a2
    # bounded: beyond a/R = 0.5, where no data reach, the force must not collapse without end
    collapse = a4 * a4 / (1.0 + 50.0 * a4 * a4)
    J_s = j_s * exp(B_s * a_power / (1.0 + B_d * a_power) + B_e * collapse - even * a)
    J_f = j_f * exp(B_f * a_power - even * a)
    J = J_s + J_f
    weight_s2 = J_s * J_s / (J * J)
    weight_s4 = weight_s2 * weight_s2
    weight_s8 = weight_s4 * weight_s4
    weight_s16 = weight_s8 * weight_s8
    weight_f2 = J_f * J_f / (J * J)
    weight_f4 = weight_f2 * weight_f2
    weight_f8 = weight_f4 * weight_f4
    weight_f16 = weight_f8 * weight_f8
    both = weight_s16 * weight_s16 + weight_f16 * weight_f16
    equal = weight_s16 * weight_f16 / both * (weight_s16 * weight_f16 / both)
    weak = J * sqrt(sqrt(sqrt(sqrt(sqrt(both))))) * (1.0 - 0.08664339756999316 * equal)
    q_power = (q + 1e-30) ** m
    soft = 1.0 + weak / (P * h) * q * q_power / (q_power + k * exp(-k3 * a))
    return PI * a * a * elastic / soft


@register_jitable
def share_at(D, y, F, a, phi, x_s, lag, f1, f2, f3):
    """delta_s*, the sphere's share of the approach."""
    f_power = (y + 1e-30) ** f2
    recoverable = (0.75 - f1 * f_power / (f_power + f3 * lag)) * F / (a * D)
    return phi + recoverable * (x_s - phi)


@register_jitable
def permanent_at(D, y, F, a, phi, lag, fin, e0, e2, f3, l1, l2, l3, l4):
    """Permanent approach over the largest one."""
    l_power = (y + 1e-30) ** l2
    recoverable = (0.75 - l1 * l_power / (l_power + f3 * lag)) * F / (a * D)
    recoverable = recoverable * exp(l3 * (1.0 - phi) * y / (y + l4))
    return 1.0 - recoverable * exp(-e0 * sqrt(D) - (1.0 + e2) * fin * D)


@register_jitable
def exponent_at(y, a, phi, u1, u2, u3, u4, u5):
    """Exponent N of the unloading curve F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N."""
    return 1.5 - y / (y + u2) * (u1 / (1.0 + y / u3) + u4) + u5 * (1.0 - phi) * a * a


@register_jitable
def contact(
    D,
    x_s, W, P, g_a, g_b, k, m, lag, fin, even, j_s, j_f, L, L_C, a_t, p,
    wy, c, b5, z, c_s, c_f, t, y1, c_m, h, B_s, B_d, B_f, r, B_e, k3, e0, e2, g0, g1, g2, g3, g4,
    f1, f2, f3, l1, l2, l3, l4, u1, u2, u3, u4, u5,
):  # fmt: skip
    """Everything at a depth D = Delta/R of first loading.

    Returns
    -------
    tuple
        F/(E' R^2), a/R, delta_s*, permanent approach over Delta and the sphere's part of it, the
        exponent of the unloading curve.
    """
    w = W * D
    y = plastic_depth(w, wy)
    small = small_radius_at(D, y, g_a, g_b, c, b5)
    first = first_part_at(w, small, x_s, L, L_C, g0, g1, g2, g3, g4)
    still = still_flat_at(small, a_t, p)
    phi = 1.0 - (1.0 - first) * still
    a = radius_at(D, small, y, first, still, fin, z, c_s, c_f, t, y1, c_m, e2)
    F = force_at(D, a, P, k, m, fin, even, j_s, j_f, h, B_s, B_d, B_f, r, B_e, k3, e0)
    share = share_at(D, y, F, a, phi, x_s, lag, f1, f2, f3)
    left = permanent_at(D, y, F, a, phi, lag, fin, e0, e2, f3, l1, l2, l3, l4)
    N = exponent_at(y, a, phi, u1, u2, u3, u4, u5)
    return F, a, share, left, phi, N


def arguments_of(function: Any) -> tuple[str, ...]:
    """Names of the arguments of one of the functions above."""
    code = function.__code__
    return tuple(code.co_varnames[: code.co_argcount])
