"""Patch test of the contact: uniform pressure across it."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as sparse_linalg

from ....core.arrays import Array, Integers
from ....fem.contact import Surfaces, Triplets, contact_forces
from ....fem.elements import State
from ..bench import Bench
from ..blocks import Block, block, rectangle, stiffness
from ..result import Measurement, Result

_PRESSURE = 1e-5
_PENALTY = 20.0


def run(bench: Bench) -> Result:
    """Pass a uniform pressure on, by an uneven and by an even flat."""
    return Result(
        title="Patch test of the contact",
        about=(
            "Two laterally held blocks, eight even elements on eleven uneven ones, a uniform "
            "pressure; error of the axial stress."
        ),
        measurements=_contact(),
        notes=(
            "Forces of the contact go to the nodes of the straight segments, as the elements' own "
            "functions have it. What is left on an uneven surface comes from the points of an "
            "edge, which do not see where a node of the other side lies.",
        ),
    )  # fmt: skip


def _contact() -> tuple[Measurement, ...]:
    upper = block(rectangle(np.linspace(0.0, 1.0, 9), np.linspace(0.0, 1.0, 7)), nu=0.3)
    uneven = np.array([0.0, 0.1, 0.25, 0.33, 0.45, 0.5, 0.64, 0.72, 0.85, 0.9, 1.0, 1.1])
    lines = np.concatenate([uneven, [1.2, 1.3, 1.4, 1.5]])
    even = np.linspace(0.0, 1.5, 13)
    out = []
    for name, r in (("uneven", lines), ("even", even)):
        lower = block(rectangle(r, np.linspace(-1.0, 0.0, 7)), nu=0.3)
        for side, (largest, inner) in zip(("sphere", "flat"), _pressed(upper, lower), strict=True):
            out += [
                Measurement(f"contact, {name} flat: axial stress in the {side}, largest error",
                            largest, "", None, 0.01, "exact"),
                Measurement(f"contact, {name} flat: the same, three elements from axis, rim and "
                            f"contact, {side}", inner),
            ]  # fmt: skip
    return tuple(out)


def _pressed(upper: Block, lower: Block) -> list[tuple[float, float]]:
    """Relative stress errors above and below: largest, and largest in the middle."""
    n = len(upper.points)
    points = np.vstack([upper.points, lower.points])
    r, z = points.T
    above = np.arange(len(r)) < n
    slave, master = (np.flatnonzero(side & (np.abs(z) < 1e-12)) for side in (above, ~above))
    slave, master = slave[np.argsort(r[slave])], master[np.argsort(r[master])]
    surfaces = Surfaces.build(
        points, sphere=slave, flat=master, penalty=_PENALTY, flat_is_slave=False
    )
    modulus = 0.7 / (1.3 * 0.4)  # of the laterally held block, nu = 0.3
    push = 2.0 * _PRESSURE / modulus + _PRESSURE / surfaces.stiffness[0]
    held = [2 * np.flatnonzero((r == 0.0) | (r == 1.5) | (above & (r == 1.0)))]
    held.append(2 * np.flatnonzero(z == -1.0) + 1)
    top = 2 * np.flatnonzero(above & (z == 1.0)) + 1
    fixed = np.unique(np.concatenate([*held, top]))
    free = np.setdiff1d(np.arange(2 * len(r)), fixed)
    load = _ring_load(points, master)
    u = np.zeros(2 * len(r))
    u[2 * np.flatnonzero(above) + 1] = -push
    triplets = Triplets.for_surfaces(surfaces)
    for _ in range(20):
        forces, matrices = [], []
        for body, part in ((upper, u[: 2 * n]), (lower, u[2 * n :])):
            f, K = stiffness(body, part, state=State.virgin(len(body.elements.conn)))
            forces.append(f)
            matrices.append(K)
        residual = np.concatenate(forces) - load
        contact, m = contact_forces(
            surfaces, points + u.reshape(-1, 2), force=residual, tangent=triplets
        )
        assert contact is not None
        coupling = sparse.csr_matrix(
            (triplets.value[:m], (triplets.row[:m], triplets.col[:m])), shape=(u.size, u.size)
        )
        K = (sparse.block_diag(matrices, format="csr") + coupling)[free][:, free]
        move = sparse_linalg.spsolve(K.tocsc(), residual[free])
        u[free] -= move
        if np.abs(move).max() < 1e-15:
            break
    return [_errors(body, part) for body, part in ((upper, u[: 2 * n]), (lower, u[2 * n :]))]


def _errors(body: Block, u: Array) -> tuple[float, float]:
    error = np.abs(_axial(body, u) / -_PRESSURE - 1.0)
    r, z = body.points[body.elements.conn].mean(axis=1).T
    inner = (r > 0.3) & (r < 0.7) & (np.abs(z) > 0.5)
    return float(error.max()), float(error[inner].max())


def _ring_load(points: Array, master: Integers) -> Array:
    """Forces of the uniform pressure on the lower block outside the upper one."""
    load = np.zeros(2 * len(points))
    for a, b in pairwise(master):
        r0, r1 = points[a, 0], points[b, 0]
        if r0 >= 1.0 - 1e-12:
            h = r1 - r0
            load[2 * a + 1] -= _PRESSURE * math.pi * h * (2.0 * r0 + r1) / 3.0
            load[2 * b + 1] -= _PRESSURE * math.pi * h * (r0 + 2.0 * r1) / 3.0
    return load


def _axial(body: Block, u: Array) -> Array:
    """Axial stress at the element centres by small strain, shape (n_elements,)."""
    x = body.elements
    ue = u.reshape(-1, 2)[x.conn]
    strain_z = np.einsum("eqa,ea->eq", x.grad[..., 1], ue[..., 1])
    strain_r = np.einsum("eqa,ea->eq", x.grad[..., 0], ue[..., 0])
    hoop = np.einsum("qa,ea->eq", x.value, ue[..., 0]) / x.r
    lame = x.K - 2.0 * x.G / 3.0
    trace = ((strain_r + strain_z + hoop) * x.dV).sum(axis=1) / x.volume
    return np.asarray(lame * trace + 2.0 * x.G * strain_z.mean(axis=1))
