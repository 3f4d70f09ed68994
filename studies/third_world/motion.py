"""Blows and presses: midpoint steps for all trials at once, and what instruments would read."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array
from .physics import Bodies, Physics, bodies_of

_FINE = 260
"""Steps of the shorter of the times that Hertz's and a plastic impact take."""

_LONGEST = 12_000
_FRICTION_FLOOR = 0.3
"""Part of the speed of approach below which the rate of a blow doesn't fall as it slows down."""


class _Contact:
    """Force on the way in and out, with the deepest dent so far in mind."""

    def __init__(self, p: Physics) -> None:
        self.p = p
        self.deepest, self.most, self.left = np.zeros(len(p.R)), 0.0 * p.R, 0.0 * p.R
        self.a = 1e-9 + 0.0 * p.R
        self.n = 1.5 + 0.0 * p.R

    def loading(self, d: Array, v: Array) -> tuple[Array, Array]:
        """Force and contact radius of a first loading."""
        p = self.p
        Y = p.Y * p.factor(self.a, v)
        crushed = 0.0 * d
        if p.layer[0]:
            height, bears, _ = p.layer
            crushed = 2.2 * Y * 2.0 * np.pi * p.R * d * bears * np.exp(-d / height)
            d = d - height * (1.0 - np.exp(-d / height))
        if not p.flat:
            F, a = p.law.load(d, p.E, Y, p.R)
            return F + crushed, a
        F, a = p.law.load(d + p.flat**2 / (2.0 * p.R), p.E, Y, p.R)
        return np.minimum(F, 2.0 * p.E * p.flat * d), np.maximum(a, p.flat)

    def force(self, d: Array, v: Array) -> Array:
        """Elastic-plastic force at the depths d while they change with v."""
        p = self.p
        slow = np.hypot(v, _FRICTION_FLOOR * p.speed)
        F, a = self.loading(np.maximum(d, 0.0), slow)
        on = d > self.deepest
        if np.any(on):
            self.deepest = np.where(on, d, self.deepest)
            self.most, self.a = np.where(on, F, self.most), np.where(on, a, self.a)
            n = p.law.exponent(self.a, p.E, p.Y, p.R)
            back = n * self.most / (2.0 * p.E * self.a)
            # all of an elastic dent comes back: 1.5 of a ball, 1 of a punch
            self.n = np.minimum(n, 2.0 * p.E * self.a * self.deepest / self.most)
            self.left = np.maximum(self.deepest - back, 0.0)
        span = np.maximum(self.deepest - self.left, 1e-15)
        out = self.most * np.clip((d - self.left) / span, 0.0, 1.0) ** self.n
        return np.where(on, F, out)

    def lost(self) -> Array:
        """Depth that stays [m]."""
        kept = self.p.layer[0] * (1.0 - self.p.layer[2]) if self.p.layer[0] else 0.0
        return np.maximum(self.left - kept, 0.0)


def blows(p: Physics) -> dict[str, Array]:
    """Columns of blows, (n,) each; NaN where a striker does not come, or stays or rattles on."""
    b, c = bodies_of(p), _Contact(p)
    v0 = np.einsum("ni,ni->n", b.normal, b.start)
    if p.film is not None:
        slower = np.maximum(1.0 + p.film[0] / v0, 1e-3)
        b.start[:, 0] *= slower
    dt = _step(p, b)
    q, v = np.zeros_like(b.start), b.start.copy()
    n = len(p.R)
    sunk, t, parted = np.zeros(n), np.zeros(n), np.zeros(n)
    end, peak, pushed, dragged = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    low, high, spring, F = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    ease = np.sum(b.tangential**2 / b.mass, axis=1)
    rubs = bool(np.any(b.tangential))
    for _ in range(_LONGEST):
        q += 0.5 * dt[:, None] * v
        sunk += dt * p.plate * F
        d = -np.einsum("ni,ni->n", b.normal, q) - sunk
        w = -np.einsum("ni,ni->n", b.normal, v) - p.plate * F
        F = c.force(d, w)
        F = np.where(F > 0.0, np.maximum(F + _lossy(p, c, d, w), 0.0), 0.0)
        inner = b.normal * F[:, None] - b.drag * v
        if b.stiff is not None:
            inner -= np.einsum("nij,nj->ni", b.stiff, q + b.loss * v)
        if rubs:
            slide = np.einsum("ni,ni->n", b.tangential, v)
            most = _friction(p, slide, c.a) * F
            if p.slip:
                spring = np.clip(spring - p.slip * 8.0 * _shear(p) * c.a * slide * dt, -most, most)
                T = spring
            else:
                free = slide + dt * np.sum(b.tangential * inner / b.mass, axis=1)
                T = np.clip(-free / (dt * ease + 1e-30), -most, most)
            inner += b.tangential * T[:, None]
            dragged += T * dt
            x = np.einsum("ni,ni->n", b.tangential, q)
            low, high = np.where(F > 0.0, np.minimum(low, x), low), np.where(
                F > 0.0, np.maximum(high, x), high
            )  # fmt: skip
        v += dt[:, None] * inner / b.mass
        q += 0.5 * dt[:, None] * v
        t += dt
        pushed += F * dt
        peak = np.maximum(peak, F)
        end = np.where(F > 0.0, t, end)
        parted = np.where((F > 0.0) | (d > c.left), 0.0, parted + dt)
        if np.all((parted > b.follow) & (t > 5.0 * dt)):
            break
        dt = np.where((parted > b.follow) & (t > 5.0 * dt), 0.0, dt)
    after = np.einsum("nki,ni->nk", b.rigid, v)
    found = _read(p, c, after, -v0) | {
        "contact_time_s": end, "peak_force_N": peak, "sliding_length_m": high - low,
        "friction_impulse_ratio": np.abs(dragged) / np.maximum(pushed, 1e-30),
    }  # fmt: skip
    return {k: np.where(parted > b.follow, x, np.nan) for k, x in found.items()}


