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
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Scene, Striker, strike
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.dynamics.mechanisms.base import Surroundings
from dentscope.models import LAWS
from dentscope.models.base import ContactLaw

E, NU, RHO = 2.06e11, 0.3, 7800.0
GAUSS = 1.0 / math.sqrt(3.0)


def matrices(nr: int, nz: int, dr: float, dz: float) -> tuple[sp.csr_matrix, np.ndarray]:
    """Stiffness and lumped masses of a grid of bilinear rings; node i (nz + 1) + j, z downwards."""
    lam, mu = E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))
    D = np.diag([lam + 2 * mu] * 3 + [mu]) + lam * (np.pad(np.ones((3, 3)) - np.eye(3), (0, 1)))
    i, j = (x.ravel() for x in np.meshgrid(np.arange(nr), np.arange(nz), indexing="ij"))
    first = i * (nz + 1) + j
    nodes = np.stack([first, first + nz + 1, first + nz + 2, first + 1], axis=1)
    K, M = np.zeros((len(i), 8, 8)), np.zeros((len(i), 4))
    for a in (-GAUSS, GAUSS):
        for b in (-GAUSS, GAUSS):
            N = (
                0.25
                * np.array([1 - a, 1 + a, 1 + a, 1 - a])
                * np.array([1 - b, 1 - b, 1 + b, 1 + b])
            )
            along = 0.5 * np.array([b - 1, 1 - b, 1 + b, -1 - b]) / dr
            down = 0.5 * np.array([a - 1, -1 - a, 1 + a, 1 - a]) / dz
            r = dr * (i + 0.5 * (1.0 + a))
            weight = 0.5 * math.pi * r * dr * dz
            B = np.zeros((len(i), 4, 8))
            B[:, 0, 0::2], B[:, 1, 1::2], B[:, 2, 0::2] = along, down, N / r[:, None]
            B[:, 3, 0::2], B[:, 3, 1::2] = down, along
            K += np.einsum("e,eki,kl,elj->eij", weight, B, D, B, optimize=True)
            M += RHO * weight[:, None] * N
    dof = np.stack([2 * nodes, 2 * nodes + 1], axis=2).reshape(len(i), 8)
    size = 2 * (nr + 1) * (nz + 1)
    rows, cols = np.repeat(dof, 8, axis=1).ravel(), np.tile(dof, (1, 8)).ravel()
    mass = np.zeros(size // 2)
    np.add.at(mass, nodes.ravel(), M.ravel())
    return sp.csr_matrix((K.ravel(), (rows, cols)), shape=(size, size)), np.repeat(mass, 2)


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
    """Return the restitution that `half-space-waves` has."""
    metal = Material(E=E, nu=NU, density=RHO, Sy=strength if strength > 0.0 else math.inf)
    scene = Scene(
        LAWS["fitted" if strength > 0.0 else "hertz"], Pair(metal, metal, R),
        Striker(RHO * 4.0 / 3.0 * math.pi * R**3, R), Approach(speed), gravity=0.0,
    )  # fmt: skip
    waves = next(m for m in MECHANISMS if m.name == "half-space-waves")
    plate = Surroundings(thickness=thickness)
    return strike(waves.attach(scene, {"wave_scale": 1.0}, plate)).restitution


def main() -> None:
    """Print both losses for each thickness."""
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
