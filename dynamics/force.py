"""The static normal force of a scene: the law, a worn or finite tip, and the force transform.

Scalar kernels shared by the reference integrator and the compiled one. All neutral settings leave
the law's own numbers untouched, bit for bit.
"""

from __future__ import annotations

import math

from numba import float64, njit, types

from ..models.kernel import BRANCH, LOADING, SPLIT, VECTOR, cubic
from .rules import RULES
from .tabulated.bits import power

# Places in the vector that describes the modified force.
RADIUS, MODULUS, FLAT, EDGE, EDGE_DEPTH, EDGE_LIMIT = range(6)
DAMPING, RADIATION, SHAPE, RETURN, DAMPING_EXPONENT = range(6, 11)
N_FORCE = 11

# The branch vector: what `set_peak` writes, the contact radius at the peak and whether the depth
# falls; flat, radius and modulus of a cut tip that has stayed elastic, else a flat of 0.
PEAK_FORCE, POWER, PEAK_RADIUS, RECEDING = range(7, 11)
CUT_FLAT, CUT_RADIUS, CUT_MODULUS = range(11, 14)
N_BRANCH = 14

# What the factors multiply, column by column: loading force and contact radius at the depth; of a
# peak at it, elastic recovery, odds of the sphere's share of what stays, exponent of the recovery.
F_FORCE, F_RECOVERY, F_RADIUS, F_ODDS, F_POWER = range(5)
N_FACTORS = 5
# The nodes of each: ln(depth / R), equally spaced.
LOG_DEPTH_FIRST, LOG_DEPTH_LAST = math.log(1e-6), 0.0

DAMPING_DEPTH = 1e-5
"""Elastic depth [m] at which the two forms of a viscous force are the same."""

PUNCH_PRESSURE = 5.69 / math.sqrt(3.0)
"""Mean pressure over yield strength under a rigid circular punch (Eq. 1.10 at a -> 0)."""


@njit(cache=True, _nrt=False, error_model="numpy")
def factor(factors, column, x):
    """Interpolate a column of the table, smooth to the first derivative (Catmull and Rom)."""
    n = len(factors) // N_FACTORS
    first, last = column * n, n - 1
    place = (math.log(max(x, 1e-300)) - LOG_DEPTH_FIRST) / (LOG_DEPTH_LAST - LOG_DEPTH_FIRST)
    place = min(max(place * last, 0.0), float(last))
    # nan is no index
    i = int(min(place, last - 1.0)) if place > 0.0 else 0
    t = place - i
    here, there = factors[first + i], factors[first + i + 1]
    before = factors[first + i - 1] if i > 0 else 2.0 * here - there
    after = factors[first + i + 2] if i + 2 <= last else 2.0 * there - here
    return cubic(t, here, there, 0.5 * (there - before), 0.5 * (after - here))


@njit(cache=True, _nrt=False, error_model="numpy")
def cut_force(b, radius, modulus, depth):
    """Force [N] on an elastic sphere with a flat of radius b (Ejike 1969)."""
    dr = depth * radius
    root = math.sqrt(b**4 + 4.0 * dr * dr)
    a2 = 0.5 * (b * b + root)
    gap = 2.0 * dr * dr / (b * b + root)
    return 2.0 * modulus / (3.0 * radius) * (2.0 * a2 + b * b) * gap**0.5


