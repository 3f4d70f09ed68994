"""A second sphere in place of the flat: the one sphere on a flat that answers for both.

Of two spheres the distance of their surfaces and the motion along them follow the same equations as
of one sphere of radius R, 1/R = 1/R_1 + 1/R_2 (Hertz), and mass m, 1/m = 1/m_1 + 1/m_2: along the
normal exactly, along the tangent for solid spheres, whose 1/m + r^2/I is 7/(2 m) whatever their
size. A seat is a sphere of negative radius; a body that is held has no mass of its own.

The smaller sphere, of the larger curvature, is the law's, whichever of the two strikes: the other
one is the nearer to a flat. Where both yield, our laws are taken at its own radius
(`models.turned.similar`). Finite elements of two spheres (tools/benchmarks/two_spheres.py, E/300,
quick, up to 0.05 R) with R_2 = 1, 1.4, 2 and 3 R_1 carry what the fitted law then says within 0.8 %
where the smaller is the weaker or both are alike, where by 1/R alone they carry up to 10 % more; of
a larger one that is the weaker 4.7 and 2.1 % less at R_2 = R_1 and 2 R_1; in a seat of -3 R_1
(E/341) 0.5, 1 and 1.7 % less at 0.01, 0.02 and 0.04 R, by 1/R alone 13 %.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.inputs.rig_numbers import RigNumbers, solid_inertia
from ...core.inputs.second_sphere import StruckSphere
from ...core.material import Pair
from ...models import LAWS
from ...models.base import ContactLaw, unwarned
from ...models.turned import SimilarLaw, as_made, similar, turned
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
        pair = replace(scene.pair, R=R)
        law = self.faced(scene.law, pair)
        # spin turns the surface as fast as before: r w
        spin = scene.approach.spin * striker.tip_radius / R
        one = Striker(
            mass=mass, tip_radius=R, radius=striker.radius, inertia=solid_inertia(mass, R, 0.0),
            name=striker.name,
        )  # fmt: skip
        return scene.with_(
            law=law, pair=pair, gravity=0.0 if self.free else scene.gravity,
            striker=one, approach=replace(scene.approach, spin=spin),
        )  # fmt: skip

    def faced(self, law: ContactLaw, pair: Pair) -> ContactLaw:
        """Return the law as the two of a pair face each other, whose R is that of both.

        The smaller one has it, of equal ones the weaker: finite elements are nearer to that.
        """
        smaller, struck = self._smaller(pair.R, pair.flat.strength < pair.sphere.strength)
        law = similar(law, smaller / pair.R)
        return turned(law) if struck else law

    def _smaller(self, R: float, weaker: bool = False) -> tuple[float, bool]:
        """Radius of the sphere of the larger curvature, R being that of both; whether it is this.

        Of equal ones it is this where it is `weaker`; in a seat it is the other.
        """
        own = 1.0 / (1.0 / R - 1.0 / self.radius)
        alike = math.isclose(own, self.radius, rel_tol=1e-9)
        struck = weaker if alike else 0.0 < self.radius < own
        return self.radius if struck else own, struck

    def departure(self, law: ContactLaw, pair: Pair, delta: float | Array) -> Array:
        """Return how far the force of a law of theirs may be off where both yield, relative, (...).

        What the radius of the smaller sphere makes of two bodies of the weaker metal at the
        approach (...) [m]. A law that has it keeps a seventh, for what finite elements differ by.
        Where the larger one is the weaker it has not: of equal spheres either could be the law's,
        and what that would change is kept, times (2 R/R_2)^2; all of it in a seat.
        """
        # a film can leave no depth at all
        depth = np.maximum(np.asarray(delta, dtype=float), 1e-9 * pair.R)
        if not math.isfinite(pair.Sy_min):
            return np.zeros_like(depth)
        own, there = as_made(law, pair)
        radii = np.abs(radius_error(pair, depth, self._smaller(pair.R)[0] / pair.R))
        if not isinstance(own, SimilarLaw):
            return np.asarray(radii)
        flat = 1.0 - (own.scale(there) - 1.0) / (own.ratio - 1.0)
        if self.radius > 0.0 and flat > 0.0:
            fitted, equal = LAWS["fitted"], similar(LAWS["fitted"], 2.0)
            with unwarned():
                either = equal.loading(there.turned, depth) / fitted.loading(there, depth) - 1.0
            kept = (2.0 * self._other(pair.R)) ** 2 * np.abs(either)
        else:
            kept = radii
        return np.asarray((1.0 - flat) / 7.0 * radii + flat * kept)

    def _other(self, R: float) -> float:
        """Curvature of the larger body over that of both, 1/R: 0 of a flat, 1/2 of equal ones."""
        here = R / abs(self.radius)
        return here if self.radius < 0.0 else min(here, 1.0 - here)

    def crater_departure(self, pair: Pair, delta: float | Array) -> Array:
        """Return how far the struck body's share of what stays may be off, relative, (...).

        The law parts it between a sphere and a flat. Of two equal spheres neither is the flat: the
        truth lies midway to the share that either would have as the other. Laws of ours have that
        (`SimilarLaw.turn`), and are as unsure of it.
        """
        depth = np.asarray(delta, dtype=float)
        if not math.isfinite(pair.Sy_min):
            return np.zeros_like(depth)
        with unwarned():
            # a rigid partner is beyond the strengths that were fitted
            ball, as_flat = LAWS["fitted"].residual(pair, depth)
            as_sphere, other = LAWS["fitted"].residual(pair.turned, depth)
        # a body that keeps next to nothing either way has no share to be unsure of
        least = 0.01 * (ball + as_flat + as_sphere + other) + 1e-12 * pair.R
        apart = np.log(np.maximum(as_flat, least) / np.maximum(as_sphere, least))
        return np.asarray(self._other(pair.R) * np.abs(apart))


def second_of(numbers: RigNumbers) -> SecondSphere | None:
    """Return the second sphere of a rig; none where a flat is struck."""
    radius = numbers.of.get("target.radius_m")
    if radius is None:
        return None
    return SecondSphere(radius, numbers.of.get("target.mass_kg", math.inf))


def radius_error(pair: Pair, delta: float | Array, ratio: float) -> Array:
    """Return how much more two spheres carry than one on a flat is said to, relative, (...).

    Both of the weaker metal of the pair; `delta` (...) [m]; `ratio`: radius of the smaller over R.
    """
    both = Pair(pair.weaker, pair.weaker, pair.R)
    # a film can leave no depth at all
    depth = np.maximum(np.asarray(delta, dtype=float), 1e-9 * pair.R)
    with unwarned():
        laws = (LAWS["fitted"], similar(LAWS["fitted"], ratio))
        one, two = (law.loading(both, depth) for law in laws)
    return np.asarray(two / one - 1.0)
