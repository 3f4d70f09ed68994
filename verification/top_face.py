"""What the other boundary condition of the hemisphere's top face would change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .. import fem
from ..campaigns.designs import pair_of
from ..core.material import Pair
from ..fem.discretise import Discretisation, discretise
from .bench import Bench
from .pairs import elastic_pair
from .paths import press
from .result import Cell, Measurement, Result, Table

_AT = (0.001, 0.003, 0.01)


def run(bench: Bench) -> Result:
    """Solve an elastic and a flattening case with the top face free and held radially."""
    flattening = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=0.1)
    rows: list[tuple[Cell, ...]] = []
    worst = {}
    for name, pair in (("elastic", elastic_pair()), ("Sy* = 0.1", flattening)):
        free, held = _both(pair)
        for x in _AT:
            F, a, s = (
                float(np.interp(x, free["delta"], held[key] - free[key]))
                for key in ("F", "a", "share")
            )
            worst[name, x] = F
            rows.append((name, f"{x:g}", f"{F:+.3f}", f"{a:+.3f}", f"{s:+.5f}"))
    return Result(
        name="top-face",
        title="The top face held radially",
        about=(
            "`fem.solve` moves the hemisphere's top face down and leaves it free radially. Here "
            "the same is solved with the face held radially as well, mesh of the `smoke` level; "
            "held minus free."
        ),
        measurements=tuple(
            Measurement(f"{name}: change of F at Delta/R = {_AT[-1]:g}", worst[name, _AT[-1]], "%")
            for name in ("elastic", "Sy* = 0.1")
        ),
        tables=(
            Table("Held minus free", ("bodies", "Delta/R", "F [%]", "a [%]", "delta_s*"),
                  tuple(rows)),
        ),
        notes=(
            "The change is that of the hemisphere's own compliance, of the order of a/R while the "
            "bodies are elastic; a real ball, loaded at its other pole, lies outside of both.",
        ),
    )  # fmt: skip


def _both(pair: Pair) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    first = min(0.3 * fem.critical_depth(pair), 4e-5)
    depths = fem.geometric_depths(first, _AT[-1], 100)
    grid = discretise(fem.ContactProblem(pair, depths), fem.Accuracy.smoke())
    held = replace(grid, held=np.unique(np.concatenate([grid.held, 2 * grid.mesh.top])))
    return _curves(grid, depths), _curves(held, depths)


def _curves(grid: Discretisation, depths: tuple[float, ...]) -> dict[str, np.ndarray]:
    readings = press(grid, depths=depths)
    return {
        "delta": np.array([r.delta for r in readings]),
        "F": 100.0 * np.log([r.force for r in readings]),
        "a": 100.0 * np.log([r.radius for r in readings]),
        "share": np.array([r.sphere / (r.sphere + r.flat) for r in readings]),
    }
