"""The arithmetic of our closed forms, written once.

The same text is compiled into the laws' kernels, runs on numpy arrays in the regression, on complex
numbers for derivatives, and is translated to other languages (`models.export`). So it keeps to
assignments of + - * / **, exp, log and sqrt of plain numbers and of the fields of the tuples below;
a function is called in a statement of its own.

`contact` draws the curves of one pair from its numbers. The compact law has these numbers by
`of_pair` from its coefficients; the fitted law moves them from there (`models.correction`). Limits,
bounds and energy balance hold for any of them, so that both laws keep them.

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
# limit: keeps the strengths' ratio defined when a body does not yield [-]: no effect on any real
# pair
TINY = 1e-9
SHARPEST = 20.0


class Bodies(NamedTuple):
    """Both bodies of a pair; each field a number or an array."""

    k_s: Any
    k_f: Any
    nu_s: Any
    nu_f: Any
    q_s: Any
    q_f: Any


class PairNumbers(NamedTuple):
    """What the curves need of a pair at every depth; each field a number or an array.

    The first seven follow from the bodies alone; the others are what the laws differ in.
    """

    x_s: Any  # elastic share of the sphere (2.3)
    W: Any  # w/D
    P: Any  # E' over the pressure of first yield
    j_s: Any  # E'/S of the sphere
    j_f: Any  # and of the flat
    L: Any  # logarithm of S_s/S_f
    L_C: Any  # logarithm of C_s/C_f
    fin: Any  # finite strain of the stiffer body
    c: Any  # radius: a^2 over R Delta of full plasticity
    g_a: Any  # its transition, early
    g_b: Any  # and late
    g_t: Any  # by what part it rises in the end
    y_b: Any  # and the depth of its early part
    z: Any  # its rise with the radius
    c_s: Any  # its lag where the sphere flows
    c_f: Any  # and where the flat does
    t: Any  # with this power of the radius
    y_c: Any  # from this depth on
    c_m: Any  # what a crater takes off it
    h: Any  # pressure: of full plasticity over S
    B_s: Any  # its fall over the radius where the sphere flows
    B_f: Any  # and where the flat does
    r: Any  # with this power of the radius
    B_e: Any  # collapse of a flattened sphere
    even: Any  # rise where both bodies yield
    k: Any  # its rise: with the logarithm of the load
    m: Any  # how that bends
    k_a: Any  # and how much less it is at a larger radius
    g_0: Any  # share: sharpness of first yield
    g_2: Any  # how it grows
    g_4: Any  # what the radius takes off the flat's lead
    a_t: Any  # radius over R at which the sphere takes over
    p: Any  # and how sharply
    f_1: Any  # elastic displacement: what plastic flow takes off it
    lag: Any  # and when
    l_0: Any  # permanent depth: when plastic flow
    l_1: Any  # takes this off the recovery
    l_2: Any  # with this power of the depth
    l_3: Any  # and what a crater gives back beside
    u_1: Any  # unloading: depth up to which the recovery stays elastic
    u_2: Any  # what is saved then
    u_4: Any  # what is saved in the end
    u_5: Any  # and what the wall of a crater takes off it


class Groups(NamedTuple):
    """Coordinates of a pair in which the fitted law's correction varies, each about one wide."""

    strengths: Any  # logarithm of the strengths' ratio, finest where they are equal
    stiffness: Any  # logarithm of E' over the lower strength
    elastic_share: Any
    nu_weak: Any  # Poisson's ratio of the body that yields
    nu_strong: Any  # and of the other


class StrengthSpread(NamedTuple):
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
    "b0 b1 b2 b3 b4 z c_s c_f h B_s B_f B_e k0 k1 k2 m0 m1 g0 g2 g4 s0 s2 s3 p0 p1 f1 f3 l1 u2 u4",
)
"""What the regression of the compact law finds, in the order of the coefficients file."""

COEFFICIENTS = Coefficients._fields
"""Name of every coefficient."""

TUPLES = ("PairNumbers", "Groups", "StrengthSpread", "Contact")
ELEMENTARY = ("exp", "log", "sqrt")
"""What the functions below may return, and what they may call beside each other."""


