"""Whether truths drawn from the priors lie anywhere in their posteriors, each place as often."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import binomtest, kstest

from ...core.arrays import Array

RANKS = Path(__file__).resolve().parents[2] / "data" / "proof" / "ranks.jsonl"
"""A line for each draw, made by `studies.calibration`."""
_LEVEL = 0.01


class Uniform(NamedTuple):
    """Whether shares of a posterior below the truth are uniform.

    `inside` is the part within the central 90 %; `p` the lesser of Kolmogorov and Smirnov's test,
    which is deaf at the ends, and of the binomial one of `inside`; `corrected` the same for the
    number of all tests by Holm (Scand. J. Stat. 6 (1979) 65).
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
    found: list[tuple[str, str, int, float]] = []
    tests: list[tuple[float, float]] = []
    for name in dict.fromkeys(x["mechanism"] for x in lines):
        here = [x["shares"] for x in lines if x["mechanism"] == name]
        for label in here[0]:
            shares = np.array([x[label] for x in here])
            inside = int(np.sum(np.abs(shares - 0.5) < 0.45))
            ends = float(binomtest(inside, len(shares), 0.9).pvalue)
            tests.append((float(kstest(shares, "uniform").pvalue), ends))
            found.append((name, label, len(shares), inside / len(shares)))
    p = np.reshape(tests, (-1, 2))
    corrected = holm(p.ravel()).reshape(-1, 2)
    return [
        Uniform(*row, float(one.min()), float(all_.min()))
        for row, one, all_ in zip(found, p, corrected, strict=True)
    ]


def holm(p: Array) -> Array:
    """Return p values corrected for their number by Holm's steps.

    Examples
    --------
    >>> holm(np.array([0.01, 0.04, 0.03])).tolist()
    [0.03, 0.06, 0.06]
    """
    order = np.argsort(p)
    found = np.empty(len(p))
    found[order] = np.maximum.accumulate(np.sort(p) * np.arange(len(p), 0, -1))
    return np.minimum(found, 1.0)


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
        "number in the central 90 %, at 1 % after Holm's correction); in the mean the central 90 % "
        f"hold {np.mean([r.inside for r in rows]):.2f}. What fails, with the part that they hold "
        f"(intervals in a verdict are as much too narrow): {told}.", "",
    ]  # fmt: skip
