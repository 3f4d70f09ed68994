"""Where checks are run: how much effort, and the solves that they share, kept between runs."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

from ... import fem
from ...campaigns.case import Case
from ...campaigns.schema import CURVE
from ...core.arrays import Array
from ...core.material import Material, Pair
from ...core.output import write_file
from .result import Result


class Effort(Enum):
    """How finely the long checks solve; the cheap ones do the same at both."""

    QUICK = "quick"
    PRODUCTION = "production"


@dataclass(frozen=True)
class Branch:
    """Curves of one branch in SI units, each of shape (n,), and what was left after unloading."""

    curve: dict[str, Array]
    depth: float = 0.0
    residual_sphere: float = 0.0
    residual_flat: float = 0.0
    steps: int = 0
    completed: bool = True


@dataclass(frozen=True)
class Solved:
    """The kept part of a solve: curves, counters and how it ended (no fields)."""

    pair: Pair
    loading: Branch
    unloadings: tuple[Branch, ...]
    counters: dict[str, float]
    completed: bool
    message: str

    def __getitem__(self, name: str) -> Array:
        """Column of the loading curve by its name in `fem.Curve`."""
        return self.loading.curve[name]

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
        path = self.folder / "solves" / f"{case.id[:24]}.json"
        if path.exists():
            raw = json.loads(path.read_text(encoding="utf-8"))
            self.reused_cpu_s += raw["counters"]["cpu_s"]
            return _solved(case.pair, raw)
        self._warm_up()
        self.say(f"  solving {case.name} at level {case.accuracy.level}")
        started = time.perf_counter()
        raw = _kept(fem.solve(case.problem, accuracy=case.accuracy))
        raw["case"] = case.specification()
        write_file(path, json.dumps(raw))
        self.say(
            f"    {raw['message']} {raw['counters']['cpu_s']:.0f} processor seconds, "
            f"{time.perf_counter() - started:.0f} s"
        )
        return _solved(case.pair, raw)

    def kept_solves(self) -> Iterator[tuple[Case, Solved]]:
        """Every solve of the present numerics that is kept."""
        for path in sorted((self.folder / "solves").glob("*.json")):
            raw = json.loads(path.read_text(encoding="utf-8"))
            case = Case.from_specification(raw["case"])
            if path.stem == case.id[:24]:
                yield case, _solved(case.pair, raw)

    def _warm_up(self) -> None:
        """Let the compiled code be loaded, so that no timed solve pays for it."""
        if not self._warm:
            body = Material(E=200e9, nu=0.3, Sy=200e6)
            problem = fem.ContactProblem(Pair(body, body, 1e-3), (1e-5, 3e-5), unload_from=(3e-5,))
            fem.solve(problem, accuracy=fem.Accuracy.smoke())
            self._warm = True


def _kept(solution: fem.Solution) -> dict[str, Any]:
    return {
        "loading": {"curve": _columns(solution.loading)},
        "unloadings": [
            {
                "curve": _columns(u.curve),
                "depth": u.depth,
                "residual_sphere": u.residual_sphere,
                "residual_flat": u.residual_flat,
                "steps": u.steps,
                "completed": u.outcome.completed,
            }
            for u in solution.unloadings
        ],
        "counters": {
            name: getattr(solution.counters, name) for name in fem.Counters.__dataclass_fields__
        },
        "completed": solution.outcome.completed,
        "message": str(solution.outcome),
    }


def _columns(curve: fem.Curve) -> dict[str, list[float | None]]:
    return {
        name: [None if np.isnan(x) else float(x) for x in getattr(curve, name)] for name in CURVE
    }


def _solved(pair: Pair, raw: dict[str, Any]) -> Solved:
    return Solved(
        pair=pair,
        loading=_branch(raw["loading"]),
        unloadings=tuple(_branch(u) for u in raw["unloadings"]),
        counters=raw["counters"],
        completed=raw["completed"],
        message=raw["message"],
    )


def _branch(raw: dict[str, Any]) -> Branch:
    curve = {name: np.array(values, dtype=float) for name, values in raw["curve"].items()}
    return Branch(**{**raw, "curve": curve})
