"""Many impacts at once: the midpoint rule with a fixed step and smoothed Coulomb friction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .laws import Curve

Array = NDArray[np.float64]

_STEPS_TO_STOP = 350.0
_MOST_STEPS = 6000
_SMOOTH = 0.01  # of the approach speed: below it friction fades


@dataclass(frozen=True, eq=False)
class Bodies:
    """Strikers just before touch, arrays of shape (n,), SI.

    Parameters
    ----------
    mass, inertia
        [kg, kg m^2].
    beside, above
        How far the centre lies beside and above the contact point [m].
    normal, tangential, spin
        Approach of the contact point (positive), velocity of the centre along +x, rotation.
    friction
        Coefficient [-].
    given_back
        Share of the elastic work that returns.
    """

    mass: Array
    inertia: Array
    beside: Array
    above: Array
    normal: Array
    tangential: Array
    spin: Array
    friction: Array
    given_back: Array


def collide(bodies: Bodies, curves: Sequence[Curve]) -> dict[str, Array]:
    """Return the observables of n impacts, each of shape (n,)."""
    n = len(bodies.mass)
    x0 = np.array([c.log_depth[0] for c in curves])
    dx = np.array([c.log_depth[1] - c.log_depth[0] for c in curves])
    last = len(curves[0].log_depth) - 1
    row = np.arange(n)
    log_force = np.stack([c.log_force for c in curves])
    recovery_of = np.stack([c.recovery for c in curves])
    crater_of = np.stack([c.crater for c in curves])
    power = np.array([c.power for c in curves])

    def look(table: Array, depth: Array) -> Array:
        place = np.clip((np.log(np.maximum(depth, 1e-30)) - x0) / dx, 0.0, last - 1e-9)
        i = place.astype(np.intp)
        t = place - i
        return np.asarray((1.0 - t) * table[row, i] + t * table[row, i + 1])

    def force_at(depth: Array, peak: Array, peak_force: Array, rest: Array) -> Array:
        up = np.exp(look(log_force, depth))
        part = np.clip((depth - rest) / np.maximum(peak - rest, 1e-30), 0.0, 1.0)
        down = peak_force * part**power * bodies.given_back
        return np.asarray(np.where(depth >= peak, up, down) * (depth > 0.0))

    m, inertia, c, s = bodies.mass, bodies.inertia, bodies.beside, bodies.above
    reduced = 1.0 / (1.0 / m + c * c / inertia)
    depth_scale = _stopping_depth(look, log_force, reduced, bodies.normal)
    h = depth_scale / bodies.normal * (1.6 / _STEPS_TO_STOP)
    vx, w = bodies.tangential.copy(), bodies.spin.copy()
    vy = -bodies.normal + w * c
    depth = np.zeros(n)
    peak, time, slid, low, high = (np.zeros(n) for _ in range(5))
    force_max, pn, pt = np.zeros(n), np.zeros(n), np.zeros(n)
    peak_force, rest, loading = np.zeros(n), np.zeros(n), np.zeros(n)
    live, gone = np.ones(n, dtype=bool), np.zeros(n)
    last_rate = bodies.normal.copy()
    eps = _SMOOTH * bodies.normal
    for _ in range(_MOST_STEPS):
        # the forces in the middle of the step, from a half step ahead
        half = 0.5 * h * live
        middle = depth + half * (-vy + w * c)
        slide = vx + w * s
        f_start = force_at(middle - half * (-vy + w * c), peak, peak_force, rest)
        t_start = -bodies.friction * f_start * np.tanh(slide / eps)
        vy_m = vy + half * f_start / m
        vx_m = vx + half * t_start / m
        w_m = w + half * (t_start * s - f_start * c) / inertia
        f = force_at(middle, peak, peak_force, rest) * live
        t = -bodies.friction * f * np.tanh((vx_m + w_m * s) / eps)
        step = 2.0 * half
        before = depth
        depth = depth + step * (-vy_m + w_m * c)
        # below a few eps the smooth friction creeps where Coulomb's sticks
        slip = vx_m + w_m * s
        slid = slid + step * np.where(np.abs(slip) > 3.0 * eps, slip, 0.0)
        vy, vx = vy + step * f / m, vx + step * t / m
        w = w + step * (t * s - f * c) / inertia
        low, high = np.minimum(low, slid), np.maximum(high, slid)
        pn, pt = pn + step * f, pt + step * t
        force_max = np.maximum(force_max, f)
        grow = live & (depth > peak)
        peak = np.where(grow, depth, peak)
        loading = np.where(grow, time + step, loading)
        peak_force = np.where(grow, np.exp(look(log_force, peak)), peak_force)
        rest = np.where(grow, np.maximum(peak - look(recovery_of, peak), 0.0), rest)
        rate = -vy + w * c
        over = live & (rate < 0.0) & (depth <= rest)
        share = np.where(over, (before - rest) / np.maximum(before - depth, 1e-30), 1.0)
        time = time + step * np.clip(share, 0.0, 1.0)
        gone = np.where(over, -rate, gone)
        live = live & ~over
        last_rate = rate
        if not live.any():
            break
    gone = np.where(live, np.maximum(-last_rate, 0.0), gone)
    return {
        "restitution": gone / bodies.normal,
        "permanent_depth_m": look(crater_of, peak),
        "contact_time_s": time,
        "peak_force_N": force_max,
        "rebound_spin_rad_s": w,
        "friction_impulse_ratio": np.abs(pt) / np.maximum(pn, 1e-30),
        "sliding_length_m": high - low,
        "rebound_speed_m_s": vy,
        "tangential_rebound_m_s": vx,
        "peak_depth_m": peak,
        "loading_time_s": loading,
        "normal_impulse_Ns": pn,
        "below_flat_s": time + look(crater_of, peak) / np.maximum(gone, 1e-6),
    }


def _stopping_depth(look, log_force: Array, mass: Array, speed: Array) -> Array:  # type: ignore[no-untyped-def]
    """Depth [m] at which the loading has taken up the energy, to some per cent."""
    energy = 0.5 * mass * speed**2
    low, high = np.full(len(mass), math.log(1e-9)), np.full(len(mass), math.log(1e-1))
    for _ in range(30):
        middle = 0.5 * (low + high)
        d = np.exp(middle)
        work = 0.45 * d * np.exp(look(log_force, d))
        low, high = np.where(work < energy, middle, low), np.where(work < energy, high, middle)
    return np.asarray(np.exp(0.5 * (low + high)))
