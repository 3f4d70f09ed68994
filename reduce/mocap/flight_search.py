"""Free flights in the poses of a body: runs of frames that one motion describes."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array
from ..rules import RULES
from ..shared.regression import robust_std
from .flight import Flights, alone, fall_acceleration, fit_flights
from .motion import Prior, deviations
from .rigid import Poses


def find_flights(poses: Poses, gravity: Array, prior: Prior) -> Flights | None:
    """Return the flights of a recording, or None if there is none.

    `gravity` is the (3,) acceleration in flight [m/s²], `prior` that of the centre of mass.
    """
    spans = _spans(poses, gravity, prior)
    if not spans:
        return None
    sigma = float(np.median([alone(poses, s, gravity, prior)[1] for s in spans]))
    spans = _merged(poses, spans, gravity, prior, sigma)
    spans = [_grown(poses, s, spans, gravity, prior, sigma) for s in spans]
    spans = [s for s in spans if s[1] - s[0] >= 4 and _falls(poses, s, gravity, prior)]
    return fit_flights(poses, spans, gravity, prior) if spans else None


def _falls(poses: Poses, span: tuple[int, int], gravity: Array, prior: Prior) -> bool:
    """Whether a span's own acceleration is that of a fall, not of rest or of sliding."""
    own = fall_acceleration(poses, fit_flights(poses, [span], gravity, prior))
    g = float(np.linalg.norm(gravity))
    return abs(own.value - g) < max(4.0 * own.std, RULES.fall_off * g)


def _spans(poses: Poses, gravity: Array, prior: Prior) -> list[tuple[int, int]]:
    """Return runs of poses in which every window fits a free flight."""
    n = poses.time.size
    if n < RULES.window:
        return []
    usual = float(np.median(np.diff(poses.time)))
    rms = np.full(n - RULES.window + 1, np.inf)
    for k in range(rms.size):
        if poses.time[k + RULES.window - 1] - poses.time[k] < 2.0 * RULES.window * usual:
            rms[k] = alone(poses, (k, k + RULES.window - 1), gravity, prior)[1]
    # a body at rest fits worse than one in flight: the best windows tell the error of a marker
    limit = RULES.clean * max(1.2 * float(np.quantile(rms, 0.05)), _noise(poses))
    clean = rms < limit
    while True:
        edges = np.flatnonzero(np.diff(np.concatenate([[False], clean, [False]]).astype(int)))
        runs = edges.reshape(-1, 2)
        spans = [(int(a), int(b) + RULES.window - 2) for a, b in runs]
        # a contact that b can pass for within a window shows over the whole span
        hidden = [
            a + int(np.argmax(rms[a:b]))
            for (a, b), span in zip(runs, spans, strict=True)
            if rms[a:b].max() > RULES.stands_out * np.median(rms[a:b])
            and alone(poses, span, gravity, prior)[1] > RULES.broken * limit
        ]
        if not hidden:
            return spans
        clean[hidden] = False


def _noise(poses: Poses) -> float:
    """Return the error of a marker by fourth differences of the origin, which motion passes.

    0 where too few frames follow each other without a gap.
    """
    even = np.flatnonzero(poses.frame[4:] - poses.frame[:-4] == 4)
    if even.size < 2 * RULES.window:
        return 0.0
    fourth = np.diff(poses.origin, 4, axis=0)[even] / np.sqrt(70.0)
    spread = np.sqrt(np.mean([robust_std(c) ** 2 for c in fourth.T]))
    return float(spread * np.sqrt(poses.shape.shape[0]))


def _merged(
    poses: Poses, spans: list[tuple[int, int]], gravity: Array, prior: Prior, sigma: float
) -> list[tuple[int, int]]:
    """Join neighbours that are one flight: a bad frame broke it, not a contact."""
    result = [spans[0]]
    for span in spans[1:]:
        whole = (result[-1][0], span[1])
        index = np.arange(whole[0], whole[1] + 1)
        (motion, offset), _ = alone(poses, whole, gravity, prior)
        off = deviations(poses, index, motion, offset)
        if robust_std(off.ravel()) < 1.5 * sigma and np.quantile(np.abs(off), 0.9) < 4.0 * sigma:
            result[-1] = whole
        else:
            result.append(span)
    return result


def _grown(
    poses: Poses, span: tuple[int, int], spans: list[tuple[int, int]], gravity: Array,
    prior: Prior, sigma: float,
) -> tuple[int, int]:  # fmt: skip
    """Move both ends of a flight to where the first frame leaves it, less a margin of one."""
    first, last = span
    inner = 2 if last - first >= RULES.window + 3 else 0
    core = (first + inner, last - inner)
    (motion, offset), rms = alone(poses, core, gravity, prior)
    limit = RULES.doubtful * max(sigma, rms)

    def reach(start: int, step: int) -> int:
        k, end = start, start
        while 0 <= k < poses.time.size and abs(k - start) <= RULES.window + inner:
            off = deviations(poses, np.array([k]), motion, offset)
            if np.sqrt(np.mean(off**2)) > limit:
                return end - step
            end, k = k, k + step
        return end

    neighbours = [s for s in spans if s != span]
    low = max([s[1] for s in neighbours if s[1] < first], default=-1) - 1
    high = min([s[0] for s in neighbours if s[0] > last], default=poses.time.size) + 1
    start, stop = max(reach(core[0], -1), low, 0), min(reach(core[1], 1), high)
    return start, min(stop, poses.time.size - 1)
