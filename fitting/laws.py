"""Both closed forms from one campaign: numbers, errors on pairs left out, and how far off they are.

What a user should expect of a law are its errors on combinations that its fit did not see: whole
combinations are left out in turn, and everything is found again without them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Mask
from ..core.processes.threads import in_one_thread
from ..models.closed_form import Coefficients
from ..models.correction import PairCorrection
from ..models.uncertainty import Calibration
from .calibrate import Misses, calibrate, misses, within
from .correct import compact_numbers, correct, corrected_prediction
from .fit import ENOUGH, FormFit, fit_tables
from .prediction import Errors, Prediction, errors_of, predict
from .ripple import ripple_of
from .rules import RULES
from .table import ResidualTable, Table

_DRAWN = ("space", "near-equal", "survey")


@dataclass(frozen=True)
class JudgedLaws:
    """A law and what pairs say of it that its fit had not seen.

    - `errors`, `held_out`: errors on the fitted rows, and on combinations left out.
    - `predicted`: every row as predicted by a fit that did not see its combination.
    - `calibration`: standard deviations from these.
    - `within`: shares of the errors left out within one and two of them, by quantity.
    """

    errors: Errors
    held_out: Errors
    predicted: Prediction
    calibration: Calibration
    within: dict[str, tuple[float, float]]


@dataclass(frozen=True)
class FittedLaws:
    """Result of both regressions: the compact law, the correction that makes the fitted one."""

    fit: FormFit
    correction: PairCorrection
    compact: JudgedLaws
    fitted: JudgedLaws


@in_one_thread
def fit_laws(table: Table, turns: ResidualTable) -> FittedLaws:
    """Fit both laws to rows of a campaign, and judge them on combinations left out."""
    fit, ripple = fit_tables(table, turns), np.stack(ripple_of(table))
    correction = correct(fit.values, table, turns, ripple)
    start = dict(zip(Coefficients._fields, fit.values.tolist(), strict=True))

    def anew(rest: Mask, rest_turns: Mask) -> list[Prediction]:
        fewer, turned = table.rows(rest), turns.rows(rest_turns)
        of_rest = ripple[:, rest]
        every = np.arange(len(fewer.D)) % RULES.every_depth == 0
        values = fit_tables(
            fewer.rows(every), turned, start=start, change=ENOUGH, ripple=of_rest[:, every]
        ).values
        found = correct(values, fewer, turned, of_rest)
        return [predict(values, table, turns), corrected_prediction(values, found, table, turns)]

    own = (
        predict(fit.values, table, turns),
        corrected_prediction(fit.values, correction, table, turns),
    )
    numbers = compact_numbers(fit.values, table)
    alone = stands_alone(table)
    sides = zip(
        own,
        left_out(anew, table, turns, folds=RULES.folds),
        (numbers, correction.of(table.bodies, numbers)),
        strict=True,
    )
    compact, fitted = (
        _judged(seen, unseen, misses(unseen, of_pair, table, turns, alone=alone), table, turns)
        for seen, unseen, of_pair in sides
    )
    return FittedLaws(fit, correction, compact, fitted)


def stands_alone(table: Table) -> Mask:
    """Whether each case is of a design drawn over the space, where no two pairs are near twins.

    A case of Table 2.1 has one at the next Sy*, and a law that was fitted to that looks better than
    it is on a user's pair. All cases count where none was drawn.
    """
    alone = np.array([name.startswith(_DRAWN) for name in table.names])
    return alone if alone.any() else ~alone


def left_out(
    predict_without: Callable[..., list[Prediction]],
    table: Table,
    turns: ResidualTable,
    *,
    folds: int,
) -> list[Prediction]:
    """Every row as predicted by fits that did not see its combination, left out in `folds` groups.

    `predict_without` fits the rows and the turning points of two masks; returns what each law then
    says of all.
    """
    count = len(table.pairs)
    # a fixed shuffle: neighbours of a design do not leave together, and a rerun gives the same
    fold = np.random.default_rng(1).permutation(count) % min(folds, count)
    outs = [(fold[table.case] == k, fold[turns.case] == k) for k in range(min(folds, count))]
    with ThreadPoolExecutor(min(os.cpu_count() or 1, 2)) as pool:
        found = list(pool.map(lambda out: predict_without(~out[0], ~out[1]), outs))
    collected = found[0]
    for (out, out_turns), one in zip(outs, found, strict=True):
        collected = [a.mix(b, out, out_turns) for a, b in zip(collected, one, strict=True)]
    return collected


def _judged(
    seen: Prediction,
    unseen: Prediction,
    found: dict[str, Misses],
    table: Table,
    turns: ResidualTable,
) -> JudgedLaws:
    calibration = calibrate(found)
    return JudgedLaws(
        errors_of(seen, table, turns), errors_of(unseen, table, turns), unseen, calibration,
        within(calibration, found),
    )  # fmt: skip
