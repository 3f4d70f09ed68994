"""A second sphere in place of the flat, as every input file states it.

`[target] shape = "sphere"` with `radius_m`, negative of a concave seat, and `mass_kg` where it is
free. Of two spheres the distance of their surfaces follows that of one of radius R on a flat,
1/R = 1/R_1 + 1/R_2 (Hertz), and their motion that of one mass, 1/m = 1/m_1 + 1/m_2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import InputError, Mistake, amiss
from ..rig import StrikerTable, TargetTable, value_of


@dataclass(frozen=True, slots=True)
class StruckSphere:
    """A sphere that is struck: its radius [m], negative for a concave seat, and its mass [kg].

    The mass is infinite where it is held.
    """

    radius: float
    mass: float = math.inf

    @property
    def free(self) -> bool:
        """Whether it moves off."""
        return math.isfinite(self.mass)

    def equivalent(self, radius: float) -> float:
        """Return R of the sphere on a flat that answers for both, 1/R = 1/R_1 + 1/R_2 [m].

        A seat no wider than the striking sphere of radius R_1 is refused.
        """
        curvature = 1.0 / radius + 1.0 / self.radius
        if not curvature > 0.0:
            raise InputError(
                f"{self.radius:g}", key="target.radius_m",
                allowed=f"a seat wider than the sphere, below -{radius:g}, or above 0",
            )  # fmt: skip
        return 1.0 / curvature

    def reduced(self, mass: float) -> float:
        """Return m_1 m_2/(m_1 + m_2) [kg]; the striker's own where this one is held."""
        return mass / (1.0 + mass / self.mass)

    def parted(self, mass: float, speed: float, restitution: float) -> tuple[float, float]:
        """Return the normal speeds after, along the approach: the striker's, this one's [m/s].

        Momentum is kept, and the relative speed turns round: v_1 - v_2 = -e v.
        """
        share = 0.0 if math.isinf(self.mass) else mass / (mass + self.mass)
        own = speed * share * (1.0 + restitution)
        return own - restitution * speed, own

    def own_rebound(self, relative: Array, speed: Array | float, reduced: Array | float) -> Array:
        """Return the striker's rebound from the relative one, both against the approach [m/s].

        `relative` and `speed`, (...), are normal speeds of the striker to this one, after and
        before. What the mass `reduced` gives this one goes off with it.
        """
        return np.asarray(relative - reduced / self.mass * (speed + relative))

    def own_tangential(self, relative: Array, before: Array, reduced: Array | float) -> Array:
        """Return the striker's speed along the contact after, from the relative one [m/s]."""
        return np.asarray(before + (1.0 - reduced / self.mass) * (relative - before))

    def own_spin(
        self, relative: Array | float, approach: Array | float, R: Array | float,
        reduced: Array | float,
    ) -> Array:  # fmt: skip
        """Return the striking sphere's spin after, from that of the equivalent one [rad/s].

        `relative` and `approach`, (...), are spins of the equivalent sphere after and before, which
        turns its surface as fast; R is that of `equivalent`.
        """
        # friction's impulse P turns a solid sphere by P/(0.4 m R), the equivalent one by its own
        share = 1.0 - reduced / self.mass
        turned = np.asarray(approach) + share * (np.asarray(relative) - approach)
        return np.asarray((1.0 - R / self.radius) * turned)

    def turned(self, impulse: float) -> float:
        """Return the spin that an impulse along the contact gives this one [rad/s]; 0 if held."""
        return 0.0 if math.isinf(self.mass) else impulse / (0.4 * self.mass * self.radius)


def struck_sphere(target: TargetTable) -> StruckSphere | None:
    """Return the second sphere of a `[target]`; none where a flat is struck."""
    if target.shape != "sphere" or target.radius_m is None:
        return None
    return StruckSphere(target.radius_m.value, value_of(target.mass_kg, math.inf))


def second_sphere_mistakes(
    target: TargetTable, strikers: Mapping[str, StrikerTable]
) -> Iterator[Mistake]:
    """Return what a second sphere needs, and what only a flat has."""
    two = target.shape == "sphere"
    free = two and target.mass_kg is not None
    flat_only = 'with target.shape = "sphere"'
    wrong = [
        (two and target.radius_m is None, "target.radius_m", "missing", "of the second sphere"),
        (two and target.thickness_m is not None, "target.thickness_m", "of a sphere", "of a flat"),
        *(
            (free and getattr(target, name) is not None, f"target.{name}", "of a free sphere",
             "left out, or without target.mass_kg: a held one")
            for name in ("support_mass_kg", "support_stiffness_N_m")
        ),
        (not two and target.radius_m is not None, "target.radius_m", "of a flat", flat_only),
        (not two and target.mass_kg is not None, "target.mass_kg", "of a flat",
         f"{flat_only}; support_mass_kg of a sprung support"),
    ]  # fmt: skip
    for name, table in strikers.items() if two else ():
        key = f"strikers.{name}"
        wrong += [
            (table.shape == "rod", f"{key}.shape", "a rod on a sphere",
             '"sphere"; a ball on the end of a rod: impact.support = "rod"'),
            (table.tip_flat_radius_m is not None, f"{key}.tip_flat_radius_m", "on a sphere",
             "on a flat"),
            (table.inertia_kg_m2 is not None, f"{key}.inertia_kg_m2", "with a second sphere",
             "left out: both are solid"),
        ]  # fmt: skip
    return amiss(wrong)
