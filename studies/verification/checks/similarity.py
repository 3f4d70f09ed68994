"""A rigid sphere on a flat whose stress is a power of the strain, or of its rate: similarity."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....core.arrays import Array, Mask
from ....core.flow import Flow, Rate, swift, tabulated
from ....core.material import Material, Pair
from ..bench import Bench, Effort
from ..curves import smoothed
from ..flat_die import similar
from ..pairs import RIGID, R
from ..result import Cell, Measurement, Result, Table

_E = 200e9
_FIRST = 1.8e-5 * _E  # flow stress at first yield: the path begins where round-off still allows
_START = 2e-4  # e0: of the strains in the contact, 1e-2, too little to count
_EXPONENTS = (0.1, 0.2, 0.4)
_DEEPEST = 1.5e-3
_JUDGED = (0.02, 0.05)  # a/R: elastic strains no longer count, finite ones do not yet
_SOURCE = "the self-similar solution (Biwa, Storåkers, J. Mech. Phys. Solids 43 (1995) 1303)"
_FORMULAS = "Storåkers, Biwa, Larsson, Int. J. Solids Struct. 34 (1997) 3061"

_AT_REST = 1e-4 * _E  # a first yield needs one; raised with the speed as all other stress is
_STRESS = 1e-3 * _E  # at the rate of the slow approach, 0.4 v/a, at a/R = 0.1
_SLOW = 1e-3  # m/s; no inertia, so that the number is free
_FASTER = 100.0
_RATE_EXPONENTS = (0.05, 0.1)
_PRESSED = (2e-3, 3e-2)
_PLASTIC = 100.0  # E' a/(R sigma) from which elastic strains count little in the mean pressure


def run(bench: Bench) -> Result:
    """Press a rigid sphere into three power-law flats and compare contact radius and load."""
    accuracy = fem.Accuracy.quick() if bench.effort is Effort.QUICK else fem.Accuracy.production()
    rows: list[tuple[Cell, ...]] = []
    measurements: list[Measurement] = []
    for n in _EXPONENTS:
        delta, radius, pressure = _solved(bench, n, accuracy)
        invariant, alike = _alike(n, radius)
        off = {
            "load at a contact radius": pressure / alike - 1.0,
            "contact radius at a depth": radius / np.sqrt(2.0 * invariant * delta) - 1.0,
        }
        fits = {
            "load at a contact radius": pressure / fitted_pressure(n, radius) - 1.0,
            "contact radius at a depth": radius / np.sqrt(2.0 * fitted_invariant(n) * delta) - 1.0,
        }
        judged = (radius > _JUDGED[0]) & (radius < _JUDGED[1])
        elastic = 1.0 / _johnson(n, radius[judged])
        for name, values in off.items():
            limit = 100.0 * float(np.polyfit(elastic, values[judged], 1)[1])
            what = f"n = {n:g}: {name}, elastic strains extrapolated away"
            measurements.append(Measurement(what, limit, "%", -1.0, 1.0, _SOURCE))
        for x in (0.02, 0.03, 0.04, 0.05):
            if radius[0] < x < radius[-1]:
                shown = [float(np.interp(x, radius, v)) for v in (*off.values(), *fits.values())]
                rows.append((n, x, f"{float(_johnson(n, np.array(x))):.0f}",
                             *(f"{100.0 * v:+.2f} %" for v in shown)))  # fmt: skip
    return Result(
        title="Similarity solution of power-law plasticity",
        about=(
            f"A rigid sphere on a flat with the flow stress K (e0 + p)^n, e0 = {_START:g}, E over "
            f"the first of it {_E / _FIRST:.0f}, nu = 0.3, level `{accuracy.level}`; ripple "
            "smoothed out. Beside it the rigid-plastic half-space of small strain with the same "
            "flow stress, in which a^2 = 2 c^2 R Delta and F = pi a^2 K (a/R)^n P: c^2 and P are "
            "solved for by velocities under a flat die (studies/verification/flat_die.py). What "
            "is left is extrapolated to infinite E' a/(R sigma), sigma the flow stress at "
            "Tabor's strain 0.2 a/R."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "Against the similarity solution, and against the formulas fitted to it",
                ("n", "a/R", "E' a/(R sigma)", *off, *(f"{name}, formula" for name in fits)),
                tuple(rows),
            ),
        ),
        notes=(
            "The formulas, c^2 = 1.43 exp(-0.97 n) and F = 3 pi a^2 K (a/(6 R))^n "
            f"({_FORMULAS}), are fits that leave e0 out.",
        ),
    )


def fitted_invariant(n: float) -> float:
    """c^2 = a^2/(2 R Delta), Storåkers's fit over the exponent n."""
    return 1.43 * math.exp(-0.97 * n)


def fitted_pressure(n: float, radius: Array) -> Array:
    """F/(pi a^2) [Pa] at a/R: Storåkers, Biwa, Larsson (1997), Eq. 78 without creep."""
    return 3.0 * _flow_stress(n, radius / 6.0)


def _alike(n: float, radius: Array) -> tuple[Array, Array]:
    """c^2 and mean pressure [Pa] of the similarity solution at each a/R.

    Solved for with none, some and more of e0 over the strain; between them by a parabola.
    """
    over = [0.0, *(_START * fitted_invariant(n) / x for x in (_JUDGED[1], _JUDGED[0]))]
    found = [similar(n, before=b) for b in over]
    # e0 R/a of each, by the c^2 that belongs to it
    at = [b / one.invariant for b, one in zip(over, found, strict=True)]
    invariant, pressure = (
        np.asarray(np.polyval(np.polyfit(at, values, 2), _START / radius))
        for values in ([one.invariant for one in found], [one.pressure for one in found])
    )
    return invariant, pressure * _flow_stress(n, radius)


