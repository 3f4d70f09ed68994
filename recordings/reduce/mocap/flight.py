"""Free flights of a rigid body in its poses: centre of mass on a parabola, constant spin.

In flight X(t) = X0 + V τ + g τ²/2 is the centre of mass and R(t) = exp([w τ]) R0 the rotation; the
markers' centroid is at X - R b, with b the centre of mass seen from the centroid. b is the same in
all flights, and spin shows it: given with its uncertainty, or found from the recording itself. A
constant spin is exact about a principal axis (a rod that tumbles, any spin of a sphere or a cube).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from ..measured import Array, Measured
from ..regression import robust_regression, robust_std
from .rigid import Poses, cross_matrices

WINDOW = 8
"""Frames in which a flight is looked for; contacts closer than this are not told apart."""

_CLEAN = 3.0
"""A window fits free flight if its residual is below this many usual ones."""

_STANDS_OUT, _BROKEN = 1.5, 5.0
"""A span of clean windows is cut at its worst if that is so many usual ones, and the span as one
flight so many limits."""

_OFF = 2.5
"""Root mean square deviation, in standard deviations, at which a frame ends the flight."""

_FALL = 0.3
"""Part of gravity by which a flight's own acceleration may differ; drag of a light ball is less."""

_MOST_STEPS = 20
_SETTLED = 1e-3
"""Part of the misfit that a step may still promise when the fit of a motion ends."""

_SHARED, _OWN = 3, 12
"""Parameters: b; and for each flight X0, V, rotation about R0, w."""


@dataclass(frozen=True)
class Prior:
    """What is known beforehand about b, the centre of mass seen from the centroid.

    Parameters
    ----------
    value
        (3,) [m].
    std
        Standard deviation along `way`, or in all directions [m].
    way
        (3,) axis of a rod; zeros for no direction of its own.
    across
        Standard deviation across `way` [m].
    """

    value: Array
    std: float
    way: Array = field(default_factory=lambda: np.zeros(3))
    across: float = math.inf

    @property
    def scale(self) -> Array:
        """The matrix that makes a deviation of b one of standard size, (3, 3) [1/m]."""
        along = np.outer(self.way, self.way)
        if not self.way.any():
            return np.asarray(np.eye(3) / self.std)
        return np.asarray(along / self.std + (np.eye(3) - along) / self.across)


@dataclass(frozen=True)
class Motion:
    """State of one flight at its reference time: X0, V, R0 (3, 3), w; g is downwards."""

    reference: float
    place: Array
    speed: Array
    turn: Array
    spin: Array
    gravity: Array

    def place_at(self, time: Array) -> Array:
        """Return the centre of mass, (n, 3) [m]."""
        tau = (np.asarray(time) - self.reference)[:, None]
        return np.asarray(self.place + self.speed * tau + 0.5 * self.gravity * tau**2)

    def speed_at(self, time: float) -> Array:
        """Return the velocity of the centre of mass, (3,) [m/s]."""
        return np.asarray(self.speed + self.gravity * (time - self.reference))

    def turn_at(self, time: Array) -> Array:
        """Return the rotations, (n, 3, 3)."""
        tau = (np.asarray(time) - self.reference)[:, None]
        return np.asarray(Rotation.from_rotvec(self.spin * tau).as_matrix() @ self.turn)

    def moved(self, step: Array) -> Motion:
        """Return the motion after a step of the twelve parameters."""
        turn = Rotation.from_rotvec(step[6:9]).as_matrix() @ self.turn
        return Motion(
            self.reference, self.place + step[:3], self.speed + step[3:6], turn,
            self.spin + step[9:12], self.gravity,
        )  # fmt: skip


@dataclass(frozen=True)
class Flights:
    """All flights of a recording.

    Parameters
    ----------
    spans
        First and last index among the poses, both included, of each flight.
    motions
        One for each flight.
    offset
        b, (3,) [m].
    covariance
        (3 + 12 f, 3 + 12 f) of b and the steps of each motion.
    sigma
        Standard deviation of a marker that the poses show about the motions [m].
    """

    spans: tuple[tuple[int, int], ...]
    motions: tuple[Motion, ...]
    offset: Array
    covariance: Array
    sigma: float

    def part(self, flights: tuple[int, ...]) -> Array:
        """Return the covariance of b and of some flights' steps."""
        index = [*range(_SHARED)]
        for f in flights:
            index += range(_SHARED + _OWN * f, _SHARED + _OWN * (f + 1))
        return np.asarray(self.covariance[np.ix_(index, index)])


