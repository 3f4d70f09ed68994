"""How far 1/R = 1/R_1 + 1/R_2 holds where both bodies yield: finite elements of two spheres.

    python tools/benchmarks/two_spheres.py [--ratios 3 -3] [--level smoke] [--strength 341]

The half-space's mesh is bent to a sphere's surface about the first contact point, every node at the
distance from it that it has: of radius `ratio` times the striking sphere's, negative for a seat.
Beyond the rings that can touch it goes on as a cone. What it carries over a sphere of radius R on a
flat of the same metal is the departure that the set-up file of an impact takes into its band.
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.fem import discretise
from dentscope.fem.mesh import Mesh

APPROACHES = (0.001, 0.003, 0.01, 0.02, 0.04)
"""Delta over the joint radius R."""


def bent(mesh: Mesh, ratio: float) -> Mesh:
    """Return the mesh with the flat bent to a sphere of `ratio` radii of the other."""
    n = mesh.n_sphere_points
    r, z = mesh.points[n:].T
    chord = np.hypot(r, z)
    below = np.arctan2(-z, r)  # from the flat downwards
    start = np.arcsin(np.minimum(chord, mesh.rings[-1]) / (2.0 * ratio))
    angle = start + below * (1.0 - start / (0.5 * np.pi))
    r_new = np.where(r == 0.0, 0.0, chord * np.cos(angle))
    points = mesh.points.copy()
    points[n:] = np.column_stack([r_new, -chord * np.sin(angle)])
    return replace(mesh, points=points)


def forces(metal: Material, ratio: float, level: str) -> np.ndarray:
    """Return F/(E' R^2) at `APPROACHES` times the joint radius R; `ratio` 0 is a flat."""
    joint = 1.0 / (1.0 + 1.0 / ratio) if ratio else 1.0  # over the sphere's radius
    pair = Pair(metal, metal, 1e-3)
    deepest = APPROACHES[-1] * joint
    depths = fem.geometric_depths(0.3 * pair.first_yield, deepest, 30)
    problem = fem.ContactProblem(pair, depths)
    straight = discretise.contact_mesh

    def mesh(**given: object) -> Mesh:
        made = straight(**given)  # type: ignore[arg-type]
        return bent(made, ratio) if ratio else made

    with patch.object(discretise, "contact_mesh", mesh):
        solution = fem.solve(problem, accuracy=getattr(fem.Accuracy, level)())
    delta = solution.loading.delta / pair.R
    force = solution.loading.force / (pair.E_reduced * pair.R**2)
    at = np.exp(np.interp(np.log(np.array(APPROACHES) * joint), np.log(delta), np.log(force)))
    return np.asarray(at) / joint**2


def main() -> None:
    """Print the departures."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--ratios", type=float, nargs="+", default=[3.0, -3.0])
    options.add_argument("--level", default="smoke", choices=("smoke", "quick", "production"))
    options.add_argument("--strength", type=float, default=341.0, help="E/S_y")
    given = options.parse_args()
    warnings.simplefilter("ignore")
    metal = Material(E=205e9, nu=0.3, Sy=205e9 / given.strength)
    flat = forces(metal, 0.0, given.level)
    print("Delta/R       ", *(f"{x:8g}" for x in APPROACHES))
    for ratio in given.ratios:
        off = forces(metal, ratio, given.level) / flat - 1.0
        print(f"R_2/R_1 = {ratio:4g}", *(f"{100.0 * x:+7.1f}%" for x in off), flush=True)


if __name__ == "__main__":
    main()
