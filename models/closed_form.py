"""The arithmetic of our closed form, written once.

The same text is compiled into the law's kernels, runs on numpy arrays in the regression, on complex
numbers for derivatives, and is translated to C, Fortran and MATLAB (`models.export`). So it keeps
to assignments of + - * / **, exp, log and sqrt of plain numbers and of the fields of the tuples
below; a function is called with arguments of the names that it gives them itself.

Symbols: k_i = (1 - nu_i^2)/E_i and q_i = 1/Sy_i of sphere (s) and flat (f), zero for a body that
does not deform or yield; E' = 1/(k_s + k_f); D = Delta/R. What each line means, and why, is in
docs/closed-form.md.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any, NamedTuple

from numba.extending import register_jitable
from numpy import exp, log, sqrt

PI = 3.141592653589793
TINY = 1e-9  # keeps the strengths' ratio defined when a body does not yield


class Bodies(NamedTuple):
    """Both bodies of a pair; each field a number or an array."""

    k_s: Any
    k_f: Any
    nu_s: Any
    nu_f: Any
    q_s: Any
    q_f: Any


class PairNumbers(NamedTuple):
    """What the form needs of a pair at every depth; each field a number or an array."""

    x_s: Any  # elastic share of the sphere (2.3)
    W: Any  # w/D
    P: Any  # E' over the pressure of first yield
    g_a: Any  # transition of the radius, early
    g_b: Any  # and late
    k: Any  # transition of the pressure: where
    m: Any  # and how sharp
    lag: Any  # of the elastic displacement
    fin: Any  # finite strain of the stiffer body
    even: Any  # rise of the full pressure over a/R where both bodies yield
    j_s: Any  # E'/S of the sphere
    j_f: Any  # and of the flat
    L: Any  # logarithm of S_s/S_f
    L_C: Any  # logarithm of C_s/C_f
    a_t: Any  # radius over R at which the sphere takes over
    p: Any  # and how sharply


class Spread(NamedTuple):
    """How far the contact has spread at one depth."""

    y: Any  # depth beyond first yield, in its own units
    phi: Any  # the sphere's part of the plastic flow
    a: Any  # contact radius over R


class Contact(NamedTuple):
    """The contact at one depth; each field a number or an array."""

    F: Any  # force over E' R^2
    a: Any  # contact radius over R
    share: Any  # delta_s*
    left: Any  # permanent approach over Delta
    phi: Any  # the sphere's part of it
    N: Any  # exponent of the unloading curve


Coefficients = namedtuple(
    "Coefficients",
    "n wy c b0 b1 b2 b3 b4 b5 z c_s c_f t y1 c_m h B_s B_d B_f r B_e B_q k0 k1 k2 k3 m0 m1 "
    "e0 e1 e2 g0 g1 g2 g3 g4 s0 s1 s2 s3 s4 s5 s6 p0 p1 p2 p3 f1 f2 f3 l1 l2 l3 l4 d1 d2 "
    "u1 u2 u3 u4 u5",
)
"""What the regression finds, in the order of the coefficients file."""

COEFFICIENTS = Coefficients._fields
"""Name of every coefficient."""

TUPLES = ("PairNumbers", "Spread", "Contact")
ELEMENTARY = ("exp", "log", "sqrt")
"""What the functions below may return, and what they may call beside each other."""


def of_pair(bodies: Bodies, co: Any) -> PairNumbers:
    """Numbers of a pair that do not change with the depth; `co` are the coefficients."""
    stiff = 1.0 / (bodies.k_s + bodies.k_f)
    x_s = bodies.k_s * stiff
    x_f = bodies.k_f * stiff
    C_s = 1.295 * exp(0.736 * bodies.nu_s)
    C_f = 1.295 * exp(0.736 * bodies.nu_f)
    j_s = stiff * bodies.q_s + TINY
    j_f = stiff * bodies.q_f + TINY
    i_s = j_s / C_s
    i_f = j_f / C_f
    i_sum = i_s + i_f
    u_s = (i_s / i_sum) ** co.n
    u_f = (i_f / i_sum) ** co.n
    v_s = u_s / (u_s + u_f)
    v_f = u_f / (u_s + u_f)
    X = i_sum * (u_s + u_f) ** (1.0 / co.n) * 2.0 ** (-4.0 * v_s * v_f / co.n)
    W = (2.0 * X / PI) * (2.0 * X / PI)
    P = 1.5 * X / sqrt(co.wy)
    e = x_s * v_f * v_f * v_f + x_f * v_s * v_s * v_s
    nu = v_s * bodies.nu_s + v_f * bodies.nu_f - 0.3
    g_a = co.b0 * exp(co.b1 * e)
    g_b = g_a * co.b2 * exp(co.b3 * e + co.b4 * nu)
    k = co.k0 * exp(co.k1 * e + co.k2 * nu)
    m = co.m0 * exp(co.m1 * nu)
    lag = exp(co.d1 * e + co.d2 * e * e * e * e)
    fin = co.e1 * (x_s - 0.5)
    even = co.B_q * 4.0 * v_s * v_f * x_f
    L = log(j_f / j_s)
    L_C = log(C_s / C_f)
    plastic = log(1e-4 * W)
    a_even = co.s0 * exp(-co.s3 * plastic - co.s4 * plastic * plastic + co.s5 * (x_s - 0.5))
    lead = 0.5 * (L + sqrt(L * L + 9e-4))
    reach = co.s1 * exp(co.s2 * log(lead) + co.s6 * plastic) / a_even
    reach2 = reach * reach
    reach4 = reach2 * reach2
    grow = exp(log(1.0 + reach4 * reach4 * reach4) / 12.0)
    a_t = a_even * grow
    p = co.p0 * exp(-co.p2 * plastic - co.p3 * (x_s - 0.5) + co.p1 * log(grow))
    return PairNumbers(x_s, W, P, g_a, g_b, k, m, lag, fin, even, j_s, j_f, L, L_C, a_t, p)


@register_jitable
def plastic_depth(w, co):
    """Depth beyond first yield in its own units: none before it, w/wy - 1 far beyond."""
    z2 = w / co.wy * (w / co.wy)
    z4 = z2 * z2
    return sqrt(sqrt(sqrt(1.0 + z4 * z4))) - 1.0


@register_jitable
def small_radius_at(D, y, pair, co):
    """a/R without finite deformation."""
    g = pair.g_b + (pair.g_a - pair.g_b) / (1.0 + y / co.b5)
    return sqrt(D / (1.0 / co.c + (1.0 - 1.0 / co.c) / sqrt(1.0 + g * y)))


@register_jitable
def first_part_at(w, small, pair, co):
    """Sphere's part of what is not elastic, before it takes the flow over."""
    lead = pair.L + pair.L_C / (1.0 + w / co.g3) - co.g4 * small * sqrt(small)
    odds = co.g0 * (1.0 + w / co.g1) ** co.g2 * lead
    bounded = odds / sqrt(1.0 + 4e-6 * odds * odds)
    return pair.x_s / (pair.x_s + (1.0 - pair.x_s) * exp(bounded))


