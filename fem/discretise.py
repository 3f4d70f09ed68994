"""From a contact problem and accuracy settings to the discrete model, with R = 1 and E' = 1."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import skfem

from ..core.arrays import Array, Integers, Mask
from ..core.material import Material, Pair
from .assemble import bulk_forces
from .contact import Surfaces
from .elements import Elements, State
from .material import EXACT, laws_of
from .mesh import Layers, Mesh, Zone, contact_mesh, ladder_rings, layers_of, outer_rings
from .problem import Accuracy, Clock, ContactProblem
from .rules import RULES

_GAUSS = 0.5 / math.sqrt(3.0)


@dataclass(frozen=True)
class Discretisation:
    """Mesh, elements, surfaces and boundary conditions of one solve.

    - `mesh`: nodes and quadrilaterals.
    - `elements`: constants of the elements that deform (a rigid body has none).
    - `element_index`: their numbers in the mesh.
    - `surfaces`: the two surfaces.
    - `driven`, `held`: degrees of freedom that move by -Delta, and those that stay.
    - `reaction`: driven degrees of freedom whose internal forces add up to the reaction; empty if
      the sphere is rigid.
    - `stress_unit`: E' [Pa].
    - `round_off`: sum of nodal forces that round-off in the deformation gradient makes [E' R^2];
      the large elements far from the contact rule it.
    - `clock`: time that the approach takes.
    - `fine`: ring width over radius along the path of the contact edge.
    """

    mesh: Mesh
    elements: Elements
    element_index: Integers
    surfaces: Surfaces
    driven: Integers
    held: Integers
    reaction: Integers
    stress_unit: float
    round_off: float
    clock: Clock
    fine: float

    @property
    def n_dofs(self) -> int:
        """Degrees of freedom, driven and held ones included."""
        return 2 * len(self.mesh.points)

    @cached_property
    def layers(self) -> tuple[Layers, Layers]:
        """Layers of the sphere and of the half-space."""
        return layers_of(self.mesh, sphere=True), layers_of(self.mesh, sphere=False)

    @property
    def slave_radius(self) -> Array:
        """Radii of the slave nodes in the undeformed state, shape (n_slave,) [R]."""
        return np.asarray(self.mesh.points[self.surfaces.slave, 0])

    @property
    def free(self) -> Integers:
        """Degrees of freedom that are solved for, in increasing order."""
        mask = np.ones(self.n_dofs, dtype=bool)
        mask[self.driven] = False
        mask[self.held] = False
        return np.flatnonzero(mask)


def discretise(
    problem: ContactProblem, accuracy: Accuracy, zone: Zone | None = None
) -> Discretisation:
    """Mesh the problem and set up its elements, surfaces and boundary conditions.

    The mesh is fine in `zone`; without one, all along the path of the contact edge.
    """
    mesh = _mesh(problem, accuracy, zone or whole_path(problem))
    pair = problem.pair
    r = mesh.points[:, 0]
    n = mesh.n_sphere_points
    node = np.arange(len(r))
    sphere = node < n
    axis = np.flatnonzero(r == 0.0)
    held = [2 * axis, 2 * mesh.far, 2 * mesh.far + 1]
    driven = [2 * mesh.top + 1]
    if problem.top == "held":
        held.append(2 * mesh.top)
    deforms = np.ones(len(mesh.quads), dtype=bool)
    if pair.sphere.rigid:
        deforms[: mesh.n_sphere_quads] = False
        held.append(2 * node[sphere])
        driven = [2 * node[sphere] + 1]
    if pair.flat.rigid:
        deforms[mesh.n_sphere_quads :] = False
        held += [2 * node[~sphere], 2 * node[~sphere] + 1]
    index = np.flatnonzero(deforms)
    elements = _elements(mesh, index, pair.sphere, pair.flat, pair.E_reduced)
    reach = np.hypot(*np.moveaxis(mesh.points[elements.conn], -1, 0)).min(axis=1)
    elements = with_linear(elements, reach > RULES.linear_beyond)
    slope = np.abs(elements.grad).sum(axis=(2, 3)) * (elements.linear < 0)[:, None]
    return Discretisation(
        mesh=mesh,
        elements=elements,
        element_index=index,
        surfaces=Surfaces.build(
            mesh.points,
            sphere=mesh.sphere_surface,
            flat=mesh.flat_surface,
            penalty=accuracy.penalty,
            flat_is_slave=_flat_is_slave(pair),
            friction=problem.friction,
        ),
        driven=np.unique(np.concatenate(driven)),
        held=np.unique(np.concatenate(held)),
        reaction=np.empty(0, np.int64) if pair.sphere.rigid else 2 * mesh.top + 1,
        stress_unit=pair.E_reduced,
        round_off=float(np.finfo(float).eps * (elements.K[:, None] * elements.dV * slope).sum()),
        clock=problem.clock,
        fine=accuracy.fine,
    )


def _flat_is_slave(pair: Pair) -> bool:
    """The weaker body, whose surface deforms the more, is the slave side."""
    return pair.sphere.rigid or pair.flat.strength < pair.sphere.strength


def whole_path(problem: ContactProblem) -> Zone:
    """Radii that the contact edge passes through from the first depth to the last."""
    return Zone(math.sqrt(problem.depths[0]), _last_radius(problem))


def _last_radius(problem: ContactProblem) -> float:
    deepest = max(problem.depths[-1], 0.5 * problem.radius_at_least**2)
    # a^2/(R Delta) tends to 2.6 in full plasticity, so the edge stays inside 1.7 sqrt(R Delta)
    last = 1.7 * math.sqrt(deepest) + 0.02
    return min(max(last, 1.08 * problem.radius_at_least), 0.9)


def _mesh(problem: ContactProblem, accuracy: Accuracy, zone: Zone) -> Mesh:
    # the gap beside the contact is read over some elements beyond its edge
    end = min(max(0.65, (1.0 + 6.0 * accuracy.fine) * _last_radius(problem)), 0.93)
    rings = ladder_rings(
        zone, core=RULES.core_radius * zone.low, end=end, fine=accuracy.fine, coarse=accuracy.coarse
    )
    far = outer_rings(end, accuracy.flat_radius, coarse=accuracy.coarse)
    return contact_mesh(
        rings=rings, far_rings=far[1:], divisions=accuracy.divisions, crowding=accuracy.crowding
    )


def with_linear(elements: Elements, mask: Mask) -> Elements:
    """Make the elements of `mask` linear: their stiffness is that of the undeformed state."""
    n = len(mask)
    tangent = np.empty((n, 8, 8))
    zero = np.zeros(2 * (int(elements.conn.max()) + 1))
    bulk_forces(
        elements, zero, state=State.virgin(n), rule=EXACT, force=zero.copy(), tangent=tangent
    )
    linear = np.full(n, -1)
    linear[mask] = np.arange(np.count_nonzero(mask))
    return elements._replace(stiffness=tangent[mask], linear=linear)


def _elements(
    mesh: Mesh, index: Integers, sphere: Material, flat: Material, unit: float
) -> Elements:
    geometry = geometry_of(skfem.MeshQuad(mesh.points.T.copy(), mesh.quads[index].T.copy()))
    geometry["grad"] = _softened(geometry["grad"], geometry["dV"])
    geometry = {name: np.ascontiguousarray(x) for name, x in geometry.items()}
    return Elements(**geometry, **_constants(index < mesh.n_sphere_quads, sphere, flat, unit))


def geometry_of(grid: skfem.MeshQuad) -> dict[str, Any]:
    """What `Elements` knows of a mesh alone, none of them linear."""
    low, high = 0.5 - _GAUSS, 0.5 + _GAUSS
    points = np.array([[low, high, high, low], [low, low, high, high]])
    basis = skfem.CellBasis(grid, skfem.ElementQuad1(), quadrature=(points, np.full(4, 0.25)))
    n = grid.t.shape[1]
    grad = np.stack([np.moveaxis(basis.basis[a][0].grad, 0, -1) for a in range(4)], axis=2)
    value = np.stack(
        [np.broadcast_to(np.asarray(basis.basis[a][0]), (n, 4))[0] for a in range(4)], axis=1
    )
    r = np.asarray(basis.global_coordinates())[0]
    dV = 2.0 * math.pi * r * basis.dx
    return {
        "conn": np.ascontiguousarray(basis.element_dofs.T.astype(np.int64)),
        "grad": np.ascontiguousarray(grad),
        "value": np.ascontiguousarray(value),
        "r": r,
        "dV": dV,
        "volume": dV.sum(axis=1),
        "stiffness": np.empty((0, 8, 8)),
        "linear": np.full(n, -1),
    }


def _softened(grad: Array, dV: Array) -> Array:
    """Gradients whose departure from the element's mean is smaller by `RULES.bending`.

    A uniform gradient stays what it is and the mean is taken over the volume, so patch tests hold;
    an element bends more easily, which is what four nodes make too stiff (the points move nearer to
    the middle of the element, Belytschko and Bindeman 1991).
    """
    mean = np.einsum("eqad,eq->ead", grad, dV / dV.sum(axis=1, keepdims=True))[:, None]
    return np.asarray(mean + RULES.bending * (grad - mean))


def _constants(is_sphere: Mask, sphere: Material, flat: Material, unit: float) -> dict[str, Any]:
    G, K, radius = (np.empty(len(is_sphere)) for _ in range(3))
    law = np.full(len(is_sphere), -1)
    flows: list[tuple[Material, float]] = []
    for mask, body in ((is_sphere, sphere), (~is_sphere, flat)):
        if not mask.any():
            continue
        shear = body.E / (2.0 * (1.0 + body.nu))
        G[mask] = shear / unit
        K[mask] = body.E / (3.0 * (1.0 - 2.0 * body.nu)) / unit
        radius[mask] = math.sqrt(2.0 / 3.0) * body.strength / (2.0 * shear)
        if body.flow is not None:
            law[mask] = len(flows)
            flows.append((body, shear))
    return {"G": G, "K": K, "radius": radius, "law": law, "laws": laws_of(flows, unit)}
