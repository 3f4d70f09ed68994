"""A rigid sphere pressed at different speeds into a metal whose stress is a power of the rate."""

from __future__ import annotations

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
_JUDGED = 8e-3  # Delta/R from which elastic strains no longer count


def run(bench: Bench) -> Result:
    """Press at one speed and at a hundred times it; F at a depth rises by 100^m."""
    accuracy = fem.Accuracy.quick() if bench.effort is Effort.QUICK else fem.Accuracy.production()
    measurements: list[Measurement] = []
    rows: list[tuple[Cell, ...]] = []
    for m in _EXPONENTS:
        delta, slow = _force(bench, m, 1.0, accuracy)
        _, fast = _force(bench, m, _FASTER, accuracy)
        off = fast / slow / _FASTER**m - 1.0
        judged = delta >= _JUDGED
        measurements.append(
            Measurement(
                f"m = {m:g}: rise of F over that of the similarity solution, largest difference",
                100.0 * float(np.abs(off[judged]).max()), "%", None, 2.0,
                "exact: F at a depth goes with the speed to the power m",
            )
        )  # fmt: skip
        rows += [
            (m, f"{x:g}", f"{np.interp(x, delta, fast / slow):.4f}", f"{_FASTER**m:.4f}",
             f"{100.0 * np.interp(x, delta, off):+.2f} %")
            for x in (0.004, 0.008, 0.015, 0.03)
        ]  # fmt: skip
    return Result(
        name="speed",
        title="A hundred times the speed",
        about=(
            "A rigid sphere on a flat whose flow stress is a power m of the rate of plastic "
            f"strain, beside a tenth that knows no rate and is raised by 100^m itself; E over the "
            f"stress at the slow speed is {_E / _STRESS:.0f}, level `{accuracy.level}`, ripple "
            "smoothed out. Without elastic strain every rate goes with the speed, every stress "
            "with its power m, and so does the force at a depth, whatever the strains."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "Force at 100 times the speed over that at the slow one",
                ("m", "Delta/R", "F over F", "100^m", "difference"),
                tuple(rows),
            ),
        ),
        notes=("Elastic strains, which similarity has not, rise with the stress of the faster.",),
    )


def _force(bench: Bench, m: float, faster: float, accuracy: fem.Accuracy) -> tuple[Floats, Floats]:
    """Delta/R and F [N] without ripple."""
    rate = Rate("overstress", 0.4 * _SLOW / (0.1 * R), m, _STRESS)
    at_rest = _AT_REST * faster**m
    flow = Flow(tabulated(np.array([0.0, 1.0]), np.full(2, at_rest)), rate)
    metal = Material(_E, 0.3, at_rest, flow=flow)
    problem = fem.ContactProblem(
        Pair(RIGID, metal, R), fem.geometric_depths(*_DEPTHS, 80), speeds=((0.0, faster * _SLOW),)
    )
    solved = bench.solve(Case(f"overstress-{m:g}-{faster:g}", problem, accuracy))
    delta = solved["delta"]
    return delta / R, np.exp(smoothed(delta, np.log(solved["force"])))
