"""How far each level of accuracy is off: the table from which a solve states its uncertainty."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.hardening import validation_hardening
from ....campaigns.cases.pairs import table_2_1
from ....core.arrays import Array
from ....core.output import write_file
from ..bench import Bench, Solved
from ..result import Cell, Measurement, Result, Table

_KNOTS = np.log([0.3, 1.0, 2.0, 4.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e5])  # of Delta/delta_c
_REACH = (
    0.6  # a knot speaks for what lies within this in the logarithm, or nearer to it than others
)
_DEEPEST, _DEPTHS = 0.1, 48
_UNITS = np.array([0.01, 0.01, 1.0, 0.01])  # of `_curves`
_COLUMNS = ("force", "radius", "sphere_share", "hardness")
_COVERED = (("one", 0.62, 1.0), ("two", 0.92, 1.0))
_PAIRS = (
    (1, 1.0), (5, 10.0), (2, 1.3), (1, 0.7), (5, 1.5), (3, 1.15), (4, 0.85),
    (4, 10.0), (2, 0.1), (3, 1.0), (1, 10.0), (1, 0.1), (5, 1.0), (2, 10.0), (4, 0.1),
    (2, 1.0), (3, 10.0), (5, 0.1), (4, 1.0),
)  # cases of Table 2.1 and Sy*, those that say most first  # fmt: skip
_HARDENING = (3, 11)  # of `validation_hardening`


@dataclass(frozen=True)
class Off:
    """How far one solve is off along its depths.

    `name`: of its pair; `strengths`: as `fem.strengths_of` has them; `w`: delta/delta_c, shape
    (n,); `error`: of ln F, ln a, the share and ln H, shape (4, n).
    """

    name: str
    strengths: str
    w: Array
    error: Array


def run(bench: Bench) -> Result:
    """Compare the levels with finer solves and write the table that the solver states."""
    base, *levels = (fem.Accuracy.production(), fem.Accuracy.quick(), fem.Accuracy.smoke())
    trios = [_trio(bench, base, number, ratio) for number, ratio in _PAIRS]
    left = _left(trios)
    found: dict[str, list[Off]] = {level.level: [] for level in (base, *levels)}
    for (number, ratio), (_, solved, finer) in zip(_PAIRS, trios, strict=True):
        own = _own(solved, finer, left, f"{number}, {ratio:g}")
        found[base.level].append(own)
        for level in levels:
            found[level.level].append(_against(bench.solve(_as_asked(solved, level)), solved, own))
    table = {level: _tables(offs) for level, offs in found.items()}
    for least, rows in pairwise(table.values()):  # the coarser level was seen at fewer depths
        rows |= {name: np.maximum(least[name], row) for name, row in rows.items()}
    _write(table)
    hardening = [_hardening(bench, k, table["quick"]) for k in _HARDENING]
    return _result(found, table, hardening)


def _trio(bench: Bench, base: fem.Accuracy, number: int, ratio: float) -> tuple[Solved, ...]:
    """A pair of Table 2.1 with elements and steps twice as large, as they are, and half of it."""
    pair = table_2_1(number, ratio)
    first = 0.3 * pair.first_yield
    steps = int(np.ceil(np.log(_DEEPEST / first) / np.log(base.step_ratio**2)))
    return tuple(
        bench.solve(
            Case(
                f"levels-{number}-Sy*-{ratio:g}",
                fem.ContactProblem(pair, fem.geometric_depths(first, _DEEPEST, n * steps + 1)),
                _scaled(base, factor),
            )
        )
        for factor, n in ((2.0, 1), (1.0, 2), (0.5, 2))
    )


def _scaled(base: fem.Accuracy, factor: float) -> fem.Accuracy:
    if factor == 1.0:
        return base
    return base.with_(
        level=f"{base.level}, {factor:g} h",
        fine=factor * base.fine,
        coarse=factor * base.coarse,
        divisions=2 * round(0.5 * base.divisions / factor),
        step_ratio=base.step_ratio**factor,
    )


def _left(trios: list[tuple[Solved, ...]]) -> Array:
    """What the finer solve has left of its difference: 1/(q - 1), q by which halving divided it.

    Of all pairs together, shape (4,); first order leaves as much again, second order a third.
    """
    squares = np.zeros((2, 4))
    for coarser, base, finer in trios:
        delta = _common(coarser, base, finer)
        for k, (other, own) in enumerate(((coarser, base), (base, finer))):
            squares[k] += (_difference(other, own, delta) ** 2).mean(axis=1)
    q = np.sqrt(squares[0] / squares[1])
    return np.asarray(1.0 / (np.clip(q, 2.0, 4.0) - 1.0))


def _as_asked(base: Solved, accuracy: fem.Accuracy) -> Case:
    """The pair at another level, with depths as far apart as a user has them."""
    first = 0.3 * base.pair.first_yield
    depths = fem.geometric_depths(first, _DEEPEST, _DEPTHS)
    return Case("levels", fem.ContactProblem(base.pair, depths), accuracy)


def _own(base: Solved, finer: Solved, left: Array, name: str) -> Off:
    """Error of the finest level: its difference from the finer solve and what that has left."""
    delta = _common(base, finer)
    error = _difference(base, finer, delta) * (1.0 + left)[:, None]
    return Off(name, fem.strengths_of(base.pair), _over_onset(base, delta), error)


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
        for solved, curves in ((s, _curves(s)) for s in (other, base))
    )
    return np.asarray(_UNITS[:, None] * (there - here))


def _curves(solved: Solved) -> tuple[Array, Array, Array, Array]:
    """Ln F [%], ln a [%], the share and ln H [%] along a loading."""
    F, a = np.log(solved["force"]), np.log(solved["radius"])
    return 100.0 * F, 100.0 * a, solved.share, 100.0 * (F - 2.0 * a)


def _tables(offs: Iterable[Off]) -> dict[str, Array]:
    """Standard uncertainty at the knots by strengths, each of shape (4, n_knots)."""
    offs = list(offs)
    return {
        strengths: _rms([off for off in offs if off.strengths == strengths])
        for strengths in dict.fromkeys(off.strengths for off in offs)
    }


def _rms(offs: list[Off]) -> Array:
    x = np.concatenate([np.log(off.w) for off in offs])
    square = np.concatenate([off.error**2 for off in offs], axis=1)
    nearest = np.abs(x[:, None] - _KNOTS).argmin(axis=1)
    rows = []
    for k, knot in enumerate(_KNOTS):
        near = (np.abs(x - knot) < _REACH) | (nearest == k)
        rows.append(np.sqrt(square[:, near].mean(axis=1)) if near.any() else np.full(4, np.nan))
    out = np.array(rows).T
    for row in out:  # pairs that never come so deep keep their last value
        known = np.isfinite(row)
        row[~known] = np.interp(_KNOTS[~known], _KNOTS[known], row[known])
    return out


def _stated(table: Array, w: Array) -> Array:
    return np.asarray([np.interp(np.log(w), _KNOTS, row) for row in table])


def _covered(offs: list[Off], within: float) -> Array:
    """Share of depths within so many stated uncertainties of a table made without the case."""
    inside = []
    for k, off in enumerate(offs):
        table = _tables(offs[:k] + offs[k + 1 :])[off.strengths]
        inside.append((np.abs(off.error) <= within * _stated(table, off.w)).mean(axis=1))
    return np.asarray(np.mean(inside, axis=0))


def _hardening(bench: Bench, k: int, tables: dict[str, Array]) -> tuple[Cell, ...]:
    """One pair that harden, `quick` against `production`: the table knows no hardening."""
    case = validation_hardening()[k]
    problem = replace(case.problem, unload_from=(), radius_at_least=0.0)
    rough, fine = (
        bench.solve(Case(f"levels-{case.name}", problem, accuracy))
        for accuracy in (fem.Accuracy.quick(), fem.Accuracy.production())
    )
    delta = _common(rough, fine)
    error, w = _difference(rough, fine, delta), _over_onset(fine, delta)
    stated = _stated(tables[fem.strengths_of(fine.pair)], w)
    pulls = np.sqrt(np.mean((error / stated) ** 2, axis=1))
    return (case.name, *(round(float(pull), 2) for pull in pulls))


def _write(table: dict[str, dict[str, Array]]) -> Path:
    content = {
        "format": fem.MESH_ERRORS_FORMAT,
        "numerics_version": fem.NUMERICS_VERSION,
        "about": "standard uncertainty of mesh and step by level; F, a, H relative; at knots of "
        "Delta over the depth of first yield; made by `dentscope verify --only levels`",
        "depth_over_first_yield": [float(f"{np.exp(x):.6g}") for x in _KNOTS],
        "levels": {
            level: {
                strengths: {
                    name: [float(f"{value:.4g}") for value in row]
                    for name, row in zip(_COLUMNS, rows, strict=True)
                }
                for strengths, rows in tables.items()
            }
            for level, tables in table.items()
        },
    }
    return write_file(fem.MESH_ERRORS_FILE, json.dumps(content, indent=1) + "\n")


def _result(
    found: dict[str, list[Off]],
    table: dict[str, dict[str, Array]],
    hardening: list[tuple[Cell, ...]],
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
        (level, strengths, f"{np.exp(knot):.3g}",
         *(f"{100.0 * rows[i, k]:.2f}" for i in (0, 1)), f"{rows[2, k]:.4f}",
         f"{100.0 * rows[3, k]:.2f}")
        for level, tables in table.items()
        for strengths, rows in tables.items()
        for k, knot in enumerate(_KNOTS)
    ]  # fmt: skip
    return Result(
        title="What each level of accuracy states of itself",
        about=(
            "Nineteen pairs of Table 2.1 of the thesis at Sy* = 0.1 to 10, to Delta/R = 0.1. The "
            "error of `production` is its difference from elements and steps half as large, at "
            "each depth and with the ripple, and what that solve has left by the difference from "
            "those twice as large; that of `quick` and `smoke` holds their difference from "
            "`production` too. A solve states the rms over the pairs at its depth, nearly equally "
            "strong (Sy* 0.7 to 1.5) or unlike."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "Stated standard uncertainty",
                ("level", "strengths", "Delta/delta_c", "F [%]", "a [%]", "delta_s*", "H [%]"),
                tuple(rows),
            ),
            Table(
                "Pairs that harden, `quick` against `production`: rms over the stated uncertainty",
                ("case of the design", "F", "a", "delta_s*", "H"),
                tuple(hardening),
            ),
        ),
    )