@register_jitable
def still_flat_at(small, pair):
    """Part of the flat's flow that goes on: 1 until the sphere takes over at a_t."""
    # (1 + (small/a_t)^(2 p))^(-1/p), so written that a sharp p overflows nothing
    power = 2.0 * pair.p * log(small / pair.a_t + 1e-300)
    size = sqrt(power * power + 1e-280)
    return exp(-(0.5 * (power + size) + log(1.0 + exp(-size))) / pair.p)


@register_jitable
def radius_at(D, small, y, first, still, pair, co):
    """a/R from that without finite deformation."""
    zeta = co.c_f + (co.c_s - co.c_f) * (1.0 - (1.0 - first) * still)
    small_power = small**co.t
    large = zeta * small_power / (1.0 + 2.0 * small_power) * y / (y + co.y1)
    crater = co.c_m * (1.0 - still) * still * (1.0 - first)
    return small * exp(
        0.5 * (co.e2 * pair.fin * D + large + (co.z * small - crater) * y / (y + 2.0))
    )


@register_jitable
def force_at(D, a, pair, co):
    """F/(E' R^2) from the contact radius."""
    elastic = 4.0 / (3.0 * PI) * a * exp(co.e0 * sqrt(D) + pair.fin * D)
    load2 = pair.P * elastic * (pair.P * elastic)
    load4 = load2 * load2
    q = sqrt(sqrt(sqrt(1.0 + load4 * load4))) - 1.0
    a_power = a**co.r
    a2 = a * a
    a4 = a2 * a2
    # bounded: beyond a/R = 0.5, where no data reach, the force must not collapse without end
    collapse = a4 * a4 / (1.0 + 50.0 * a4 * a4)
    J_s = pair.j_s * exp(
        co.B_s * a_power / (1.0 + co.B_d * a_power) + co.B_e * collapse - pair.even * a
    )
    J_f = pair.j_f * exp(co.B_f * a_power - pair.even * a)
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
    q_power = (q + 1e-30) ** pair.m
    soft = 1.0 + weak / (pair.P * co.h) * q * q_power / (q_power + pair.k * exp(-co.k3 * a))
    return PI * a * a * elastic / soft


