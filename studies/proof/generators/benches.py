"""The kinds of bench on which sets are recorded, drawn at random."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...concealed import Metal, Striker
from .rig import Rig

MILD_STEEL = Metal("mild steel", 206e9, 0.29, 300e6, 7850.0, 480.0, 1790.0)
ALUMINIUM = Metal("aluminium 6061-T6", 69e9, 0.33, 280e6, 2700.0, 896.0, 855.0)
BRASS = Metal("brass", 103e9, 0.34, 250e6, 8500.0, 380.0, 1190.0)
COPPER = Metal("copper, hard", 118e9, 0.34, 210e6, 8940.0, 385.0, 1356.0)
TOUGH_ALUMINIUM = Metal("aluminium 7075-T6", 71.7e9, 0.33, 500e6, 2810.0, 960.0, 750.0)
TARGETS = (MILD_STEEL, ALUMINIUM, BRASS, COPPER, TOUGH_ALUMINIUM)

BEARING_STEEL = Metal("bearing steel, hardened", 208e9, 0.30, 2000e6, 7830.0)
CARBIDE = Metal("tungsten carbide", 600e9, 0.22, 4500e6, 14900.0)
HARD = Metal("tool steel, hardened", 210e9, 0.29, math.inf, 7800.0)
GLASS = Metal("glass block", 70e9, 0.22, math.inf, 2500.0)

_KNOWN = {
    "strength": 0.04, "modulus": 0.015, "radius": 0.01, "mass": 0.003, "friction": 0.10,
    "speed": 0.004, "angle": math.radians(0.5),
}  # fmt: skip


def _grid(
    strikers: int, angles: list[float], speeds: np.ndarray, repeats: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rows = [
        (k, a, v) for k in range(strikers) for a in angles for v in speeds for _ in range(repeats)
    ]
    which, angle, speed = (np.array(column) for column in zip(*rows, strict=True))
    return which.astype(np.intp), angle.astype(float), speed.astype(float)


def _noise(rng: np.random.Generator, *names: str) -> dict[str, tuple[float, float]]:
    quality = rng.uniform(0.7, 1.3)
    table = {
        "restitution": (0.002, 0.010), "permanent_depth_m": (0.5e-6, 0.012),
        "contact_time_s": (0.5e-6, 0.010), "peak_force_N": (5.0, 0.015),
        "rebound_spin_rad_s": (0.05, 0.010), "friction_impulse_ratio": (0.002, 0.02),
        "sliding_length_m": (1.5e-6, 0.02), "tangential_rebound_m_s": (0.003, 0.008),
    }  # fmt: skip
    return {name: (table[name][0] * quality, table[name][1] * quality) for name in names}


def _rig(
    rng: np.random.Generator, bench: str, target: Metal, strikers: tuple[Striker, ...],
    grid: tuple[np.ndarray, np.ndarray, np.ndarray], noise: dict[str, tuple[float, float]],
    **more: object,
) -> Rig:  # fmt: skip
    which, angle, speed = grid
    zero = np.zeros(len(which))
    options: dict[str, object] = {"tangential": zero, "temperature": zero + 295.0} | more
    return Rig(
        bench=bench, target=target, strikers=strikers, which=which, angle=angle, speed=speed,
        mu=float(np.round(rng.uniform(0.10, 0.25), 2)), tolerance=dict(_KNOWN), noise=noise,
        **options,  # type: ignore[arg-type]
    )  # fmt: skip


def rods_normal(rng: np.random.Generator) -> Rig:
    """Rods of two or three lengths dropped upright."""
    radius = rng.choice([4.5e-3, 6.35e-3, 8.8e-3])
    tip = float(np.round(radius * rng.choice([1.0, 1.5, 2.0]), 5))
    lengths = rng.choice(
        [0.10, 0.15, 0.20, 0.25, 0.30, 0.40], size=rng.integers(2, 4), replace=False
    )
    strikers = tuple(
        Striker(f"rod-{1e3 * L:.0f}", BEARING_STEEL, tip, float(radius), float(L))
        for L in np.sort(lengths)
    )
    speeds = np.round(np.geomspace(rng.uniform(0.3, 0.6), rng.uniform(2.5, 4.0), 6), 3)
    grid = _grid(len(strikers), [0.5 * math.pi], speeds, 2 if len(strikers) == 3 else 3)
    some = ["contact_time_s", "peak_force_N"]
    names = ["restitution", "permanent_depth_m", *some[: rng.integers(1, 3)]]
    return _rig(rng, "rods-normal", _metal(rng), strikers, grid, _noise(rng, *names))


def rods_oblique(rng: np.random.Generator) -> Rig:
    """Inclined rods of two lengths."""
    radius = rng.choice([6.35e-3, 8.8e-3])
    lengths = rng.choice([0.15, 0.20, 0.25, 0.30], size=2, replace=False)
    strikers = tuple(
        Striker(f"rod-{1e3 * L:.0f}", BEARING_STEEL, float(radius), float(radius), float(L))
        for L in np.sort(lengths)
    )
    angles = [math.radians(a) for a in np.sort(rng.choice([25, 35, 45, 55, 65, 75], 4, False))]
    speeds = np.round(np.geomspace(rng.uniform(0.6, 0.9), rng.uniform(2.2, 3.5), 3), 3)
    grid = _grid(2, angles, speeds, 2)
    names = ["restitution", "permanent_depth_m", "rebound_spin_rad_s", "sliding_length_m"]
    if rng.random() < 0.5:
        names.append("friction_impulse_ratio")
    return _rig(rng, "rods-oblique", _metal(rng), strikers, grid, _noise(rng, *names))


def _balls(rng: np.random.Generator, radii: list[float]) -> tuple[Striker, ...]:
    metal = BEARING_STEEL if rng.random() < 0.7 else CARBIDE
    return tuple(Striker(f"ball-{2e3 * r:g}", metal, r, r) for r in radii)


def balls_normal(rng: np.random.Generator) -> Rig:
    """Balls of three sizes, straight down."""
    radii = sorted(rng.choice([1.5e-3, 2.5e-3, 4e-3, 6e-3, 9e-3, 12.5e-3], 3, False).tolist())
    speeds = np.round(np.geomspace(rng.uniform(0.25, 0.5), rng.uniform(3.0, 6.0), 6), 3)
    names = ["restitution", "permanent_depth_m"]
    if rng.random() < 0.7:
        names.append("contact_time_s")
    grid = _grid(3, [0.5 * math.pi], speeds, 3)
    rig = _rig(rng, "balls-normal", _metal(rng), _balls(rng, radii), grid, _noise(rng, *names))
    return rig


def balls_oblique(rng: np.random.Generator) -> Rig:
    """Balls of two sizes at several angles."""
    radii = sorted(rng.choice([4e-3, 6e-3, 9e-3, 12.5e-3], 2, False).tolist())
    angles = [math.radians(a) for a in (15.0, 30.0, 45.0, 60.0, 75.0)]
    speeds = np.round(np.geomspace(rng.uniform(0.5, 0.8), rng.uniform(2.0, 3.0), 3), 3)
    which, angle, speed = _grid(2, angles, speeds, 2)
    names = ["restitution", "permanent_depth_m", "rebound_spin_rad_s", "tangential_rebound_m_s"]
    return _rig(
        rng, "balls-oblique", _metal(rng), _balls(rng, radii), (which, angle, speed),
        _noise(rng, *names), tangential=-speed / np.tan(angle),
    )  # fmt: skip


def balls_elastic(rng: np.random.Generator) -> Rig:
    """Hard balls on a block that doesn't yield: bounces timed to a few parts in a thousand."""
    radii = sorted(rng.choice([2.5e-3, 4e-3, 6e-3, 9e-3], 2, False).tolist())
    speeds = np.round(np.geomspace(0.05, rng.uniform(0.8, 1.5), 7), 4)
    noise = {"restitution": (0.001 * rng.uniform(0.7, 1.3), 0.0), "contact_time_s": (1e-7, 0.004)}
    grid = _grid(2, [0.5 * math.pi], speeds, 3)
    target = GLASS if rng.random() < 0.5 else HARD
    return _rig(
        rng, "balls-elastic", target,
        tuple(Striker(f"ball-{2e3 * r:g}", HARD, r, r) for r in radii), grid, noise, law="elastic",
    )  # fmt: skip