def _flow_stress(n: float, strain: Array) -> Array:
    """K p^n [Pa], without e0."""
    return np.asarray(_strength(n) * strain**n)


def _johnson(n: float, radius: Array) -> Array:
    """E' a/(R sigma), Johnson's parameter: how little elastic strains count."""
    return np.asarray(_E / (1.0 - 0.3**2) * radius / _flow_stress(n, 0.2 * radius))


def _strength(n: float) -> float:
    """K [Pa]."""
    return float(_FIRST / _START**n)


def _solved(bench: Bench, n: float, accuracy: fem.Accuracy) -> tuple[Array, Array, Array]:
    """Delta/R, a/R and mean pressure [Pa] without ripple."""
    law = Flow(swift(Sy=_FIRST, K=_strength(n), n=n))
    depths = fem.geometric_depths(_DEEPEST / 20.0, _DEEPEST, 80)
    problem = fem.ContactProblem(Pair(RIGID, Material(_E, 0.3, _FIRST, flow=law), R), depths)
    solved = bench.solve(Case(f"power-law-{n:g}", problem, accuracy))
    delta = solved["delta"]
    force, radius = (np.exp(smoothed(delta, np.log(solved[k]))) for k in ("force", "radius"))
    return delta / R, radius / R, force / (math.pi * radius**2)


def speed(bench: Bench) -> Result:
    """Press at one speed and at a hundred times it; F at a contact radius rises by 100^m."""
    accuracy = fem.Accuracy.quick() if bench.effort is Effort.QUICK else fem.Accuracy.production()
    measurements: list[Measurement] = []
    rows: list[tuple[Cell, ...]] = []
    for m in _RATE_EXPONENTS:
        slow = _curves(bench, m, 1.0, accuracy)
        fast = _curves(bench, m, _FASTER, accuracy)
        rise = np.interp(slow.radius, fast.radius, fast.force) / slow.force
        off = rise / _FASTER**m - 1.0
        judged = _is_plastic(slow.radius, m) & (slow.radius <= fast.radius[-1])
        measurements.append(
            Measurement(
                f"m = {m:g}: rise of F at a contact radius over 100^m, largest difference",
                100.0 * float(np.abs(off[judged]).max()), "%", None, 2.0,
                "exact without elastic strain: stresses go with the power m of the speed",
            )
        )  # fmt: skip
        at_depth = fast.force / slow.force / _FASTER**m - 1.0
        rows += [
            (m, f"{x:g}", f"{np.interp(x, slow.radius, rise):.4f}", f"{_FASTER**m:.4f}",
             f"{100.0 * np.interp(x, slow.radius, off):+.2f} %",
             f"{100.0 * np.interp(x, slow.radius, at_depth):+.2f} %")
            for x in (0.08, 0.12, 0.16, 0.2)
        ]  # fmt: skip
    return Result(
        title="A hundred times the speed",
        about=(
            "A rigid sphere on a flat whose flow stress is a power m of the rate of plastic "
            "strain, beside a tenth that knows no rate and is raised by 100^m itself; E over the "
            f"stress at the slow speed is {_E / _STRESS:.0f}, level `{accuracy.level}`, ripple "
            f"smoothed out, judged from E' a/(R sigma) = {_PLASTIC:g} on. Without elastic strain "
            "the force goes with the power m of the speed, at a contact radius and at a depth "
            "alike."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "Force at 100 times the speed over that at the slow one",
                ("m", "a/R", "F over F", "100^m", "difference", "the same at a depth"),
                tuple(rows),
            ),
        ),
        notes=(
            "Elastic strains rise with the stress of the faster; they make the contact sink in, "
            "which the force at a depth feels and the mean pressure hardly.",
        ),
    )


def _is_plastic(radius: Array, m: float) -> Mask:
    """Where the faster contact is plastic, sigma its flow stress at the rate 0.4 v/a."""
    stress = _FASTER**m * (_AT_REST + _STRESS * (0.1 / radius) ** m)
    return np.asarray(_E / (1.0 - 0.3**2) * radius / stress >= _PLASTIC)


class Curves(NamedTuple):
    """a/R and F [N] over the depths, without ripple."""

    radius: Array
    force: Array


def _curves(bench: Bench, m: float, faster: float, accuracy: fem.Accuracy) -> Curves:
    rate = Rate("overstress", 0.4 * _SLOW / (0.1 * R), m, _STRESS)
    at_rest = _AT_REST * faster**m
    flow = Flow(tabulated(np.array([0.0, 1.0]), np.full(2, at_rest)), rate)
    metal = Material(_E, 0.3, at_rest, flow=flow)
    problem = fem.ContactProblem(
        Pair(RIGID, metal, R), fem.geometric_depths(*_PRESSED, 80), speeds=((0.0, faster * _SLOW),)
    )
    solved = bench.solve(Case(f"overstress-{m:g}-{faster:g}", problem, accuracy))
    delta = solved["delta"]
    radius, force = (np.exp(smoothed(delta, np.log(solved[k]))) for k in ("radius", "force"))
    return Curves(radius / R, force)
