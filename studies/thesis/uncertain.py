"""What is uncertain of chapter 5's rod, as draws from stated ranges; nothing is fitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from ...core.arrays import Array
from ...dynamics import Friction, Scene, Striker
from ...dynamics.mechanisms import Mechanism, Surroundings
from ...dynamics.mechanisms.base import Constants, Values, attached


class Range(NamedTuple):
    """From where to where, even in the number or in its logarithm, and whose range it is."""

    low: float
    high: float
    log: bool
    source: str


RANGES: Mapping[str, Range] = {
    "mass [kg]": Range(
        0.4607, 0.567, False, "as stated; a cylinder with round ends of the stated size"
    ),
    "shank radius [m]": Range(
        7.94e-3, 8.8e-3, False, "a bar of 5/8 inch, which weighs as stated; as stated"
    ),
    "Cowper-Symonds rate [1/s]": Range(
        40.4, 114.0, True, "mild steel: Cowper and Symonds 1957; Hsu and Jones 2004"
    ),
    "Cowper-Symonds exponent": Range(5.0, 5.56, False, "the same two"),
    "loss factor of the rod": Range(1e-4, 1e-2, True, "a bare steel rod; one with markers on it"),
    "friction over the measured impulse ratio": Range(
        0.8, 1.5, False, "a tip that also slides back shows less than its coefficient"
    ),
    "angle [deg]": Range(-1.7, 1.7, False, "standard deviation of 1 degree"),
}
"""Drawn numbers; the last two anew for every angle, the others once a rod."""

_SHARED = 5


@dataclass(frozen=True, slots=True)
class Rod:
    """One draw.

    Parameters
    ----------
    mass, radius
        [kg], of the shank [m].
    rate, exponent
        D [1/s] and q of Cowper and Symonds.
    loss
        Loss factor of the vibrations [-].
    friction, tilt
        (angles,) coefficient over the measured impulse ratio; what to add to the angle [deg].
    """

    mass: float
    radius: float
    rate: float
    exponent: float
    loss: float
    friction: tuple[float, ...]
    tilt: tuple[float, ...]

    @property
    def hardening(self) -> Values:
        """Cowper and Symonds's 1 + (r/D)^(1/q) in the terms of the mechanism."""
        rise = (1000.0 / self.rate) ** (1.0 / self.exponent)
        return {
            "rise_at_1000_per_s": rise, "rate_exponent": 1.0 / self.exponent, "strength_kept": 1.0,
        }  # fmt: skip


def draw_rods(count: int, angles: int, *, seed: int = 0) -> list[Rod]:
    """Return `count` rods, spread evenly over all ranges (Latin hypercube)."""
    shared = list(RANGES.values())[:_SHARED]
    friction, tilt = list(RANGES.values())[_SHARED:]
    ranges = [*shared, *[friction] * angles, *[tilt] * angles]
    places = qmc.LatinHypercube(len(ranges), seed=np.random.default_rng(seed)).random(count)
    found = []
    for row in places:
        x = [_at(r, float(p)) for r, p in zip(ranges, row, strict=True)]
        mu, lean = x[_SHARED : _SHARED + angles], x[_SHARED + angles :]
        found.append(Rod(x[0], x[1], x[2], x[3], x[4], tuple(mu), tuple(lean)))
    return found


def _at(known: Range, place: float) -> float:
    if known.log:
        return float(known.low * (known.high / known.low) ** place)
    return known.low + (known.high - known.low) * place


def scenes_of(
    rods: Sequence[Rod], stated: Sequence[Scene], ratios: Array, mechanisms: Sequence[Mechanism],
    literature: Constants, around: Surroundings,
) -> list[Scene]:  # fmt: skip
    """Return the scene of every rod at every angle, the angles of one rod together.

    Parameters
    ----------
    rods
        The draws.
    stated
        The impacts as stated, one an angle.
    ratios
        (angles,) measured impulse ratios.
    mechanisms
        What acts.
    literature
        Published constants; those of the rate are replaced by the draw's.
    around
        Of the rig.
    """
    found = []
    for rod in rods:
        constants = {**literature, "strain-rate-hardening": rod.hardening}
        for scene, ratio, share, lean in zip(stated, ratios, rod.friction, rod.tilt, strict=True):
            a, s = scene.approach, scene.striker
            scene = scene.with_(
                striker=Striker(rod.mass, s.tip_radius, s.length, rod.radius, name=s.name),
                approach=replace(a, angle=a.angle + np.radians(lean)),
                friction=Friction(share * ratio),
            )
            scene = attached(mechanisms, scene, constants, around)
            found.append(scene.with_(modes=replace(scene.modes, loss_factor=rod.loss)))
    return found
