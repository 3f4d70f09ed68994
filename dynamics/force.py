"""The static normal force of a scene: the law, a worn or finite tip, and the force transform.

Scalar kernels shared by the reference integrator and the compiled one. All neutral settings leave
the law's own numbers untouched, bit for bit.
"""

from __future__ import annotations

import math

import numpy as np
from numba import float64, njit, types

from ..models.kernel import BRANCH_SIGNATURE, LOADING_SIGNATURE, RESIDUAL_SIGNATURE, VECTOR
from .bits import power
from .rules import RULES

LOADING = types.FunctionType(LOADING_SIGNATURE)
BRANCH = types.FunctionType(BRANCH_SIGNATURE)
SPLIT = types.FunctionType(RESIDUAL_SIGNATURE)

# Places in the vector that describes the modified force.
RADIUS, MODULUS, FLAT, EDGE, EDGE_DEPTH, EDGE_LIMIT = range(6)
DAMPING, RADIATION, SHAPE, RETURN = range(6, 10)
N_FORCE = 10

# The branch vector: what `set_peak` writes, the smooth stretch of the loading curve, the contact
# radius at the peak and whether the depth falls; flat, radius and modulus of a cut tip that has
# stayed elastic, else a flat of 0.
SEGMENT_LOW, SEGMENT_HIGH, PEAK_FORCE, POWER, PEAK_RADIUS, RECEDING = range(7, 13)
CUT_FLAT, CUT_RADIUS, CUT_MODULUS = range(13, 16)
N_BRANCH = 16

# What the factors multiply, column by column: loading force and contact radius at the depth; of a
# peak at it, elastic recovery, odds of the sphere's share of what stays, exponent of the recovery.
F_FORCE, F_RECOVERY, F_RADIUS, F_ODDS, F_POWER = range(5)
N_FACTORS = 5
# The nodes of each: ln(depth / R), equally spaced.
LOG_DEPTH_FIRST, LOG_DEPTH_LAST = math.log(1e-6), 0.0

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
    m0, m1 = 0.5 * (there - before), 0.5 * (after - here)
    rise = there - here
    return here + t * (m0 + t * (3.0 * rise - 2.0 * m0 - m1 + t * (m0 + m1 - 2.0 * rise)))


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
    depth scale, (two of the caller), the force at the peak and the power of the law's recovery.
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
            branch[CUT_FLAT], branch[CUT_RADIUS], branch[CUT_MODULUS] = (
                b,
                force[RADIUS],
                force[MODULUS],
            )
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
def loading_window(depth, first, last):
    """Depths about one on loading between which its slope is taken, from `first` to `last`."""
    low, high = max(depth * (1.0 - _SLOPE_STEP), first), min(depth * (1.0 + _SLOPE_STEP), last)
    return low, max(low, high)


@njit(cache=True, _nrt=False)
def unloading_window(branch, depth):
    """Depths about one on the branch that `set_peak` prepared between which its slope is taken."""
    rest = branch[1] + branch[2]
    step = _SLOPE_STEP * max(depth - rest, 0.0)
    return depth - step, min(depth + step, max(branch[0], depth))


@njit(cache=True, _nrt=False)
def _log_force(loading, par, force, factors, x):
    return math.log(max(static_loading(loading, par, force, factors, math.exp(x)), 1e-300))


@njit(cache=True, _nrt=False)
def _jump_between(loading, par, force, factors, low, high):
    """Logarithm of the depth just above a jump between two others; nan without one."""
    f_low = _log_force(loading, par, force, factors, low)
    f_high = _log_force(loading, par, force, factors, high)
    for _ in range(60):
        x = 0.5 * (low + high)
        f = _log_force(loading, par, force, factors, x)
        if abs(f - f_low) > abs(f_high - f):
            high, f_high = x, f
        else:
            low, f_low = x, f
        if high - low < 3e-15 * abs(x):
            break
    return high if abs(f_high - f_low) > 1e-9 else math.nan


@njit(cache=True)
def _meeting_point(loading, par, force, factors, x):
    """Logarithm of the depth at which the cubics through either side of a kink near x meet."""
    h = 4e-4
    sides = np.empty((2, 4))
    for k in range(4):
        sides[0, k] = _log_force(loading, par, force, factors, x - 1e-5 - k * h)
        sides[1, k] = _log_force(loading, par, force, factors, x + 1e-5 + k * h)
    low, high = -1e-5, 1e-5
    g_low = 0.0
    for i in range(40):
        t = low if i == 0 else high if i == 1 else 0.5 * (low + high)
        g = 0.0
        for side in range(2):
            u = (-1e-5 - t if side == 0 else t - 1e-5) / h
            y0, y1, y2, y3 = sides[side]
            d1, d2, d3 = y1 - y0, y2 - 2.0 * y1 + y0, y3 - 3.0 * y2 + 3.0 * y1 - y0
            value = y0 + u * (d1 + (u - 1.0) / 2.0 * (d2 + (u - 2.0) / 3.0 * d3))
            g += value if side == 0 else -value
        if i == 0:
            g_low = g
        elif i == 1:
            if (g < 0.0) == (g_low < 0.0):
                return x
        elif (g < 0.0) == (g_low < 0.0):
            low = t
        else:
            high = t
    return x + 0.5 * (low + high)


