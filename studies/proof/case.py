"""One set of a run: its truth and what was said of it, opened after both were sealed."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import beta

from .same_meaning import comparable
from .seal import Ledger, check, sealed_twice


@dataclass(frozen=True)
class Case:
    """One set with its truth and what was said of it; `verdict` is empty after a failure."""

    name: str
    truth: dict[str, Any]
    verdict: dict[str, Any]
    event: dict[str, Any]

    @property
    def said(self) -> str:
        """The verdict's kind; a diagnosis that failed counts as undetermined."""
        return str(self.verdict.get("verdict", "undetermined"))

    @property
    def best(self) -> frozenset[str]:
        """Names of the best explanation, and of the numbers that it takes for wrong."""
        return frozenset((*self.verdict.get("mechanisms", ()), *self.wrong))

    @property
    def wrong(self) -> list[str]:
        """Keys of the numbers of the sheet that the best explanation takes for wrong."""
        return [str(one["key"]) for one in self.verdict.get("wrong_inputs", ())]

    @property
    def reported(self) -> list[frozenset[str]]:
        """Every explanation that is reported, the best first."""
        rest = [frozenset(names) for names in self.verdict.get("alternatives", ())]
        return ([self.best] if self.best else []) + [r for r in rest if r != self.best]

    @property
    def true(self) -> frozenset[str]:
        """Names of what is missing."""
        return frozenset(self.truth["mechanisms"])

    @property
    def named(self) -> bool:
        """Whether a mechanism is named."""
        return self.said in ("missing-physics", "indistinguishable") and bool(self.reported)

    @property
    def off(self) -> bool:
        """Whether the metal is some per cent off elastic-perfect plasticity."""
        return "metal" in self.truth

    @property
    def worse(self) -> bool:
        """Whether held-out conditions are predicted worse than by the baseline."""
        table = self.verdict.get("improvement") or {}
        base, more = table.get("log_density_baseline"), table.get("log_density_extended")
        return base is not None and more is not None and float(more) < float(base)

    @property
    def size(self) -> float:
        """Size of the smallest effect; NaN if it is not known."""
        return float(np.min(self.truth["sizes"])) if self.truth["sizes"] else math.nan


def open_run(run: Path) -> list[Case]:
    """Check the seals of every set that has a verdict, and read truth and verdict.

    Sets that two processes sealed are left out, and their truths stay closed; sealed again after
    it was opened, a set is a broken seal.

    Raises `SealBroken`: a seal does not hold; nothing is scored then.
    """
    ledger = Ledger(run / "ledger.jsonl")
    verdicts, opened = ledger.of("verdict"), ledger.of("opened")
    cases = []
    once = sorted(set(verdicts) - (sealed_twice(ledger) - set(opened)))
    for name in once:
        check(ledger, run, name)
    for name in once:
        if name not in opened:
            ledger.add(event="opened", set=name)
        event = verdicts[name]
        truth = json.loads((run / "truths" / f"{name}.json").read_text())
        path = run / "verdicts" / f"{name}.json"
        verdict = json.loads(path.read_text()) if event["verdict"] else {}
        cases.append(Case(name, truth, verdict, event))
    return cases


def interval(hits: int, of: int, *, level: float = 0.95) -> tuple[float, float]:
    """Binomial interval of Clopper and Pearson (Biometrika 26 (1934) 404).

    Examples
    --------
    >>> [round(x, 4) for x in interval(0, 10)]
    [0.0, 0.3085]
    """
    tail = 0.5 * (1.0 - level)
    low = 0.0 if hits == 0 else float(beta.ppf(tail, hits, of - hits + 1))
    high = 1.0 if hits == of else float(beta.ppf(1.0 - tail, hits + 1, of - hits))
    return low, high


def state_of(low: float, high: float, *, least: float, most: float = math.inf) -> str:
    """Return whether a mark is met, by its whole interval: `met`, `missed` or `not shown`.

    Examples
    --------
    >>> [state_of(low, 0.2, least=0.1) for low in (0.11, 0.05)], state_of(0.0, 0.05, least=0.1)
    (['met', 'not shown'], 'missed')
    """
    if low >= least and high <= most:
        return "met"
    return "missed" if high < least or low > most else "not shown"


def covered(case: Case) -> list[bool]:
    """Whether each parameter that means the same in both lies in its 90 % interval."""
    if case.best != case.true:
        return []
    found = []
    for effect in case.truth["effects"]:
        for name, value in comparable(effect).items():
            said = (case.verdict.get("parameters") or {}).get(name)
            if said:
                found.append(float(said["low"]) <= value <= float(said["high"]))
    return found
