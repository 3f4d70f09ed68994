"""Scores of answers: the proof's own marks, with intervals over draws of sets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ...core.arrays import Array
from ..proof.rivals import (
    ANOTHER_PAIR,
    BASELINE,
    OUTSIDE,
    Mark,
    draws_of,
    mark_of,
    mean_with_interval,
)
from .answers import MECHANISMS, Odds

NAMED = 0.5
"""A name is said where it has more than this."""

ENOUGH, MOST = 0.9, 3
"""The set of an answer: the fewest names, the most probable first, that have so much together, and
three at most."""

_METHOD = "method"


class Row(NamedTuple):
    """One score: its name, value and 95 % interval."""

    name: str
    value: float
    low: float
    high: float


def marks(answers: Mapping[str, Odds], truths: Mapping[str, tuple[str, ...]]) -> list[Mark]:
    """Return the marks of each set, in the order of the truths."""
    return [_mark(answers[name], truth) for name, truth in truths.items()]


def _mark(odds: Odds, truth: tuple[str, ...]) -> Mark:
    order = sorted(odds, key=lambda name: -odds[name])
    total = np.cumsum([odds[name] for name in order])
    size = min(int(np.searchsorted(total, ENOUGH - 1e-9)) + 1, MOST)
    line: dict[str, Any] = {
        "truth": list(truth), "acting": len(MECHANISMS), "said": {_METHOD: _said(order[0], odds)}
    }  # fmt: skip
    return mark_of(line, _METHOD)._replace(
        in_set=float(("+".join(truth) or BASELINE) in order[:size])
    )


def _said(lead: str, odds: Odds) -> dict[str, Any]:
    """What an answer comes to, in the words of a verdict."""
    verdict, names = "missing-physics", [lead.split("+")]
    if odds[lead] <= NAMED or lead == ANOTHER_PAIR:
        verdict, names = "undetermined", []
    elif lead in (BASELINE, OUTSIDE):
        verdict, names = {BASELINE: "adequate", OUTSIDE: OUTSIDE}[lead], []
    return {"verdict": verdict, "names": names, "odds": odds}


def scores(answers: Mapping[str, Odds], truths: Mapping[str, tuple[str, ...]]) -> list[Row]:
    """Return every score of a method.

    `answers`: probabilities by set and name; `truths`: names of what is concealed by set: none,
    one, two, or the one that stands for all outside.
    """
    table = np.array(marks(answers, truths))
    column = {name: table[:, k] for k, name in enumerate(Mark._fields)}
    null = np.array([not truth for truth in truths.values()])
    outside = np.array([truth == (OUTSIDE,) for truth in truths.values()])
    every = np.ones(len(null), dtype=bool)
    chosen: list[tuple[str, Array, Any]] = [
        ("mean ln p of the truth", column["ln_p"], every),
        ("Brier", column["brier"], every),
        ("truth in front", column["front"], every),
        ("named exactly", column["exact"], every),
        ("in the set", column["in_set"], every),
        ("nulls named", column["null_named"], null),
        ("outside named", column["forced"], outside),
        ("said less true", column["said"] - column["front"], every),
    ]
    return [
        Row(name, *mean_with_interval(values[of], draws_of(int(np.sum(of)))))
        for name, values, of in chosen
        if of.any()
    ]