@njit(cache=True, _nrt=False)
def static_loading(loading, par, force, factors, depth):
    """Loading force [N] at `depth` [m], measured from first touch.

    A flat of radius b on the tip: the lesser of the elastic truncated sphere (Ejike 1969,
    F = 2E'/(3R) (2a^2 + b^2) sqrt(a^2 - b^2), delta = a sqrt(a^2 - b^2) / R) and the law at the
    depth shifted by the missing cap. At the edge of a finite tip the contact radius stops and the
    force goes on as under a flat punch, up to that punch's plastic limit.
    """
    if depth <= 0.0:
        return 0.0
    b = force[FLAT]
    x = min(depth, force[EDGE_DEPTH])
    if b > 0.0:
        f = loading(par, x + b * b / (2.0 * force[RADIUS]))
        f = min(f, cut_force(b, force[RADIUS], force[MODULUS], x))
    else:
        f = loading(par, x)
    if depth > force[EDGE_DEPTH]:
        further = 2.0 * force[MODULUS] * force[EDGE] * (depth - force[EDGE_DEPTH])
        f = min(f + further, max(f, force[EDGE_LIMIT]))
    if len(factors) > 1:
        f *= factor(factors, F_FORCE, depth / force[RADIUS])
    return f


@njit(cache=True, _nrt=False)
def law_radius(radius, par, force, factors, depth, peak):
    """Contact radius [m] of the law at `depth`, up to `peak`, with its factor there."""
    a = radius(par, depth, peak)
    if len(factors) > 1:
        a *= factor(factors, F_RADIUS, peak / force[RADIUS])
    return a


@njit(cache=True, _nrt=False)
def static_radius(radius, par, force, factors, depth):
    """Contact radius [m] on loading, with a flat of the tip and the tip's edge."""
    b = force[FLAT]
    if b > 0.0:
        x = depth + b * b / (2.0 * force[RADIUS])
        a = max(b, law_radius(radius, par, force, factors, x, x))
    else:
        a = law_radius(radius, par, force, factors, depth, depth)
    return min(a, force[EDGE])


@njit(cache=True, _nrt=False)
def _fit_power(unloading, par, branch):
    """Recognise a recovery F_m x^n, x from 0 at the residual depth to 1 at the peak.

    Nearly every law recovers so; then a step need not ask the law for its peak force again. The
    power is trusted only if it gives three other points to rounding; else it is 0.
    """
    peak, rest = branch[4], branch[5]
    branch[POWER] = 0.0
    branch[PEAK_FORCE] = unloading(par, peak, peak)
    if branch[PEAK_FORCE] <= 0.0 or peak <= rest:
        return
    sample = unloading(par, rest + 0.25 * (peak - rest), peak)
    if sample <= 0.0:
        return
    n = math.log(sample / branch[PEAK_FORCE]) / math.log(0.25)
    if abs(n - 1.5) < 1e-12:
        n = 1.5
    for x in (0.02, 0.5, 0.9):
        there = unloading(par, rest + x * (peak - rest), peak)
        if abs(there - branch[PEAK_FORCE] * x**n) > 1e-12 * branch[PEAK_FORCE]:
            return
    branch[POWER] = n


