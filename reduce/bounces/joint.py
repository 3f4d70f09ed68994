"""All flights of a track fitted together: a launch each, and one view that they share.

How much the scale drifts is not known beforehand. Its parameters have a normal prior of width s;
the fit is made for several s, and each counts as much as the track makes it likely (the evidence
of a linear model with normal errors; MacKay, Information Theory, 2003, ch. 28).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array, Mask
from ..measured import Measured
from ..rules import RULES
from ..shared.regression import long_run_factor, robust_std
from .flights import Piece
from .track import Track
from .view import Launch, Stage, View

SHARED = len(View._fields)


@dataclass(frozen=True)
class Before:
    """What is known of fall and drag [unit/s², 1/unit] before the track is looked at.

    `bends` and `grows` are the drift of the scale with height and with time that is possible, in
    that of a body that rises by 0.1 m or is seen for a second: over a path of a few millimetres
    that lasts milliseconds neither perspective nor a body that comes nearer changes the scale much.
    """

    fall: Measured
    drag: Measured
    bends: float = 1.0
    grows: float = 1.0


@dataclass(frozen=True)
class JointSolution:
    """One fit: shared unknowns and launches in a row, their covariance, its share of belief."""

    x: Array
    covariance: Array
    weight: float

    @property
    def view(self) -> View:
        """The shared unknowns."""
        return View(*(float(v) for v in self.x[:SHARED]))

    def launch(self, piece: int) -> Launch:
        """Return the launch of a piece."""
        k = SHARED + 2 * piece
        return Launch(float(self.x[k]), float(self.x[k + 1]))


def fit_together(
    track: Track, pieces: Sequence[Piece], stage: Stage, view: View, before: Before
) -> tuple[list[Piece], list[JointSolution]]:
    """Fit all pieces with one view, beginning with `view` and what is known of fall and drag.

    Returns the pieces without their strays and with the spread of a sample, and the fits, the
    weights of which add up to one, the likeliest first.
    """
    pieces = list(pieces)
    x = np.concatenate([view, *(p.launch for p in pieces)])
    for _ in range(3):
        x, _, _, _ = _settled(track, pieces, stage, x, before, RULES.scale_widths[1][0])
        pieces = _cleaned(track, pieces, stage, x)
    found = []
    # a path that cannot tell, as the straight one of a fast rod, pays for a usual drift in its
    # speeds; a rare one must show, else it alone would make the error of one that does not tell
    for width, usual in RULES.scale_widths:
        there, covariance, misfit, spread = _settled(track, pieces, stage, x, before, width)
        found.append((there, covariance, math.log(usual) - 0.5 * misfit - 0.5 * spread))
    best = max(f[2] for f in found)
    belief = np.exp([f[2] - best for f in found])
    belief /= belief.sum()
    solutions = [JointSolution(f[0], f[1], float(w)) for f, w in zip(found, belief, strict=True)]
    solutions.sort(key=lambda s: -s.weight)
    likeliest = solutions[0]
    return [replace(p, launch=likeliest.launch(k)) for k, p in enumerate(pieces)], solutions


def _settled(
    track: Track, pieces: Sequence[Piece], stage: Stage, x: Array, before: Before, width: float
) -> tuple[Array, Array, float, float]:
    """Gauss-Newton: unknowns, covariance, misfit with the prior's, log of the spread of belief."""
    mean = np.array([before.fall.value, before.drag.value, 0.0, 0.0, 0.0])
    bends, grows = width * before.bends, width * before.grows
    std = np.array([before.fall.std, before.drag.std, bends, bends, grows])
    for _ in range(15):
        design, left = _system(track, pieces, stage, x)
        known = np.zeros((SHARED, x.size))
        known[:, :SHARED] = np.diag(1.0 / std)
        design = np.concatenate([design, known])
        left = np.concatenate([left, (mean - x[:SHARED]) / std])
        size = np.linalg.norm(design, axis=0)
        normal = (design / size).T @ (design / size)
        inverse = np.linalg.pinv(normal, hermitian=True)
        step = inverse @ ((design / size).T @ left)
        misfit = float(left @ left)
        x = x + step / size
        if np.abs(step).max() < 1e-3:
            break
    _, log_size = np.linalg.slogdet(normal)
    spread = float(log_size + 2.0 * np.log(size).sum() + 2.0 * np.log(std).sum())
    return x, inverse / np.outer(size, size), misfit, spread


def _system(track: Track, pieces: Sequence[Piece], stage: Stage, x: Array) -> tuple[Array, Array]:
    """Return design (n, 5 + 2 pieces) and residual (n,), both over the spread of a sample."""
    view = View(*x[:SHARED])
    rows, lefts = [], []
    for k, piece in enumerate(pieces):
        first = SHARED + 2 * k
        launch = Launch(*x[first : first + 2])
        time = track.time[piece.index]
        seen = stage.seen(view, launch, piece.reference, time)
        design = np.zeros((time.size, x.size))
        slopes = stage.slopes(view, launch, piece.reference, time)
        design[:, :SHARED] = slopes[:, :SHARED]
        design[:, first : first + 2] = slopes[:, SHARED:]
        rows.append(design / piece.sigma)
        lefts.append((track.height[piece.index] - seen) / piece.sigma)
    return np.concatenate(rows), np.concatenate(lefts)


def _cleaned(track: Track, pieces: Sequence[Piece], stage: Stage, x: Array) -> list[Piece]:
    """Leave strays out, and take the spread of a sample from what is left."""
    view = View(*x[:SHARED])
    kept = []
    for k, piece in enumerate(pieces):
        launch = Launch(*x[SHARED + 2 * k : SHARED + 2 * k + 2])
        seen = stage.seen(view, launch, piece.reference, track.time[piece.index])
        left = track.height[piece.index] - seen
        usual = max(robust_std(left, lost=2), track.floor, 1e-9 * stage.reach)
        good = np.abs(left - np.median(left)) <= RULES.no_chance * usual
        good &= _untrimmed(left / usual)
        if good.sum() < RULES.flight_samples:
            good = np.ones(left.size, dtype=np.bool_)
        kept.append((piece, launch, left[good], piece.index[good]))
    squares = [float(left @ left) for _, _, left, _ in kept]
    freedom = [max(left.size - 2.5, 1.0) for _, _, left, _ in kept]
    pooled = float(np.median([s / f for s, f in zip(squares, freedom, strict=True)]))
    result = []
    for (piece, launch, left, index), s, f in zip(kept, squares, freedom, strict=True):
        together = long_run_factor(left, lost=2.5)
        variance = (s + RULES.pooled * pooled) / (f + RULES.pooled) * together
        sigma = max(float(np.sqrt(variance)), track.floor, 1e-9 * stage.reach)
        result.append(replace(piece, index=index, launch=launch, sigma=sigma))
    return result


def _untrimmed(z: Array) -> Mask:
    """Leave out samples at both ends that hang off together: a shadow, a touch, a hand."""
    kept = np.ones(z.size, dtype=np.bool_)
    most = z.size // 4
    for way in (1, -1):
        off = np.abs(z[::way][: most + 1]) > RULES.doubtful
        kept[::way][: int(np.argmin(off)) if not off.all() else most] = False
    return kept
