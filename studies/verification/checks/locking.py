"""No locking: plastic limit loads with exact solutions, nearly incompressible elasticity."""

from __future__ import annotations

import math

import numpy as np
import skfem

from .... import fem
from ....core.arrays import Array
from ....core.material import Material, Pair
from ..bench import Bench
from ..blocks import block, rectangle, walk
from ..pairs import RIGID, R, hertz_force
from ..result import Measurement, Result, Table

_YIELD = 1e-4  # Sy/E: small enough that the change of shape does not count
_HILL = "Hill, The Mathematical Theory of Plasticity (1950), chapter V"


def run(bench: Bench) -> Result:
    """Expand a thick tube and a thick shell beyond their limit; press a rubber-like sphere."""
    rows = []
    tube = {n: _tube(n) / (2.0 / math.sqrt(3.0) * math.log(2.0)) - 1.0 for n in (2, 4, 8)}
    shell = {n: _shell(n) / (2.0 * math.log(2.0)) - 1.0 for n in (2, 4, 8)}
    for n in tube:
        rows.append((n, f"{100.0 * tube[n]:+.3f} %", f"{100.0 * shell[n]:+.3f} %"))
    elastic = {nu: _incompressible(nu) for nu in (0.3, 0.45, 0.499, 0.4999)}
    return Result(
        title="Locking",
        about=(
            "Limit pressure of a thick tube (plane strain, 2/sqrt(3) Sy ln 2) and of a thick "
            "spherical shell (2 Sy ln 2), b/a = 2, Sy/E = 1e-4, opened to ten times the "
            "displacement of first yield. Elastic sphere on a rigid flat, Poisson's ratio up to "
            "0.4999."
        ),
        measurements=(
            Measurement("limit pressure of the tube, 8 elements, error", 100.0 * abs(tube[8]), "%",
                        None, 0.5, _HILL),
            Measurement("limit pressure of the shell, 8 elements, error", 100.0 * abs(shell[8]),
                        "%", None, 0.5, _HILL),
            Measurement("F/F_Hertz of nu = 0.4999 over that of nu = 0.3, difference",
                        100.0 * abs(elastic[0.4999] / elastic[0.3] - 1.0), "%", None, 0.5, "Hertz"),
        ),
        tables=(
            Table("Error of the limit pressure", ("elements", "tube", "shell"), tuple(rows)),
            Table("Elastic sphere on a rigid flat, Delta/R = 1e-4", ("nu", "F/F_Hertz"),
                  tuple((nu, f"{x:.5f}") for nu, x in elastic.items())),
        ),
    )  # fmt: skip


def _steps(first: float) -> Array:
    return np.concatenate([first * np.linspace(0.5, 3.0, 11), first * np.array([4.0, 6.0, 10.0])])


def _tube(n: int) -> float:
    """Limit pressure over Sy of the tube 1 < r < 2."""
    r = np.geomspace(1.0, 2.0, n + 1)
    body = block(
        rectangle(r, np.array([0.0, 0.1, 0.2]), distortion=0.02), nu=0.3, yield_strain=_YIELD
    )
    p = body.mesh.p
    inner = np.flatnonzero(p[0] == 1.0)
    fixed = np.concatenate([2 * inner, 2 * np.arange(p.shape[1]) + 1])
    field = np.zeros(2 * p.shape[1])
    field[2 * inner] = 1.0
    _, force, _ = walk(body, _steps(1.5 * _YIELD), fixed=fixed, imposed=lambda s: s * field)[-1]
    return float(force[2 * inner].sum() / (2.0 * math.pi * 0.2) / _YIELD)


def _shell(n: int) -> float:
    """Limit pressure over Sy of the shell 1 < rho < 2, upper half."""
    flat = skfem.MeshQuad.init_tensor(np.geomspace(1.0, 2.0, n + 1), np.linspace(0.0, 1.0, 3 * n))
    rho, angle = flat.p[0], flat.p[1] * 0.5 * math.pi
    points = np.stack([rho * np.cos(angle), rho * np.sin(angle)])
    points[np.abs(points) < 1e-13] = 0.0
    body = block(skfem.MeshQuad(points, flat.t), nu=0.3, yield_strain=_YIELD)
    inner = np.flatnonzero(rho == 1.0)
    field = np.zeros(2 * points.shape[1])
    field[2 * inner], field[2 * inner + 1] = points[0, inner], points[1, inner]
    axis, plane = np.flatnonzero(points[0] == 0.0), np.flatnonzero(points[1] == 0.0)
    fixed = np.unique(np.concatenate([2 * inner, 2 * inner + 1, 2 * axis, 2 * plane + 1]))
    _, force, _ = walk(body, _steps(1.5 * _YIELD), fixed=fixed, imposed=lambda s: s * field)[-1]
    # virtual work: the radial reactions over a uniform radial motion of the inner surface
    work = float((force * field)[np.concatenate([2 * inner, 2 * inner + 1])].sum())
    return work / (2.0 * math.pi) / _YIELD


def _incompressible(nu: float) -> float:
    pair = Pair(sphere=Material(E=200e9, nu=nu), flat=RIGID, R=R)
    c = fem.solve(fem.ContactProblem(pair, (1e-4,)), accuracy=fem.Accuracy.quick()).loading
    return float(c.force[0]) / hertz_force(pair, 1e-4 * R)
