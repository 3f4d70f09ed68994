"""The two base laws, fitted pair by pair to quasi-static finite elements.

Each hard striker on each soft flat of the benches is solved once; the constants of the expanding-
cavity dent (`cavity`) and of the row of springs (`foundation`) are fitted to its force, to its
residual depths and to the elastic energy that its unloadings give back. So the concealed impacts
strike bodies that behave as elastic-perfectly-plastic ones do, within a per cent or two, by laws
that the tool under test does not know.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import least_squares

from .... import fem
from ....core.arrays import Array
from ....core.material import Material, Pair
from . import cavity, foundation

if TYPE_CHECKING:
    from ...concealed import Metal


FILE = Path(__file__).resolve().parents[3] / "data" / "proof" / "base_laws.json"

_DEPTHS = np.geomspace(2e-4, 0.1, 40)
_TURNS = (6, 13, 20, 26, 32, 39)
_CLOSE, _LOOSE = 0.01, 0.5


@dataclass(frozen=True)
class Curve:
    """Finite-element results of one pair, by the strength Y of the flat and the radius R.

    `stiffness`: E'/Y; `depth`, `force`: (n,) depth/R and F/(Y R^2) of the loading; `turn`, `left`,
    `back`: (k,) depth/R at which an unloading begins, residual depth/R, energy given back/(Y R^3).
    """

    stiffness: float
    depth: Array
    force: Array
    turn: Array
    left: Array
    back: Array


def solve(target: Metal, striker: Metal) -> Curve:
    """Load one pair to Delta/R = 0.1 and unload it from six depths.

    Raises `RuntimeError`: the finite elements did not get there.
    """
    R, Y = 1e-3, target.Sy
    bodies = [Material(E=x.E, nu=x.nu, Sy=x.Sy) for x in (striker, target)]
    pair = Pair(bodies[0], bodies[1], R)
    turns = tuple(float(_DEPTHS[i]) for i in _TURNS)
    problem = fem.ContactProblem(pair, tuple(_DEPTHS.tolist()), unload_from=turns)
    found = fem.solve(problem, accuracy=fem.Accuracy.production())
    if not found.outcome.completed or len(found.unloadings) < len(turns):
        raise RuntimeError(f"{striker.name} on {target.name}: {found.outcome}")
    loading = found.loading
    back = [-np.trapezoid(u.curve.force, u.curve.delta) for u in found.unloadings]
    return Curve(
        pair.E_reduced / Y, loading.delta / R, loading.force / (Y * R**2),
        np.array([u.depth for u in found.unloadings]),
        np.array([u.residual / R for u in found.unloadings]), np.array(back) / (Y * R**3),
    )  # fmt: skip


def _of_cavity(c: Array, stiffness: float, depth: float) -> tuple[float, float, float]:
    """Force, residual depth and energy given back, by Y and R."""
    force, _, left = cavity.dent(depth, stiffness, 1.0, 1.0, 0.0, c)
    power = cavity.exponent(depth * stiffness**2, 0.0, c)
    return force, left, force * (depth - left) / (power + 1.0)


def _of_row(c: Array, stiffness: float, depth: float) -> tuple[float, float, float]:
    W = depth * stiffness**2
    wide = float(foundation.spread(W, c))
    edge = math.sqrt(wide * depth)
    plastic, force = np.zeros(foundation.N_SPRINGS), np.zeros(foundation.N_SPRINGS)
    total, _, _ = foundation.press(
        depth, depth, edge, stiffness, 1.0, 1.0, c, foundation.PLACE, plastic, force
    )
    width = 2.0 * np.sqrt(foundation.PLACE) / foundation.N_SPRINGS * edge
    left = float(np.min(plastic + (foundation.PLACE * edge) ** 2 / wide))
    return total, left, float(np.sum(force**2 / stiffness * width))


LAWS = {
    "cavity": (_of_cavity, cavity.COEFFICIENTS),
    "foundation": (_of_row, foundation.COEFFICIENTS),
}
"""Function and constants for all pairs alike, from which those of one pair are fitted."""


def fit(curve: Curve, law: str) -> tuple[Array, dict[str, float]]:
    """Constants of one law for one pair, and the rms of what is left, logarithmic.

    A residual depth counts by how much of the depth it is: where little is left, less.
    """
    at, usual = LAWS[law]
    share = np.minimum(2.0 * curve.left / (curve.turn - curve.left), 1.0)

    def misses(x: Array) -> tuple[Array, Array, Array]:
        c = usual * np.exp(x)
        force = np.array([at(c, curve.stiffness, d)[0] for d in curve.depth])
        there = np.array([at(c, curve.stiffness, d) for d in curve.turn])
        left = np.log(np.maximum(there[:, 1], 1e-3 * curve.left) / curve.left)
        return np.log(force / curve.force), left, np.log(there[:, 2] / curve.back)

    def residual(x: Array) -> Array:
        force, left, back = misses(x)
        parts = (
            force / len(force) ** 0.5,
            left * share / len(left) ** 0.5,
            back / len(back) ** 0.5,
        )
        return np.concatenate([*(p / _CLOSE for p in parts), x / _LOOSE])

    x = least_squares(residual, np.zeros(len(usual))).x
    names = ("force", "residual depth", "energy given back")
    rms = {n: float(np.sqrt(np.mean(m**2))) for n, m in zip(names, misses(x), strict=True)}
    return usual * np.exp(x), rms


def fill(targets: tuple[Metal, ...], strikers: tuple[Metal, ...]) -> list[str]:
    """Solve and fit the pairs that the file lacks; say what is left of each fit."""
    content = stored()
    said = []
    for target in targets:
        for striker in strikers:
            key = _key(target, striker)
            if key in content:
                continue
            curve = solve(target, striker)
            entry: dict[str, Any] = {
                k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in vars(curve).items()
            }
            for law in LAWS:
                constants, rms = fit(curve, law)
                entry[law] = {"constants": constants.tolist(), "rms": rms}
                left = ", ".join(f"{n} {v:.1%}" for n, v in rms.items())
                said.append(f"{key}, {law}: {left}")
            content[key] = entry
            FILE.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
            stored.cache_clear()
    return said


@cache
def stored() -> dict[str, Any]:
    """Content of the file: curves and constants by the pair's name; empty without a file."""
    return json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}


def _key(target: Metal, striker: Metal) -> str:
    return f"{striker.name} on {target.name}"


@cache
def constants(target: Metal, striker: Metal) -> Array:
    """Constants of both laws for a pair, those of `cavity` first; the usual ones if it has none."""
    entry = stored().get(_key(target, striker), {})
    parts = [entry[k]["constants"] if entry else usual for k, (_, usual) in LAWS.items()]
    return np.concatenate([np.asarray(p, dtype=float) for p in parts])
