"""A rigid sphere pressed at different speeds into a metal whose stress is a power of the rate."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .... import fem
from ....campaigns.case import Case
from ....core.flow import Flow, Rate, tabulated
from ....core.material import Material, Pair
from ..bench import Bench, Effort
from ..curves import smoothed
from ..pairs import RIGID, R
from ..result import Cell, Measurement, Result, Table

Floats = npt.NDArray[np.float64]

_E = 200e9
_AT_REST = 1e-4 * _E  # a first yield needs one; raised with the speed as all other stress is
_STRESS = 1e-3 * _E  # at the rate of the slow approach, 0.4 v/a, at a/R = 0.1
_SLOW = 1e-3  # m/s; no inertia, so that the number is free
_FASTER = 100.0
_EXPONENTS = (0.05, 0.1)
_DEPTHS = (2e-3, 3e-2)
_PLASTIC = 100.0  # E' a/(R sigma) from which elastic strains count little in the mean pressure


def run(bench: Bench) -> Result:
    """Press at one speed and at a hundred times it; F at a contact radius rises by 100^m."""
    accuracy = fem.Accuracy.quick() if bench.effort is Effort.QUICK else fem.Accuracy.production()
    measurements: list[Measurement] = []
    rows: list[tuple[Cell, ...]] = []
    for m in _EXPONENTS:
        slow = _curves(bench, m, 1.0, accuracy)
        fast = _curves(bench, m, _FASTER, accuracy)
        rise = np.interp(slow.radius, fast.radius, fast.force) / slow.force
        off = rise / _FASTER**m - 1.0
        judged = _plastic(slow.radius, m) & (slow.radius <= fast.radius[-1])
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
        name="speed",
        title="A hundred times the speed",
        about=(
            "A rigid sphere on a flat whose flow stress is a power m of the rate of plastic "
            f"strain, beside a tenth that knows no rate and is raised by 100^m itself; E over the "
            f"stress at the slow speed is {_E / _STRESS:.0f}, level `{accuracy.level}`, ripple "
            f"smoothed out, judged from E' a/(R sigma) = {_PLASTIC:g} on. Without elastic "
            "strain every rate goes with the speed, every stress with its power m, and so does the "
            "force, at a contact radius and at a depth alike."
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


def _plastic(radius: Floats, m: float) -> npt.NDArray[np.bool_]:
    """Where the faster contact is plastic, sigma its flow stress at the rate 0.4 v/a."""
    stress = _FASTER**m * (_AT_REST + _STRESS * (0.1 / radius) ** m)
    return np.asarray(_E / (1.0 - 0.3**2) * radius / stress >= _PLASTIC)


class Curves(NamedTuple):
    """a/R and F [N] over the depths, without ripple."""

    radius: Floats
    force: Floats


def _curves(bench: Bench, m: float, faster: float, accuracy: fem.Accuracy) -> Curves:
    rate = Rate("overstress", 0.4 * _SLOW / (0.1 * R), m, _STRESS)
    at_rest = _AT_REST * faster**m
    flow = Flow(tabulated(np.array([0.0, 1.0]), np.full(2, at_rest)), rate)
    metal = Material(_E, 0.3, at_rest, flow=flow)
    problem = fem.ContactProblem(
        Pair(RIGID, metal, R), fem.geometric_depths(*_DEPTHS, 80), speeds=((0.0, faster * _SLOW),)
    )
    solved = bench.solve(Case(f"overstress-{m:g}-{faster:g}", problem, accuracy))
    delta = solved["delta"]
    radius, force = (np.exp(smoothed(delta, np.log(solved[k]))) for k in ("radius", "force"))
    return Curves(radius / R, force)
