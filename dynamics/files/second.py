"""A second sphere in place of the flat: the one sphere on a flat that answers for both.

Of two spheres the distance of their surfaces and the motion along them follow the same equations as
of one sphere of radius R, 1/R = 1/R_1 + 1/R_2 (Hertz), and mass m, 1/m = 1/m_1 + 1/m_2: along the
normal exactly, along the tangent for solid spheres, whose 1/m + r^2/I is 7/(2 m) whatever their
size. A seat is a sphere of negative radius; a body that is held has no mass of its own.

How far 1/R holds where both yield is known best of two equal spheres: they are each other's mirror,
and so each is a sphere of its own on a rigid flat that is pressed half as deep. Finite elements of
that sphere carry 3 % more at an approach of 0.02 R and 26 % more at 0.1 R than those of a sphere on
a flat of its metal (E/341); the fitted law, which both sides are taken from, says so within 1.5 %.
Finite elements of two spheres (tools/benchmarks/two_spheres.py, E/341, coarse) carry at 0.04 R with
R_2 = 1, 1.5, 3, 6 and 20 R_1 6.8, 6.2, 4.3, 3.8 and 1.3 % more, at 0.02 R 2.4, 2.0, 2.1, 1.1 and
0.7 %: as the root of R/R_2. In a seat of -3 R_1 they carry 1.1, 4.7 and 12.8 % less at 0.01, 0.02
and 0.04 R, twice the mirror's departure.

The smaller sphere, of the larger curvature, is the law's, whichever of the two strikes: the other
one is the nearer to a flat.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.inputs.rig_numbers import RigNumbers, solid_inertia
from ...core.inputs.second_sphere import StruckSphere
from ...core.material import Pair
from ...models import LAWS
from ...models.base import DomainWarning
from ...models.turned import turned
from ..scene import Scene, Striker


@dataclass(frozen=True, slots=True)
class SecondSphere(StruckSphere):
    """A sphere that is struck, in a scene."""

    def facing(self, scene: Scene) -> Scene:
        """Return the impact of one sphere on a flat that is this one's.

        The striking sphere keeps its own radius where it flies; a seat no wider is refused.
        """
        striker = scene.striker
        R, mass = self.equivalent(striker.tip_radius), self.reduced(striker.mass)
        # the smaller sphere, of the larger curvature, is the law's: the other one is nearer a flat
        law = turned(scene.law) if 0.0 < self.radius < striker.tip_radius else scene.law
        # spin turns the surface as fast as before: r w
        spin = scene.approach.spin * striker.tip_radius / R
        one = Striker(
            mass=mass, tip_radius=R, radius=striker.radius, inertia=solid_inertia(mass, R, 0.0),
            name=striker.name,
        )  # fmt: skip
        return scene.with_(
            law=law, pair=replace(scene.pair, R=R), gravity=0.0 if self.free else scene.gravity,
            striker=one, approach=replace(scene.approach, spin=spin),
        )  # fmt: skip

    def departure(self, pair: Pair, delta: float | Array) -> Array:
        """Return how far 1/R may be off where both yield: the force's part, relative, (...).

        The mirror's departure at the approach (...) [m] times the root of 2 R/R_2, R_2 of the
        larger; in a seat twice that, and 4 R/|R_2| times it as the seat closes, which is chosen.
        """
        if not math.isfinite(pair.Sy_min):
            return np.zeros_like(np.asarray(delta, dtype=float))
        other = self._other(pair.R)
        size = math.sqrt(2.0 * other)
        size = max(2.0 * size, 4.0 * other) if self.radius < 0.0 else size
        return size * np.abs(mirror_error(pair, delta))

    def _other(self, R: float) -> float:
        """Curvature of the larger body over that of both, 1/R: 0 of a flat, 1/2 of equal ones."""
        here = R / abs(self.radius)
        return here if self.radius < 0.0 else min(here, 1.0 - here)

    def crater_departure(self, pair: Pair, delta: float | Array) -> Array:
        """Return how far the struck body's share of what stays may be off, relative, (...).

        The law parts it between a sphere and a flat. Of two equal spheres neither is the flat: the
        truth lies midway to the share that either would have as the other.
        """
        depth = np.asarray(delta, dtype=float)
        if not math.isfinite(pair.Sy_min):
            return np.zeros_like(depth)
        with warnings.catch_warnings(action="ignore", category=DomainWarning):
            # a rigid partner is beyond the strengths that were fitted
            _, as_flat = LAWS["fitted"].residual(pair, depth)
            as_sphere, _ = LAWS["fitted"].residual(pair.turned, depth)
        stays = (as_flat > 0.0) & (as_sphere > 0.0)
        apart = np.log(np.where(stays, as_flat, 1.0) / np.where(stays, as_sphere, 1.0))
        return np.asarray(self._other(pair.R) * np.abs(apart))


def second_of(numbers: RigNumbers) -> SecondSphere | None:
    """Return the second sphere of a rig; none where a flat is struck."""
    radius = numbers.of.get("target.radius_m")
    if radius is None:
        return None
    return SecondSphere(radius, numbers.of.get("target.mass_kg", math.inf))


def mirror_error(pair: Pair, delta: float | Array) -> Array:
    """Return how much more two equal spheres carry than one on a flat is said to, relative, (...).

    Sphere and flat of radius R are both taken to be of the weaker metal; `delta` (...) [m].
    """
    law, body = LAWS["fitted"], pair.weaker
    both = Pair(body, body, pair.R)
    # one of two equal spheres, R being half of its radius, on what mirrors it: a rigid flat
    half = Pair(body, body.with_(rigid=True), 2.0 * pair.R)
    # a film can leave no depth at all
    depth = np.maximum(np.asarray(delta, dtype=float), 1e-9 * pair.R)
    with warnings.catch_warnings(action="ignore", category=DomainWarning):
        # a rigid partner is beyond the strengths that were fitted
        return np.asarray(law.loading(half, 0.5 * depth) / law.loading(both, depth) - 1.0)
