"""Numbers by their bits: places of depths in tables, and powers without a call to the C library."""

from __future__ import annotations

import math
from typing import Any

from numba import float64, int64, njit, types
from numba.extending import intrinsic

_INLINE = {"cache": True, "_nrt": False, "error_model": "numpy", "forceinline": True}
_MANTISSA = 52

# fmt: off
# The polynomials of the C library fdlibm (e_log.c, e_exp.c), each below 1e-16.
_LOG_ODD = (6.666666666666735130e-1, 2.857142874366239149e-1, 1.818357216161805012e-1,
            1.479819860511658591e-1)
_LOG_EVEN = (3.999999999940941908e-1, 2.222219843214978396e-1, 1.531383769920937332e-1)
_EXP = (1.66666666666666019037e-1, -2.77777777770155933842e-3, 6.61375632143793436117e-5,
        -1.65339022054652515390e-6, 4.13813679705723846039e-8)
# ln 2 as a sum whose first part has few digits, so that its multiples are exact
_LN2 = (6.93147180369123816490e-1, 1.90821492927058770002e-10)
# fmt: on


def _seen_as(kind: Any, given: Any) -> Any:
    """Return a compiled function that takes the bits of `given` for those of another kind."""

    def seen(_typing: Any, _number: Any) -> Any:
        def code(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            return builder.bitcast(arguments[0], context.get_value_type(kind))

        return kind(given), code

    return intrinsic(seen)


bits_of = _seen_as(types.int64, types.float64)
"""A number's bits as an integer, which grows with the number."""
_number_of = _seen_as(types.float64, types.int64)


@njit(**_INLINE)
def _logarithm(x):
    """Natural logarithm of a normal positive number."""
    bits = bits_of(x)
    # the exponent that leaves a fraction between sqrt(1/2) and sqrt(2)
    k = ((bits - bits_of(math.sqrt(0.5))) >> _MANTISSA) * (1 << _MANTISSA)
    f = _number_of(bits - k) - 1.0
    k = float64(k >> _MANTISSA)
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    odd = z * (_LOG_ODD[0] + w * (_LOG_ODD[1] + w * (_LOG_ODD[2] + w * _LOG_ODD[3])))
    even = w * (_LOG_EVEN[0] + w * (_LOG_EVEN[1] + w * _LOG_EVEN[2]))
    half = 0.5 * f * f
    return k * _LN2[0] - ((half - (s * (half + odd + even) + k * _LN2[1])) - f)


@njit(**_INLINE)
def _exponential(x):
    """Exponential of a number between -700 and 0."""
    k = math.floor(x * 1.44269504088896338700 + 0.5)
    high, low = x - k * _LN2[0], k * _LN2[1]
    r = high - low
    t = r * r
    c = t * (_EXP[0] + t * (_EXP[1] + t * (_EXP[2] + t * (_EXP[3] + t * _EXP[4]))))
    c = r - c
    y = 1.0 - ((low - r * c / (2.0 - c)) - high)
    return _number_of(bits_of(y) + int64(k) * (1 << _MANTISSA))


@njit(cache=True, _nrt=False, error_model="numpy")
def power(x, n):
    """x^n for 0 <= x <= 1 and n > 0, right to a few units in the last place."""
    if x < 1e-300:
        return 0.0
    return _exponential(max(n * _logarithm(x), -700.0))