def _read(p: Physics, c: _Contact, after: Array, v0: Array) -> dict[str, Array]:
    back = after[:, 0]
    if p.film is not None:
        back = back - p.film[0] * p.film[1]
    if p.adhesion is not None:
        back = np.sqrt(np.maximum(back**2 - 2.0 * p.adhesion / p.mass, 0.0))
    stays = (back < 0.01 * v0) | (p.film is not None and p.film[0] > 0.95 * v0)
    found = {
        "restitution": back / v0, "permanent_depth_m": c.lost(), "dent_diameter_m": 2.0 * c.a,
        "rebound_spin_rad_s": after[:, 2],
        "tangential_rebound_m_s": after[:, 1] - after[:, 2] * p.R,
    }  # fmt: skip
    return {k: np.where(stays, np.nan, x) for k, x in found.items()}


def _step(p: Physics, b: Bodies) -> Array:
    """Time steps (n,) [s]."""
    elastic = 2.87 * (p.mass**2 / (p.R * p.E**2 * p.speed)) ** 0.2
    plastic = 1.6 * np.sqrt(p.mass / (2.0 * np.pi * p.R * 2.8 * p.Y))
    if np.isinf(p.rig.flat.Sy):
        plastic = elastic
    return np.asarray(np.minimum(np.minimum(elastic, plastic) / _FINE, b.most))


def _lossy(p: Physics, c: _Contact, d: Array, w: Array) -> Array:
    """Forces that go with speed: of the contact, and of waves into the flat."""
    deep = np.maximum(d - c.left, 0.0)
    a = np.sqrt(p.R * deep)
    form, number = p.damper
    found = p.dashpot * a * a * w
    if form == "kuwabara-kono":
        found = found + number * 2.0 * p.E * np.sqrt(p.R) * np.sqrt(deep) * w
    elif form == "tsuji":
        found = found + number * np.sqrt(p.mass * 4.0 / 3.0 * p.E) * (p.R * deep) ** 0.25 * w
    return np.asarray(found)


def _shear(p: Physics) -> float:
    """Mindlin's modulus of the two bodies, 1 over (2 - nu)/G of both [Pa]."""
    flat, ball = p.rig.flat, p.rig.strikers[0].metal
    each = [(2.0 - m.nu) * 2.0 * (1.0 + m.nu) / m.E for m in (flat, ball)]
    return 1.0 / sum(each)


def _friction(p: Physics, slide: Array, a: Array) -> Array:
    mu = p.mu
    for one in p.rub:
        mu = mu * one(np.abs(slide), a)
    for one in p.plough:
        mu = mu + one(np.abs(slide), a)
    return mu


def presses(p: Physics) -> dict[str, Array]:
    """Columns of presses to each row's load, (n,) each."""
    loads = p.rig.load
    low, high = np.zeros(len(loads)), p.R.copy()
    still = 0.0 * low
    for _ in range(50):
        d = 0.5 * (low + high)
        c = _Contact(p)
        for _ in range(4):  # the strength depends on the radius that it makes
            F, c.a = c.loading(d, still)
        low, high = np.where(F < loads, d, low), np.where(F < loads, high, d)
    c.force(high, still)
    return {
        "permanent_depth_m": c.lost(), "press_depth_m": c.deepest,
        "recovered_depth_m": c.deepest - c.left, "dent_diameter_m": 2.0 * c.a,
    }  # fmt: skip
