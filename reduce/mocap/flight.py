"""The flights of a recording fitted together: a motion each, and one centre of mass.

b, the centre of mass seen from the centroid of the markers, is the same in all flights, and spin
shows it: given with its uncertainty, or found from the recording itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ..measured import Measured
from ..rules import RULES
from ..shared.regression import FIT_ROUNDS, robust_regression, robust_std
from .motion import OWN, SHARED, Motion, Prior, deviations, first_guess, jacobian
from .rigid import Poses

Spans = Sequence[tuple[int, int]]
"""First and last index of flights among the poses, both included."""


@dataclass(frozen=True)
class Flights:
    """All flights of a recording, a motion each, and b, (3,) [m].

    `spans` are first and last index among the poses, both included; `covariance` (3 + 12 f, 3 + 12
    f) is that of b and the steps of each motion, `sigma` that of a marker about the motions [m].
    """

    spans: tuple[tuple[int, int], ...]
    motions: tuple[Motion, ...]
    offset: Array
    covariance: Array
    sigma: float

    def part(self, flights: tuple[int, ...]) -> Array:
        """Return the covariance of b and of some flights' steps."""
        index = [*range(SHARED)]
        for f in flights:
            index += range(SHARED + OWN * f, SHARED + OWN * (f + 1))
        return np.asarray(self.covariance[np.ix_(index, index)])


def fit_flights(poses: Poses, spans: Spans, gravity: Array, prior: Prior) -> Flights:
    """Fit all flights, one or more, together, with one centre of mass."""
    motions, offset = [first_guess(poses, s, gravity) for s in spans], prior.value.copy()
    sigma = 1e-4
    for _ in range(FIT_ROUNDS):
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
    design, residual = _system(poses, flights.spans, flights.motions, flights.offset)
    size = float(np.linalg.norm(flights.motions[0].gravity))
    more = []
    for span, motion in zip(flights.spans, flights.motions, strict=True):
        index = np.arange(span[0], span[1] + 1)
        tau = (poses.time[index] - motion.reference)[:, None]
        fall = np.concatenate(
            [0.5 * tau**2 * motion.gravity / size, np.zeros((index.size, 3))], axis=1
        )
        more.append(np.einsum("kij,kj->ki", poses.whiten[index], fall).T.ravel())
    fit = robust_regression(np.column_stack([design, np.concatenate(more)]), residual, floor=1e-7)
    return Measured(size + float(fit.coefficients[-1]), float(np.sqrt(fit.covariance[-1, -1])))


def _solved(design: Array, residual: Array) -> Array:
    scale = np.linalg.norm(design, axis=0)
    scale[scale == 0.0] = 1.0
    return np.asarray(np.linalg.lstsq(design / scale, residual, rcond=1e-12)[0] / scale)


def _residual(poses: Poses, spans: Spans, motions: Sequence[Motion], offset: Array) -> Array:
    """Return the deviations of all spans, component by component in time, (6 n,)."""
    each = (
        deviations(poses, np.arange(span[0], span[1] + 1), motion, offset).T.ravel()
        for span, motion in zip(spans, motions, strict=True)
    )
    return np.concatenate(list(each))


def _with_prior(
    poses: Poses, spans: Spans, motions: list[Motion], offset: Array, prior: Prior, weight: float
) -> tuple[Array, Array]:
    """Return design and residual with three rows that draw b to what is known beforehand."""
    design, residual = _system(poses, spans, motions, offset)
    known = np.zeros((SHARED, design.shape[1]))
    known[:, :SHARED] = weight * prior.scale
    residual = np.concatenate([residual, known[:, :SHARED] @ (prior.value - offset)])
    return np.concatenate([design, known]), residual


def _system(
    poses: Poses, spans: Spans, motions: Sequence[Motion], offset: Array
) -> tuple[Array, Array]:
    """Return design (6 n, 3 + 12 f) and residual (6 n,), component by component in time."""
    width = SHARED + OWN * len(spans)
    designs = []
    for f, (span, motion) in enumerate(zip(spans, motions, strict=True)):
        index = np.arange(span[0], span[1] + 1)
        own = jacobian(poses, index, motion, offset)
        whole = np.zeros((index.size, 6, width))
        whole[:, :, :SHARED] = own[:, :, :SHARED]
        first = SHARED + OWN * f
        whole[:, :, first : first + OWN] = own[:, :, SHARED:]
        # component by component, so that neighbours in the stack are neighbours in time
        designs.append(np.swapaxes(whole, 0, 1).reshape(-1, width))
    return np.concatenate(designs), _residual(poses, spans, motions, offset)


def alone(
    poses: Poses, span: tuple[int, int], gravity: Array, prior: Prior
) -> tuple[tuple[Motion, Array], float]:
    """Fit one flight by itself; motion and b, and the root mean square residual [m]."""
    motions, offset = [first_guess(poses, span, gravity)], prior.value.copy()
    # the prior of b only keeps what no spin shows from running away
    weight = 1e-4
    for _ in range(FIT_ROUNDS):
        motions, offset, _, settled = _gauss_newton(poses, [span], motions, offset, prior, weight)
        if settled:
            break
    residual = _residual(poses, [span], motions, offset)
    freedom = max(residual.size - OWN, 1)
    return (motions[0], offset), float(np.sqrt(residual @ residual / freedom))


def _moved(motions: list[Motion], offset: Array, step: Array) -> tuple[list[Motion], Array]:
    """Return motions and b after a step of all parameters."""
    own = step[SHARED:].reshape(-1, OWN)
    return [m.moved(s) for m, s in zip(motions, own, strict=True)], offset + step[:SHARED]


def _gauss_newton(
    poses: Poses, spans: Spans, motions: list[Motion], offset: Array, prior: Prior, weight: float
) -> tuple[list[Motion], Array, Array, bool]:
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
            return *there, left, bool(before - left @ left < RULES.motion_settled * before)
    return motions, offset, left, True
