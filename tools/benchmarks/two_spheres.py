"""How far 1/R = 1/R_1 + 1/R_2 holds where both bodies yield: finite elements of two spheres.

    python tools/benchmarks/two_spheres.py [--ratios 3 -3] [--level smoke] [--times 1]

The half-space's mesh is bent to a sphere's surface about the first contact point, every node at the
distance from it that it has: of radius `ratio` times the striking sphere's, negative for a seat.
Beyond the rings that can touch it goes on as a cone. Told is what the two carry over what the
fitted law has for a sphere of radius R on a flat, and over what `impact` takes.
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.dynamics.files.second import SecondSphere
from dentscope.fem import discretise
from dentscope.fem.mesh import Mesh
from dentscope.models import LAWS

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


def forces(pair: Pair, ratio: float, level: str) -> np.ndarray:
    """Return F/(E' R^2) at `APPROACHES` times the joint radius R, by finite elements."""
    joint = 1.0 / (1.0 + 1.0 / ratio)  # over the sphere's radius
    depths = fem.geometric_depths(0.3 * pair.first_yield, APPROACHES[-1] * joint, 30)
    problem = fem.ContactProblem(pair, depths)
    straight = discretise.contact_mesh

    def mesh(**given: object) -> Mesh:
        return bent(straight(**given), ratio)  # type: ignore[arg-type]

    with patch.object(discretise, "contact_mesh", mesh):
        solution = fem.solve(problem, accuracy=getattr(fem.Accuracy, level)())
    delta = solution.loading.delta / pair.R
    force = solution.loading.force / (pair.E_reduced * pair.R**2)
    at = np.exp(np.interp(np.log(np.array(APPROACHES) * joint), np.log(delta), np.log(force)))
    return np.asarray(at) / joint**2


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--ratios", type=float, nargs="+", default=[3.0, -3.0])
    options.add_argument("--level", default="smoke", choices=("smoke", "quick", "production"))
    options.add_argument("--strength", type=float, default=341.0, help="E/S_y of the weaker")
    options.add_argument("--times", type=float, default=1.0, help="smaller's over larger's S_y")
    given = options.parse_args()
    warnings.simplefilter("ignore")
    weak = Material(E=205e9, nu=0.3, Sy=205e9 / given.strength)
    small, large = (weak.with_(Sy=weak.Sy * max(x, 1.0)) for x in (given.times, 1.0 / given.times))
    print("Delta/R                  ", *(f"{x:8g}" for x in APPROACHES))
    for ratio in given.ratios:
        joint = Pair(small, large, 1e-3 / (1.0 + 1.0 / ratio))
        depth = joint.R * np.array(APPROACHES)
        found = forces(Pair(small, large, 1e-3), ratio, given.level)
        faced = SecondSphere(ratio * 1e-3).faced(LAWS["fitted"], joint)
        for what, law in (("flat", LAWS["fitted"]), ("as told", faced)):
            off = found / (law.loading(joint, depth) / (joint.E_reduced * joint.R**2)) - 1.0
            print(
                f"R_2/R_1 = {ratio:4g}, {what:8s}",
                *(f"{100.0 * x:+7.1f}%" for x in off),
                flush=True,
            )


if __name__ == "__main__":
    main()
