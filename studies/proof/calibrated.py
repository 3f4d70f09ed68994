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


def calibration(cases: list[Case]) -> list[tuple[float, float, int, int]]:
    """Stated probability of the best explanation against how often it was right, in bins.

    Returned: (low, high, right, cases) of each bin with cases.
    """
    edges = [0.0, 0.5, 0.7, 0.9, 0.97, 1.0]
    counts = [[0, 0] for _ in edges[1:]]
    for case in cases:
        stated = case.verdict.get("probabilities") or {}
        if not stated or case.truth["kind"] in PLANTED:
            continue
        top = max(stated, key=lambda key: float(stated[key]))
        kind = case.truth["kind"]
        true = {"null": frozenset({"baseline"}), "outside": frozenset({"outside-library"})}
        right = frozenset(top.split("+")) == true.get(kind, case.true)
        place = int(np.searchsorted(edges[1:-1], float(stated[top]), side="right"))
        counts[place][0] += right
        counts[place][1] += 1
    return [(edges[i], edges[i + 1], r, n) for i, (r, n) in enumerate(counts) if n]
