"""Many impacts at once: the midpoint rule with a fixed step and smoothed Coulomb friction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array, Mask
from ..rules import RULES
from .laws import NullCurve

# limit: its steps at most [-]: fifty times as many as to the turning point
_NULL_MOST_STEPS = 6000


@dataclass(frozen=True, eq=False)
class NullBodies:
    """Strikers just before touch, arrays of shape (n,), SI.

    - `mass`, `inertia`: [kg, kg m^2].
    - `beside`, `above`, `tip`: how far the centre of mass lies beside and above the contact point,
      and that of the tip above it [m].
    - `normal`, `tangential`, `spin`: approach of the contact point (positive), velocity of the
      centre along +x, rotation.
    - `friction`: coefficient [-].
    - `given_back`: share of the elastic work that returns.
    - `scan`: depth at which a scan ends a mark [m].
    """

    mass: Array
    inertia: Array
    beside: Array
    above: Array
    tip: Array
    normal: Array
    tangential: Array
    spin: Array
    friction: Array
    given_back: Array
    scan: Array


@dataclass(frozen=True, eq=False)
class _Contacts:
    """The curves of n contacts, looked up at one depth each."""

    first: Array
    step: Array
    log_force: Array
    recovery: Array
    crater: Array
    radius: Array
    power: Array
    given_back: Array

    @classmethod
    def of(cls, curves: Sequence[NullCurve], given_back: Array) -> _Contacts:
        """Stack the tables of the curves."""
        force, recovery, crater, radius, power = (
            np.array([getattr(c, key) for c in curves])
            for key in ("log_force", "recovery", "crater", "radius", "power")
        )
        first, second = np.array([c.log_depth[:2] for c in curves]).T
        return cls(first, second - first, force, recovery, crater, radius, power, given_back)

    def look(self, table: Array, depth: Array) -> Array:
        """Return the values of a table (n, k) at the depths (n,)."""
        row, last = np.arange(len(table)), table.shape[1] - 1
        place = np.clip((np.log(np.maximum(depth, 1e-30)) - self.first) / self.step, 0.0,
                        last - 1e-9)  # fmt: skip
        i = place.astype(np.intp)
        t = place - i
        return np.asarray((1.0 - t) * table[row, i] + t * table[row, i + 1])

    def force(self, depth: Array, s: _State) -> Array:
        """Return the normal force at the depths, above the peak on loading, below on recovery."""
        up = np.exp(self.look(self.log_force, depth))
        part = np.clip((depth - s.rest) / np.maximum(s.peak - s.rest, 1e-30), 0.0, 1.0)
        down = s.peak_force * part**self.power * self.given_back
        return np.asarray(np.where(depth >= s.peak, up, down) * (depth > 0.0))

    def stopping_depth(self, mass: Array, speed: Array) -> Array:
        """Depth [m] at which the loading has taken up the energy, to some per cent."""
        energy = 0.5 * mass * speed**2
        low, high = np.full(len(mass), math.log(1e-9)), np.full(len(mass), math.log(1e-1))
        for _ in range(30):
            middle = 0.5 * (low + high)
            d = np.exp(middle)
            work = 0.45 * d * np.exp(self.look(self.log_force, d))
            low, high = np.where(work < energy, middle, low), np.where(work < energy, high, middle)
        return np.asarray(np.exp(0.5 * (low + high)))


class _State(NamedTuple):
    """Where n impacts are: velocities, depth and its peak, slip, mark, impulses, times; (n,) each.

    `place` is that of the contact on the flat, `first` and `last` are the ends of the mark.
    """

    vx: Array
    vy: Array
    spin: Array
    depth: Array
    peak: Array
    peak_force: Array
    rest: Array
    slid: Array
    slid_low: Array
    slid_high: Array
    place: Array
    first: Array
    last: Array
    normal: Array
    tangential: Array
    largest_force: Array
    time: Array
    loading: Array
    rate: Array
    gone: Array
    live: Mask

    @classmethod
    def touching(cls, bodies: NullBodies) -> _State:
        """Return the state at first touch."""
        n = len(bodies.mass)
        zero = np.zeros(n)
        vy = -bodies.normal + bodies.spin * bodies.beside
        return cls(
            bodies.tangential, vy, bodies.spin, zero, zero, zero, zero, zero, zero, zero, zero,
            zero, zero, zero, zero, zero, zero, zero, bodies.normal, zero, np.ones(n, dtype=bool),
        )  # fmt: skip


def collide(bodies: NullBodies, curves: Sequence[NullCurve]) -> dict[str, Array]:
    """Return the observables of n impacts, each of shape (n,)."""
    contacts = _Contacts.of(curves, bodies.given_back)
    reduced = 1.0 / (1.0 / bodies.mass + bodies.beside * bodies.beside / bodies.inertia)
    h = contacts.stopping_depth(reduced, bodies.normal) / bodies.normal * (1.6 / RULES.null_steps)
    s = _State.touching(bodies)
    for _ in range(_NULL_MOST_STEPS):
        s = _stepped(s, bodies, contacts, h)
        if not s.live.any():
            break
    gone = np.where(s.live, np.maximum(-s.rate, 0.0), s.gone)
    crater = contacts.look(contacts.crater, s.peak)
    # a scan ends a mark a little below the fresh flat, on its wall
    radius = contacts.look(contacts.radius, s.peak)
    inside = np.sqrt(np.clip(1.0 - bodies.scan / np.maximum(crater, 1e-30), 0.0, 1.0))
    width = 2.0 * radius * inside
    length = np.where(inside > 0.0, s.last - s.first - 2.0 * radius * (1.0 - inside), 0.0)
    return {
        "restitution": gone / bodies.normal,
        "permanent_depth_m": crater,
        "dent_diameter_m": 2.0 * radius,
        "contact_time_s": s.time,
        "peak_force_N": s.largest_force,
        "rebound_spin_rad_s": s.spin,
        "friction_impulse_ratio": np.abs(s.tangential) / np.maximum(s.normal, 1e-30),
        "sliding_length_m": s.slid_high - s.slid_low,
        "scar_length_m": length,
        "scar_width_m": width,
        "scar_excess_m": length - width,
        "rebound_speed_m_s": s.vy,
        "tangential_rebound_m_s": s.vx,
        "peak_depth_m": s.peak,
        "loading_time_s": s.loading,
        "normal_impulse_Ns": s.normal,
        "below_flat_s": s.time + crater / np.maximum(gone, 1e-6),
    }


def _stepped(s: _State, bodies: NullBodies, contacts: _Contacts, h: Array) -> _State:
    """Return the state after a step h; those that have parted stay as they are."""
    m, inertia, beside, above = bodies.mass, bodies.inertia, bodies.beside, bodies.above
    mu, eps = bodies.friction, RULES.null_smooth * bodies.normal
    # the forces in the middle of the step, from a half step ahead
    half = 0.5 * h * s.live
    middle = s.depth + half * (-s.vy + s.spin * beside)
    slide = s.vx + s.spin * above
    f = contacts.force(middle - half * (-s.vy + s.spin * beside), s)
    t = -mu * f * np.tanh(slide / eps)
    vy_middle = s.vy + half * f / m
    vx_middle = s.vx + half * t / m
    spin_middle = s.spin + half * (t * above - f * beside) / inertia
    slip = vx_middle + spin_middle * above
    f = contacts.force(middle, s) * s.live
    t = -mu * f * np.tanh(slip / eps)
    step = 2.0 * half
    depth = s.depth + step * (-vy_middle + spin_middle * beside)
    # below a few eps the smooth friction creeps where Coulomb's sticks
    slid = s.slid + step * np.where(np.abs(slip) > 3.0 * eps, slip, 0.0)
    place = s.place + step * (vx_middle + spin_middle * (above - bodies.tip))
    vy, vx = s.vy + step * f / m, s.vx + step * t / m
    spin = s.spin + step * (t * above - f * beside) / inertia
    grow = s.live & (depth > s.peak)
    peak = np.where(grow, depth, s.peak)
    rest = np.maximum(peak - contacts.look(contacts.recovery, peak), 0.0)
    rest = np.where(grow, rest, s.rest)
    wide = contacts.look(contacts.radius, peak)
    wide *= np.sqrt(np.clip((depth - rest) / np.maximum(peak - rest, 1e-30), 0.0, 1.0))
    wide *= s.live
    rate = -vy + spin * beside
    over = s.live & (rate < 0.0) & (depth <= rest)
    share = np.where(over, (s.depth - rest) / np.maximum(s.depth - depth, 1e-30), 1.0)
    return _State(
        vx, vy, spin, depth, peak,
        np.where(grow, np.exp(contacts.look(contacts.log_force, peak)), s.peak_force), rest, slid,
        np.minimum(s.slid_low, slid), np.maximum(s.slid_high, slid), place,
        np.minimum(s.first, place - wide), np.maximum(s.last, place + wide), s.normal + step * f,
        s.tangential + step * t, np.maximum(s.largest_force, f),
        s.time + step * np.clip(share, 0.0, 1.0), np.where(grow, s.time + step, s.loading), rate,
        np.where(over, -rate, s.gone), s.live & ~over,
    )  # fmt: skip
