"""Concealed sets from the library of finite-element impacts: interpolated, misstated, read off."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np

from ....core.arrays import Array
from ...concealed import Striker
from ..generators.effects import EFFECTS, Effect
from ..generators.folder import read_off, write_files
from ..generators.parameters import FOUNDATION
from ..generators.rig import Rig
from ..generators.simulate import Visibility, noise_std
from ..generators.truth import Truth, draw_instrument, draw_nuisances
from .catalogue import FILE, SERIES, Series, impacts

_READ = ("restitution", "permanent_depth_m", "contact_time_s", "peak_force_N")
_REPEATS = 4
_MOST_COLUMNS = {"restitution": (0.002, 0.010), "permanent_depth_m": (0.2e-6, 0.012),
                 "contact_time_s": (0.2e-6, 0.010), "peak_force_N": (5.0, 0.015)}  # fmt: skip


def available(path: Path = FILE) -> tuple[Series, ...]:
    """Series whose impacts are all in the library and parted in time."""
    if not path.exists():
        return ()
    with h5py.File(path, "r") as store:
        have = {key for key in store if store[key].attrs["parted"] == 1.0}
    lacking = {series.name for series, _, _, key in impacts() if key not in have}
    return tuple(series for series in SERIES if series.name not in lacking)


def draw_explicit(rng: np.random.Generator, series: Series) -> Truth:
    """Draw nuisances and instrument for one series.

    The impacts are as computed; with nuisances, it is the sheet that states other values.
    """
    z = draw_nuisances(rng) if rng.random() < 0.5 else {}
    instrument = draw_instrument(rng)
    quality = float(rng.uniform(0.7, 1.3))
    noise = {name: (a * quality, b * quality) for name, (a, b) in _MOST_COLUMNS.items()}
    rig = _rig(series, noise)
    effects = tuple(
        Effect(name, "meshed", dict(numbers), False) for name, numbers in series.effects.items()
    )
    sizes = _sizes(series, rig) if series.kind in ("single", "outside") else ()
    more = {"series": series.name}
    return Truth(series.kind, rig, effects, sizes, "explicit", z, instrument, more)


def write_explicit(truth: Truth, folder: Path, *, name: str) -> None:
    """Write the recording set of a truth of this family."""
    series = next(s for s in SERIES if s.name == truth.more["series"])
    rng = np.random.default_rng(truth.instrument.seed)
    rig = truth.rig
    n = len(rig)
    release = 1.0 + 0.01 * rng.normal(size=n)
    clean = readings_at(series, rig, rig.speed * release)
    readings = read_off(rig, clean, truth, rng)
    off = {k: 1.0 / (1.0 + rig.tolerance[k] * truth.z.get(k, 0.0)) for k in rig.tolerance}
    stated = replace(truth, rig=_misstated(rig, off))
    speed = rig.speed * release * (1.0 + 0.002 * rng.normal(size=n)) * off["speed"]
    write_files(stated, folder, name=name, speed=speed, readings=readings)


def readings_at(series: Series, rig: Rig, speed: Array) -> dict[str, Array]:
    """What a perfect instrument reads at these speeds, by column, (n,).

    The logarithm of each reading is interpolated over that of the speed by a parabola through the
    nearest three computed impacts.
    """
    table = _table(series)
    out = {name: np.zeros(len(speed)) for name in _READ}
    for i, number in enumerate(rig.which):
        speeds, values = table[rig.strikers[number].name]
        x: Array = np.log(speeds)
        at = math.log(speed[i])
        first = int(np.clip(np.argmin(np.abs(x - at)) - 1, 0, len(x) - 3))
        pick = slice(first, first + 3)
        for k, name in enumerate(_READ):
            line = np.polyfit(x[pick], np.log(values[pick, k]), 2)
            out[name][i] = math.exp(float(np.polyval(line, at)))
    return out


def _table(series: Series) -> dict[str, tuple[Array, Array]]:
    found: dict[str, tuple[list[float], list[list[float]]]] = {}
    with h5py.File(FILE, "r") as store:
        for other, striker, speed, key in impacts():
            if other.name == series.name:
                speeds, values = found.setdefault(striker.name, ([], []))
                speeds.append(speed)
                values.append([float(store[key].attrs[name]) for name in _READ])
    return {name: (np.array(s), np.array(v)) for name, (s, v) in found.items()}


def _mass(series: Series, striker: Striker) -> float:
    with h5py.File(FILE, "r") as store:
        for other, body, _, key in impacts():
            if other.name == series.name and body.name == striker.name:
                return float(store[key].attrs["mass_kg"])
    raise KeyError(striker.name)


def _rig(series: Series, noise: dict[str, tuple[float, float]]) -> Rig:
    # the length of a cylinder of the bar's mass, so that mass and size agree on the sheet
    bodies = tuple(
        replace(s, length=_mass(series, s) / (s.metal.density * math.pi * s.radius**2))
        for s in series.strikers
    )
    rows = [(k, v) for k in range(len(bodies)) for v in series.speeds for _ in range(_REPEATS)]
    n = len(rows)
    return Rig(
        bench="explicit", target=series.target, strikers=bodies,
        which=np.array([k for k, _ in rows], dtype=np.intp),
        angle=np.full(n, 0.5 * math.pi), speed=np.array([v for _, v in rows]),
        tangential=np.zeros(n), temperature=np.full(n, 295.0), mu=0.15,
        tolerance={
            "strength": 0.04, "modulus": 0.015, "radius": 0.01, "mass": 0.003, "friction": 0.10,
            "speed": 0.004, "angle": math.radians(0.5),
        },
        noise=noise,
    )  # fmt: skip


def _misstated(rig: Rig, off: dict[str, float]) -> Rig:
    target = replace(
        rig.target, Sy=rig.target.Sy * off["strength"], E=rig.target.E * off["modulus"]
    )
    bodies = tuple(
        replace(
            s,
            tip_radius=s.tip_radius * off["radius"],
            metal=replace(
                s.metal, E=s.metal.E * off["modulus"], density=s.metal.density * off["mass"]
            ),
        )
        for s in rig.strikers
    )
    return replace(rig, target=target, strikers=bodies)


def _sizes(series: Series, rig: Rig) -> tuple[float, ...]:
    """Size against the null series on the same strikers and metal, where there is one; else NaN.

    What the nuisances and another metal would change is that of a fast family on the same rig.
    """
    same = [
        s for s in SERIES
        if s.kind == "null" and s.target == series.target and s.strikers == series.strikers
    ]  # fmt: skip
    if not same:
        return tuple(math.nan for _ in series.effects)
    seen = Visibility.of(rig, family=FOUNDATION, z={})
    few = seen.rig
    with_it, without = (readings_at(s, few, few.speed) for s in (series, same[0]))
    std = noise_std(few, without)
    change = [(with_it[k] - without[k]) / std[k] for k in few.noise]
    return (seen.size(math.sqrt(_REPEATS) * np.concatenate(change)),)


assert all(set(s.effects) <= set(EFFECTS) or s.kind == "outside" for s in SERIES)
