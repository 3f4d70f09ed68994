"""Whether stated probabilities and intervals are as often right as they say."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable

import numpy as np

from .case import Case, covered
from .generators.truth import PLANTED

BINS = (0.0, 0.05, 0.3, 0.7, 0.95, 1.0)
"""Edges of the bins of the inclusion probability."""


def inclusion(cases: Iterable[Case]) -> list[tuple[float, float, float, int, int]]:
    """Stated probability that a mechanism takes part, against how often it does, in bins.

    Every mechanism that a set could show counts once; those of no weight at all are left out.

    Returned: (low, high, mean stated, acting, cases) of each bin with cases.
    """
    rows = []
    for case in cases:
        if case.truth["kind"] in PLANTED:
            continue
        for name, p in (case.verdict.get("inclusion") or {}).items():
            rows.append((float(p), name in case.true))
    found = []
    for low, high in itertools.pairwise(BINS):
        here = [(p, hit) for p, hit in rows if low <= p < high or p == high == 1.0]
        if here:
            mean = float(np.mean([p for p, _ in here]))
            found.append((low, high, mean, sum(hit for _, hit in here), len(here)))
    return found


def calibration_error(cases: Iterable[Case]) -> float:
    """Mean distance of stated inclusion and frequency over the bins, by their cases."""
    rows = inclusion(cases)
    total = sum(n for *_, n in rows)
    if not total:
        return math.nan
    return sum(n * abs(mean - hits / n) for _, _, mean, hits, n in rows) / total


def coverage_by_class(cases: Iterable[Case]) -> dict[str, tuple[int, int]]:
    """Mechanism, and whether its metal is off, to intervals that cover, of how many."""
    found: dict[str, tuple[int, int]] = {}
    for case in cases:
        if case.truth["kind"] != "single":
            continue
        for hit in covered(case):
            name = f"{'+'.join(sorted(case.true))}, metal {'off' if case.off else 'as the law'}"
            hits, of = found.get(name, (0, 0))
            found[name] = (hits + hit, of + 1)
    return dict(sorted(found.items()))
