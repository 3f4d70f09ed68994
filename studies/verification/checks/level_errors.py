"""How far each level of accuracy is off: the table from which a solve states its uncertainty."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.hardening import validation_hardening
from ....core.arrays import Array
from ....core.output import write_file
from ..bench import Bench, Effort, Solved
from ..result import Cell, Measurement, Result, Table
from . import convergence

_KNOTS = np.log([0.3, 1.0, 2.0, 4.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e5])  # of Delta/delta_c
_REACH = (
    0.6  # a knot speaks for what lies within this in the logarithm, or nearer to it than others
)
_DEEPEST, _DEPTHS = 0.1, 48
_UNITS = np.array([0.01, 0.01, 1.0, 0.01])  # of `convergence.curves`
_COLUMNS = ("force", "radius", "sphere_share", "hardness")
_COVERED = (("one", 0.62, 1.0), ("two", 0.92, 1.0))
_HARDENING = (3, 11)  # of `validation_hardening`


@dataclass(frozen=True)
class Off:
    """How far one solve is off along its depths.

    `name`: of its pair; `equal`: whether the two bodies are equally strong; `w`: delta/delta_c,
    shape (n,); `error`: of ln F, ln a, the share and ln H, shape (4, n).
    """

    name: str
    equal: bool
    w: Array
    error: Array


def run(bench: Bench) -> Result:
    """Compare the levels over Table 2.1 and write the table that the solver states."""
    plan = convergence.plan_of(Effort.PRODUCTION)
    levels = (fem.Accuracy.quick(), fem.Accuracy.smoke())
    found: dict[str, list[Off]] = {level.level: [] for level in (plan.base, *levels)}
    for number, ratio in convergence.ordered_cases():
        base, *others = (
            bench.solve(convergence.case_of(number, ratio, plan=plan, accuracy=accuracy))
            for accuracy in (plan.base, plan.coarser, plan.bulkier, plan.bolder)
        )
        own = _own(base, others, f"{number}, {ratio:g}", equal=ratio == 1.0)
        found["production"].append(own)
        for level in levels:
            found[level.level].append(_against(bench.solve(_as_asked(base, level)), base, own))
    table = {level: _table(offs) for level, offs in found.items()}
    _write(table)
    hardening = [_hardening(bench, k, table["quick"]) for k in _HARDENING]
    return _result(found, table, hardening)


def _as_asked(base: Solved, accuracy: fem.Accuracy) -> Case:
    """The pair at another level, with depths as far apart as a user has them."""
    first = 0.3 * base.pair.first_yield
    depths = fem.geometric_depths(first, _DEEPEST, _DEPTHS)
    return Case("levels", fem.ContactProblem(base.pair, depths), accuracy)


def _own(base: Solved, others: list[Solved], name: str, *, equal: bool) -> Off:
    """Error of the finest level, by the differences that `convergence` combines."""
    delta = _common(base, *others)
    edge, bulk, step = (_difference(other, base, delta) for other in others)
    return Off(name, equal, _over_onset(base, delta), convergence.combined(edge, bulk, step))


def _against(solved: Solved, base: Solved, own: Off) -> Off:
    """Error of a coarser level: its difference from the finest, and the finest's own."""
    delta = _common(solved, base)
    w = _over_onset(base, delta)
    finest = np.array([np.interp(np.log(w), np.log(own.w), row) for row in own.error])
    return replace(own, w=w, error=np.hypot(_difference(solved, base, delta), finest))


def _common(first: Solved, *others: Solved) -> Array:
    """Depths of the first that all reached [m]."""
    last = min(solved["delta"][-1] for solved in (first, *others))
    return np.asarray(first["delta"][first["delta"] <= last * (1.0 + 1e-9)])


def _over_onset(solved: Solved, delta: Array) -> Array:
    return np.asarray(delta / (solved.pair.first_yield * solved.pair.R))


def _difference(other: Solved, base: Solved, delta: Array) -> Array:
    """Of ln F, ln a, share and ln H as they are, ripple and all; shape (4, n)."""
    there, here = (
        np.array([np.interp(np.log(delta), np.log(solved["delta"]), y) for y in curves])
        for solved, curves in ((s, convergence.curves(s)) for s in (other, base))
    )
    return np.asarray(_UNITS[:, None] * (there - here))


def _table(offs: Iterable[Off]) -> Array:
    """Standard uncertainty at the knots, shape (4, n_knots): the worse of the two classes."""
    offs = list(offs)
    classes = [[off for off in offs if off.equal is kind] for kind in (True, False)]
    return np.asarray(np.max([_rms(chosen) for chosen in classes if chosen], axis=0))


