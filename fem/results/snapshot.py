"""The full fields of one converged state, in SI units."""

from __future__ import annotations

import numpy as np

from ...core.material import Pair
from ..discretise import Discretisation
from ..elements import State, cauchy_stress
from ..newton import Equilibrium
from ..solution import Profile, Snapshot


def take_snapshot(
    grid: Discretisation, found: Equilibrium, state: State, *, depth: float, pair: Pair
) -> Snapshot:
    """Collect stresses, strains, displacements and the two surfaces of a converged state."""
    R, unit = pair.R, grid.stress_unit
    mesh, index = grid.mesh, grid.element_index
    n = len(mesh.quads)
    deviator, mean = cauchy_stress(grid.elements, state)
    mises = np.sqrt(
        1.5 * ((deviator[..., [0, 1, 3]] ** 2).sum(axis=-1) + 2.0 * deviator[..., 2] ** 2)
    )
    stress = deviator.mean(axis=1)
    stress[:, [0, 1, 3]] += mean[:, None]
    return Snapshot(
        depth=depth,
        points=mesh.points * R,
        quads=mesh.quads,
        n_sphere_quads=mesh.n_sphere_quads,
        displacement=found.u.reshape(-1, 2) * R,
        von_mises=_everywhere(mises.mean(axis=1) * unit, index, n),
        plastic_strain=_everywhere(state.peeq.mean(axis=1), index, n),
        mean_stress=_everywhere(mean * unit, index, n),
        stress=_everywhere(stress * unit, index, n),
        profile=take_profile(grid, found, depth=depth, pair=pair),
    )


def take_profile(grid: Discretisation, found: Equilibrium, *, depth: float, pair: Pair) -> Profile:
    """Collect the contact pressure and the shapes of the two surfaces."""
    x = (grid.mesh.points + found.u.reshape(-1, 2)) * pair.R
    sphere, flat = grid.surfaces.sphere, grid.surfaces.flat
    return Profile(
        depth=depth,
        sphere_r=x[sphere, 0],
        sphere_z=x[sphere, 1],
        pressure=_current_pressure(grid, found) * grid.stress_unit,
        flat_r=x[flat, 0],
        flat_z=x[flat, 1],
    )


def _everywhere(values: np.ndarray, index: np.ndarray, n: int) -> np.ndarray:
    """Values on all elements; zero in a rigid body."""
    out = np.zeros((n, *values.shape[1:]))
    out[index] = values
    return out


def _current_pressure(grid: Discretisation, found: Equilibrium) -> np.ndarray:
    """Pressure at the sphere's surface nodes on the current area, not the reference one."""
    surfaces = grid.surfaces

    def radii(nodes: np.ndarray) -> np.ndarray:
        return np.asarray(grid.mesh.points[nodes, 0] + found.u[2 * nodes])

    r0, r = grid.mesh.points[surfaces.slave, 0], radii(surfaces.slave)
    edge0, edge = np.diff(r0**2), np.diff(r**2)
    area0, area = (np.append(e, 0.0) + np.insert(e, 0, 0.0) for e in (edge0, edge))
    pressure = found.contact.pressure * area0 / area
    return np.asarray(np.interp(radii(surfaces.sphere), r, pressure, right=0.0))
