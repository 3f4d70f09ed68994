"""Check of momentum: one impulse at the contact point must explain all that a trial measured.

Each trial is a small problem of least squares with four unknowns; all of them are solved at once,
by Levenberg and Marquardt's method over whole arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from ...core.arrays import Array, Indices, Mask
from ...core.inputs.second_sphere import StruckSphere, struck_sphere
from ...core.rig import StrikerTable
from ..recording_set import RecordingSet
from ..rules import RULES
from .findings import Finding, judged, two_sided
from .rigid import FIXED_BY_MOMENTUM, RigidTouch, measured_after, touch
from .trial_view import angle_std, speed_std

# limit: relative fall of the sum of squares below which a trial is done [-]: round-off
_MOMENTUM_SETTLED = 1e-10

# limit: most steps of the least squares [-]
_MOMENTUM_STEPS = 60

SHARE = RULES.false_alarms / 2.0
"""This check's part of the false alarms."""

_NORMAL = ("restitution", "rebound_speed_m_s")

Residuals = Callable[[Array, Indices], Array]


@dataclass(frozen=True, slots=True)
class MomentumTrials:
    """The trials of one striker, `n` of them.

    - `angle`, `speed`: (n, 2) angle of the axis [rad] and normal approach [m/s]: values and the
      standard deviations within which they may move.
    - `tangential`, `spin`: (n,) speed of the centre along the flat [m/s] and angular velocity
      [rad/s], before.
    - `measured`: (n, 2) values and standard deviations by observable, of `FIXED_BY_MOMENTUM`; NaN
      where there is none.
    - `second`: what is struck, where that is a sphere.
    """

    striker: StrikerTable
    angle: Array
    speed: Array
    tangential: Array
    spin: Array
    measured: Mapping[str, Array]
    second: StruckSphere | None = None

    def before(self, speed: Array | float = 0.0, angle: Array | float = 0.0) -> RigidTouch[Array]:
        """Return the motion before, speed and angle off by that many standard deviations."""
        stretch = 1.0 + speed * self.speed[:, 1] / self.speed[:, 0]
        return touch(
            self.striker, angle=self.angle[:, 0] + angle * self.angle[:, 1],
            normal=self.speed[:, 0] * stretch, tangential=self.tangential * stretch, spin=self.spin,
            second=self.second,
        )  # fmt: skip

    def only(self, rows: Indices) -> MomentumTrials:
        """Return some of the trials, by number or by a mask."""
        return MomentumTrials(
            self.striker, self.angle[rows], self.speed[rows], self.tangential[rows],
            self.spin[rows], {name: both[rows] for name, both in self.measured.items()},
            self.second,
        )  # fmt: skip


def check_momentum(found: RecordingSet) -> list[Finding]:
    """One impulse must explain every velocity, spin and impulse ratio of a trial."""
    n = len(found.trials)
    misfit, degrees = np.zeros(n), np.zeros(n)
    names = np.array(found.trials.striker)
    for name in found.setup.strikers:
        of = np.flatnonzero(names == name)
        misfit[of], degrees[of] = momentum_misfit(_trials(found, name, of))
    if not degrees.any():
        return []
    total, tests = float(misfit.sum()), int(degrees.sum())
    each = misfit / np.maximum(degrees, 1.0)
    worst = int(np.argmax(each))
    p = float(chdtrc(tests, total))
    return [
        Finding(
            "momentum",
            judged(p, SHARE),
            f"one impulse a trial leaves chi squared {total:.1f} on {tests} degrees of freedom"
            + (f", most in {found.trials.trial[worst]}" if each[worst] > 0.0 else ""),
            total, float(tests), two_sided(p),
        )
    ]  # fmt: skip


def _trials(found: RecordingSet, striker: str, rows: Indices) -> MomentumTrials:
    approach = found.approach
    return MomentumTrials(
        found.setup.strikers[striker],
        np.stack([approach.angle, angle_std(found)], axis=1)[rows],
        np.stack([approach.normal, speed_std(found)], axis=1)[rows],
        approach.tangential[rows],
        approach.spin[rows],
        {
            name: np.stack([found.values(name), found.std(name)], axis=1)[rows]
            for name in FIXED_BY_MOMENTUM
            if name in found.observed
        },
        struck_sphere(found.setup.target),
    )


def momentum_misfit(trials: MomentumTrials) -> tuple[Array, Array]:
    """Return chi squared and degrees of freedom of the one impulse that fits each trial best.

    Both are of shape (n,). Every observable beyond two is a test. Unknown are the two components of
    the impulse, and speed and angle within their standard deviations; a part `RULES.frozen_angle`
    of the approach speed is added to what was measured.
    """
    misfit = np.zeros(len(trials.speed))
    known = {name: np.isfinite(both[:, 0]) for name, both in trials.measured.items()}
    degrees = np.maximum(np.sum([*known.values()], axis=0) - _felt(trials, known), 0.0)
    tested = np.flatnonzero(degrees)
    if tested.size:
        misfit[tested] = _best(trials.only(tested))
    return misfit, degrees


