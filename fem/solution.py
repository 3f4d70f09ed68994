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

    - `delta`: approach Delta [m].
    - `force`: normal force F, the reaction at the driven face [N].
    - `radius`: contact radius a, from the opening gap beside the contact [m].
    - `radius_last_node`: radius of the last node in contact, as the thesis reads it [m].
    - `sphere`, `flat`: displacement of the pole relative to the sphere's top, and of the flat's
      surface below it, towards the body [m].
    - `hardness`: mean pressure F/(pi a^2) [Pa].
    - `force_defect`: (contact force - reaction)/reaction [-].
    - `energy_defect`: (external work - stored - dissipated)/external work [-]; nan on unloading.
    - `dissipated`: plastic work so far [J].
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

    - `depth`: Delta/R at which it starts.
    - `curve`: from the turning point to the last state in contact.
    - `residual_sphere`, `residual_flat`: permanent displacement of the pole and of the flat below
      it, force-free [m].
    - `crater_r`, `crater_z`: force-free surface of the flat, shape (n,) [m].
    - `tip_r`, `tip_z`: force-free surface of the sphere, its top at rest, shape (n,) [m].
    - `steps`: steps taken.
    - `outcome`: how it ended.
    - `reload`: from the last state in contact up to the turning point again, if it was asked for.
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

    - `depth`: Delta/R.
    - `sphere_r`, `sphere_z`: current coordinates of the sphere's surface nodes, shape (n_slave,)
      [m].
    - `pressure`: contact pressure there, on the current area, shape (n_slave,) [Pa].
    - `flat_r`, `flat_z`: current coordinates of the flat's surface nodes, shape (n_master,) [m].
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

    - `depth`: Delta/R.
    - `points`, `quads`: reference coordinates (r, z), shape (n_nodes, 2) [m], and elements, shape
      (n_elements, 4).
    - `n_sphere_quads`: the sphere's elements come first; this many.
    - `displacement`: shape (n_nodes, 2) [m].
    - `von_mises`: Cauchy von Mises stress at the element centres (mean of the points), shape
      (n_elements,) [Pa].
    - `plastic_strain`: equivalent plastic strain, likewise [-].
    - `mean_stress`: mean Cauchy stress (negative in compression), likewise [Pa].
    - `stress`: Cauchy stress (rr, zz, rz, tt), mean of the points, shape (n_elements, 4) [Pa].
    - `profile`: the two surfaces and the contact pressure.
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

    - `problem`, `accuracy`: what was asked.
    - `outcome`: how it ended.
    - `loading`: results at the recorded depths.
    - `unloadings`: one for each depth of `problem.unload_from` that was reached.
    - `snapshots`: one for each depth of `problem.snapshots` that was reached.
    - `counters`: steps, iterations, processor time.
    - `mesh_digest`: SHA-256 of the mesh.
    - `profiles`: one for each depth of `problem.profiles` that was reached.
    - `boundary`, `yield_measure`: what is driven and which stress yields, in words.
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
