"""A recording set's own pair by finite elements, kept for the next time that it is asked for."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace

import numpy as np

from ...core.compiled import cache_folder
from ...core.errors import InputError
from ...core.material import Pair
from ...core.rules import RULES as CORE
from ...models.table import PairTable
from ...models.table_file import read_table, write_table
from ..rules import RULES

# limit: digits of a depth [-]: sets of one pair that go as deep share a solve
_SOLVE_DIGITS = 2

# limit: part of a solve between two lines of progress [-]: five lines a solve
_TOLD_OF_SOLVE = 0.2

_SOLVING = "solving the set's own pair by finite elements, kept for the next time"


def solved_pair(
    name: str, pair: Pair, depths: Sequence[float], progress: Callable[[str], None]
) -> tuple[PairTable | None, tuple[str, ...]]:
    """Return the table of a pair, and why there is none where it could not be made.

    - `name`: of the set, for the notes.
    - `pair`: the bodies, with their flow curves; the radius does not matter.
    - `depths`: Delta/R of the peaks of the impacts.
    """
    low, high = (_rounded(d, math.ceil) for d in (min(depths), max(depths)))
    path = cache_folder("pairs") / f"{_digest(pair, low, high)}.json"
    if path.exists():
        try:
            return replace(read_table(path).tables[0], pair=pair), ()
        except InputError:  # cut short or of an older form: made again
            path.unlink()
    progress(_SOLVING)
    try:
        table = solved_table(pair, low, high, progress=progress)
    except InputError as error:
        return None, (f"the pair of {name} was not solved by finite elements: {error}",)
    write_table(table, path)
    return table, ()


def solved_table(
    pair: Pair, low: float, high: float, *, progress: Callable[[str], None] = lambda _: None
) -> PairTable:
    """Solve a pair for impacts whose peaks reach Delta/R from `low` to `high`.

    At `quick`: what `production` has more of is in the radius.

    Raises `InputError`: it hardly yields there, or the solve does not reach that far.
    """
    # loaded when there is something to solve: most diagnoses need none of it
    from ... import fem
    from ...fitting.case_table import pair_table

    onset = pair.first_yield
    last = min(RULES.solve_deeper * high, CORE.deepest)
    if last < 2.0 * onset:
        raise InputError(f"Delta/R to {last:.2g}", key="depth",
                         allowed=f"well beyond first yield at {onset:.2g}")  # fmt: skip
    first = min(0.3 * onset, 1e-2 * last)
    shallowest = max(min(low, 0.3 * high), 1.3 * onset)
    turns = tuple(map(float, np.geomspace(shallowest, last, RULES.solve_turns)))
    problem = fem.ContactProblem(
        pair=pair, depths=fem.geometric_depths(first, last, RULES.solve_depths), unload_from=turns
    )
    accuracy = fem.Accuracy.quick()
    told = 0.0

    def tell(done: float) -> None:
        nonlocal told
        if done >= told + _TOLD_OF_SOLVE:
            told = done
            progress(f"{_SOLVING}: {done:.0%}")

    solution = fem.solve(problem, accuracy=accuracy, progress=tell)
    reached = solution.loading.delta[-1] / pair.R if len(solution.loading.delta) else 0.0
    if reached < high:
        raise InputError(str(solution.outcome), key="law", allowed="a pair that can be solved")
    return pair_table(solution, fem.discretisation_uncertainty(solution.loading, problem, accuracy))


def _rounded(x: float, way: Callable[[float], int]) -> float:
    unit = 10.0 ** (math.floor(math.log10(x)) - _SOLVE_DIGITS + 1)
    return float(way(x / unit) * unit)


def _digest(pair: Pair, low: float, high: float) -> str:
    from ...fem.problem import NUMERICS_VERSION

    bodies = [
        {"E": b.E, "nu": b.nu, "Sy": b.Sy, "flow": b.flow and asdict(b.flow)}
        for b in (pair.sphere, pair.flat)
    ]
    told = json.dumps(
        [NUMERICS_VERSION, "quick", RULES.solve_turns, RULES.solve_depths, low, high, bodies],
        sort_keys=True,
    )
    return hashlib.sha256(told.encode()).hexdigest()[:24]