def find_flights(poses: Poses, gravity: Array, prior: Prior) -> Flights | None:
    """Return the flights of a recording, or None if there is none.

    Parameters
    ----------
    poses
        Of the body.
    gravity
        (3,) acceleration in flight [m/s²].
    prior
        Of the centre of mass.
    """
    spans = _spans(poses, gravity, prior)
    if not spans:
        return None
    sigma = float(np.median([_alone(poses, s, gravity, prior)[1] for s in spans]))
    spans = _merged(poses, spans, gravity, prior, sigma)
    spans = [_grown(poses, s, spans, gravity, prior, sigma) for s in spans]
    spans = [s for s in spans if s[1] - s[0] >= 4 and _falls(poses, s, gravity, prior)]
    return fit_flights(poses, spans, gravity, prior)


def _falls(poses: Poses, span: tuple[int, int], gravity: Array, prior: Prior) -> bool:
    """Whether a span's own acceleration is that of a fall, not of rest or of sliding."""
    alone = fit_flights(poses, [span], gravity, prior)
    if alone is None:
        return False
    own, g = fall_acceleration(poses, alone), float(np.linalg.norm(gravity))
    return abs(own.value - g) < max(4.0 * own.std, _FALL * g)


def fit_flights(
    poses: Poses, spans: list[tuple[int, int]], gravity: Array, prior: Prior
) -> Flights | None:
    """Fit all flights together, with one centre of mass."""
    if not spans:
        return None
    motions, offset, sigma = [_start(poses, s, gravity) for s in spans], prior.value.copy(), 1e-4
    for _ in range(_MOST_STEPS):
        weight = max(sigma, 1e-7)
        motions, offset, left, settled = _gauss_newton(poses, spans, motions, offset, prior, weight)
        sigma = robust_std(left)
        if settled:
            break
    for _ in range(2):
        weight = max(sigma, 1e-7)
        design, residual = _with_prior(poses, spans, motions, offset, prior, weight)
        fit = robust_regression(design, residual, floor=1e-7)
        sigma = fit.sigma
        motions, offset = _moved(motions, offset, fit.coefficients)
    return Flights(tuple(spans), tuple(motions), offset, fit.covariance, sigma)


def fall_acceleration(poses: Poses, flights: Flights) -> Measured:
    """Return the downward acceleration that the poses themselves show [m/s²].

    A check of units, frame rate and the direction taken for up.
    """
    spans, motions = list(flights.spans), list(flights.motions)
    design, residual = _system(poses, spans, motions, flights.offset)
    size = float(np.linalg.norm(motions[0].gravity))
    more = []
    for span, motion in zip(spans, motions, strict=True):
        index = np.arange(span[0], span[1] + 1)
        tau = (poses.time[index] - motion.reference)[:, None]
        fall = np.concatenate(
            [0.5 * tau**2 * motion.gravity / size, np.zeros((index.size, 3))], axis=1
        )
        more.append(np.einsum("kij,kj->ki", poses.whiten[index], fall).T.ravel())
    fit = robust_regression(np.column_stack([design, np.concatenate(more)]), residual, floor=1e-7)
    return Measured(size + float(fit.coefficients[-1]), float(np.sqrt(fit.covariance[-1, -1])))


def deviations(poses: Poses, index: npt.NDArray[np.int_], motion: Motion, offset: Array) -> Array:
    """Return the whitened deviation of poses from a motion, (n, 6), in metres of a marker."""
    time = poses.time[index]
    turn = motion.turn_at(time)
    origin = motion.place_at(time) - turn @ offset
    rotation = Rotation.from_matrix(poses.turn[index] @ np.swapaxes(turn, 1, 2)).as_rotvec()
    off = np.concatenate([poses.origin[index] - origin, rotation], axis=1)
    return np.asarray(np.einsum("kij,kj->ki", poses.whiten[index], off))


def _solved(design: Array, residual: Array) -> Array:
    scale = np.linalg.norm(design, axis=0)
    scale[scale == 0.0] = 1.0
    return np.asarray(np.linalg.lstsq(design / scale, residual, rcond=1e-12)[0] / scale)