def balls_small(rng: np.random.Generator) -> Rig:
    """Small balls at low and middle speed: small dents, depth by a profilometer."""
    radii = sorted(rng.choice([0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3], 3, False).tolist())
    speeds = np.round(np.geomspace(rng.uniform(0.2, 0.4), rng.uniform(2.0, 4.0), 5), 3)
    quality = rng.uniform(0.7, 1.3)
    noise = {
        "restitution": (0.003 * quality, 0.008),
        "permanent_depth_m": (0.05e-6 * quality, 0.012),
    }
    grid = _grid(3, [0.5 * math.pi], speeds, 3)
    return _rig(rng, "balls-small", _metal(rng), _balls(rng, radii), grid, noise)


def microspheres(rng: np.random.Generator) -> Rig:
    """Microspheres on an elastic plate, rebound by a laser: a hundredth of a metre a second up."""
    radii = sorted(rng.choice([10e-6, 20e-6, 40e-6, 80e-6], 2, False).tolist())
    strikers = tuple(Striker(f"bead-{2e6 * r:g}um", HARD, r, r) for r in radii)
    which, angle, speed = _grid(2, [0.5 * math.pi], np.geomspace(0.06, 0.8, 8).round(4), 3)
    noise = {"restitution": (0.008 * rng.uniform(0.7, 1.3), 0.0)}
    return _rig(rng, "microspheres", GLASS, strikers, (which, angle, speed), noise, law="elastic")


