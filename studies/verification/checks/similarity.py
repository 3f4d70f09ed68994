"""A rigid sphere on a flat of power-law plasticity: the similarity solution of small strains."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .... import fem
from ....campaigns.case import Case
from ....core.flow import Flow, swift
from ....core.material import Material, Pair
from ..bench import Bench, Effort
from ..curves import smoothed
from ..pairs import RIGID, R
from ..result import Cell, Measurement, Result, Table

Floats = npt.NDArray[np.float64]

_E = 200e9
_FIRST = 1.8e-5 * _E  # flow stress at first yield: the path begins where round-off still allows
_START = 2e-4  # e0: of the strains in the contact, 1e-2, too little to count
_EXPONENTS = (0.1, 0.2, 0.4)
_DEEPEST = 1.5e-3
_JUDGED = (0.02, 0.045)  # a/R: elastic strains no longer count, finite ones do not yet
_SOURCE = "Storåkers, Biwa, Larsson, Int. J. Solids Struct. 34 (1997) 3061"


def run(bench: Bench) -> Result:
    """Press a rigid sphere into three power-law flats and compare contact radius and load."""
    accuracy = fem.Accuracy.quick() if bench.effort is Effort.QUICK else fem.Accuracy.production()
    rows: list[tuple[Cell, ...]] = []
    measurements: list[Measurement] = []
    for n in _EXPONENTS:
        delta, radius, pressure = _solved(bench, n, accuracy)
        alike = np.sqrt(2.0 * invariant(n) * delta)
        load = pressure * radius**2 / (mean_pressure(n, alike) * alike**2) - 1.0
        off = {
            "load at a depth": load,
            "contact radius at a depth": radius / alike - 1.0,
            "load at a contact radius": pressure / mean_pressure(n, radius) - 1.0,
        }
        judged = (radius > _JUDGED[0]) & (radius < _JUDGED[1])
        for name, values in off.items():
            mean = 100.0 * float(values[judged].mean())
            what = f"n = {n:g}: {name}, mean over a/R {_JUDGED[0]:g} to {_JUDGED[1]:g}"
            measurements.append(Measurement(what, mean, "%", -1.0, 1.0, _SOURCE))
        for x in (0.02, 0.03, 0.04, 0.05):
            if radius[0] < x < radius[-1]:
                shown = [float(np.interp(x, radius, values)) for values in off.values()]
                rows.append((n, x, _elastic(n, x), *(f"{100.0 * v:+.2f} %" for v in shown)))
    return Result(
        name="similarity",
        title="Similarity solution of power-law plasticity",
        about=(
            "A rigid sphere on a flat with the flow stress K (e0 + p)^n, "
            f"e0 = {_START:g}, E over the first of it {_E / _FIRST:.0f}, nu = 0.3, level "
            f"`{accuracy.level}`; ripple smoothed out. By similarity "
            "a^2 = 2 c^2 R Delta with c^2 = 1.43 exp(-0.97 n), and "
            "F = 3 pi a^2 K (a/(6 R))^n."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "Against the similarity solution",
                ("n", "a/R", "E' a/(R sigma)", *off),
                tuple(rows),
            ),
        ),
        notes=(
            "The solution is of rigid, power-law plasticity and small strain, and its two formulas "
            "are fits of its authors to their own finite elements. sigma in the table is the flow "
            "stress at Tabor's strain 0.2 a/R.",
        ),
    )


def invariant(n: float) -> float:
    """c^2 = a^2/(2 R Delta), Storåkers's fit over the exponent n."""
    return 1.43 * math.exp(-0.97 * n)


def mean_pressure(n: float, radius: Floats) -> Floats:
    """F/(pi a^2) [Pa] at a/R: Storåkers, Biwa, Larsson (1997), Eq. 78 without creep."""
    return np.asarray(3.0 * _strength(n) * (radius / 6.0) ** n)


def _strength(n: float) -> float:
    """K [Pa]."""
    return float(_FIRST / _START**n)


def _elastic(n: float, radius: float) -> str:
    return f"{_E / (1.0 - 0.3**2) * radius / (_strength(n) * (0.2 * radius) ** n):.0f}"


def _solved(bench: Bench, n: float, accuracy: fem.Accuracy) -> tuple[Floats, Floats, Floats]:
    """Delta/R, a/R and mean pressure [Pa] without ripple."""
    law = Flow(swift(Sy=_FIRST, K=_strength(n), n=n))
    depths = fem.geometric_depths(_DEEPEST / 20.0, _DEEPEST, 80)
    problem = fem.ContactProblem(Pair(RIGID, Material(_E, 0.3, _FIRST, flow=law), R), depths)
    solved = bench.solve(Case(f"power-law-{n:g}", problem, accuracy))
    delta = solved["delta"]
    force, radius = (np.exp(smoothed(delta, np.log(solved[k]))) for k in ("force", "radius"))
    return delta / R, radius / R, force / (math.pi * radius**2)
