"""What a normal impact of one pair comes to, tabulated over the work of loading.

Times and returned work are integrals over the law's own curves: eight-point panels over the root
of the way to the turning point, one for each smooth cell of the loading curve, and a 32-point rule
for the recovery.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numba import float64, njit, types

from ...core.arrays import Array
from ...core.material import Pair
from ...core.rules import RULES as CORE
from ...models.base import ContactLaw, Kernels
from ...models.kernel import BRANCH, LOADING, SPLIT, VECTOR
from ..rules import RULES
from .cells import TableCells, cells_of
from .law_table import TABLES_KEPT

# limit: least peak depth that the route answers for [R]; dust
SHALLOWEST = 1e-8

ERROR = RULES.table_error
"""Error of the table; restitution and times come out within ten times this of the integral."""

DEEPEST = CORE.deepest
"""Peak depths over R that the route answers for."""

# Columns of the table: ln(d_m), ln(F_m), returned share of the work, residual depths over d_m, then
# the times of loading and of recovery over that at constant speed, each with its four corrections.
DEPTH, FORCE, RETURNED, SPHERE, FLAT, LOADING_TIME = range(6)
TERMS = 5
RECOVERY_TIME = LOADING_TIME + TERMS
COLUMNS = RECOVERY_TIME + TERMS


def energy_table(law: ContactLaw, pair: Pair) -> TableCells:
    """Return the pair's table over ln W, made at its first use and kept.

    It ends early where the law does: where its force jumps or falls without bound, or is no number.
    """
    numbers = np.asarray(law.parameters(pair), dtype=float).tobytes()
    return _table(law.kernels, numbers, pair.R)


_PANEL, _WEIGHT = (0.5 * x for x in np.polynomial.legendre.leggauss(8))
_PANEL = _PANEL + 0.5
_WORK_NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(9) / 8)
_WORK_OF = np.linalg.inv(np.vander(_WORK_NODES, increasing=True))
_WORK_OF = np.vstack([np.zeros(9), _WORK_OF / np.arange(1, 10)[:, None]])
"""From a slope at nine nodes of a cell to the coefficients of its integral."""


def _recovery_rule(count: int) -> tuple[Array, Array, Array, Array]:
    """Nodes of the recovery: x from 0 to 1, 1 - x, dx/du, and integrals from each node to the peak.

    x = u^3 (4 - 3 u) grows as the cube at the residual depth, where the force is a broken power,
    and closes as the square at the peak, where the time is an inverse root.
    """
    u, _ = (0.5 * z for z in np.polynomial.legendre.leggauss(count))
    u = u + 0.5
    legendre = np.polynomial.legendre.Legendre
    basis = [legendre.basis(k, domain=[0.0, 1.0]) for k in range(count)]
    values = np.stack([b(u) for b in basis], axis=1)
    to_peak = np.stack([b.integ()(1.0) - b.integ()(u) for b in basis], axis=1)
    rule = to_peak @ np.linalg.inv(values)
    slope = 12.0 * u**2 * (1.0 - u)
    return u**3 * (4.0 - 3.0 * u), (1.0 - u) ** 2 * (1.0 + 2.0 * u + 3.0 * u**2), slope, rule


_X, _LEFT, _SLOPE, _TO_PEAK = _recovery_rule(32)
_WHOLE = 0.5 * np.polynomial.legendre.leggauss(32)[1]


@lru_cache(maxsize=TABLES_KEPT)
def _table(kernels: Kernels, numbers: bytes, R: float) -> TableCells:
    loading, par = kernels.loading, np.frombuffer(bytearray(numbers))
    low, high = math.log(0.1 * SHALLOWEST * R), math.log(2.0 * DEEPEST * R)

    def log_force(x: Array) -> Array:
        out = np.empty((len(x), 1))
        _log_forces(loading, par, x, out)
        return out

    found = cells_of(log_force, low, high, tolerance=ERROR)
    if found.count < 2:
        return replace(found, count=0)
    curve = found.vector
    bins, count = int(curve[2]), int(curve[3])
    edges = np.ascontiguousarray(curve[4 + bins + 1 : 4 + bins + count])
    nodes = edges[:-1, None] + np.diff(edges)[:, None] * _WORK_NODES
    nodes[:, -1] = np.nextafter(edges[1:], -np.inf)
    slope = np.exp(nodes + log_force(nodes.ravel()).reshape(nodes.shape))
    own = np.ascontiguousarray(np.diff(edges)[:, None] * (slope @ _WORK_OF.T))
    # below the first edge the force is a power
    first = nodes[0, :2]
    power = float(np.diff(log_force(first)[:, 0])[0] / (first[1] - first[0]))
    works = np.concatenate([[slope[0, 0] / (1.0 + power)], own.sum(axis=1)]).cumsum()

    def columns(y: Array) -> Array:
        out = np.empty((len(y), COLUMNS))
        _ask(loading, kernels.unloading, kernels.residual, par, edges, own, works, power, y, out)
        return out

    # a law may end before the shallowest depth
    inside = min(int(np.searchsorted(edges, math.log(SHALLOWEST * R))), len(edges) - 2)
    return cells_of(
        columns, math.log(works[inside]), math.log(works[-1]) - 1e-12, tolerance=ERROR, least=1e-9
    )


@njit(types.void(LOADING, VECTOR, VECTOR, float64[:, ::1]), cache=True, _nrt=False,
      error_model="numpy")  # fmt: skip
def _log_forces(loading, par, x, out):
    for i in range(len(x)):
        out[i, 0] = math.log(loading(par, math.exp(x[i])))


@njit(cache=True, _nrt=False)
def _within(edges, own, k, x):
    """Work of loading from the left end of a cell to exp(x)."""
    t = (x - edges[k]) / (edges[k + 1] - edges[k])
    sum_ = 0.0
    for j in range(9, 0, -1):
        sum_ = (sum_ + own[k, j]) * t
    return sum_


@njit(cache=True, _nrt=False)
def _work(edges, own, works, power, x):
    """Work of loading to the depth exp(x)."""
    k = np.searchsorted(edges, x, side="right") - 1
    if k < 0:
        return works[0] * math.exp((1.0 + power) * (x - edges[0]))
    k = min(k, len(own) - 1)
    return works[k] + _within(edges, own, k, x)


@njit(cache=True, _nrt=False, error_model="numpy")
def _loading_times(edges, own, works, power, x, top, work, row):
    """Time of loading over d_m sqrt(1/W), and its moments: panels of s = sqrt(1 - d/d_m)."""
    from_s = 0.0
    steep = work / math.exp(row[DEPTH] + row[FORCE])
    k, end, above = top, x, 0.0
    while from_s < 1.0:
        # one panel a cell of the curve, the last one down to no depth
        last = k < 0 or edges[k] < x - 4.0
        to_s = 1.0 if last else math.sqrt(-math.expm1(edges[k] - x))
        # a peak close above the edge of a cell: the force is that of the peak
        short = k == top and to_s < 3e-4
        for j in range(8):
            s = from_s + (to_s - from_s) * _PANEL[j]
            place = x + math.log1p(-s * s)
            rest = 1.0
            if last:
                rest = work - _work(edges, own, works, power, place)
            elif not short:
                rest = above + (_within(edges, own, k, end) - _within(edges, own, k, place))
            r = steep if short else s * s * work / rest
            term = (to_s - from_s) * _WEIGHT[j] * 2.0 * math.sqrt(r)
            for n in range(TERMS):
                row[LOADING_TIME + n] += term
                term *= r
        from_s = to_s
        above += _within(edges, own, max(k, 0), end)
        k -= 1
        end = edges[max(k + 1, 0)]


@njit(cache=True, error_model="numpy")
def _recovery(unloading, par, peak, way, work, row):
    """Returned share of the work, time of the recovery over its way sqrt(1/W_u), its moments."""
    row[RETURNED], row[RECOVERY_TIME] = 0.0, 1.0
    if way <= 1e-12 * peak:
        return
    count = len(_X)
    force = np.empty(count)
    back = 0.0
    for j in range(count):
        force[j] = unloading(par, peak - way * _LEFT[j], peak) * _SLOPE[j] * way
        back += _WHOLE[j] * force[j]
    row[RETURNED], row[RECOVERY_TIME] = back / work, 0.0
    for j in range(count):
        rest = 0.0
        for i in range(count):
            rest += _TO_PEAK[j, i] * force[i]
        r = _LEFT[j] * back / rest
        term = _WHOLE[j] * _SLOPE[j] / math.sqrt(_LEFT[j]) * math.sqrt(r)
        for n in range(TERMS):
            row[RECOVERY_TIME + n] += term
            term *= r


@njit(
    types.void(LOADING, BRANCH, SPLIT, VECTOR, VECTOR, float64[:, ::1], VECTOR, float64, VECTOR,
               float64[:, ::1]),
    cache=True, error_model="numpy",
)  # fmt: skip
def _ask(loading, unloading, residual, par, edges, own, works, power, y, out):
    """Fill the columns at y = ln W."""
    for i in range(len(y)):
        work = math.exp(y[i])
        k = max(min(int(np.searchsorted(works, work, side="right")) - 1, len(own) - 1), 0)
        low, high = edges[k], edges[k + 1]
        for _ in range(200):
            middle = 0.5 * (low + high)
            if works[k] + _within(edges, own, k, middle) < work:
                low = middle
            else:
                high = middle
            if high - low <= 2e-16 * abs(low):
                break
        x = 0.5 * (low + high)
        depth = math.exp(x)
        sphere, flat = residual(par, depth)
        out[i, DEPTH], out[i, FORCE] = x, math.log(loading(par, depth))
        out[i, SPHERE], out[i, FLAT] = sphere / depth, flat / depth
        for j in range(LOADING_TIME, COLUMNS):
            out[i, j] = 0.0
        _loading_times(edges, own, works, power, x, k, work, out[i])
        _recovery(unloading, par, depth, depth - sphere - flat, work, out[i])
