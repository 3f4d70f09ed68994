"""The rigs of the third world: bodies, settings, what is read and how well."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...core.arrays import Array, Indices
from ..concealed import Metal, Striker

FLATS = (
    Metal("steel S235", 205e9, 0.29, 260e6, 7850.0, 470.0, 1780.0),
    Metal("aluminium 2024-T351", 73e9, 0.33, 330e6, 2780.0, 875.0, 775.0),
    Metal("bronze CuSn8", 112e9, 0.34, 280e6, 8800.0, 377.0, 1150.0),
    Metal("titanium, grade 2", 105e9, 0.34, 300e6, 4510.0, 520.0, 1930.0),
    Metal("nickel 200, cold drawn", 204e9, 0.31, 420e6, 8890.0, 456.0, 1710.0),
)
BALL = Metal("bearing steel 100Cr6", 210e9, 0.30, 2100e6, 7810.0)
CARBIDE = Metal("tungsten carbide K20", 620e9, 0.22, 4800e6, 14900.0)
GLASS = Metal("float glass", 72e9, 0.23, math.inf, 2500.0)
HARD = Metal("hard steel", 210e9, 0.30, math.inf, 7800.0)


TOLERANCE = {
    "strength": 0.05, "modulus": 0.015, "tip": 0.008, "mass": 0.003, "friction": 0.08,
    "angle": math.radians(0.4), "speed": 0.004,
}  # fmt: skip
"""Standard deviation of what the sheet states: fractions, of the angle radians."""


@dataclass(frozen=True)
class Rig:
    """Bodies and settings, a row a trial; SI.

    - `bench`, `flat`, `strikers`: kind of rig and its bodies.
    - `which`, `angle`, `speed`, `temperature`, `load`: (n,) striker's number, angle [rad], normal
      speed [m/s], temperature [K], load of a press [N], 0 for a blow.
    - `mu`: friction as stated.
    - `noise`: column to (number, fraction): standard deviation as stated.
    - `heights`: whether heights are stated, with an error that all trials of one height share.
    - `gauge`: column to the stated standard deviation of a scale that its readings share.
    - `curve`: (2, k) plastic strain and stress over the strength, where the sheet has the metal's
      curve.
    - `told`: further keys of [target].
    - `fluid`: viscosity of a stated film [Pa s], 0 for none.
    """

    bench: str
    flat: Metal
    strikers: tuple[Striker, ...]
    which: Indices
    angle: Array
    speed: Array
    temperature: Array
    load: Array
    mu: float
    noise: dict[str, tuple[float, float]]
    heights: bool = False
    gauge: dict[str, float] = field(default_factory=dict)
    curve: Array | None = None
    told: dict[str, float] = field(default_factory=dict)
    fluid: float = 0.0

    @property
    def rods(self) -> bool:
        """Whether the strikers are rods."""
        return self.strikers[0].length > 0.0

    @property
    def oblique(self) -> bool:
        """Whether any blow is not straight."""
        return bool(np.any(self.angle < 0.499 * math.pi))


READ = {
    "restitution": (0.003, 0.006), "permanent_depth_m": (0.4e-6, 0.012),
    "dent_diameter_m": (8e-6, 0.006), "contact_time_s": (3e-7, 0.01), "peak_force_N": (4.0, 0.012),
    "rebound_spin_rad_s": (0.08, 0.008), "friction_impulse_ratio": (0.002, 0.015),
    "sliding_length_m": (1.5e-6, 0.02), "tangential_rebound_m_s": (0.004, 0.006),
    "press_depth_m": (0.3e-6, 0.01), "recovered_depth_m": (0.3e-6, 0.02),
}  # fmt: skip


def _rig(
    rng: np.random.Generator, bench: str, flat: Metal, strikers: tuple[Striker, ...], *,
    speeds: Array, read: list[str], repeats: int, angles: tuple[float, ...] = (90.0,), **more: Any,
) -> Rig:  # fmt: skip
    rows = [
        (k, math.radians(a), v)
        for k in range(len(strikers)) for a in angles for v in speeds for _ in range(repeats)
    ]  # fmt: skip
    which, angle, speed = (np.array(c) for c in zip(*rows, strict=True))
    fine = float(rng.uniform(0.7, 1.4))
    noise = {k: (READ[k][0] * fine, READ[k][1] * fine) for k in read}
    given = {"temperature": np.full(len(which), 293.0), "load": np.zeros(len(which))} | more
    mu = float(np.round(rng.uniform(0.1, 0.28), 2))
    return Rig(bench, flat, strikers, which.astype(np.intp), angle, speed, mu=mu, noise=noise,
               **given)  # fmt: skip


def _steps(rng: np.random.Generator, low: float, high: float, count: int) -> Array:
    first, last = np.exp(rng.uniform(-0.2, 0.2, 2)) * (low, high)
    return np.asarray(np.geomspace(first, last, count).round(3))


def _some(rng: np.random.Generator, values: list[float], count: int) -> list[float]:
    return sorted(float(x) for x in rng.choice(values, count, replace=False))


def _flat(rng: np.random.Generator) -> Metal:
    return FLATS[int(rng.integers(len(FLATS)))]


def _balls(rng: np.random.Generator, radii: list[float]) -> tuple[Striker, ...]:
    metal = CARBIDE if rng.random() < 0.3 else BALL
    return tuple(Striker(f"ball-{2e3 * r:g}mm", metal, r, r) for r in radii)


def _straight(rng: np.random.Generator) -> Rig:
    radii = _some(rng, [2e-3, 3e-3, 5e-3, 7.5e-3, 10e-3, 15e-3], 3)
    read = ["restitution", "permanent_depth_m" if rng.random() < 0.6 else "dent_diameter_m"]
    read += ["contact_time_s"] * int(rng.random() < 0.5)
    return _rig(rng, "balls", _flat(rng), _balls(rng, radii), speeds=_steps(rng, 0.35, 4.5, 6),
                read=read, repeats=2)  # fmt: skip


def _rods(rng: np.random.Generator) -> Rig:
    radius = float(rng.choice([5e-3, 6e-3, 8e-3]))
    lengths = _some(rng, [0.08, 0.12, 0.18, 0.24, 0.36], 2)
    if rng.random() < 0.4:  # one length, tips 1 : 4
        bodies = [(radius, lengths[0]), (4.0 * radius, lengths[0])]
    else:
        bodies = [(2.0 * radius, length) for length in lengths]
    strikers = tuple(
        Striker(f"rod-{k + 1}", BALL, tip, radius, length) for k, (tip, length) in enumerate(bodies)
    )
    read = ["restitution", "permanent_depth_m", str(rng.choice(["peak_force_N", "contact_time_s"]))]
    return _rig(rng, "rods", _flat(rng), strikers, speeds=_steps(rng, 0.4, 3.0, 6), read=read,
                repeats=3)  # fmt: skip


def _balls_aslant(rng: np.random.Generator) -> Rig:
    read = ["restitution", "rebound_spin_rad_s", "tangential_rebound_m_s"]
    return _rig(
        rng, "balls-aslant", _flat(rng), _balls(rng, _some(rng, [4e-3, 6e-3, 10e-3, 12e-3], 2)),
        speeds=_steps(rng, 0.6, 2.4, 3), read=read, repeats=2,
        angles=(20.0, 35.0, 50.0, 65.0, 80.0),
    )  # fmt: skip


def _rods_aslant(rng: np.random.Generator) -> Rig:
    radius = float(rng.choice([6e-3, 8e-3]))
    strikers = tuple(
        Striker(f"rod-{k + 1}", BALL, radius, radius, length)
        for k, length in enumerate(_some(rng, [0.12, 0.16, 0.22, 0.30], 2))
    )
    read = ["restitution", "permanent_depth_m", "rebound_spin_rad_s", "sliding_length_m"]
    angles = tuple(_some(rng, [30.0, 40.0, 50.0, 60.0, 70.0, 80.0], 3))
    return _rig(rng, "rods-aslant", _flat(rng), strikers, speeds=_steps(rng, 0.7, 2.8, 3),
                read=read, repeats=2, angles=angles)  # fmt: skip


def _elastic(rng: np.random.Generator) -> Rig:
    strikers = tuple(
        Striker(f"ball-{2e3 * r:g}mm", HARD, r, r) for r in _some(rng, [3e-3, 5e-3, 8e-3], 2)
    )
    flat = GLASS if rng.random() < 0.5 else HARD
    rig = _rig(rng, "elastic", flat, strikers, speeds=_steps(rng, 0.06, 1.0, 6),
               read=["restitution", "contact_time_s"], repeats=3)  # fmt: skip
    fine = float(rng.uniform(0.7, 1.4))
    rig.noise.update(restitution=(0.0015 * fine, 0.0), contact_time_s=(1e-7, 0.005 * fine))
    return rig


def _beads(rng: np.random.Generator) -> Rig:
    strikers = tuple(
        Striker(f"bead-{2e6 * r:g}um", HARD, r, r) for r in _some(rng, [12e-6, 25e-6, 50e-6], 2)
    )
    rig = _rig(rng, "beads", GLASS, strikers, speeds=_steps(rng, 0.08, 0.7, 7),
               read=["restitution"], repeats=3)  # fmt: skip
    rig.noise.update(restitution=(0.01 * float(rng.uniform(0.7, 1.4)), 0.0))
    return rig


def _small(rng: np.random.Generator) -> Rig:
    radii = _some(rng, [0.3e-3, 0.6e-3, 1.2e-3, 2.5e-3, 5e-3], 3)
    rig = _rig(rng, "small", _flat(rng), _balls(rng, radii), speeds=_steps(rng, 0.3, 3.0, 5),
               read=["restitution", "permanent_depth_m"], repeats=3)  # fmt: skip
    fine = float(rng.uniform(0.7, 1.4))
    rig.noise.update(permanent_depth_m=(0.06e-6 * fine, 0.012 * fine))
    return rig


def _drops(rng: np.random.Generator) -> Rig:
    radii = _some(rng, [2e-3, 4e-3, 6e-3, 10e-3], 3)
    return _rig(rng, "drops", _flat(rng), _balls(rng, radii), speeds=_steps(rng, 0.7, 4.4, 6),
                read=["restitution"], repeats=4, heights=True)  # fmt: skip


def _heated(rng: np.random.Generator) -> Rig:
    flat = _flat(rng)
    hot = np.linspace(293.0, 0.5 * flat.melting, 4).round()
    return _rig(rng, "heated", flat, _balls(rng, _some(rng, [5e-3, 8e-3], 1)),
                speeds=_steps(rng, 0.5, 3.0, 4), read=["restitution", "permanent_depth_m"],
                repeats=8, temperature=np.tile(np.repeat(hot, 2), 4))  # fmt: skip


def _pressed(rng: np.random.Generator) -> Rig:
    """Two balls that strike and are pressed: five speeds, and six loads to like depths."""
    flat = _flat(rng)
    balls = _balls(rng, _some(rng, [3e-3, 5e-3, 8e-3], 2))
    read = ["restitution", "permanent_depth_m", "press_depth_m", "recovered_depth_m"]
    rig = _rig(rng, "pressed", flat, balls, speeds=_steps(rng, 0.5, 4.0, 5), read=read, repeats=3)
    loads = [
        (k, 2.6 * flat.Sy * math.pi * (share * b.tip_radius) ** 2)
        for k, b in enumerate(balls) for share in np.linspace(0.08, 0.25, 3) for _ in range(2)
    ]  # fmt: skip
    more, load = (np.array(c) for c in zip(*loads, strict=True))
    n = len(more)
    return replace(
        rig, which=np.concatenate([rig.which, more.astype(np.intp)]),
        angle=np.concatenate([rig.angle, np.full(n, 0.5 * math.pi)]),
        speed=np.concatenate([rig.speed, np.zeros(n)]),
        load=np.concatenate([rig.load, load.round(1)]),
        temperature=np.full(len(rig.which) + n, 293.0),
    )  # fmt: skip


def _plateau(rng: np.random.Generator) -> Rig:
    """Balls on a metal whose measured curve has a plateau and then rises."""
    rig = _straight(rng)
    strain = np.concatenate([[0.0], np.geomspace(0.002, 0.2, 12)])
    end, rise = float(rng.uniform(0.008, 0.025)), float(rng.uniform(0.3, 0.7))
    stress = 1.0 + rise * (1.0 - np.exp(-np.maximum(strain - end, 0.0) / 0.06))
    return replace(rig, bench="plateau", curve=np.stack([strain, stress]))


BENCHES: dict[str, Callable[[np.random.Generator], Rig]] = {
    "balls": _straight, "rods": _rods, "balls-aslant": _balls_aslant, "rods-aslant": _rods_aslant,
    "elastic": _elastic, "beads": _beads, "small": _small, "drops": _drops, "heated": _heated,
    "pressed": _pressed, "plateau": _plateau,
}  # fmt: skip
"""By the name of the kind."""
