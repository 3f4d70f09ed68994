"""One material point, walked along a path of deformation with the production stress update."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.material import Material
from ...fem.material import EXACT, FlowLaws, exponential, laws_of, no_laws
from ...fem.material import return_map as lanes
from ...fem.material.flow import law_at

IDENTITY = np.array([1.0, 0.0, 0.0, 1.0, 1.0])

_LANE = 13  # of the point; in the others points are at rest


class Updated(NamedTuple):
    """A point after a step: deviator (rr, zz, rz, tt) and mean of its elastic strain, and flow.

    `slip` is the length of the plastic increment, `worked` the mean radius of the yield circle
    meanwhile.
    """

    e: Array
    mean: float
    flows: bool
    slip: float
    worked: float


class MaterialPoint:
    """A point, in units of its modulus.

    - `G`: shear modulus.
    - `radius`: of the yield circle, sqrt(2/3) Sy/(2 G), of a metal without a flow law.
    - `laws`: the flow law, if there is one.
    - `seconds`: duration of every step.
    - `rule`: stress update.
    - `unit`: the modulus [Pa].
    """

    def __init__(
        self, G: float, *, radius: float = math.inf, laws: FlowLaws | None = None,
        seconds: float = math.inf, rule: int = EXACT, unit: float = 1.0,
    ) -> None:  # fmt: skip
        self.G, self.rule, self.seconds, self.unit = G, rule, seconds, unit
        self._radius = radius if laws is None else float(laws.curve[0, 1, 0])
        self._law, self._laws = float(laws is not None), laws or no_laws()
        self.strain, self.work = 0.0, 0.0
        self.rest(IDENTITY, np.array([1.0, 1.0, 0.0, 1.0]), np.zeros(4))

    @classmethod
    def of(cls, metal: Material, *, seconds: float, rule: int = EXACT) -> MaterialPoint:
        """The point of a metal that flows."""
        shear = metal.E / (2.0 * (1.0 + metal.nu))
        laws = laws_of([(metal, shear)], metal.E)
        return cls(shear / metal.E, laws=laws, seconds=seconds, rule=rule, unit=metal.E)

    def rest(self, F: Array, b: Array, e: Array) -> None:
        """Put it where steps begin: F (5,), elastic b (4,) and deviator of its strain (4,)."""
        self._last = F, b, e

    def _rows(self, F: Array) -> tuple[Array, Array]:
        """Rows of all lanes after the step to `F`, and them by lane, (rows, L)."""
        w = np.zeros(lanes.OTHERS)
        rows = w.reshape(-1, lanes.L)
        first = [n // lanes.L for n in (lanes.F0, lanes.O0, lanes.B0, lanes.E0)]
        still = (IDENTITY, IDENTITY, np.array([1.0, 1.0, 0.0, 1.0]), np.zeros(4))
        for at, rest, mine in zip(first, still, (F, *self._last), strict=True):
            rows[at : at + len(rest)] = rest[:, None]
            rows[at : at + len(rest), _LANE] = mine
        radius, law = rows[lanes.R0 // lanes.L], rows[lanes.LAW // lanes.L]
        rows[lanes.G2 // lanes.L], radius[:] = 2.0 * self.G, 1.0
        radius[_LANE], law[_LANE] = min(self._radius, 1e30), self._law
        if self._law:
            _, radius[_LANE] = law_at(self._laws, 0, self.strain, self.work, 0.0, math.inf)
        rows[lanes.STRAIN // lanes.L, _LANE] = self.strain
        rows[lanes.WORK // lanes.L, _LANE] = self.work
        lanes.stresses(w, float(self.rule == EXACT), self._laws, self.seconds)
        return w, rows[:, _LANE]

    def walk(self, F: Array, *, stay: bool = False) -> Updated:
        """Take the step to a deformation gradient (5,); `stay`: look only."""
        _, found = self._rows(F)
        row = [
            found[n // lanes.L] for n in (lanes.M, lanes.FLOWS, lanes.SLIP, lanes.WORKED)
        ]  # fmt: skip
        e = found[lanes.E0 // lanes.L :][:4].copy()
        done = Updated(e, float(row[0]), bool(row[1]), float(row[2]), float(row[3]))
        if not stay:
            self.rest(F, np.array(exponential(e, done.mean)), e)
            self.strain += math.sqrt(2.0 / 3.0) * done.slip
            self.work += 2.0 * self.G * done.worked * done.slip
        return done

    def stress(self, F: Array) -> Array:
        """Deviatoric first Piola-Kirchhoff stress after that step, shape (5,) [E]."""
        _, found = self._rows(F)
        return found[lanes.P0 // lanes.L :][:5].copy()

    def tangent(self, F: Array) -> Array:
        """Its derivative by F, shape (5, 5) [E]."""
        w, found = self._rows(F)
        lanes.tangents(w)
        return found[lanes.TANGENT // lanes.L :][:25].reshape(5, 5).T.copy()

    def mises(self, done: Updated) -> float:
        """Von Mises stress of an isochoric step [Pa]."""
        e = done.e
        square = e[0] ** 2 + e[1] ** 2 + e[3] ** 2 + 2.0 * e[2] ** 2
        return float(2.0 * self.G * self.unit * math.sqrt(1.5 * square))


def stretched(strain: float) -> Array:
    """Isochoric tension along z by a logarithmic strain."""
    across = math.exp(-0.5 * strain)
    return np.array([across, 0.0, 0.0, math.exp(strain), across])