@njit(
    types.void(LOADING, BRANCH, SPLIT, VECTOR, VECTOR, VECTOR, float64, VECTOR),
    cache=True,
    _nrt=False,
)
def set_peak(loading, unloading, residual, par, force, factors, peak, branch):
    """Write into `branch` what the unloading from `peak` needs.

    Entries: peak, residual depth of sphere and flat, force scale, law's peak and residual depth,
    depth scale, the force at the peak and the power of the law's recovery.
    """
    shift = force[FLAT] * force[FLAT] / (2.0 * force[RADIUS])
    law_peak = peak + shift
    sphere, flat = residual(par, law_peak)
    law_rest = sphere + flat
    rest = max(law_rest - shift, 0.0)
    recovery, odds, bend = 1.0, 1.0, 1.0
    if len(factors) > 1:
        at = peak / force[RADIUS]
        recovery = factor(factors, F_RECOVERY, at)
        odds, bend = factor(factors, F_ODDS, at), factor(factors, F_POWER, at)
    if recovery != 1.0:
        rest = max(peak - recovery * (peak - rest), 0.0)
    share = 0.0 if law_rest == 0.0 else sphere / law_rest
    if odds != 1.0:
        share = odds * share / (odds * share + 1.0 - share)
    branch[0] = peak
    branch[1] = share * rest
    branch[2] = rest - share * rest
    branch[3] = force[RETURN]
    branch[4] = law_peak
    branch[5] = law_rest
    branch[6] = 1.0
    if shift > 0.0 or recovery != 1.0 or len(factors) > 1 or peak > force[EDGE_DEPTH]:
        law_force = loading(par, law_peak)
        if law_force > 0.0:
            branch[3] *= static_loading(loading, par, force, factors, peak) / law_force
        if peak > rest:
            branch[6] = (law_peak - law_rest) / (peak - rest)
    _fit_power(unloading, par, branch)
    branch[POWER] *= bend
    if force[SHAPE] != 0.0 and branch[POWER] > 0.0:
        branch[POWER] += force[SHAPE]
    # A cut tip whose elastic force is still the lesser one has not yielded: it gives all back.
    branch[CUT_FLAT] = 0.0
    b = force[FLAT]
    if b > 0.0 and recovery == 1.0 and peak <= force[EDGE_DEPTH]:
        elastic = cut_force(b, force[RADIUS], force[MODULUS], peak)
        if elastic <= loading(par, law_peak):
            branch[1], branch[2] = 0.0, 0.0
            branch[CUT_FLAT] = b
            branch[CUT_RADIUS], branch[CUT_MODULUS] = force[RADIUS], force[MODULUS]
            branch[3] = force[RETURN] * static_loading(loading, par, force, factors, peak) / elastic


@njit(cache=True, _nrt=False)
def static_unloading(unloading, par, branch, depth):
    """Force [N] at `depth` [m] on the branch that `set_peak` prepared."""
    if depth <= branch[1] + branch[2]:
        return 0.0
    if branch[CUT_FLAT] > 0.0:
        return branch[3] * cut_force(
            branch[CUT_FLAT], branch[CUT_RADIUS], branch[CUT_MODULUS], depth
        )
    if branch[POWER] > 0.0:
        x = min((depth - branch[1] - branch[2]) / (branch[0] - branch[1] - branch[2]), 1.0)
        if branch[POWER] == 1.5:
            return branch[3] * branch[PEAK_FORCE] * (x * math.sqrt(x))
        return branch[3] * branch[PEAK_FORCE] * power(x, branch[POWER])
    if branch[3] == 1.0 and branch[6] == 1.0 and branch[4] == branch[0]:
        return unloading(par, depth, branch[0])
    x = branch[4] - (branch[0] - depth) * branch[6]
    return branch[3] * unloading(par, x, branch[4])


_SLOPE_STEP = RULES.slope_step


@njit(cache=True, _nrt=False)
def loading_window(depth):
    """Depths about one on loading between which its slope is taken."""
    return depth * (1.0 - _SLOPE_STEP), depth * (1.0 + _SLOPE_STEP)


@njit(cache=True, _nrt=False)
def unloading_window(branch, depth):
    """Depths about one on the branch that `set_peak` prepared between which its slope is taken."""
    rest = branch[1] + branch[2]
    step = _SLOPE_STEP * max(depth - rest, 0.0)
    return depth - step, min(depth + step, max(branch[0], depth))


@njit(float64(BRANCH, VECTOR, VECTOR, VECTOR, float64), cache=True, _nrt=False)
def edge_depth(radius, par, force, factors, limit):
    """Depth [m] at which the contact radius reaches `limit`; infinite when it never does."""
    low, high = 0.0, 2.0 * force[RADIUS]
    if not math.isfinite(limit) or law_radius(radius, par, force, factors, high, high) < limit:
        return math.inf
    for _ in range(200):
        middle = 0.5 * (low + high)
        if law_radius(radius, par, force, factors, middle, middle) < limit:
            low = middle
        else:
            high = middle
        if high - low <= 1e-15 * high:
            break
    return 0.5 * (low + high)