def balls_drops(rng: np.random.Generator) -> Rig:
    """Balls of three sizes from five to eight heights, their restitution alone."""
    radii = sorted(rng.choice([2e-3, 3e-3, 5e-3, 8e-3, 12.5e-3], 3, False).tolist())
    count = int(rng.integers(5, 9))
    heights = np.geomspace(rng.uniform(0.02, 0.05), rng.uniform(0.8, 1.5), count)
    speeds = np.round(np.sqrt(2.0 * 9.81 * heights), 3)
    noise = {"restitution": (0.004 * rng.uniform(0.7, 1.5), 0.005)}
    grid = _grid(3, [0.5 * math.pi], speeds, int(rng.integers(3, 6)))
    return _rig(rng, "balls-drops", _metal(rng), _balls(rng, radii), grid, noise)


def rods_angles(rng: np.random.Generator) -> Rig:
    """One rod at four angles from two or three heights."""
    radius = float(rng.choice([4.5e-3, 6.35e-3, 8.8e-3]))
    length = float(rng.choice([0.15, 0.20, 0.30]))
    body = Striker(f"rod-{1e3 * length:.0f}", BEARING_STEEL, radius, radius, length)
    angles = [math.radians(a) for a in (20.0, 45.0, 70.0, 80.0)]
    speeds = np.round(np.geomspace(rng.uniform(0.8, 1.2), rng.uniform(2.0, 3.0), 3), 3)
    grid = _grid(1, angles, speeds[: rng.integers(2, 4)], 4)
    names = ("restitution", "permanent_depth_m", "sliding_length_m")
    return _rig(rng, "rods-angles", _metal(rng), (body,), grid, _noise(rng, *names))


def balls_heated(rng: np.random.Generator) -> Rig:
    """One ball on a flat at four temperatures."""
    r = float(rng.choice([4e-3, 6e-3, 9e-3]))
    target = _metal(rng)
    speeds = np.round(np.geomspace(rng.uniform(0.4, 0.6), rng.uniform(2.5, 4.0), 4), 3)
    hot = np.linspace(293.0, 0.55 * target.melting, 4).round()
    which, angle, speed = _grid(1, [0.5 * math.pi], speeds, 12)
    temperature = np.tile(np.repeat(hot, 3), len(speeds))
    noise = _noise(rng, "restitution", "permanent_depth_m")
    return _rig(
        rng, "balls-heated", target, (Striker(f"ball-{2e3 * r:g}", BEARING_STEEL, r, r),),
        (which, angle, speed), noise, temperature=temperature,
    )  # fmt: skip


def _metal(rng: np.random.Generator) -> Metal:
    return TARGETS[int(rng.integers(len(TARGETS)))]


BENCHES: dict[str, Callable[[np.random.Generator], Rig]] = {
    "rods-normal": rods_normal,
    "rods-oblique": rods_oblique,
    "balls-normal": balls_normal,
    "balls-oblique": balls_oblique,
    "balls-elastic": balls_elastic,
    "balls-small": balls_small,
    "balls-heated": balls_heated,
    "balls-drops": balls_drops,
    "rods-angles": rods_angles,
    "microspheres": microspheres,
}
"""By name; the first four are the common ones."""