@register_jitable
def share_at(D, y, F, a, phi, pair, co):
    """delta_s*, the sphere's share of the approach."""
    f_power = (y + 1e-30) ** co.f2
    recoverable = (0.75 - co.f1 * f_power / (f_power + co.f3 * pair.lag)) * F / (a * D)
    return phi + recoverable * (pair.x_s - phi)


@register_jitable
def permanent_at(D, y, F, a, phi, pair, co):
    """Permanent approach over the largest one."""
    l_power = (y + 1e-30) ** co.l2
    recoverable = (0.75 - co.l1 * l_power / (l_power + co.f3 * pair.lag)) * F / (a * D)
    recoverable = recoverable * exp(co.l3 * (1.0 - phi) * y / (y + co.l4))
    return 1.0 - recoverable * exp(-co.e0 * sqrt(D) - (1.0 + co.e2) * pair.fin * D)


@register_jitable
def elastic_work_at(lift, rise):
    """Work of loading an elastic body over F Delta; 2/5 for Hertz.

    The integral over 2 tau^4 exp[-lift (1 - tau) - rise (1 - tau^2)], tau^2 = depth/D from 0 to 1,
    by the five points of Gauss and Jacobi; its error is below 1e-11 up to D = 0.2, 1e-7 at 1.
    """
    return (
        0.12471059717856033 * exp(-0.027385581465734443 * lift - 0.054021192859252554 * rise)
        + 0.16542542620387934 * exp(-0.13911365632355732 * lift - 0.2588747032714058 * rise)
        + 0.08804893901076577 * exp(-0.31994076725899045 * lift - 0.5375194399637094 * rise)
        + 0.020421083450944417 * exp(-0.5390663254684844 * lift - 0.787540147682875 * rise)
        + 0.001393954155850188 * exp(-0.760207955197519 * lift - 0.942499775249445 * rise)
    )


@register_jitable
def exponent_at(D, y, F, a, phi, left, pair, co):
    """Exponent N of the unloading curve F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N.

    An elastic body gives back the work of its loading. Of what a permanent depth costs, a body that
    has yielded saves the part `back`, which stays below 1, so that no cycle creates energy.
    """
    lift = co.e0 * sqrt(D)
    rise = (1.0 + 1.5 * co.e2) * pair.fin * D
    work = elastic_work_at(lift, rise)
    # just beyond yield the force may exceed an elastic body's; what is above was not spent before
    excess = F / (4.0 / 3.0 * D * sqrt(D) * exp(lift + rise)) - 1.0
    above = 0.5 * (excess + sqrt(excess * excess))
    far = y / co.u3
    late = co.u2 / (1.0 + far * far) + co.u4
    back = late + (0.9 - co.u2 - co.u4) / (1.0 + y / co.u1) - co.u5 * (1.0 - phi) * a * a
    return (1.0 + above) * (1.0 - back * left) / work - 1.0


@register_jitable
def spread_at(D, pair, co):
    """How far the contact has spread: depth beyond yield, the sphere's part of the flow, a/R."""
    w = pair.W * D
    y = plastic_depth(w, co)
    small = small_radius_at(D, y, pair, co)
    first = first_part_at(w, small, pair, co)
    still = still_flat_at(small, pair)
    phi = 1.0 - (1.0 - first) * still
    a = radius_at(D, small, y, first, still, pair, co)
    return Spread(y, phi, a)


@register_jitable
def contact(D, pair, co):
    """Everything at a depth D = Delta/R of first loading."""
    y, phi, a = spread_at(D, pair, co)
    F = force_at(D, a, pair, co)
    share = share_at(D, y, F, a, phi, pair, co)
    left = permanent_at(D, y, F, a, phi, pair, co)
    N = exponent_at(D, y, F, a, phi, left, pair, co)
    return Contact(F, a, share, left, phi, N)
