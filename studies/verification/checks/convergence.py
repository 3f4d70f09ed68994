"""Error of mesh and step, and ripple, for Table 2.1 of the thesis at three strength ratios."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.pairs import TABLE_2_1, table_2_1
from ....core.arrays import Array
from ..bench import Bench, Effort, Solved
from ..curves import inner, ripple, smoothed
from ..result import Cell, Measurement, Result, Table

_RATIOS = (0.1, 1.0, 10.0)
# F [%], a [%], delta_s*, H [%]
_NAMES = ("F", "a", "delta_s*", "H")
_MARKS = (0.5, 0.5, 0.002, 1.0)
_BULK = 4.0 / 3.0
_RIPPLE_MARKS = {"F": 0.1, "a": 0.05}


@dataclass(frozen=True)
class Plan:
    """A level of accuracy and what it is compared with.

    - `base`: the level whose error is estimated.
    - `coarser`: the same steps on elements twice as large.
    - `bulkier`: the same elements at the contact edge, those of the bulk larger by about a third.
    - `bolder`: the same elements with steps twice as large (in ln Delta).
    - `deepest`: largest Delta/R.
    - `unload_from`: depths that the base is unloaded from.
    """

    base: fem.Accuracy
    coarser: fem.Accuracy
    bulkier: fem.Accuracy
    bolder: fem.Accuracy
    deepest: float
    unload_from: tuple[float, ...]


def plan_of(effort: Effort) -> Plan:
    """Return what is solved at an effort."""
    if effort is Effort.QUICK:
        base, deepest = fem.Accuracy.smoke().with_(level="smoke, h/2", fine=0.05), 0.01
    else:
        base, deepest = fem.Accuracy.production(), 0.1
    return Plan(
        base=base,
        coarser=base.with_(level=f"{base.level}, 2 h", fine=2.0 * base.fine),
        bulkier=base.with_(
            level=f"{base.level}, 4/3 H",
            coarse=_BULK * base.coarse,
            divisions=2 * round(0.5 * base.divisions / _BULK),
        ),
        bolder=base.with_(level=f"{base.level}, 2 steps", step_ratio=base.step_ratio**2),
        deepest=deepest,
        unload_from=(0.3 * deepest, deepest),
    )


def ordered_cases() -> list[tuple[int, float]]:
    """Case of Table 2.1 and Sy*, those that say most first."""
    first = [(1, 1.0), (5, 10.0), (3, 0.1)]
    return first + [
        (number, ratio) for number in TABLE_2_1 for ratio in _RATIOS if (number, ratio) not in first
    ]


def case_of(number: int, ratio: float, *, plan: Plan, accuracy: fem.Accuracy) -> Case:
    """Return a case of Table 2.1; the base is also unloaded.

    Every step is recorded, so that the ripple, whose period is an element, is seen as it is:
    at wider depths it would look like a wave of any length, which no smoothing takes out.
    """
    pair = table_2_1(number, ratio)
    first = 0.3 * pair.first_yield
    steps = int(np.ceil(np.log(plan.deepest / first) / np.log(plan.bolder.step_ratio)))
    # depths of the bolder solve are every other one of the base's
    steps *= 1 if accuracy == plan.bolder else 2
    problem = fem.ContactProblem(
        pair,
        fem.geometric_depths(first, plan.deepest, steps + 1),
        unload_from=plan.unload_from if accuracy == plan.base else (),
    )
    return Case(f"table-2.1-case-{number}-Sy*-{ratio:g}", problem, accuracy)


def run(bench: Bench) -> Result:
    """Solve every case on two meshes and with two steps; what is done is kept case by case."""
    plan = plan_of(bench.effort)
    rows: list[tuple[Cell, ...]] = []
    total = np.empty((0, 4))
    ripples = np.empty((0, 4))
    cases = ordered_cases()
    for k, (number, ratio) in enumerate(cases, start=1):
        base, coarser, bulkier, bolder = (
            bench.solve(case_of(number, ratio, plan=plan, accuracy=accuracy))
            for accuracy in (plan.base, plan.coarser, plan.bulkier, plan.bolder)
        )
        edge, wave = difference(coarser, base)
        bulk, _ = difference(bulkier, base)
        step, _ = difference(bolder, base)
        mesh = _of_mesh(edge, bulk)
        error = combined(edge, bulk, step)
        total, ripples = np.vstack([total, error]), np.vstack([ripples, wave])
        rows.append(
            (f"{number}, {ratio:g}", *(_pair_of_numbers(i, mesh, step / 3.0) for i in range(4)),
             f"{wave[0]:.2f} / {wave[1]:.2f} / {wave[3]:.2f}",
             f"{base.counters['cpu_s']:.0f}", "" if base.completed else base.message)
        )  # fmt: skip
        found = _result(plan, rows, total, ripples, k, len(cases))
        bench.publish(found)
    return found


def difference(other: Solved, base: Solved) -> tuple[Array, Array]:
    """Largest smoothed differences of F, a, delta_s*, H (in %, share absolute), and base's ripple.

    Depths that both reached, but for the ends, where smoothing is one-sided.
    """
    delta = base["delta"][inner(base["delta"])]
    delta = delta[delta <= other["delta"][inner(other["delta"])][-1]]
    off = [
        float(np.abs(_smooth_at(delta, other, x) - _smooth_at(delta, base, y)).max())
        for x, y in zip(curves(other), curves(base), strict=True)
    ]
    return np.array(off), np.array([ripple(base["delta"], y) for y in curves(base)])


def combined(edge: Array, bulk: Array, step: Array) -> Array:
    """Error of the base, from its differences with larger elements and longer steps."""
    return np.hypot(_of_mesh(edge, bulk), step / 3.0)  # of second order in the step


def _of_mesh(edge: Array, bulk: Array) -> Array:
    # first order in the element at the edge, where the contact opens: what halving changed is
    # what is left; second order in the bulk
    return np.hypot(edge, bulk / (_BULK**2 - 1.0))


def curves(solved: Solved) -> tuple[Array, Array, Array, Array]:
    """Ln F [%], ln a [%], the share and ln H [%] along a loading."""
    F, a = np.log(solved["force"]), np.log(solved["radius"])
    return 100.0 * F, 100.0 * a, solved.share, 100.0 * (F - 2.0 * a)


def _smooth_at(delta: Array, solved: Solved, values: Array) -> Array:
    own = solved["delta"]
    return np.interp(np.log(delta), np.log(own), smoothed(own, values))


def _result(
    plan: Plan, rows: list[tuple[Cell, ...]], total: Array, ripples: Array, done: int, of: int
) -> Result:
    worst = total.max(axis=0)
    waves = ripples.max(axis=0)
    base = plan.base
    marked = base.level == "production"
    settings = f"{base.divisions} divisions, edge {base.fine:g} a, steps of {base.step_ratio:g}"
    return Result(
        name="convergence",
        title="Error of mesh and step",
        about=(
            f"Table 2.1 of the thesis at Sy* = 0.1, 1, 10, to Delta/R = {plan.deepest:g}, level "
            f"`{base.level}` ({settings}): against elements twice as large at the edge, a third "
            "larger everywhere else and steps twice as large (in ln Delta), ripple smoothed out. "
            "The error is the whole difference at the edge (first order), 9/7 of that of the "
            "bulk and a third of that of the step (second order), added in the square."
        ),
        measurements=(
            *(
                Measurement(f"error of {name}, largest over cases and depths", float(value),
                            "" if name == "delta_s*" else "%", None, mark if marked else None,
                            "own estimate")
                for name, value, mark in zip(_NAMES, worst, _MARKS, strict=True)
            ),
            *(
                Measurement(f"ripple of {name}, rms, worst case", float(waves[_NAMES.index(name)]),
                            "%", None, mark if marked else None, "own")
                for name, mark in _RIPPLE_MARKS.items()
            ),
        ),
        tables=(
            Table(
                "Largest differences, mesh + step",
                ("case, Sy*", "F [%]", "a [%]", "delta_s*", "H [%]", "ripple F / a / H [%]",
                 "processor s", "ended"),
                tuple(rows),
            ),
        ),
        notes=(
            *((f"{done} of {of} cases measured so far.",) if done < of else ()),
            *(("The marks hold for the production level and Delta/R = 0.1; this is a coarser "
               "level, to show how the error is measured.",) if base.level != "production" else ()),
        ),
        complete=done == of,
    )  # fmt: skip


def _pair_of_numbers(i: int, mesh: Array, step: Array) -> str:
    digits = 4 if _NAMES[i] == "delta_s*" else 2
    return f"{mesh[i]:.{digits}f} + {step[i]:.{digits}f}"