def _residual(
    poses: Poses, spans: list[tuple[int, int]], motions: list[Motion], offset: Array
) -> Array:
    """Return the deviations of all spans, component by component in time, (6 n,)."""
    each = (
        deviations(poses, np.arange(span[0], span[1] + 1), motion, offset).T.ravel()
        for span, motion in zip(spans, motions, strict=True)
    )
    return np.concatenate(list(each))


def _with_prior(
    poses: Poses, spans: list[tuple[int, int]], motions: list[Motion], offset: Array,
    prior: Prior, weight: float,
) -> tuple[Array, Array]:  # fmt: skip
    """Return design and residual with three rows that draw b to what is known beforehand."""
    design, residual = _system(poses, spans, motions, offset)
    known = np.zeros((_SHARED, design.shape[1]))
    known[:, :_SHARED] = weight * prior.scale
    residual = np.concatenate([residual, known[:, :_SHARED] @ (prior.value - offset)])
    return np.concatenate([design, known]), residual


def _system(
    poses: Poses, spans: list[tuple[int, int]], motions: list[Motion], offset: Array
) -> tuple[Array, Array]:
    """Return design (6 n, 3 + 12 f) and residual (6 n,), component by component in time."""
    width = _SHARED + _OWN * len(spans)
    designs = []
    for f, (span, motion) in enumerate(zip(spans, motions, strict=True)):
        index = np.arange(span[0], span[1] + 1)
        own = _jacobian(poses, index, motion, offset)
        whole = np.zeros((index.size, 6, width))
        whole[:, :, :_SHARED] = own[:, :, :_SHARED]
        first = _SHARED + _OWN * f
        whole[:, :, first : first + _OWN] = own[:, :, _SHARED:]
        # component by component, so that neighbours in the stack are neighbours in time
        designs.append(np.swapaxes(whole, 0, 1).reshape(-1, width))
    return np.concatenate(designs), _residual(poses, spans, motions, offset)


def _jacobian(poses: Poses, index: npt.NDArray[np.int_], motion: Motion, offset: Array) -> Array:
    """Return the whitened derivatives of a pose by b and the twelve parameters, (n, 6, 15)."""
    n = index.size
    time = poses.time[index]
    tau = time - motion.reference
    turn = motion.turn_at(time)
    arm = cross_matrices(turn @ offset).reshape(n, 3, 3)
    carried = Rotation.from_rotvec(motion.spin * tau[:, None]).as_matrix()
    spun = tau[:, None, None] * _left_jacobian(motion.spin * tau[:, None])
    whole = np.zeros((n, 6, _SHARED + _OWN))
    whole[:, :3, :3] = -turn
    whole[:, :3, 3:6] = np.eye(3)
    whole[:, :3, 6:9] = tau[:, None, None] * np.eye(3)
    whole[:, :3, 9:12] = arm @ carried
    whole[:, :3, 12:15] = arm @ spun
    whole[:, 3:, 9:12] = carried
    whole[:, 3:, 12:15] = spun
    return np.asarray(poses.whiten[index] @ whole)


