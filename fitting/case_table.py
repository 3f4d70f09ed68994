"""A solved pair as the table that a contact law reads."""

from __future__ import annotations

import math

import numpy as np

from .. import fem
from ..core.errors import InputError
from ..models.table import FEWEST_UNLOADINGS, LoadingCurve, PairTable, Turns, energy_exponent


def pair_table(solution: fem.Solution, uncertainty: fem.CurveUncertainty) -> PairTable:
    """Return what a law needs of a solve and of the uncertainty of its loading curve.

    The pair was pressed, and unloaded from several depths; too few of a pair that yields are
    refused.
    """
    pair, c = solution.problem.pair, solution.loading
    rows = []
    for u in solution.unloadings:
        total = u.residual_sphere + u.residual_flat
        if 0.0 < total < u.depth * pair.R and u.depth > pair.first_yield:
            exponent = energy_exponent(u.curve.delta, u.curve.force, total)
            rows.append((u.depth, total / (u.depth * pair.R), u.residual_sphere / total, exponent))
    turns = np.array(sorted(row for row in rows if math.isfinite(row[-1]))).reshape(-1, 4)
    if len(turns) < FEWEST_UNLOADINGS and math.isfinite(pair.Sy_min):
        raise InputError(
            f"unloaded beyond first yield: {len(turns)} times", key="load.unload_from",
            allowed=f"{FEWEST_UNLOADINGS} or more for a law of this pair",
        )  # fmt: skip
    curve = LoadingCurve(
        depth=c.delta / pair.R,
        force=c.force / (pair.E_reduced * pair.R**2),
        radius=c.radius / pair.R,
        share=c.sphere_share,
        force_std=uncertainty.force / c.force,
        radius_std=uncertainty.radius / c.radius,
        share_std=uncertainty.sphere_share,
    )
    return PairTable(pair, curve, Turns(*turns.T))
