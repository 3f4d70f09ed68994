"""Running a design: what is missing is computed, what ends is stored at once."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from .case import Case
from .designs import Design, distinct_cases
from .executor import Ended, Executor
from .store import Store


@dataclass(frozen=True)
class Status:
    """Counts of a design's cases in a store; done + failed + missing = designed."""

    designed: int
    done: int
    failed: int

    @property
    def missing(self) -> int:
        """Cases that have not ended."""
        return self.designed - self.done - self.failed


@dataclass(frozen=True)
class Step:
    """One case that ended, for whoever shows the progress."""

    case: Case
    done: bool
    message: str
    cpu_s: float
    status: Status


def status_of(design: Design, store: Store) -> Status:
    """Count a design's cases in a store."""
    return _counts(distinct_cases(design), store.statuses())


@dataclass(frozen=True)
class Share:
    """What one of several runs of a sweep computes: every `of`-th case, from `part` = 1 on."""

    part: int = 1
    of: int = 1


def cases_to_do(
    design: Design,
    store: Store,
    *,
    again: frozenset[str] = frozenset(),
    share: Share = Share(),
) -> dict[str, Case]:
    """Cases that a run would compute, in its order, by their id.

    Those with a status in `again` are computed again: a case that failed is tried with smaller
    steps and elements; its identity stays. `share` is this run's, where several share the design.
    """
    stored = store.statuses()
    mine = list(distinct_cases(design).items())[share.part - 1 :: share.of]
    return {
        key: case.refined() if key in stored else case
        for key, case in mine
        if key not in stored or stored[key] in again
    }


def run_design(
    design: Design,
    folder: Path,
    *,
    executor: Executor,
    time_limit_s: float,
    again: frozenset[str] = frozenset(),
    share: Share = Share(),
    until: float = math.inf,
    report: Callable[[Step], None] | None = None,
) -> Status:
    """Compute what a design lacks in a run's folder; several may do so at once.

    The folder is made if needed; `again` and `share` are those of `cases_to_do`. One case may take
    `time_limit_s` of the clock; after `until`, of `time.monotonic()`, no further result is waited
    for. `report` is called after each case. A case that cannot be written is refused; all completed
    cases are kept.
    """
    store = Store(folder)
    cases = distinct_cases(design)
    todo = cases_to_do(design, store, again=again, share=share)
    stored = store.statuses()
    with closing(executor.run(todo, time_limit_s=time_limit_s)) as endings:
        for ended in endings:
            case, solution = cases[ended.id], ended.solution
            store.put(case, solution, message=ended.message, computed_by=ended.computed_by)
            stored[ended.id] = "done" if ended.done else "failed"
            if report is not None:
                report(_step(case, ended, _counts(cases, stored)))
            if time.monotonic() > until:
                break
    return status_of(design, store)


def _step(case: Case, ended: Ended, status: Status) -> Step:
    solution = ended.solution
    if solution is None:
        return Step(case, False, ended.message, 0.0, status)
    message = "" if ended.done else str(solution.outcome)
    return Step(case, ended.done, message, solution.counters.cpu_s, status)


def _counts(cases: Mapping[str, Case], stored: Mapping[str, str]) -> Status:
    found = [stored[key] for key in cases if key in stored]
    return Status(len(cases), found.count("done"), found.count("failed"))
