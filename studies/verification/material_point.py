"""One material point, walked along a path of deformation with the production stress update."""

from __future__ import annotations

import math

import numpy as np

from ...core.arrays import Array
from ...core.material import Material
from ...fem.laws import laws_of
from ...fem.material import (
    EXACT,
    NO_LAW,
    MaterialStep,
    Updated,
    deviatoric_pk1,
    elastic_deviator,
    exponential,
    hardened,
    law_of,
)

IDENTITY = np.array([1.0, 0.0, 0.0, 1.0, 1.0])


class MaterialPoint:
    """A point of a metal that flows, in units of its modulus.

    Parameters
    ----------
    metal
        With a flow law.
    seconds
        Duration of every step.
    rule
        Stress update.
    """

    def __init__(self, metal: Material, *, seconds: float, rule: int = EXACT) -> None:
        self.shear = metal.E / (2.0 * (1.0 + metal.nu))
        self.G = self.shear / metal.E
        laws = laws_of([(metal, self.shear)], metal.E)
        self.curve = laws.curve[0]
        self._law = law_of(laws, 0, 2.0 * self.G, seconds)
        self._last = MaterialStep(
            IDENTITY, IDENTITY, np.array([1.0, 1.0, 0.0, 1.0]), np.zeros(4),
            float(self.curve[1, 0]), rule, False, NO_LAW,
        )  # fmt: skip
        self.strain, self.work = 0.0, 0.0

    def step(self, F: Array) -> MaterialStep:
        """The step from where the point is to a deformation gradient (5,)."""
        step: MaterialStep = hardened(
            self._last._replace(F=F), self._law, self.curve, self.strain, self.work
        )
        return step

    def walk(self, F: Array) -> Updated:
        """Take that step."""
        done: Updated = elastic_deviator(self.step(F), self.curve)
        self._last = self._last._replace(
            F_old=F, b_old=np.array(exponential(done.e, done.mean)), e_old=np.array(done.e)
        )
        self.strain += math.sqrt(2.0 / 3.0) * done.slip
        self.work += 2.0 * self.G * done.worked * done.slip
        return done

    def stress(self, F: Array) -> Array:
        """Deviatoric first Piola-Kirchhoff stress after that step, shape (5,) [E]."""
        P = np.empty(5)
        deviatoric_pk1(self.step(F), self.curve, self.G, P)
        return P

    def mises(self, done: Updated) -> float:
        """Von Mises stress of an isochoric step [Pa]."""
        e = done.e
        square = e[0] ** 2 + e[1] ** 2 + e[3] ** 2 + 2.0 * e[2] ** 2
        return float(2.0 * self.shear * math.sqrt(1.5 * square))


def stretched(strain: float) -> Array:
    """Isochoric tension along z by a logarithmic strain."""
    across = math.exp(-0.5 * strain)
    return np.array([across, 0.0, 0.0, math.exp(strain), across])
