"""What is proposed, and one session's worth of it: what each adds to the others, by the minute.

Greedy by gain over minutes, or the best one by itself where that is more (S. Khuller, A. Moss and
J. Naor, Inf. Process. Lett. 70 (1999) 39).
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...core.arrays import Indices
from ...core.unstated import unstated_equal
from ...recordings.bench import Bench
from ..rules import RULES
from .foreseen import Foreseen, discrimination, information

_TAKES = dict(RULES.minutes)


@unstated_equal
@dataclass(frozen=True, slots=True)
class Proposal:
    """What to do, how well it would discriminate, and what it would do to the interval.

    - `expected_discrimination`: D averaged over the rivals; 0 where there are none.
    - `kind`: `trial`, `press`, `build`, `noise`, `observable`, `hardness`, `weigh`, `calliper` or
      `none`.
    - `information`: nats by which the entropy of which rival is true is expected to fall.
    - `interval`: width of the leading parameter's interval over that of today; nan where not worked
      out.
    - `trial`: striker, speed [m/s] and angle [degrees] of a trial, mass [kg] and tip radius [m],
      repeats; of a press its load [N]; of a number of the sheet its key.
    - `observable`: what to measure as well, of a proposal of that kind.
    - `minutes`: how long it takes; nan where there is nothing to do.
    """

    change: str
    expected_discrimination: float
    kind: str = "trial"
    interval: float = math.nan
    trial: Mapping[str, str | float] = field(default_factory=dict)
    information: float = 0.0
    observable: str = ""
    minutes: float = math.nan

    @property
    def per_hour(self) -> float:
        """Information over the hours it takes [nat/h]; 0 where there is nothing to do."""
        return 60.0 * self.information / self.minutes if self.minutes > 0.0 else 0.0


class Option(NamedTuple):
    """What could be done, with its places among the cells that are foreseen."""

    cells: Indices
    proposal: Proposal


class Telling(NamedTuple):
    """What the most telling reading would mean.

    `step`: which of the session's steps reads it; `read`: observable, or the key of a number of the
    sheet; `expected`: explanation to the mean and standard deviation of it, as cells are compared.
    """

    step: int
    read: str
    expected: Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Session:
    """What to do in one session.

    - `steps`: in the order in which strikers are changed least.
    - `minutes`, `length`: how long they take, and a session is.
    - `information`: nats by which the entropy of which rival is true is expected to fall.
    - `entropy`: of today [nat].
    - `outcomes`: the most telling reading, and what it would mean.
    - `elsewhere`: where nothing is worth it: what another rig could do that is.
    """

    steps: tuple[Proposal, ...] = ()
    minutes: float = 0.0
    length: float = RULES.session
    information: float = 0.0
    entropy: float = 0.0
    outcomes: tuple[Telling, ...] = ()
    elsewhere: tuple[Proposal, ...] = field(default=())

    @property
    def goes_on(self) -> bool:
        """Whether a session is worth it."""
        return bool(self.information >= RULES.worth)


def takes(bench: Bench, what: str) -> float:
    """Return how many minutes something takes; nan where the rig cannot do it."""
    if bench.minutes is None:
        return float(_TAKES[what])
    stated = getattr(bench.minutes, what)
    if stated is None:
        return float(_TAKES[what]) if what in ("strike", "change") else math.nan
    return float(stated)


def chosen(
    count: int, gain: Callable[[Sequence[int]], float], cost: Callable[[Sequence[int]], float],
    *, budget: float,
) -> list[int]:  # fmt: skip
    """Return which of so many options are worth most together within a budget.

    `gain`, `cost`: of some of them together; `budget`: what they may cost.
    """
    single = [gain([k]) for k in range(count)]
    picked: list[int] = []
    known = 0.0
    # a gain falls as others are there: what was its most is looked at again only as it leads
    queue = [(-g / cost([k]), k, 0) for k, g in enumerate(single)]
    heapq.heapify(queue)
    while queue:
        _, k, seen = heapq.heappop(queue)
        more = cost([*picked, k]) - (cost(picked) if picked else 0.0)
        if cost([*picked, k]) > budget:
            continue
        if seen < len(picked):
            added = gain([*picked, k]) - known
            heapq.heappush(queue, (-added / more, k, len(picked)))
            continue
        value = gain([*picked, k])
        if value - known < RULES.worth_more:
            break
        picked, known = [*picked, k], value
    fits = [k for k in range(count) if cost([k]) <= budget]
    best = max(fits, key=lambda k: single[k], default=None)
    return [best] if best is not None and single[best] > known else picked


def session_of(
    bench: Bench, options: Sequence[Option], seen: Sequence[Foreseen],
    rivals: Mapping[str, float], reads: Sequence[str],
) -> Session:  # fmt: skip
    """Return the session that is expected to tell most.

    - `bench`: what the rig can do.
    - `options`: what could be done with it.
    - `seen`: what all cells would show under each rival.
    - `rivals`: explanation to its probability.
    - `reads`: observable or key of each cell.
    """
    weight = np.array(list(rivals.values()))
    # a verdict is sure by so much too much: what leads is tested too
    doubted = (1.0 - RULES.doubt) * weight / max(weight.sum(), 1e-12) + RULES.doubt / len(weight)
    change, budget = takes(bench, "change"), bench.session_minutes or RULES.session

    def cells(some: Sequence[int]) -> Indices:
        return np.concatenate([options[k].cells for k in some])

    def gain(some: Sequence[int]) -> float:
        return information([s.of(cells(some)) for s in seen], doubted.tolist())

    def cost(some: Sequence[int]) -> float:
        strikers = {options[k].proposal.trial.get("striker", "") for k in some} - {""}
        work = sum(options[k].proposal.minutes for k in some)
        return work + change * max(len(strikers) - 1, 0)

    share = weight[weight > 0.0] / max(weight.sum(), 1e-12)
    entropy = -float(np.sum(share * np.log(share)))
    some = chosen(len(options), gain, cost, budget=budget) if len(options) else []
    if not some:
        return Session(length=budget, entropy=entropy)
    some.sort(key=lambda k: (str(options[k].proposal.trial.get("striker", "")), k))
    places = [(n, int(i)) for n, k in enumerate(some) for i in options[k].cells]
    alone = [discrimination([s.of(np.array([i])) for s in seen], doubted.tolist())
             for _, i in places]  # fmt: skip
    step, i = places[int(np.argmax(alone))]
    expected = {
        name: (float(s.mean[i]), math.sqrt(float(s.covariance[i, i])))
        for name, s in zip(rivals, seen, strict=True)
    }
    return Session(
        tuple(options[k].proposal for k in some), cost(some), budget,
        information([s.of(cells(some)) for s in seen], weight.tolist()), entropy,
        (Telling(step, reads[i], expected),),
    )  # fmt: skip