def _left_jacobian(vectors: Array) -> Array:
    """Return J with exp([v + d]) = exp([J d]) exp([v]) to first order, (n, 3) to (n, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    safe = np.maximum(angle, 1e-6)
    cross = cross_matrices(vectors).reshape(-1, 3, 3)
    one = np.where(angle < 1e-3, 0.5 - angle**2 / 24.0, (1.0 - np.cos(safe)) / safe**2)
    two = np.where(angle < 1e-3, 1.0 / 6.0 - angle**2 / 120.0, (safe - np.sin(safe)) / safe**3)
    return np.asarray(np.eye(3) + one * cross + two * (cross @ cross))


def _start(poses: Poses, span: tuple[int, int], gravity: Array) -> Motion:
    index = np.arange(span[0], span[1] + 1)
    time = poses.time[index]
    middle = int(index[index.size // 2])
    reference = float(poses.time[middle])
    steps = (
        Rotation.from_matrix(
            poses.turn[index[1:]] @ np.swapaxes(poses.turn[index[:-1]], 1, 2)
        ).as_rotvec()
        / np.diff(time)[:, None]
    )
    tau = time - reference
    line = np.polyfit(tau, poses.origin[index] - 0.5 * gravity * tau[:, None] ** 2, 1)
    return Motion(
        reference, line[1], line[0], poses.turn[middle], np.median(steps, axis=0), gravity
    )


def _alone(
    poses: Poses, span: tuple[int, int], gravity: Array, prior: Prior
) -> tuple[tuple[Motion, Array], float]:
    """Fit one flight by itself; motion and b, and the root mean square residual [m]."""
    motions, offset = [_start(poses, span, gravity)], prior.value.copy()
    # the prior of b only keeps what no spin shows from running away
    weight = 1e-4
    for _ in range(_MOST_STEPS):
        motions, offset, _, settled = _gauss_newton(poses, [span], motions, offset, prior, weight)
        if settled:
            break
    residual = _residual(poses, [span], motions, offset)
    freedom = max(residual.size - _OWN, 1)
    return (motions[0], offset), float(np.sqrt(residual @ residual / freedom))


def _moved(motions: list[Motion], offset: Array, step: Array) -> tuple[list[Motion], Array]:
    """Return motions and b after a step of all parameters."""
    own = step[_SHARED:].reshape(-1, _OWN)
    return [m.moved(s) for m, s in zip(motions, own, strict=True)], offset + step[:_SHARED]


def _gauss_newton(
    poses: Poses, spans: list[tuple[int, int]], motions: list[Motion], offset: Array,
    prior: Prior, weight: float,
) -> tuple[list[Motion], Array, Array, bool]:  # fmt: skip
    """Bring motions and b nearer to the poses: both, what the step leaves, and whether it ends.

    Where little spin shows b, a whole step can turn a body by so much that it no longer does.
    """

    def misfit(motions: list[Motion], offset: Array) -> float:
        residual = _residual(poses, spans, motions, offset)
        far = weight * prior.scale @ (prior.value - offset)
        return float(residual @ residual + far @ far)

    design, residual = _with_prior(poses, spans, motions, offset, prior, weight)
    step = _solved(design, residual)
    left = residual - design @ step
    before = float(residual @ residual)
    for part in (1.0, 0.5, 0.2, 0.05):
        there = _moved(motions, offset, part * step)
        if misfit(*there) < before:
            return *there, left, bool(before - left @ left < _SETTLED * before)
    return motions, offset, left, True


def _spans(poses: Poses, gravity: Array, prior: Prior) -> list[tuple[int, int]]:
    """Return runs of poses in which every window fits a free flight."""
    n = poses.time.size
    if n < WINDOW:
        return []
    usual = float(np.median(np.diff(poses.time)))
    rms = np.full(n - WINDOW + 1, np.inf)
    for k in range(rms.size):
        if poses.time[k + WINDOW - 1] - poses.time[k] < 2.0 * WINDOW * usual:
            rms[k] = _alone(poses, (k, k + WINDOW - 1), gravity, prior)[1]
    # a body at rest fits worse than one in flight: the best windows tell the error of a marker
    limit = _CLEAN * max(1.2 * float(np.quantile(rms, 0.05)), _noise(poses))
    clean = rms < limit
    while True:
        edges = np.flatnonzero(np.diff(np.concatenate([[False], clean, [False]]).astype(int)))
        runs = edges.reshape(-1, 2)
        spans = [(int(a), int(b) + WINDOW - 2) for a, b in runs]
        # a contact that b can pass for within a window shows over the whole span
        hidden = [
            a + int(np.argmax(rms[a:b]))
            for (a, b), span in zip(runs, spans, strict=True)
            if rms[a:b].max() > _STANDS_OUT * np.median(rms[a:b])
            and _alone(poses, span, gravity, prior)[1] > _BROKEN * limit
        ]
        if not hidden:
            return spans
        clean[hidden] = False


def _noise(poses: Poses) -> float:
    """Return the error of a marker by fourth differences of the origin, which motion passes.

    0 where too few frames follow each other without a gap.
    """
    even = np.flatnonzero(poses.frame[4:] - poses.frame[:-4] == 4)
    if even.size < 2 * WINDOW:
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
        (motion, offset), _ = _alone(poses, whole, gravity, prior)
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
    inner = 2 if last - first >= WINDOW + 3 else 0
    core = (first + inner, last - inner)
    (motion, offset), rms = _alone(poses, core, gravity, prior)
    limit = _OFF * max(sigma, rms)

    def reach(start: int, step: int) -> int:
        k, end = start, start
        while 0 <= k < poses.time.size and abs(k - start) <= WINDOW + inner:
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
