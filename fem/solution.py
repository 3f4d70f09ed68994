"""What a solve returns: curves in SI units, unloadings, snapshots, counters, how it ended."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..core.arrays import Array, Integers
from ..core.errors import Outcome
from .problem import Accuracy, ContactProblem


@dataclass(frozen=True)
class Curve:
    """Results along a loading or unloading branch; every array has shape (n,).

    Parameters
    ----------
    delta
        Approach Delta [m].
    force
        Normal force F, the reaction at the driven face [N].
    radius
        Contact radius a, from the opening gap beside the contact [m].
    radius_last_node
        Radius of the last node in contact, as the thesis reads it [m].
    sphere, flat
        Displacement of the pole relative to the sphere's top, and of the flat's surface below it,
        towards the body [m].
    hardness
        Mean pressure F/(pi a^2) [Pa].
    force_defect
        (contact force - reaction)/reaction [-].
    energy_defect
        (external work - stored - dissipated)/external work [-]; nan on unloading.
    dissipated
        Plastic work so far [J].
    """

    delta: Array
    force: Array
    radius: Array
    radius_last_node: Array
    sphere: Array
    flat: Array
    hardness: Array
    force_defect: Array
    energy_defect: Array
    dissipated: Array

    @property
    def sphere_share(self) -> Array:
        """delta_s* = delta_s/(delta_s + delta_f) (Eq. 2.2) [-]."""
        return np.asarray(self.sphere / (self.sphere + self.flat))


@dataclass(frozen=True)
class Unloading:
    """One unloading to zero force.

    Parameters
    ----------
    depth
        Delta/R at which it starts.
    curve
        From the turning point to the last state in contact.
    residual_sphere, residual_flat
        Permanent displacement of the pole and of the flat below it, force-free [m].
    crater_r, crater_z
        Force-free surface of the flat, shape (n,) [m].
    tip_r, tip_z
        Force-free surface of the sphere, its top at rest, shape (n,) [m].
    steps
        Steps taken.
    outcome
        How it ended.
    reload
        From the last state in contact up to the turning point again, if it was asked for.
    """

    depth: float
    curve: Curve
    residual_sphere: float
    residual_flat: float
    crater_r: Array
    crater_z: Array
    tip_r: Array
    tip_z: Array
    steps: int
    outcome: Outcome
    reload: Curve | None = None

    @property
    def residual(self) -> float:
        """Permanent approach, both bodies together [m]."""
        return self.residual_sphere + self.residual_flat


@dataclass(frozen=True)
class Profile:
    """Contact pressure and shape of the two surfaces at one depth.

    Parameters
    ----------
    depth
        Delta/R.
    sphere_r, sphere_z
        Current coordinates of the sphere's surface nodes, shape (n_slave,) [m].
    pressure
        Contact pressure there, on the current area, shape (n_slave,) [Pa].
    flat_r, flat_z
        Current coordinates of the flat's surface nodes, shape (n_master,) [m].
    """

    depth: float
    sphere_r: Array
    sphere_z: Array
    pressure: Array
    flat_r: Array
    flat_z: Array


@dataclass(frozen=True)
class Snapshot:
    """Fields of one state.

    Parameters
    ----------
    depth
        Delta/R.
    points, quads
        Reference coordinates (r, z), shape (n_nodes, 2) [m], and elements, shape (n_elements, 4).
    n_sphere_quads
        The sphere's elements come first; this many.
    displacement
        Shape (n_nodes, 2) [m].
    von_mises
        Cauchy von Mises stress at the element centres (mean of the points), shape (n_elements,)
        [Pa].
    plastic_strain
        Equivalent plastic strain, likewise [-].
    mean_stress
        Mean Cauchy stress (negative in compression), likewise [Pa].
    stress
        Cauchy stress (rr, zz, rz, tt), mean of the points, shape (n_elements, 4) [Pa].
    profile
        The two surfaces and the contact pressure.
    """

    depth: float
    points: Array
    quads: Integers
    n_sphere_quads: int
    displacement: Array
    von_mises: Array
    plastic_strain: Array
    mean_stress: Array
    stress: Array
    profile: Profile


@dataclass(frozen=True)
class Counters:
    """Work that a solve took; times are processor seconds.

    `dofs` are those of the largest mesh, `meshes` the number of meshes, `transfer_jump` the largest
    relative change of the force at a change of mesh.
    """

    dofs: int
    steps: int
    iterations: int
    factorisations: int
    failed_steps: int
    patterns: int
    meshes: int
    transfer_jump: float
    cpu_s: float
    cpu_assembly_s: float
    cpu_contact_s: float
    cpu_linear_s: float
    peak_memory_mb: float


@dataclass(frozen=True)
class Solution:
    """Everything a solve gives.

    Parameters
    ----------
    problem, accuracy
        What was asked.
    outcome
        How it ended.
    loading
        Results at the recorded depths.
    unloadings
        One for each depth of `problem.unload_from` that was reached.
    snapshots
        One for each depth of `problem.snapshots` that was reached.
    counters
        Steps, iterations, processor time.
    mesh_digest
        SHA-256 of the mesh.
    profiles
        One for each depth of `problem.profiles` that was reached.
    boundary, yield_measure
        What is driven and which stress yields, in words.
    """

    problem: ContactProblem
    accuracy: Accuracy
    outcome: Outcome
    loading: Curve = field(repr=False)
    unloadings: tuple[Unloading, ...] = field(repr=False)
    snapshots: tuple[Snapshot, ...] = field(repr=False)
    counters: Counters
    mesh_digest: str
    profiles: tuple[Profile, ...] = field(default=(), repr=False)
    boundary: str = "top face moves by -Delta, free radially"
    yield_measure: str = "Cauchy"
