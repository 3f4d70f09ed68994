"""The arithmetic of our closed form, written once.

The same text is compiled into the law's kernels, runs on numpy arrays in the regression, on complex
numbers for derivatives, and is translated to C, Fortran and MATLAB (`models.export`). So it keeps
to assignments of + - * / **, exp and sqrt, and to plain numbers in and out; the arguments after the
inputs are pair numbers (`PAIR_NUMBERS`) and coefficients (`COEFFICIENTS`).

Symbols: k_i = (1 - nu_i^2)/E_i and q_i = 1/Sy_i of sphere (s) and flat (f), zero for a body that
does not deform or yield; E' = 1/(k_s + k_f); D = Delta/R. What each line means, and why, is in
docs/closed-form.md.
"""

from __future__ import annotations

from typing import Any

from numba.extending import register_jitable
from numpy import exp, sqrt

PI = 3.141592653589793
TINY = 1e-9  # keeps the weights of the two bodies defined when neither yields

PAIR_NUMBERS = (
    "x_s", "W", "alpha", "beta", "gamma", "e0", "lag", "r_s", "r_f", "C_r",
)  # fmt: skip
"""What `of_pair` returns, in this order."""

COEFFICIENTS = (
    "n", "wy", "m", "A", "a0", "a1", "e_s", "e_f", "h_s", "h_f", "r", "y0",
    "c", "b0", "b1", "c_s", "c_f", "t", "y1",
    "g0", "g1", "g2", "g3", "g4", "g5", "k1", "k2", "r1", "r2", "d1", "u1", "u2", "u3",
)  # fmt: skip
"""Every coefficient, in the order of the coefficients file."""


def of_pair(
    k_s, k_f, nu_s, nu_f, q_s, q_f,
    n, wy, A, a0, a1, e_s, e_f, b0, b1, d1,
):  # fmt: skip
    """Numbers of a pair that do not change with the depth.

    Returns
    -------
    tuple
        `PAIR_NUMBERS`: elastic share of the sphere (2.3); W = w/D; alpha, beta: transition of the
        force; gamma: transition of the radius; e0: finite elastic strain in the force; lag: of the
        pressure's change behind first yield; r_s, r_f: 1/S of each body over the sum of both;
        C_r = C_f/C_s.
    """
    stiff = 1.0 / (k_s + k_f)
    x_s = k_s * stiff
    x_f = k_f * stiff
    C_s = 1.295 * exp(0.736 * nu_s)
    C_f = 1.295 * exp(0.736 * nu_f)
    i_s = stiff * q_s / C_s + TINY
    i_f = stiff * q_f / C_f + TINY
    i_sum = i_s + i_f
    u_s = (i_s / i_sum) ** n
    u_f = (i_f / i_sum) ** n
    v_s = u_s / (u_s + u_f)
    v_f = u_f / (u_s + u_f)
    equal = 4.0 * v_s * v_f
    X = i_sum * (u_s + u_f) ** (1.0 / n) * 2.0 ** (-equal / n)
    W = (2.0 * X / PI) ** 2
    elastic = 1.0 - x_s * (1.0 - v_f**4) - x_f * (1.0 - v_s**4)
    alpha = a0 + a1 * elastic
    slope = A * (v_s * C_s + v_f * C_f) / alpha
    beta = wy * slope * slope
    gamma = wy / b0 * exp(-b1 * elastic)
    e0 = e_s * x_s + e_f * x_f
    lag = exp(d1 * elastic)
    j_s = stiff * q_s + TINY
    j_f = stiff * q_f + TINY
    r_s = j_s / (j_s + j_f)
    r_f = j_f / (j_s + j_f)
    C_r = C_f / C_s
    return x_s, W, alpha, beta, gamma, e0, lag, r_s, r_f, C_r


@register_jitable
def plastic_depth(D, W, wy, m):
    """Depth beyond first yield in its own units: none before it, w/wy - 1 far beyond."""
    z = (W * D / wy) ** m
    return (1.0 + z) ** (1.0 / m) - 1.0


@register_jitable
def plastic_part_at(D, W, x_s, r_s, r_f, C_r, g0, g1, g2, g3, g4, g5):
    """Sphere's part of what is not elastic."""
    w = W * D
    G = g0 * (1.0 + w / g3) ** g4
    p_s = x_s * r_s**G * exp(G * g1 * D**g5) * C_r ** (g0 / (1.0 + w / g2))
    p_f = (1.0 - x_s) * r_f**G
    return p_s / (p_s + p_f)


@register_jitable
def force_at(D, y, phi, alpha, beta, e0, h_s, h_f, r, y0):
    """F/(E' R^2)."""
    eta = h_f + (h_s - h_f) * phi
    soft = 1.0 + alpha * (sqrt(1.0 + beta * y) - 1.0)
    large = exp(e0 * sqrt(D) - eta * D**r * y / (y + y0))
    return 4.0 / 3.0 * D * sqrt(D) * large / soft


@register_jitable
def radius_at(D, y, phi, gamma, c, c_s, c_f, t, y1):
    """a/R."""
    zeta = c_f + (c_s - c_f) * phi
    sink = 1.0 / c + (1.0 - 1.0 / c) / sqrt(1.0 + gamma * y)
    return sqrt(D / sink * exp(zeta * D**t * y / (y + y1)))


@register_jitable
def share_at(D, y, F, a, phi, x_s, lag, k1, k2):
    """delta_s*, the sphere's share of the approach."""
    elastic = (0.75 - k1 * y / (y + k2 * lag)) * F / (a * D)
    return phi + elastic * (x_s - phi)


@register_jitable
def permanent_at(D, y, F, a, e0, lag, r1, r2):
    """Permanent approach over the largest one."""
    return 1.0 - (0.75 - r1 * y / (y + r2 * lag)) * F * exp(-e0 * sqrt(D)) / (a * D)


@register_jitable
def exponent_at(y, u1, u2, u3):
    """Exponent N of the unloading curve F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N."""
    return 1.5 - u1 * y / ((y + u2) * (1.0 + y / u3))


@register_jitable
def contact(
    D,
    x_s, W, alpha, beta, gamma, e0, lag, r_s, r_f, C_r,
    wy, m, h_s, h_f, r, y0, c, c_s, c_f, t, y1,
    g0, g1, g2, g3, g4, g5, k1, k2, r1, r2, u1, u2, u3,
):  # fmt: skip
    """Everything at a depth D = Delta/R of first loading.

    Returns
    -------
    tuple
        F/(E' R^2), a/R, delta_s*, permanent approach over Delta and the sphere's part of it, the
        exponent of the unloading curve.
    """
    y = plastic_depth(D, W, wy, m)
    phi = plastic_part_at(D, W, x_s, r_s, r_f, C_r, g0, g1, g2, g3, g4, g5)
    F = force_at(D, y, phi, alpha, beta, e0, h_s, h_f, r, y0)
    a = radius_at(D, y, phi, gamma, c, c_s, c_f, t, y1)
    share = share_at(D, y, F, a, phi, x_s, lag, k1, k2)
    left = permanent_at(D, y, F, a, e0, lag, r1, r2)
    N = exponent_at(y, u1, u2, u3)
    return F, a, share, left, phi, N


def arguments_of(function: Any) -> tuple[str, ...]:
    """Names of the arguments of one of the functions above."""
    code = function.__code__
    return tuple(code.co_varnames[: code.co_argcount])
