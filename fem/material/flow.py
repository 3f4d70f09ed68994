"""Flow stress that depends on plastic strain, rate and heat, and how far the yield circle grows.

Radii are those of the yield circle in dev e at J = 1, rho = sqrt(2/3) sigma/(2 G), and lambda is
the length of the plastic increment, dp = sqrt(2/3) lambda.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import Array, Integers
from ...core.flow import Flow, Heating, Rate
from ...core.material import Material

# limit: part of the strength that heat leaves at the least [-]; a metal at its melting point
# keeps none: keeps the root defined
_WEAKEST = 0.01

NO_RATE, COWPER_SYMONDS, JOHNSON_COOK, OVERSTRESS = range(4)
_RATES = {
    "cowper-symonds": COWPER_SYMONDS,
    "johnson-cook": JOHNSON_COOK,
    "overstress": OVERSTRESS,
}
_SLOW, _COLD = Rate("overstress", 1.0, 1.0), Heating(0.0, 1.0, 1.0)

_ROOT = math.sqrt(2.0 / 3.0)
# limit: size of the yield circle's radius to which its root is found [-]: ten units of the last
# digit
_ROUND_OFF = 3e-15
# limit: most rounds of that root [-]
_MOST = 80


class FlowLaws(NamedTuple):
    """The flow laws of a solve, one row each (R = 1, E' = 1).

    - `curve`: plastic strain, radius and its slope by row of the table, shape (n_laws, 3, n_rows).
    - `rate`: `NO_RATE`, `COWPER_SYMONDS`, `JOHNSON_COOK` or `OVERSTRESS`, shape (n_laws,).
    - `reference`, `number`, `overstress`: of the rate law [1/s], [-], [radius], shape (n_laws,).
    - `rise`: rise of temperature by a plastic work, over that at which no strength is left [1/E'].
    - `exponent`: of the softening [-].
    """

    curve: Array
    rate: Integers
    reference: Array
    number: Array
    overstress: Array
    rise: Array
    exponent: Array


class Law(NamedTuple):
    """One point's law in one step: numbers of `FlowLaws`, and where the step starts.

    - `rate`, `reference`, `number`, `overstress`, `rise`, `exponent`: as in `FlowLaws`.
    - `strain`, `work`: plastic strain and plastic work so far [-, E'].
    - `static`: radius of the table at that strain.
    - `stiffness`: 2 G, which turns a radius times lambda into work [E'].
    - `seconds`: duration of the step; `inf`: no clock.
    """

    rate: int
    reference: float
    number: float
    overstress: float
    rise: float
    exponent: float
    strain: float
    work: float
    static: float
    stiffness: float
    seconds: float


class Radius(NamedTuple):
    """Radius of the yield circle after some flow.

    `end`, `gain`: the radius and its derivative by lambda; `start`: the radius of the same rate at
    the step's start.
    """

    end: float
    gain: float
    start: float


class Circle(NamedTuple):
    """The yield circle through a step, with the present J.

    - `mean`, `end`: radius on which the point slides, and in the end.
    - `gain`: derivative of the end by what drives the flow, both as the circle grows.
    - `drift`: derivative of the way along the increment by the mean radius.
    - `flow`: lambda.
    - `worked`: mean radius while it flows, for the plastic work.
    - `decay`: exp(-length/mean) of the slide on it.
    """

    mean: float
    end: float
    gain: float
    drift: float
    flow: float
    worked: float
    decay: float


@njit(cache=True)
def table(curve, p):
    """Radius and its slope at plastic strain p, by Hermite's cubics."""
    strain = curve[0]
    radius = curve[1]
    slope = curve[2]
    low = 0
    high = len(strain) - 1
    if p >= strain[high]:
        return radius[high], 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if strain[middle] <= p:
            low = middle
        else:
            high = middle
    h = strain[high] - strain[low]
    t = (p - strain[low]) / h
    rise = radius[high] - radius[low]
    a = h * slope[low] - rise
    b = rise - h * slope[high]
    value = radius[low] + t * (rise + (1.0 - t) * (a * (1.0 - t) + b * t))
    grow = rise + (1.0 - 2.0 * t) * (a * (1.0 - t) + b * t) + t * (1.0 - t) * (b - a)
    return value, grow / h


def no_laws() -> FlowLaws:
    """Laws of a solve in which all is perfectly plastic."""
    none = np.empty(0)
    return FlowLaws(np.empty((0, 3, 0)), np.empty(0, np.int64), *[none] * 5)


def laws_of(bodies: Sequence[tuple[Material, float]], unit: float) -> FlowLaws:
    """Laws of bodies that have one, each with its shear modulus [Pa]; `unit` is E' [Pa]."""
    if not bodies:
        return no_laws()
    flows = [body.flow or Flow() for body, _ in bodies]
    per_stress = [math.sqrt(2.0 / 3.0) / (2.0 * shear) for _, shear in bodies]
    rates = [flow.rate or _SLOW for flow in flows]
    heats = [flow.heating or _COLD for flow in flows]
    most = max(2 if flow.curve is None else len(flow.curve.strain) for flow in flows)
    return FlowLaws(
        curve=np.array(
            [_table(body, scale, most) for (body, _), scale in zip(bodies, per_stress, strict=True)]
        ),
        rate=np.array([_RATES[flow.rate.law] if flow.rate else NO_RATE for flow in flows]),
        reference=np.array([rate.reference for rate in rates]),
        number=np.array([rate.number for rate in rates]),
        overstress=np.array([r.stress * s for r, s in zip(rates, per_stress, strict=True)]),
        rise=np.array([h.fraction * unit / (h.capacity * h.range) for h in heats]),
        exponent=np.array([h.exponent for h in heats]),
    )


def _table(body: Material, scale: float, rows: int) -> Array:
    """Plastic strain, radius and slope by row, the last stress repeated up to so many rows."""
    curve = body.flow.curve if body.flow else None
    strain, stress, slope = (
        ([0.0, 1.0], [body.Sy] * 2, [0.0] * 2)
        if curve is None
        else (list(curve.strain), list(curve.stress), list(curve.slope))
    )
    while len(strain) < rows:
        strain.append(2.0 * strain[-1])
        stress.append(stress[-1])
        slope.append(0.0)
    return np.array([strain, np.array(stress) * scale, np.array(slope) * scale])


@njit(cache=True)
def law_at(laws, k, strain, work, stiffness, seconds):
    """Law k where a step starts from a plastic strain and work, and the radius at rest there."""
    static, _ = table(laws.curve[k], strain)
    law = Law(
        laws.rate[k],
        laws.reference[k],
        laws.number[k],
        laws.overstress[k],
        laws.rise[k],
        laws.exponent[k],
        strain,
        work,
        static,
        stiffness,
        seconds,
    )
    soft, _ = softening(law, work)
    return law, static * soft


@njit(cache=True)
def softening(law, work):
    """Factor that the heat of a plastic work leaves of the strength, and its derivative."""
    if law.rise == 0.0 or work <= 0.0:
        return 1.0, 0.0
    loss = (law.rise * work) ** law.exponent
    if loss > 1.0 - _WEAKEST:
        return _WEAKEST, 0.0
    return 1.0 - loss, -law.exponent * loss / work


@njit(cache=True)
def _of_rate(law, rate):
    """Factor and addend of the radius at a rate of plastic strain, and their derivatives."""
    x = rate / law.reference
    if law.rate == NO_RATE or x <= 0.0:
        return 1.0, 0.0, 0.0, 0.0
    if law.rate == COWPER_SYMONDS:
        more = x ** (1.0 / law.number)
        return 1.0 + more, more / (law.number * rate), 0.0, 0.0
    if law.rate == JOHNSON_COOK:
        if x <= 1.0:
            return 1.0, 0.0, 0.0, 0.0
        return 1.0 + law.number * math.log(x), law.number / rate, 0.0, 0.0
    more = law.overstress * x**law.number
    return 1.0, 0.0, more, law.number * more / rate


@njit(cache=True)
def grown(law, curve, flow):
    """`Radius` at J = 1 after a plastic increment of length `flow`.

    The heat of the step is foreseen from the flow stress at its start.
    """
    dp = _ROOT * flow
    still, grow = table(curve, law.strain + dp)
    factor, dfactor, more, dmore = _of_rate(law, dp / law.seconds)
    dfactor *= _ROOT / law.seconds
    dmore *= _ROOT / law.seconds
    soft0, _ = softening(law, law.work)
    begun = (law.static * factor + more) * soft0
    heat = law.stiffness * begun * flow
    dheat = law.stiffness * (begun + flow * (law.static * dfactor + dmore) * soft0)
    soft, dsoft = softening(law, law.work + heat)
    hot = still * factor + more
    gain = (_ROOT * grow * factor + still * dfactor + dmore) * soft + hot * dsoft * dheat
    return Radius(hot * soft, gain, begun)


@njit(cache=True)
def circle_of(law, curve, J, start, way):
    """Find how far the circle grows in a step, by Newton's method between two bounds.

    A point at distance n from the centre moves by `length` under the cosine c, `way` for short: on
    a circle of radius M its way along the increment is W = M ln((1 + c + a^2 (1 - c))/(2 a)),
    a = exp(-length/M), which holds for a radius that changes with M its mean, and
    lambda = W - (end - n).
    """
    n, length, c = way
    low = 0.0
    high = n + length
    flow = high - start
    if not 0.0 < flow < high:
        flow = 0.5 * high
    found = Circle(start, start, 0.0, 0.0, 0.0, start, 1.0)
    for _ in range(_MOST):
        now = grown(law, curve, flow)
        end = J * now.end
        gain = J * now.gain
        mean = 0.5 * (n + end)
        a = math.exp(-length / mean)
        den = 1.0 + c + a * a * (1.0 - c)
        along = math.log(0.5 * den) + length / mean
        drift = along - length / mean * (1.0 + c - a * a * (1.0 - c)) / den
        off = flow + end - n - mean * along
        stiff = 1.0 + gain * (1.0 - 0.5 * drift)
        worked = 0.5 * (J * now.start + end)
        found = Circle(mean, end, gain / stiff, drift, flow, worked, a)
        if off > 0.0:
            high = flow
        else:
            low = flow
        # a rate law may be vertical at no flow: only what is left over, a stress, tells the root
        if abs(off) <= _ROUND_OFF * start or high - low <= 1e-16 * high:
            break
        flow -= off / stiff
        if not low < flow < high:
            # many orders of magnitude may lie below
            flow = math.sqrt(low * high) if low > 0.0 else 0.03 * high
    return found