def _rms(offs: list[Off]) -> Array:
    x = np.concatenate([np.log(off.w) for off in offs])
    square = np.concatenate([off.error**2 for off in offs], axis=1)
    nearest = np.abs(x[:, None] - _KNOTS).argmin(axis=1)
    rows = []
    for k, knot in enumerate(_KNOTS):
        near = (np.abs(x - knot) < _REACH) | (nearest == k)
        rows.append(np.sqrt(square[:, near].mean(axis=1)) if near.any() else np.full(4, np.nan))
    out = np.array(rows).T
    for row in out:  # a class that never comes so deep keeps its last value
        known = np.isfinite(row)
        row[~known] = np.interp(_KNOTS[~known], _KNOTS[known], row[known])
    return out


def _stated(table: Array, w: Array) -> Array:
    return np.asarray([np.interp(np.log(w), _KNOTS, row) for row in table])


def _covered(offs: list[Off], within: float) -> Array:
    """Share of depths within so many stated uncertainties of a table made without the case."""
    inside = []
    for k, off in enumerate(offs):
        table = _table(offs[:k] + offs[k + 1 :])
        inside.append((np.abs(off.error) <= within * _stated(table, off.w)).mean(axis=1))
    return np.asarray(np.mean(inside, axis=0))


def _hardening(bench: Bench, k: int, table: Array) -> tuple[Cell, ...]:
    """One pair that harden, `quick` against `production`: the table knows no hardening."""
    case = validation_hardening()[k]
    problem = replace(case.problem, unload_from=(), radius_at_least=0.0)
    rough, fine = (
        bench.solve(Case(f"levels-{case.name}", problem, accuracy))
        for accuracy in (fem.Accuracy.quick(), fem.Accuracy.production())
    )
    delta = _common(rough, fine)
    error, w = _difference(rough, fine, delta), _over_onset(fine, delta)
    pulls = np.sqrt(np.mean((error / _stated(table, w)) ** 2, axis=1))
    return (case.name, *(round(float(pull), 2) for pull in pulls))


def _write(table: dict[str, Array]) -> Path:
    content = {
        "format": fem.MESH_ERRORS_FORMAT,
        "numerics_version": fem.NUMERICS_VERSION,
        "about": "standard uncertainty of mesh and step by level; F, a, H relative; at knots of "
        "Delta over the depth of first yield; made by `dentscope verify --only levels`",
        "depth_over_first_yield": [float(f"{np.exp(x):.6g}") for x in _KNOTS],
        "levels": {
            level: {
                name: [float(f"{value:.4g}") for value in row]
                for name, row in zip(_COLUMNS, rows, strict=True)
            }
            for level, rows in table.items()
        },
    }
    return write_file(fem.MESH_ERRORS_FILE, json.dumps(content, indent=1) + "\n")


def _result(
    found: dict[str, list[Off]], table: dict[str, Array], hardening: list[tuple[Cell, ...]]
) -> Result:
    measurements = [
        Measurement(
            f"{level}: depths within {name} stated uncertaint{'y' if name == 'one' else 'ies'} of "
            "a table made without the pair, mean of F, a, share, H",
            float(_covered(offs, within).mean()), "", low, high, "own estimate",
        )
        for level, offs in found.items()
        for within, (name, low, high) in enumerate(_COVERED, start=1)
    ]  # fmt: skip
    rows: list[tuple[Cell, ...]] = [
        (level, f"{np.exp(knot):.3g}",
         *(f"{100.0 * rows[i, k]:.2f}" for i in (0, 1)), f"{rows[2, k]:.4f}",
         f"{100.0 * rows[3, k]:.2f}")
        for level, rows in table.items()
        for k, knot in enumerate(_KNOTS)
    ]  # fmt: skip
    return Result(
        name="levels",
        title="What each level of accuracy states of itself",
        about=(
            "Table 2.1 of the thesis at Sy* = 0.1, 1, 10, to Delta/R = 0.1. The error of "
            "`production` is that of the check before, at each depth and with the ripple; that "
            "of `quick` and `smoke` holds their difference from `production` too. A solve states "
            "the rms over the pairs at its depth, of equally strong bodies or of the others, "
            "whichever is larger."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "Stated standard uncertainty",
                ("level", "Delta/delta_c", "F [%]", "a [%]", "delta_s*", "H [%]"),
                tuple(rows),
            ),
            Table(
                "Pairs that harden, `quick` against `production`: rms over the stated uncertainty",
                ("case of the design", "F", "a", "delta_s*", "H"),
                tuple(hardening),
            ),
        ),
    )
