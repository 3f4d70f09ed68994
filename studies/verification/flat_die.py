"""A sphere pressed into a rigid, power-law plastic half-space: the self-similar solution.

Where the flow stress is K p^n and no strain is elastic or large, every stage of the indentation is
the same but for its size (Hill, Storakers and Zdunek, Proc. R. Soc. A 423 (1989) 301; Biwa and
Storakers, J. Mech. Phys. Solids 43 (1995) 1303). The velocities are those under a flat die of the
present contact radius a; the plastic strain of a point is what it has gathered while the contact
grew, so that along a ray from the first point of contact it follows from the strain rate farther
out. With x = place/a, strain rate h'(t)/a e(x) and plastic strain a/(R c^2) E(x),

    E(x) = integral from 0 to 1 of e(x/s) ds,    c^2 = a^2/(2 R h) = 1 - 2 integral of s v(1/s) ds,

v the surface's velocity over the die's. This is small strain, Levy and Mises's flow rule and an
incompressible velocity on a mesh of its own by scikit-fem; it shares nothing with the solver.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as sparse_linalg
import skfem
from skfem.helpers import grad

from ...core.arrays import Array, Integers

_INNER, _OUTER = 0.01, 50.0  # [a]: a rigid speck at the first point, and where nothing moves
_FLOOR = 1e-6  # least strain and strain rate: farther out it is as good as rigid
_ORDER = 5  # of the quadrature
# of the element sizes away from the die's edge, in log(distance/a) and in angle; half as many
# elements a side move neither result by more than 0.15 %
_GROWTH, _LARGEST = 1.4, 0.2
_MOST_ROUNDS = 200
_STILL = 1e-6


@dataclass(frozen=True)
class Similar:
    """Contact of one exponent.

    `invariant`: c^2 = a^2/(2 R h); `pressure`: mean pressure over K (a/R)^n.
    """

    invariant: float
    pressure: float


def similar(n: float, *, before: float = 0.0) -> Similar:
    """Solve for velocities and plastic strains in turn until neither changes.

    - `n`: exponent of the plastic strain.
    - `before`: what the flow stress counts beside the plastic strain, K (e0 + p)^n, as e0 R c^2/a.
    """
    die = Die(_GROWTH, _LARGEST)
    viscosity = np.full(die.radius.shape, 1.0 / 3.0)
    found = Similar(math.nan, math.nan)
    for _ in range(_MOST_ROUNDS):
        force, surface, rate = die.velocities(viscosity)
        strain = die.gathered(rate)
        last, c2 = found, 1.0 - 2.0 * die.sunk(surface)
        found = Similar(c2, force / math.pi * c2**-n)
        viscosity = (before + strain) ** n / (3.0 * rate)
        moved = abs(found.invariant - last.invariant), abs(found.pressure / last.pressure - 1.0)
        if max(moved) < _STILL:
            return found
    raise ArithmeticError(f"velocities under the die still change after {_MOST_ROUNDS} rounds")


def _graded(growth: float, largest: float, end: float) -> Array:
    """From 0 to an end, finest at 0."""
    places, size = [0.0], 1e-4
    while places[-1] < end:
        places.append(places[-1] + size)
        size = min(size * growth, largest)
    return np.array(places) * (end / places[-1])


class Die:
    """A flat die of radius 1 that sinks at speed 1; rings and rays, finest at its edge."""

    def __init__(self, growth: float, largest: float, outer: float = _OUTER) -> None:
        inwards = _graded(growth, largest, -math.log(_INNER))
        outwards = _graded(growth, largest, math.log(outer))
        rings = np.concatenate([-inwards[::-1], outwards[1:]])
        rays = 0.5 * math.pi - _graded(growth, largest, 0.5 * math.pi)[::-1]
        rays[0] = 0.0
        flat = skfem.MeshQuad.init_tensor(rings, rays)
        curved = skfem.MeshQuad2.from_mesh(flat)
        distance, angle = np.exp(curved.doflocs[0]), curved.doflocs[1]
        places = np.stack([distance * np.sin(angle), distance * np.cos(angle)])
        places[0, angle < 1e-12] = 0.0
        mesh = skfem.MeshQuad2(places, curved.t)
        self._v = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=_ORDER)
        self._p = self._v.with_element(skfem.ElementQuad1())
        self.radius, depth = np.asarray(self._v.global_coordinates())
        self.distance = np.hypot(self.radius, depth)
        self._grid = _along_rays(flat, rings, rays, self.distance.shape)
        self._log = np.log(self.distance).ravel()[self._grid]
        self._hold(outer)
        self._continuity = _continuity.assemble(self._v, self._p, r=self.radius)

    def _hold(self, outer: float) -> None:
        place = self._v.doflocs
        distance = np.hypot(*place)
        downwards = np.zeros(self._v.N, dtype=np.bool_)
        for dofs in (self._v.nodal_dofs, self._v.facet_dofs, self._v.interior_dofs):
            downwards[dofs[1]] = True
        surface = np.abs(place[1]) < 1e-9 * np.maximum(distance, 1.0)
        die = downwards & surface & (distance < 1.0 + 1e-9)
        speck = distance < _INNER * (1.0 + 1e-6)
        axis = ~downwards & (place[0] < 1e-12)
        self._moved = die | (speck & downwards)
        self._free = ~(die | speck | axis | (distance > outer * (1.0 - 1e-6)))
        outside = np.flatnonzero(downwards & surface & (distance >= 1.0 - 1e-9))
        self._outside = outside[np.argsort(distance[outside])]
        self._at = distance[self._outside]

    def velocities(self, viscosity: Array) -> tuple[float, Array, Array]:
        """Force on the die, speeds of the surface beside it (n,), strain rates at the points."""
        stiffness = _stiffness.assemble(self._v, viscosity=viscosity, r=self.radius)
        n_p = self._p.N
        whole = sparse.bmat(
            [[stiffness, self._continuity.T], [self._continuity, -1e-10 * sparse.eye(n_p)]]
        ).tocsc()
        x = np.concatenate([self._moved.astype(float), np.zeros(n_p)])
        free = np.concatenate([np.flatnonzero(self._free), self._v.N + np.arange(n_p)])
        x[free] = sparse_linalg.splu(whole[free][:, free].tocsc()).solve(-(whole @ x)[free])
        force = 2.0 * math.pi * float((whole @ x)[: self._v.N][self._moved].sum())
        v = self._v.interpolate(x[: self._v.N])
        (rr, rz), (zr, zz) = np.asarray(grad(v))
        hoop = np.asarray(v)[0] / self.radius
        rate = np.sqrt(2.0 / 3.0 * (rr**2 + zz**2 + hoop**2 + 0.5 * (rz + zr) ** 2))
        return force, x[self._outside], np.maximum(rate, _FLOOR)

    def gathered(self, rate: Array) -> Array:
        """E, from the strain rates along each ray."""
        share = rate.ravel()[self._grid] * np.exp(-self._log)
        steps = 0.5 * (share[1:] + share[:-1]) * np.diff(self._log, axis=0)
        beyond = np.zeros_like(share)
        beyond[:-1] = np.cumsum(steps[::-1], axis=0)[::-1]
        strain = np.empty(rate.size)
        strain[self._grid] = np.exp(self._log) * beyond
        return np.maximum(strain.reshape(rate.shape), _FLOOR)

    def sunk(self, surface: Array) -> float:
        """Integral of s v(1/s) ds over s from 0 to 1."""
        return float(np.trapezoid(surface / self._at**2, np.log(self._at)))


def _along_rays(flat: Any, rings: Array, rays: Array, shape: tuple[int, ...]) -> Integers:
    """Numbers of the quadrature points by distance and by ray, (n_distances, n_rays)."""
    middle = flat.p[:, flat.t].mean(axis=1)
    ring = np.searchsorted(rings, middle[0]) - 1
    ray = np.searchsorted(rays, middle[1]) - 1
    # all elements count their points alike: three distances on three rays, or as many
    place = flat.mapping().F(skfem.quadrature.get_quadrature(skfem.refdom.RefQuad, _ORDER)[0])
    nearer, beside = (np.unique(np.round(row, 9), return_inverse=True)[1] for row in place[:, 0, :])
    side = math.isqrt(shape[1])
    grid = np.empty((len(rings[1:]) * side, len(rays[1:]) * side), dtype=np.int64)
    grid[ring[:, None] * side + nearer, ray[:, None] * side + beside] = np.arange(
        math.prod(shape)
    ).reshape(shape)
    return grid


def _viscous(u: Any, v: Any, w: Any) -> Any:
    gu, gv = grad(u), grad(v)
    shear = 0.5 * (gu[0, 1] + gu[1, 0]) * (gv[0, 1] + gv[1, 0])
    hoop = u[0] * v[0] / w.r**2
    return 2.0 * w.viscosity * w.r * (gu[0, 0] * gv[0, 0] + gu[1, 1] * gv[1, 1] + hoop + shear)


def _divergence(u: Any, q: Any, w: Any) -> Any:
    g = grad(u)
    return -(g[0, 0] + g[1, 1] + u[0] / w.r) * q * w.r


_stiffness = skfem.BilinearForm(_viscous)
_continuity = skfem.BilinearForm(_divergence)
