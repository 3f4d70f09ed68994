"""Whether truths drawn from the priors lie anywhere in their posteriors, each place as often."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import binomtest, kstest

RANKS = Path(__file__).resolve().parents[2] / "data" / "proof" / "ranks.jsonl"
"""A line for each draw, made by `studies.calibration`."""
AT_DATA = RANKS.with_name("ranks-at-data.jsonl")
"""The same of draws from the posterior at shipped sets, made by `studies.at_data`."""
_LEVEL = 0.01


class Uniform(NamedTuple):
    """Whether shares of a posterior below the truth are uniform.

    `inside` is the part within the central 90 %; `p` the lesser of Kolmogorov and Smirnov's test,
    which is deaf at the ends, and of the binomial one of `inside`; `corrected` the same times the
    number of all tests (Bonferroni).
    """

    mechanism: str
    parameter: str
    draws: int
    inside: float
    p: float
    corrected: float


def read_ranks(path: Path = RANKS) -> list[dict[str, Any]]:
    """Return what is kept of each draw; nothing where the file is missing."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    return [json.loads(line) for line in text.splitlines()]


def uniformity(lines: Sequence[dict[str, Any]]) -> list[Uniform]:
    """Test each mechanism's parameters, and the stated strength."""
    found: list[tuple[tuple[str, str, int, float], float]] = []
    for name in dict.fromkeys(x["mechanism"] for x in lines):
        here = [x["shares"] for x in lines if x["mechanism"] == name]
        for label in here[0]:
            shares = np.array([x[label] for x in here])
            inside = int(np.sum(np.abs(shares - 0.5) < 0.45))
            ends = binomtest(inside, len(shares), 0.9).pvalue
            p = min(float(kstest(shares, "uniform").pvalue), float(ends))
            found.append(((name, label, len(shares), inside / len(shares)), p))
    count = 2 * len(found)
    return [Uniform(*row, p, min(p * count, 1.0)) for row, p in found]


def rank_lines(lines: Sequence[dict[str, Any]]) -> list[str]:
    """The section of the page; empty where nothing was drawn."""
    rows = uniformity(lines)
    if not rows:
        return []
    rejected = [r for r in rows if r.corrected < _LEVEL]
    told = (
        ", ".join(f"`{r.parameter}` of {r.mechanism} ({r.inside:.2f})" for r in rejected) or "none"
    )
    return [
        "## Where truths lie in their posteriors", "",
        f"{len(lines)} draws from the priors, simulated on benches of the "
        "[challenge](challenge.md) and fitted as a diagnosis fits them (`python -m "
        "dentscope.studies.calibration`; Talts and others, arXiv:1804.06788): the share of a "
        "posterior below the truth ought to be uniform. Of "
        f"{len(rows)} parameters {len(rows) - len(rejected)} pass (Kolmogorov and Smirnov, and the "
        "number in the central 90 %, at 1 % after Bonferroni's correction); in the mean the "
        f"central 90 % hold {np.mean([r.inside for r in rows]):.2f}. What fails, with the part "
        f"that they hold (intervals in a verdict are as much too narrow): {told}.", "",
    ]  # fmt: skip


def at_data_lines(lines: Sequence[dict[str, Any]]) -> list[str]:
    """What follows it: the same at recordings; empty where nothing was drawn."""
    rows = uniformity(lines)
    if not rows:
        return []
    sets = {x["mechanism"]: x["set"] for x in lines}
    held = [
        f"{place} ({name.replace('+', ', ')}) "
        + ", ".join(
            f"`{r.parameter}` {r.inside:.2f}{'*' if r.corrected < _LEVEL else ''}"
            for r in rows
            if r.mechanism == name
        )
        for name, place in sets.items()
    ]
    draws = sorted({r.draws for r in rows})
    return [
        f"At the data in hand: {' to '.join(map(str, draws))} draws from the posterior of what "
        f"leads at {len(sets)} shipped sets, recordings made from each, fitted together with those "
        "measured (`python -m dentscope.studies.at_data`; Säilynoja and others, arXiv:2502.03279). "
        f"The central 90 % hold, * where uniformity is rejected: {'; '.join(held)}.", "",
    ]  # fmt: skip
