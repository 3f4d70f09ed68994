"""Where checks are run: how much effort, and the solves that they share, kept between runs."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path

import numpy as np

from ... import fem
from ...campaigns import Case, CaseRecord, Store
from ...campaigns.records import UnloadingRecord
from ...core.arrays import Array
from ...core.material import Material, Pair
from .result import Result


class Effort(Enum):
    """How finely the long checks solve; the cheap ones do the same at both."""

    QUICK = "quick"
    PRODUCTION = "production"


@dataclass(frozen=True)
class Solved:
    """The part of a stored solve that checks read; `message` is empty where it was completed."""

    pair: Pair
    curve: dict[str, Array]
    unloadings: tuple[UnloadingRecord, ...] = ()
    counters: dict[str, float] = field(default_factory=dict)
    message: str = ""

    @classmethod
    def of(cls, record: CaseRecord) -> Solved:
        """Return that part of a case."""
        pair, left = record.case.pair, record.unloadings
        return cls(pair, record.curve, left, record.counters, record.message)

    def __getitem__(self, name: str) -> Array:
        """Column of the loading curve by its name in `fem.Curve`."""
        return self.curve[name]

    @property
    def share(self) -> Array:
        """delta_s* along the loading curve."""
        return np.asarray(self["sphere"] / (self["sphere"] + self["flat"]))


@dataclass
class Bench:
    """What a check is given to work with.

    `folder`: where results and solves are kept; `effort`: how finely to solve; `say`: called with a
    line of progress; `publish`: called by a long check with what it has so far.
    """

    folder: Path
    effort: Effort = Effort.PRODUCTION
    say: Callable[[str], None] = lambda line: None
    publish: Callable[[Result], None] = lambda result: None
    reused_cpu_s: float = field(default=0.0, init=False)
    _warm: bool = field(default=False, init=False)

    def solve(self, case: Case) -> Solved:
        """Solve a case, or read it if the same numerics have solved it before."""
        if case.id in self._store.statuses():
            found = Solved.of(self._store.read(case.id))
            self.reused_cpu_s += found.counters["cpu_s"]
            return found
        self._warm_up()
        self.say(f"  solving {case.name} at level {case.accuracy.level}")
        started = time.perf_counter()
        solution = fem.solve(case.problem, accuracy=case.accuracy)
        self._store.put(case, solution)
        self.say(
            f"    {solution.outcome} {solution.counters.cpu_s:.0f} processor seconds, "
            f"{time.perf_counter() - started:.0f} s"
        )
        return Solved.of(self._store.read(case.id))

    def kept_solves(self) -> Iterator[tuple[Case, Solved]]:
        """Every solve of the present numerics that is kept."""
        for record in self._store.read_all():
            if record.id == record.case.id:
                yield record.case, Solved.of(record)

    @property
    def _store(self) -> Store:
        return Store(self.folder / "solves")

    def _warm_up(self) -> None:
        """Let the compiled code be loaded, so that no timed solve pays for it."""
        if not self._warm:
            body = Material(E=200e9, nu=0.3, Sy=200e6)
            problem = fem.ContactProblem(Pair(body, body, 1e-3), (1e-5, 3e-5), unload_from=(3e-5,))
            fem.solve(problem, accuracy=fem.Accuracy.smoke())
            self._warm = True
