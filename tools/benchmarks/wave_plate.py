"""Energy that a plate of any thickness takes from a blow: an explicit elastic wave solution.

    python tools/benchmarks/wave_plate.py [--thickness 0.0135 0.02] [--radius 0.005] [--speed 1]

Axisymmetric bilinear elements with lumped masses, central differences in time, a free plate wide
enough that nothing comes back from its edge. The ball is rigid and meets the surface through a
contact law's force; the local, static part of the surface's motion is the law's already and is
taken out of the mesh's (a half-space under the same patch of load), so that what is left is what
waves do. Zener's theory, a half-space's and the one law between them are no part of it.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import scipy.sparse as sp
import skfem
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Scene, Striker, strike
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.dynamics.mechanisms.base import Surroundings
from dentscope.models import LAWS
from dentscope.models.base import ContactLaw
from skfem.helpers import ddot, sym_grad

E, NU, RHO = 2.06e11, 0.3, 7800.0


def matrices(nr: int, nz: int, dr: float, dz: float) -> tuple[sp.csr_matrix, np.ndarray]:
    """Stiffness and lumped masses of a grid of bilinear rings; node i (nz + 1) + j, z downwards."""
    mesh = skfem.MeshQuad.init_tensor(dr * np.arange(nr + 1), dz * np.arange(nz + 1))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()), intorder=3)
    mass = skfem.LinearForm(lambda v, w: 2.0 * math.pi * RHO * w.x[0] * v)
    lumped = mass.assemble(basis.with_element(skfem.ElementQuad1()))
    return skfem.BilinearForm(_work).assemble(basis).tocsr(), np.repeat(lumped, 2)


def _work(u, v, w):
    """Elastic work of the strains of u on those of v, all around the axis."""
    lam, mu = E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))
    (a, b), r = (sym_grad(u), sym_grad(v)), w.x[0]
    trace = (a[0, 0] + a[1, 1] + u[0] / r) * (b[0, 0] + b[1, 1] + v[0] / r)
    return 2.0 * math.pi * r * (lam * trace + 2.0 * mu * (ddot(a, b) + u[0] * v[0] / r**2))


class Contact:
    """Force of a contact law over the approach, back from the deepest one."""

    def __init__(self, law: ContactLaw, pair: Pair) -> None:
        self.law, self.pair, self.peak = law, pair, 0.0

    def force(self, depth: float) -> float:
        """Return the force [N] at an approach [m]; of the trials of a step the last one counts."""
        if depth <= 0.0:
            return 0.0
        if depth >= self.peak:
            return float(self.law.loading(self.pair, depth))
        return float(self.law.unloading(self.pair, depth, self.peak))


def blow(
    thickness: float, R: float, speed: float, strength: float, *, cell: float = 0.5e-3
) -> tuple[float, float, float]:
    """Return restitution, contact time [s] and largest force [N] of a steel ball on steel."""
    metal = Material(E=E, nu=NU, density=RHO, Sy=strength if strength > 0.0 else math.inf)
    contact = Contact(LAWS["fitted" if strength > 0.0 else "hertz"], Pair(metal, metal, R))
    mass = RHO * 4.0 / 3.0 * math.pi * R**3
    longest = 8e-5 * (R / 5e-3) * speed**-0.2
    # a plate's wave of the highest speed does not come back from the edge
    wide, patch = 0.5 * 5600.0 * longest, 3.0 * cell
    nr, nz = round(wide / cell), max(8, round(thickness / cell))
    dr, dz = wide / nr, thickness / nz
    K, M = matrices(nr, nz, dr, dz)
    step = 0.5 * min(dr, dz) / math.sqrt(E * (1 - NU) / ((1 + NU) * (1 - 2 * NU) * RHO))
    r = dr * np.arange(nr + 1)
    share = np.sqrt(np.clip(1.0 - (r / patch) ** 2, 0.0, None)) * r
    share[0] = dr / 8.0
    near = share > 0.0
    load, share = 2 * (np.arange(nr + 1) * (nz + 1))[near] + 1, share[near] / share.sum()
    # mean approach of a half-space under a Hertzian pressure of this radius (Johnson 1985, 3.4)
    static = 0.6 * (1.0 - NU**2) / (E * patch)
    u, du = np.zeros(len(M)), np.zeros(len(M))
    x, v, t, largest, force = 0.0, speed, 0.0, 0.0, 0.0
    while t < 2e-6 or force > 1e-6 * largest:
        here = x - share @ u[load]
        for _ in range(60):
            new = contact.force(here + static * force)
            if abs(new - force) < 1e-8 * max(new, 1e-3 * largest, 1e-6):
                break
            force = 0.5 * (force + new)
        contact.peak = max(contact.peak, here + static * force)
        largest = max(largest, force)
        pull = -(K @ u)
        pull[load] += force * share
        du += step * pull / M
        du[: 2 * (nz + 1) : 2] = 0.0  # on the axis nothing moves outwards
        u += step * du
        v -= step * force / mass
        x += step * v
        t += step
    return -v / speed, t, largest


def told(thickness: float, R: float, speed: float, strength: float) -> float:
    metal = Material(E=E, nu=NU, density=RHO, Sy=strength if strength > 0.0 else math.inf)
    scene = Scene(
        LAWS["fitted" if strength > 0.0 else "hertz"], Pair(metal, metal, R),
        Striker(RHO * 4.0 / 3.0 * math.pi * R**3, R), Approach(speed), gravity=0.0,
    )  # fmt: skip
    waves = next(m for m in MECHANISMS if m.name == "half-space-waves")
    plate = Surroundings(thickness=thickness)
    return strike(waves.attach(scene, {"wave_scale": 1.0}, plate)).restitution


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--thickness", type=float, nargs="+", default=[0.005, 0.0135, 0.02, 0.03])
    options.add_argument("--radius", type=float, default=0.005)
    options.add_argument("--speed", type=float, default=1.0)
    options.add_argument("--strength", type=float, default=0.0, help="Pa; 0: elastic")
    given = options.parse_args()
    at = given.radius, given.speed, given.strength
    print("thickness [mm], restitution and energy lost [%]: explicit, told; told/explicit - 1 [%]")
    for h in given.thickness:
        found, ours = blow(h, *at)[0], told(h, *at)
        lost, said = 100.0 * (1.0 - found**2), 100.0 * (1.0 - ours**2)
        print(
            f"{1e3 * h:6g} {found:.4f} {ours:.4f} {lost:7.3f} {said:7.3f} "
            f"{100 * (said / lost - 1):+5.1f}", flush=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
