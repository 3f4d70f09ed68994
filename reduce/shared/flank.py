"""Where the flank of a force meets zero: the ends of a pulse, the depth at which contact begins.

Where bodies touch and part the force follows a power: 3/2 of an elastic sphere, 1 of a plastic dent
or of a spring, 2 of a pyramid. The flank above the noise tells the end, by each power as far as it
fits.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import least_squares

from ...core.arrays import Array
from ..measured import Measured
from ..rules import RULES
from .regression import unit_covariance


def meets_zero(
    t: Array, force: Array, step: int, powers: tuple[float, ...] = RULES.flank_powers
) -> Measured:
    """Mean over the powers of F = (a s (1 - b s²))^p, s from the end, each as likely as it fits.

    Against time the striker slows down away from the end: b is 1/6 of a spring, F = sin s. `t` (n,)
    is time or depth, `force` in its largest; `step` is -1 where the force rises with `t` from its
    zero, 1 where it falls to it.
    """
    scale = float(np.ptp(t))
    s = -step * (t - t[0 if step < 0 else -1]) / scale  # grows from the end inwards
    ends, variances, spreads = [], [], []
    for power in powers:

        def model(s: Array, at: float, a: float, b: float, power: float = power) -> Array:
            late = np.maximum(s - at, 0.0)
            return np.asarray(np.maximum(a * late * (1.0 - b * late**2), 0.0) ** power)

        slope, level = np.polyfit(s, force ** (1.0 / power), 1)
        first = (float(np.clip(-level / slope, -9.0, 0.5)), slope) if slope > 0.0 else (-0.5, 1.0)
        fit = least_squares(
            lambda c, m=model: m(s, *c) - force, (*first, 0.0),
            bounds=((-10.0, 0.0, -0.1), (0.9, np.inf, 0.3)), x_scale="jac", max_nfev=50,
        )  # fmt: skip
        sigma = max(float(np.std(fit.fun)) * math.sqrt(s.size / (s.size - 3.0)), 1e-6)
        ends.append(float(fit.x[0]))
        variances.append(sigma**2 * float(unit_covariance(fit.jac)[0, 0]))
        spreads.append(sigma)
    belief = (min(spreads) / np.array(spreads)) ** s.size
    belief /= belief.sum()
    at = float(belief @ ends)
    between = np.ptp(ends) / (len(ends) - 1)  # the power lies between those that are tried
    variance = float(belief @ (variances + (np.array(ends) - at) ** 2)) + between**2 / 12.0
    end = t[0 if step < 0 else -1] - step * scale * at
    rough = 0.1 * float(np.median(np.diff(t)))
    return Measured(float(end), max(scale * math.sqrt(variance), rough))
