"""Which of many recorded instants belong to one bouncing ball.

Intervals between contacts shrink by a nearly steady factor. Echoes and knocks add instants, quiet
bounces are missed; the chain is the longest run of instants whose intervals agree with one factor,
one missed bounce at a time allowed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ...core.tables import counted
from ..rules import RULES
from ..shared.regression import robust_regression, robust_std

# limit: part of an interval by which bounces of one ball stray from a course [-]
_UNEVEN = 0.01

# limit: flights beyond the coefficients of a course above a parabola at least [-]
_FREE = 4

# limit: part of a course's cross-validated error that one more bend has to leave at most [-]; of
# six flights that scatter one in fifty does
_WON = 0.25

# limit: instants that runs are looked for among [-]: their pairs' work
_INSTANTS_TRIED = 80

_FACTORS = np.exp(np.arange(math.log(0.1), 0.0, 0.08))


@dataclass(frozen=True)
class Chain:
    """Instants of one run: `times` (n,) [s], and the indices of those that belong to it, (k,).

    `single` says whether the gap after each but the last is one flight that can be used (not two
    with a missed contact between, nor one that strays), `missed` whether it is two; `factor` is the
    typical ratio of an interval to the one before; `notes` tell what was left out.
    """

    times: Array
    kept: tuple[int, ...]
    single: tuple[bool, ...]
    missed: tuple[bool, ...]
    factor: float
    notes: tuple[str, ...]

    @property
    def free(self) -> int:
        """Flights beyond those that a smooth course takes."""
        return sum(self.single) - self._course[1]

    def scatter(self) -> float:
        """Return the standard deviation of an instant by the roughness of the intervals [s].

        Each rest about the smooth course is the error of two instants. NaN for fewer than three
        flights.
        """
        if self.free < 1:
            return math.nan
        rest = self._course[0][np.array(self.single)]
        if self.free < 4:  # half of three rests may be none by luck
            return math.sqrt(float(rest @ rest) / self.free / 2.0)
        return robust_std(rest, lost=self._course[1]) / math.sqrt(2.0)

    @property
    def _course(self) -> tuple[Array, int]:
        return _course(self.times, self.kept, self.single, self.missed)

    def by_luck(self, count: int) -> float:
        """Return how many such runs are expected by chance among as many instants.

        Each interval beyond the two that tell a factor lies within two of the usual rests, to both
        sides, of where it should, of intervals over a range of e.
        """
        flights = np.diff(self.times[list(self.kept)])[np.array(self.single)]
        if flights.size < 3:
            return float(len(self.kept) < count)
        rest = math.sqrt(2.0 / float(np.mean(flights**2))) * self.scatter()
        runs = math.comb(count, len(self.kept))
        return float(runs * min(4.0 * rest, 1.0) ** (flights.size - 2))

    def shrinks(self, std: Array) -> bool:
        """Whether the last flight is shorter than the first beyond the instants' errors (n,) [s].

        Taps and clocks keep their time; of two flights nothing more is known.
        """
        flights = np.flatnonzero(self.single)
        first, last = ([self.kept[k], self.kept[k + 1]] for k in (flights[0], flights[-1]))
        change = np.ptp(self.times[first]) - np.ptp(self.times[last])
        error = float(np.linalg.norm(np.nan_to_num(std[[*first, *last]])))
        return bool(change > RULES.by_chance * error)


def _course(
    times: Array, kept: Sequence[int], single: Sequence[bool], missed: Sequence[bool]
) -> tuple[Array, int]:
    """Intervals less their smooth course, (k - 1,) [s], and its number of coefficients.

    The logarithms of the intervals follow a parabola in the number of the bounce; of fewer than six
    flights a line, for one restitution. Drag and a restitution that follows the speed bend them
    more: a higher degree counts where generalised cross-validation wins much by it, for a ball's
    bounces scatter, too. Zeros for fewer than three flights.
    """
    gaps = np.diff(times[list(kept)])
    use = np.array(single)
    n = int(use.sum())
    if n < 3:
        return np.zeros_like(gaps), 2
    number = np.arange(gaps.size) + np.cumsum(missed) - 0.5 * gaps.size
    weight = gaps[use] / gaps[use].max()  # an error in seconds weighs less in a long interval
    best, course = math.inf, (np.zeros_like(gaps), 2)
    for terms in range(3 if n >= 6 else 2, min(max(n - _FREE, 3), max(n - 2, 2)) + 1):
        design = np.vander(number / gaps.size, terms)
        fit = robust_regression(design[use] * weight[:, None], np.log(gaps[use]) * weight)
        rest = np.asarray(gaps - np.exp(design @ fit.coefficients))
        score = float(np.linalg.norm(rest[use])) / (n - terms)
        if score < _WON * best:
            best, course = score, (rest, terms)
    return course


def chain_of(times: Array) -> Chain | None:
    """Return the longest run of bounces in the first 80 of rising instants (n,) [s], or None."""
    used = np.asarray(times[:_INSTANTS_TRIED], dtype=np.float64)
    if used.size < 3:
        return None
    found = max((_longest(used, factor) for factor in _FACTORS), key=lambda c: c[0])
    for _ in range(3):
        again = _longest(used, _typical(used, found))
        if again[0] <= found[0]:
            break
        found = again
    _, kept, single = found
    if len(kept) < 3:
        return None
    extra = sum(kept[0] < i < kept[-1] for i in set(range(used.size)) - set(kept))
    outside = times.size - len(kept) - extra
    missed = tuple(not one for one in single)
    single, stray = _without_strays(used, kept, single)
    gaps = dict(zip(kept, missed, strict=False))
    kept, single, ends = _without_false_ends(used, kept, single)
    told = (
        (extra, "instant", "left out as echoes or knocks: {} between bounces"),
        (outside, "instant", "left out: {} before or after the run"),
        (sum(missed), "bounce", "not recorded: {}; neighbours left out"),
        (stray, "interval", "left out, off the course of the others: {}"),
        (ends, "instant", "left out, off the course of the run: {} at its ends"),
    )
    notes = tuple(text.format(counted(count, what)) for count, what, text in told if count)
    missed = tuple(gaps[k] for k in kept[:-1])
    run = Chain(np.asarray(times), kept, single, missed, _typical(used, found), notes)
    # taps, steps: among as many instants some hang together
    return None if run.by_luck(used.size) > 0.5 else run


def _without_false_ends(
    times: Array, kept: tuple[int, ...], single: tuple[bool, ...]
) -> tuple[tuple[int, ...], tuple[bool, ...], int]:
    """Give up a first or last instant that is a knock: its flight is too long or too short."""
    before = len(kept)
    for way in (-1, 1):
        while len(kept) > 4 and all(single[::way][:3]):
            flights = np.abs(np.diff(times[list(kept)]))[::way][:3]
            own, next_to_it = np.diff(np.log(flights))
            if abs(own - next_to_it) <= RULES.sudden:
                break
            kept, single = (kept[:-1], single[:-1]) if way < 0 else (kept[1:], single[1:])
    return kept, single, before - len(kept)


def _without_strays(
    times: Array, kept: tuple[int, ...], single: tuple[bool, ...]
) -> tuple[tuple[bool, ...], int]:
    """Give up flights that a knock in place of a bounce has shortened or lengthened."""
    rest, terms = _course(times, kept, single, [not one for one in single])
    if sum(single) < 6:
        return single, 0
    rounding = 1e-9 * float(np.ptp(times[list(kept)]))  # of instants without any scatter
    limit = np.maximum(
        max(RULES.stray * robust_std(rest[np.array(single)], lost=terms), rounding),
        _UNEVEN * np.diff(times[list(kept)]),
    )
    kept_ones = tuple(map(bool, np.array(single) & (np.abs(rest) <= limit)))
    return kept_ones, sum(single) - sum(kept_ones)


_Run = tuple[float, tuple[int, ...], tuple[bool, ...]]


def _typical(times: Array, run: _Run) -> float:
    """Return the median factor from a gap to the next; a gap of two flights f, f² tells it too.

    One wrong end moves one factor of many: so the run with the echo of a bounce in its place does
    not confirm itself.
    """
    _, kept, single = run
    gaps = np.diff(times[list(kept)])
    factors = []
    for ratio, one, next_one in zip(gaps[1:] / gaps[:-1], single, single[1:], strict=False):
        if one == next_one:
            factors.append(ratio if one else math.sqrt(ratio))
        elif one:  # ratio = f + f²
            factors.append(0.5 * (math.sqrt(1.0 + 4.0 * ratio) - 1.0))
        else:  # ratio = f²/(1 + f)
            factors.append(0.5 * (ratio + math.sqrt(ratio * (ratio + 4.0))))
    return min(float(np.median(factors)), 0.999) if factors else 0.5


def _longest(times: Array, factor: float) -> _Run:
    """Score and members of the best run for one factor.

    `score[i, j, m]` is that of the best run that ends with the gap from i to j, holding one flight
    (m = 0) or two (m = 1); a run grows where the next gap begins as the factor says.
    """
    n = times.size
    gap = times[None, :] - times[:, None]
    first = np.stack([gap, gap / (1.0 + factor)], axis=2)  # first flight within the gap
    last = np.stack([gap, gap * factor / (1.0 + factor)], axis=2)
    cost = np.array([0.0, RULES.missed_bounce])
    score = np.full((n, n, 2), -np.inf)
    back: dict[tuple[int, int, int], tuple[int, int]] = {}
    rows, columns = np.triu_indices(n, 1)
    score[rows, columns] = 2.0 - cost
    with np.errstate(divide="ignore", invalid="ignore"):
        log_first, log_last = np.log(first), np.log(last)
    step = math.log(factor)
    for j in range(1, n - 1):
        incoming = log_last[:j, j] + step  # (j, 2)
        for k in range(j + 1, n):
            for m in (0, 1):
                off = np.abs(log_first[j, k, m] - incoming)
                # a small price for disorder picks the smoother of two runs of one length
                gain = np.where(off <= RULES.chain_off, score[:j, j] - 0.5 * off, -np.inf)
                best = int(np.argmax(gain))
                value = float(gain.flat[best]) + 1.0 - cost[m]
                if value > score[j, k, m]:
                    score[j, k, m] = value
                    back[j, k, m] = (best // 2, best % 2)
    j, k, m = (int(v) for v in np.unravel_index(int(np.argmax(score)), score.shape))
    kept, single, total = [k, j], [m == 0], float(score[j, k, m])
    while (j, k, m) in back:
        i, m = back[j, k, m]
        j, k = i, j
        kept.append(i)
        single.append(m == 0)
    return total, tuple(reversed(kept)), tuple(reversed(single))