@njit(cache=True)
def _kink_between(loading, par, force, factors, low, high):
    """Logarithm of the depth of a kink (a jump of the slope); nan without one.

    To about 1e-10 for a finite jump, to rounding for a slope that is infinite on one side.
    """
    while high - low > 4e-15 * abs(low):
        h = 0.25 * (high - low)
        best, place = -1.0, 0
        for k in range(1, 4):
            x = low + k * h
            bend = _log_force(loading, par, force, factors, x - h)
            bend += _log_force(loading, par, force, factors, x + h)
            bend = abs(bend - 2.0 * _log_force(loading, par, force, factors, x))
            if bend > best:
                best, place = bend, k
        if best < 1e-12:
            break
        low, high = low + (place - 1) * h, low + (place + 1) * h
    x, h = 0.5 * (low + high), 1e-4
    middle = 2e-6
    left = _log_force(loading, par, force, factors, x - middle)
    left -= _log_force(loading, par, force, factors, x - h)
    right = _log_force(loading, par, force, factors, x + h)
    right -= _log_force(loading, par, force, factors, x + middle)
    if abs(right - left) <= 2e-3 * h:
        return math.nan
    return _meeting_point(loading, par, force, factors, x)


@njit(cache=True)
def _bend_between(loading, par, force, factors, low, high):
    """Logarithm of the depth at which the curvature jumps, to about 1e-5; nan without one.

    Yield without a jump of the slope: a step across it has an error that its estimate can miss.
    """
    level = np.empty(17)
    while True:
        h = (high - low) / 16.0
        for k in range(17):
            level[k] = _log_force(loading, par, force, factors, low + k * h)
        best, place = -1.0, 0
        for k in range(2, 14):
            before = level[k] - 2.0 * level[k - 1] + level[k - 2]
            after = level[k + 3] - 2.0 * level[k + 2] + level[k + 1]
            if abs(after - before) > best:
                best, place = abs(after - before), k
        low, high = low + (place - 1) * h, low + (place + 2) * h
        if h < 1e-5:
            break
    x = 0.5 * (low + high)
    curvature = np.empty(4)
    h = 2e-4
    for k in range(4):
        # two places on each side of x
        at = x + (-3.0, -1.2, 1.2, 3.0)[k] * h
        bend = _log_force(loading, par, force, factors, at - h)
        bend += _log_force(loading, par, force, factors, at + h)
        curvature[k] = (bend - 2.0 * _log_force(loading, par, force, factors, at)) / h**2
    jump = abs(curvature[2] - curvature[1])
    smooth = abs(curvature[1] - curvature[0]) + abs(curvature[3] - curvature[2])
    return x if jump > 1e-2 + 3.0 * smooth else math.nan


@njit(float64[::1](LOADING, VECTOR, VECTOR, VECTOR), cache=True)
def find_breaks(loading, par, force, factors):
    """Depths at which the loading force, its slope or its curvature jumps, rising.

    Published fits do so at the borders of their ranges. A logarithmic scan for uneven slopes, each
    then located; an integrator that knows these depths can end a step on them.
    """
    n = 240
    first, last = math.log(1e-9 * force[RADIUS]), math.log(force[RADIUS])
    step = (last - first) / n
    level = np.empty(n + 1)
    for i in range(n + 1):
        level[i] = _log_force(loading, par, force, factors, first + i * step)
    found = np.empty(32)
    count = 0
    for i in range(2, n - 3):
        rise = level[i + 1] - level[i]
        around = 0.5 * (level[i] - level[i - 1] + level[i + 2] - level[i + 1])
        before = level[i] - 2.0 * level[i - 1] + level[i - 2]
        after = level[i + 3] - 2.0 * level[i + 2] + level[i + 1]
        low, x = first + i * step, math.nan
        if count == len(found):
            break
        if abs(rise - around) >= 1e-4:
            x = _jump_between(loading, par, force, factors, low, low + step)
            if math.isnan(x):
                x = _kink_between(loading, par, force, factors, low, low + step)
        if math.isnan(x) and abs(after - before) > 3e-5:
            x = _bend_between(loading, par, force, factors, low - step, low + 2.0 * step)
            # neighbouring cells see the same bend
            if not low <= x < low + step:
                x = math.nan
        if not math.isnan(x) and (count == 0 or math.exp(x) > found[count - 1] * (1.0 + 1e-5)):
            found[count] = math.exp(x)
            count += 1
    return found[:count].copy()


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


def neutral_force(radius: float, modulus: float) -> np.ndarray:
    """Return the force vector of an unmodified law."""
    force = np.zeros(N_FORCE)
    force[RADIUS], force[MODULUS] = radius, modulus
    force[EDGE] = force[EDGE_DEPTH] = force[EDGE_LIMIT] = math.inf
    force[RETURN] = 1.0
    return force
