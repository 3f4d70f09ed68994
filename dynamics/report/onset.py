"""When a blow first yields, and how hard it presses: what follows from pair and mass alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ...core.material import Pair
from ...models.base import unwarned
from ..force import F_FORCE, F_RADIUS
from ..result import Impact
from ..scene import Scene
from ..strength import strength_table, stronger

# limit: depths at which the mean pressure is looked at [-]
_PRESSURE_POINTS = 60


@dataclass(frozen=True)
class FirstYield:
    """Where a body first yields: Hertz up to the critical depth (Eqs. 1.16, 1.19)."""

    depth: float  # approach [m]
    load: float  # [N]
    work: float  # to there [J]

    def speed(self, mass: float) -> float:
        """Normal speed at which an effective mass [kg] just makes it yield [m/s]."""
        return math.sqrt(2.0 * self.work / mass)


def first_yield(pair: Pair) -> FirstYield | None:
    """Return where a pair first yields; none where neither body ever does."""
    depth = pair.first_yield * pair.R
    if not math.isfinite(depth):
        return None
    load = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R) * depth**1.5
    return FirstYield(depth, load, 0.4 * load * depth)


def effective_mass(scene: Scene) -> float:
    """Mass that the contact feels along the normal [kg].

    1/m* = 1/m + c^2/I + 1/M: the striker's, its leaning (Eq. 5.1), and that of a support that is
    free to move.
    """
    striker, support = scene.striker, scene.support
    beside, _ = striker.arm(scene.approach.angle)
    return 1.0 / (1.0 / striker.mass + beside**2 / striker.inertia + 1.0 / support.mass)


def first_yield_speed(scene: Scene) -> float:
    """Normal speed of approach at which one of the bodies begins to yield [m/s].

    Infinite where neither body yields, 0 for a tip with a flat, whose edge yields at once.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> from dentscope.dynamics import Approach, Striker, scene_of
    >>> from dentscope.models import LAWS
    >>> hard, soft = Material(E=200e9, nu=0.3), Material(E=200e9, nu=0.3, Sy=1e9)
    >>> ball = Striker(mass=7800 * 4 / 3 * 3.14159 * 0.005**3, tip_radius=0.005)
    >>> scene = scene_of(LAWS["hertz"], sphere=hard, flat=soft, striker=ball, approach=Approach(1))
    >>> round(first_yield_speed(scene), 3)  # 0.151 by Johnson's rounded constant (1985, 11.5)
    0.153
    """
    pair = scene.pair
    if scene.striker.tip_flat_radius > 0.0 and math.isfinite(pair.Sy_min):
        return 0.0
    onset = first_yield(as_strong(scene))
    return math.inf if onset is None else onset.speed(effective_mass(scene))


def as_strong(scene: Scene, depth: float = math.nan) -> Pair:
    """Return the pair as strong as it is in the blow, at a depth [m] or where it first yields."""
    if not scene.flow or not math.isfinite(scene.pair.Sy_min):
        return scene.pair
    table = strength_table(scene.law, scene.pair)
    strength, at = np.log(scene.strengths(table)), np.log(depth)
    if math.isnan(depth):
        # the depth of first yield goes as the square of the strength there
        beyond = table.log_depth - 2.0 * strength - math.log(scene.pair.first_yield * scene.pair.R)
        at = np.interp(0.0, np.maximum.accumulate(beyond), table.log_depth)
    return stronger(scene.pair, math.exp(float(np.interp(at, table.log_depth, strength))))


def largest_mean_pressure(scene: Scene, found: Impact) -> float:
    """Largest mean pressure F/(pi a^2) on the way to the peak [Pa], by the scene's law.

    nan where the tip is cut flat, for the law's contact radius is not that of the contact, and
    where the impact ended before it had a peak. Of a strength that varies with depth the law
    answers at each depth for a pair of that strength.
    """
    peak = found.peak_depth_m
    if scene.striker.tip_flat_radius > 0.0 or not 0.0 < peak < math.inf:
        return math.nan
    depth = np.geomspace(1e-3 * peak, peak, _PRESSURE_POINTS)
    # the doubt about a law has its own line
    with unwarned():
        stated = scene.law.hardness(scene.pair, depth)
        return float(np.max(stated * _harder(scene, depth)))


def _harder(scene: Scene, depth: Array) -> Array:
    """Mean pressure over that at the stated strength, at these depths."""
    if not scene.flow:
        return np.ones_like(depth)
    table = strength_table(scene.law, scene.pair)
    found = table.factors(scene.strengths(table))
    ratio = np.log(found[F_FORCE]) - 2.0 * np.log(found[F_RADIUS])
    return np.asarray(np.exp(np.interp(np.log(depth), table.log_depth, ratio)))