def of_pair(bodies: Bodies, co: Any) -> PairNumbers:
    """Numbers of a pair by the compact law; `co` are its coefficients."""
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
    u_s = (i_s / i_sum) ** 8.0
    u_f = (i_f / i_sum) ** 8.0
    v_s = u_s / (u_s + u_f)
    v_f = u_f / (u_s + u_f)
    X = i_sum * (u_s + u_f) ** 0.125 * 2.0 ** (-0.5 * v_s * v_f)
    W = (2.0 * X / PI) * (2.0 * X / PI)
    P = 1.5 * X / sqrt(1.35)
    L = log(j_f / j_s)
    L_C = log(C_s / C_f)
    fin = 2.5 * (x_s - 0.5)
    e = x_s * v_f * v_f * v_f + x_f * v_s * v_s * v_s
    nu = v_s * bodies.nu_s + v_f * bodies.nu_f - 0.3
    g_a = co.b0 * exp(co.b1 * e)
    g_b = g_a * co.b2 * exp(co.b3 * e + co.b4 * nu)
    k = co.k0 * exp(co.k1 * e + co.k2 * nu)
    m = co.m0 + co.m1 * e
    l_0 = 1.65 * exp(e + 0.6 * (e - 0.5) * (e - 0.5))
    plastic = log(1e-4 * W)
    a_even = co.s0 * exp(-co.s3 * plastic)
    lead = 0.5 * (L + sqrt(L * L + 9e-4))
    reach = exp(co.s2 * log(lead)) / a_even
    reach2 = reach * reach
    reach4 = reach2 * reach2
    grow = log(1.0 + reach4 * reach4 * reach4) / 12.0
    a_t = a_even * exp(grow)
    p = co.p0 * exp(co.p1 * grow)
    return PairNumbers(
        x_s, W, P, j_s, j_f, L, L_C, fin, 2.86, g_a, g_b, 2.0 * e, 6.5,
        co.z, co.c_s, co.c_f, 2.5, 80.0, 0.0, co.h, co.B_s, co.B_f, 1.75, co.B_e, 0.0, k, m, 0.0,
        co.g0, co.g2, co.g4, a_t, p, co.f1, co.f3, l_0, co.l1, 0.82, 0.0, 0.2, co.u2, co.u4, 0.25,
    )  # fmt: skip


def groups_of(bodies: Bodies, pair: PairNumbers) -> Groups:
    """Coordinates of a pair for the correction."""
    far = pair.L / 0.15
    s2 = pair.j_s * pair.j_s
    f2 = pair.j_f * pair.j_f
    part = s2 * s2 / (s2 * s2 + f2 * f2)
    strengths = log(far + sqrt(far * far + 1.0)) / 1.2
    stiffness = (0.5 * log(pair.W) - 5.0) / 1.2
    elastic_share = (pair.x_s - 0.5) / 0.22
    nu_weak = (part * bodies.nu_s + (1.0 - part) * bodies.nu_f - 0.3) / 0.08
    nu_strong = (part * bodies.nu_f + (1.0 - part) * bodies.nu_s - 0.3) / 0.08
    return Groups(strengths, stiffness, elastic_share, nu_weak, nu_strong)


@register_jitable
def plastic_depth(w):
    """Depth beyond first yield in its own units: none before it, w/wy - 1 far beyond."""
    z2 = w / 1.35 * (w / 1.35)
    z4 = z2 * z2
    return sqrt(sqrt(sqrt(1.0 + z4 * z4))) - 1.0


@register_jitable
def small_radius_at(D, y, pair):
    """a/R without finite deformation."""
    early = 1.0 / (1.0 + y / pair.y_b)
    g = (pair.g_b + (pair.g_a - pair.g_b) * early) * (1.0 - 0.75 * early)
    g = g * (1.0 + pair.g_t * y / (y + 230.0))
    return sqrt(D / (1.0 / pair.c + (1.0 - 1.0 / pair.c) / sqrt(1.0 + g * y)))


@register_jitable
def first_part_at(w, small, pair):
    """Sphere's part of what is not elastic, before it takes the flow over."""
    lead = pair.L + pair.L_C / (1.0 + w / 50.0) - pair.g_4 * small * sqrt(small)
    odds = pair.g_0 * (1.0 + w / 600.0) ** pair.g_2 * lead
    bounded = odds / sqrt(1.0 + 4e-6 * odds * odds)
    return pair.x_s / (pair.x_s + (1.0 - pair.x_s) * exp(bounded))


@register_jitable
def still_flat_at(small, pair):
    """Part of the flat's flow that goes on: 1 until the sphere takes over at a_t."""
    sharp = pair.p / sqrt(1.0 + pair.p * pair.p / (SHARPEST * SHARPEST))
    # (1 + (small/a_t)^(2 sharp))^(-1/sharp), so written that it overflows nothing
    power = 2.0 * sharp * log(small / pair.a_t + 1e-300)
    size = sqrt(power * power + 1e-280)
    return exp(-(0.5 * (power + size) + log(1.0 + exp(-size))) / sharp)


@register_jitable
def within_data(reach):
    """A radius over R up to 0.55; beyond, where no data are, it stays, and what follows it."""
    r2 = reach / 0.62 * (reach / 0.62)
    r4 = r2 * r2
    r8 = r4 * r4
    return reach / sqrt(sqrt(sqrt(sqrt(1.0 + r8 * r8))))