def _felt(trials: MomentumTrials, known: Mapping[str, Mask]) -> Array:
    """How many components of the impulse show in what was measured, (n,).

    Two spheres meet along the line of centres: some observables know one component alone.
    """
    n = len(trials.speed)
    if trials.second is None:
        return np.full(n, 2.0)
    normal = [known[name] for name in _NORMAL if name in known]
    other = [here for name, here in known.items() if name not in _NORMAL]
    parts = [np.any(rows, axis=0) for rows in (normal, other) if rows]
    return np.sum(parts, axis=0, dtype=float) if parts else np.zeros(n)


def _best(trials: MomentumTrials) -> Array:
    """Sum of squares of each trial; friction against the tip's sliding, or with it.

    An elastic grip throws a tip back, so that both signs occur; |P_x| has a minimum on each side.
    """
    momentum = trials.striker.mass_kg.value * trials.speed[:, 0]
    unit = {name: _unit(name, trials) for name in trials.measured}

    def residuals(x: Array, rows: Indices) -> Array:
        some = trials.only(rows)
        px, py = x[:, :2].T * momentum[rows]
        after = measured_after(some.before(x[:, 2], x[:, 3]), (px, py))
        left = [x[:, 2], x[:, 3]]
        for name, (value, std) in ((n, both.T) for n, both in some.measured.items()):
            sigma = np.hypot(std, RULES.frozen_angle * unit[name][rows])
            left.append(np.nan_to_num((after[name] - value) / sigma))
        return np.stack(left, axis=1)

    e = _measured(trials, "restitution", 0.5)
    starts = []
    mu = _measured(trials, "friction_impulse_ratio", 0.2)
    for ratio in (mu, -mu):
        impulse = np.stack(trials.before().impulse(e, ratio), axis=1) / momentum[:, None]
        starts.append(np.concatenate([impulse, np.zeros_like(impulse)], axis=1))
    return np.asarray(np.minimum(*(least_squares(residuals, start) for start in starts)))


def _measured(trials: MomentumTrials, name: str, otherwise: float) -> Array:
    unknown = np.full(len(trials.speed), otherwise)
    if name not in trials.measured:
        return unknown
    value = trials.measured[name][:, 0]
    return np.where(np.isfinite(value), value, unknown)


def _unit(name: str, trials: MomentumTrials) -> Array:
    """What the model tolerance is a part of: 1, a speed, or a speed over an arm."""
    speed = trials.speed[:, 0]
    if name == "rebound_spin_rad_s":
        return speed / (trials.striker.length / 2.0 or trials.striker.tip_radius_m.value)
    return speed if name.endswith("_m_s") else np.ones_like(speed)


def least_squares(residuals: Residuals, start: Array) -> Array:
    """Return the least sums of squares of many small problems, shape (n,).

    `residuals` gives those (k, m) of problems number (k,) at their unknowns (k, p), `start` is (n,
    p). Levenberg 1944 and Marquardt 1963, with a damping of each problem's own.
    """
    x, at = start.copy(), np.arange(len(start))
    r = residuals(x, at)
    cost = np.sum(r**2, axis=1)
    damping = np.full(len(x), 1e-3)
    for _ in range(_MOMENTUM_STEPS):
        J = _jacobian(residuals, x[at], at, r[at])
        H, g = J.swapaxes(1, 2) @ J, np.einsum("nmp,nm->np", J, r[at])
        weight = damping[at, None, None] * H
        # an unknown that nothing feels stays where it is
        weight += 1e-12 * np.trace(H, axis1=1, axis2=2)[:, None, None]
        H += weight * np.eye(x.shape[1])
        new = x[at] - np.linalg.solve(H, g[..., None])[..., 0]
        with np.errstate(all="ignore"):  # a step too far gives no number, which is no better
            tried = residuals(new, at)
            sums = np.sum(tried**2, axis=1)
        better = sums < cost[at]
        done = np.where(
            better, cost[at] - sums <= _MOMENTUM_SETTLED * (1.0 + sums), damping[at] > 1e6
        )
        x[at[better]], r[at[better]], cost[at[better]] = new[better], tried[better], sums[better]
        damping[at] *= np.where(better, 0.1, 10.0)
        at = at[~done]
        if not at.size:
            break
    return np.asarray(cost)


def _jacobian(residuals: Residuals, x: Array, rows: Indices, at: Array) -> Array:
    """Derivatives (k, m, p) of the residuals by forward differences."""
    columns = []
    for i in range(x.shape[1]):
        step = 1e-7 * np.maximum(np.abs(x[:, i]), 0.1)
        moved = x.copy()
        moved[:, i] += step
        columns.append((residuals(moved, rows) - at) / step[:, None])
    return np.asarray(np.stack(columns, axis=2))
