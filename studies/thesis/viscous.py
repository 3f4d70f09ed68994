"""Kelvin-Voigt and Hunt-Crossley: the rate-dependent models that chapter 1 criticises.

They are no contact laws: their force depends on the rate of penetration, they know no peak and
leave no dent.

The paradox of Kelvin and Voigt: F = k d + c d' is already c v at first touch, with nothing pressed
in, and it pulls (F < 0) before the bodies part at d = 0. Whoever lets them part where the force
vanishes instead is left with a depth that no plastic flow has made. Hunt and Crossley make the
damping grow with the force, F = K d^n (1 + (3/2) alpha d'), which is zero at touch and at parting
and gives e = 1 - alpha v for slow impacts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...core.arrays import Array
from ...core.errors import InputError


def kelvin_voigt(
    depth: npt.ArrayLike, rate: npt.ArrayLike, *, stiffness: float, damping: float
) -> Array:
    """F = k d + c d', shape (...) [N]; k [N/m], c [N s/m]."""
    return stiffness * np.asarray(depth, float) + damping * np.asarray(rate, float)


def hunt_crossley(
    depth: npt.ArrayLike,
    rate: npt.ArrayLike,
    *,
    stiffness: float,
    alpha: float,
    exponent: float = 1.5,
) -> Array:
    """F = K d^n (1 + (3/2) alpha d'), shape (...) [N]; K [N/m^n], alpha [s/m]."""
    d = np.maximum(np.asarray(depth, float), 0.0)
    return np.asarray(stiffness * d**exponent * (1.0 + 1.5 * alpha * np.asarray(rate, float)))


def alpha_for(restitution: float, *, speed: float) -> float:
    """Hunt and Crossley's alpha [s/m] for a restitution e of 0.05 to below 1 at a speed [m/s].

    From the first integral of their impact: ln[(1 + u)/(1 - u e)] = u (1 + e), u = (3/2) alpha v.

    Examples
    --------
    >>> round(alpha_for(0.99, speed=1.0), 3)
    0.01
    """

    def off(u: float) -> float:
        return math.log1p(u) - math.log1p(-u * restitution) - u * (1.0 + restitution)

    from scipy.optimize import brentq

    last = (1.0 - 1e-12) / restitution
    return float(brentq(off, 1e-6, last, xtol=1e-14) / (1.5 * speed))


@dataclass(frozen=True)
class Paradox:
    """What a Kelvin-Voigt impact implies.

    Parameters
    ----------
    force_at_touch
        Force with nothing pressed in yet [N].
    pull_at_return
        Force when the depth is zero again [N], below zero.
    restitution_at_return
        Rebound over approach speed if the bodies part at zero depth.
    restitution_at_zero_force
        The same if they part where the force vanishes.
    depth_at_zero_force
        What is then still pressed in [m].
    """

    force_at_touch: float
    pull_at_return: float
    restitution_at_return: float
    restitution_at_zero_force: float
    depth_at_zero_force: float


def paradox(*, mass: float, stiffness: float, damping: float, speed: float) -> Paradox:
    """Return the closed-form impact of a mass on spring and dashpot, damping ratio z below 1.

    With w_0 = sqrt(k/m), z = c/(2 sqrt(k m)) and w_d = w_0 sqrt(1 - z^2) the depth is
    v/w_d exp(-z w_0 t) sin(w_d t); it returns to zero at pi/w_d with e = exp(-pi z/sqrt(1 - z^2)),
    and the force vanishes at w_d t = pi - 2 asin(z), before that.

    Raises
    ------
    InputError
        The damping is critical or more: the mass never comes back.
    """
    w0 = math.sqrt(stiffness / mass)
    z = damping / (2.0 * math.sqrt(stiffness * mass))
    if not 0.0 <= z < 1.0:
        raise InputError(
            f"{damping:g} N s/m is a damping ratio of {z:.3g}",
            key="damping",
            allowed="a ratio from 0 to below 1",
        )
    wd = w0 * math.sqrt(1.0 - z * z)
    e = math.exp(-math.pi * z / math.sqrt(1.0 - z * z))
    # the acceleration is v w0^2/wd exp(-z w0 t) times a sine that vanishes at this phase
    phase = math.pi - math.atan2(2.0 * z * math.sqrt(1.0 - z * z), 1.0 - 2.0 * z * z)
    fade = math.exp(-z * w0 * phase / wd)
    depth = speed / wd * fade * math.sin(phase)
    rate = speed * fade * (math.cos(phase) - z / math.sqrt(1.0 - z * z) * math.sin(phase))
    return Paradox(damping * speed, -damping * e * speed, e, -rate / speed, depth)