@register_jitable
def radius_at(small, y, first, still, pair):
    """a/R from that without finite deformation."""
    zeta = pair.c_f + (pair.c_s - pair.c_f) * (1.0 - (1.0 - first) * still)
    near = within_data(small)
    small_power = near**pair.t
    large = zeta * small_power / (1.0 + 2.0 * small_power) * y / (y + pair.y_c)
    crater = pair.c_m * (1.0 - still) * still * (1.0 - first)
    return small * exp(0.5 * (large + (pair.z * small - crater) * y / (y + 2.0)))


@register_jitable
def force_at(D, a, pair):
    """F/(E' R^2) from the contact radius."""
    elastic = 4.0 / (3.0 * PI) * a * exp(0.31 * sqrt(D) + pair.fin * D)
    load2 = pair.P * elastic * (pair.P * elastic)
    load4 = load2 * load2
    q = sqrt(sqrt(sqrt(1.0 + load4 * load4))) - 1.0
    near = within_data(a)
    near2 = near * near
    near4 = near2 * near2
    collapse = near4 * near4 / (1.0 + 50.0 * near4 * near4)
    power = near**pair.r
    J_s = pair.j_s * exp(pair.B_s * power + pair.B_e * collapse - pair.even * near)
    J_f = pair.j_f * exp(pair.B_f * power - pair.even * near)
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
    # beyond first yield the pressure rises with the logarithm of the load, up to full plasticity
    c = pair.k * exp(-pair.k_a * near)
    far = log(1.0 + q / c)
    bend = sqrt(pair.m * pair.m + 4e-4)
    slope = (1.0 + 0.25 * (bend + pair.m) * far) / (1.0 + 0.25 * (bend - pair.m) * far)
    rising = elastic * (1.0 + c * far * slope) / (1.0 + q)
    full2 = rising * weak / pair.h * (rising * weak / pair.h)
    full4 = full2 * full2
    full8 = full4 * full4
    return PI * a * a * rising / sqrt(sqrt(sqrt(sqrt(1.0 + full8 * full8))))


@register_jitable
def share_at(D, y, F, a, phi, pair):
    """delta_s*, the sphere's share of the approach."""
    kappa = 0.75 - pair.f_1 * y / (y + pair.lag)
    flow = 1.0 - kappa * F / (a * D) * exp(-0.31 * sqrt(D) - pair.fin * D)
    # what flows is never negative, which keeps the share between phi and x_s
    flow = 0.5 * (flow + sqrt(flow * flow + 1e-16))
    return pair.x_s + flow * (phi - pair.x_s)


@register_jitable
def permanent_at(D, y, F, a, phi, pair):
    """Permanent approach over the largest one."""
    l_power = (y + 1e-30) ** pair.l_2
    psi = 0.75 - pair.l_1 * l_power / (l_power + pair.l_0) + 0.08 * y / (y + 160.0)
    psi = psi * exp((pair.l_3 * (1.0 - phi) - 0.2 * phi * a) * y / (y + 100.0))
    recoverable = psi * F / (a * D)
    return 1.0 - recoverable * exp(-0.31 * sqrt(D) - pair.fin * D)


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
def exponent_at(D, y, F, a, phi, left, pair):
    """Exponent N of the unloading curve F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N.

    An elastic body gives back the work of its loading. Of what a permanent depth costs, a body that
    has yielded saves the part `back`, which stays below 1, so that no cycle creates energy.
    """
    lift = 0.31 * sqrt(D)
    rise = pair.fin * D
    work = elastic_work_at(lift, rise)
    # just beyond yield the force may exceed an elastic body's; what is above was not spent before
    excess = F / (4.0 / 3.0 * D * sqrt(D) * exp(lift + rise)) - 1.0
    above = 0.5 * (excess + sqrt(excess * excess))
    far = y / 50.0
    late = pair.u_2 / (1.0 + far * far) + pair.u_4
    back = (
        late + (0.9 - pair.u_2 - pair.u_4) / (1.0 + y / pair.u_1) - pair.u_5 * (1.0 - phi) * a * a
    )
    return (1.0 + above) * (1.0 - back * left) / work - 1.0


@register_jitable
def spread_at(D, pair):
    """How far the contact has spread: depth beyond yield, the sphere's part of the flow, a/R."""
    w = pair.W * D
    y = plastic_depth(w)
    small = small_radius_at(D, y, pair)
    first = first_part_at(w, small, pair)
    still = still_flat_at(small, pair)
    phi = 1.0 - (1.0 - first) * still
    a = radius_at(small, y, first, still, pair)
    return StrengthSpread(y, phi, a)


@register_jitable
def contact(D, pair):
    """Everything at a depth D = Delta/R of first loading."""
    y, phi, a = spread_at(D, pair)
    F = force_at(D, a, pair)
    share = share_at(D, y, F, a, phi, pair)
    left = permanent_at(D, y, F, a, phi, pair)
    N = exponent_at(D, y, F, a, phi, left, pair)
    return Contact(F, a, share, left, phi, N)
