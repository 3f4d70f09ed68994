"""Write a concealed set as the folder that a user has: set.toml, trials.csv, a curve."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array, Indices
from ..concealed import Metal
from .benches import TOLERANCE, Rig
from .draw import Truth, readings

RELEASE, SPEED = 0.012, 0.003
"""Scatter of the release, and of the speed's reading; fractions."""

HEIGHT = 0.008
"""Error of a height, which all its trials share, as a fraction."""

SIGNED = {"rebound_spin_rad_s", "tangential_rebound_m_s"}
_SHAPES = ("gaussian", "laplace", "flat", "lognormal")


def write(truth: Truth, folder: Path, *, name: str) -> None:
    """Make the recordings of a set.

    `folder`, `name`: where and under which name; neither says what it conceals.
    """
    rig, n = truth.rig, len(truth.rig.which)
    rng, settings = released(truth)
    clean = readings(rig, truth.law, truth.z, truth.effects, settings.release)
    read = {k: seen(*drawn(rng, rig, k, n), rig.noise[k], column) for k, column in clean.items()}
    read = {k: x if k in SIGNED else np.where(x > 0.0, x, np.nan) for k, x in read.items()}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "set.toml").write_text(_sheet(rig, name), encoding="utf-8")
    if rig.curve is not None:
        rows = [f"{e:.5g},{s * rig.flat.Sy:.6g}" for e, s in rig.curve.T]
        text = "\n".join(["plastic_strain,true_stress_Pa", *rows]) + "\n"
        (folder / "curve.csv").write_text(text, encoding="utf-8")
    tested = np.argsort(_order(truth, rng))
    with (folder / "trials.csv").open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, lineterminator="\n").writerows(
            table(rig, settings.stated, read, tested, first=1)
        )


class Settings(NamedTuple):
    """Factor on each trial's speed, and the speed that is stated, (n,) each."""

    release: Array
    stated: Array


class Instrument(NamedTuple):
    """What reads a column: shape of its noise, that over what is stated, scale."""

    shape: str
    spread: float
    scale: float


def released(truth: Truth) -> tuple[np.random.Generator, Settings]:
    """Return how the trials of a set were released, and what draws its readings after that."""
    rng, rig = np.random.default_rng(truth.seed), truth.rig
    n = len(rig.which)
    if rig.heights:
        steps, group = np.unique(rig.speed, return_inverse=True)
        return rng, Settings((1.0 + 0.5 * HEIGHT * rng.normal(size=len(steps)))[group], rig.speed)
    release = 1.0 + RELEASE * rng.normal(size=n)
    return rng, Settings(release, rig.speed * release * (1.0 + SPEED * rng.normal(size=n)))


def drawn(rng: np.random.Generator, rig: Rig, name: str, n: int) -> tuple[Instrument, Array]:
    """Return a column's instrument and its noise (n,): of some shape, wild ones, NaN where lost."""
    shape = str(rng.choice(_SHAPES))
    noise = noise_of(rng, n)[shape]
    spread = float(rng.uniform(0.85, 1.15))  # a stated noise is an estimate
    noise = noise * spread
    wild = rng.random(n) < 0.01
    noise = np.where(wild, noise + rng.choice([-1.0, 1.0], n) * rng.uniform(5.0, 9.0, n), noise)
    scale = 1.0 + rig.gauge.get(name, 0.0) * float(np.clip(rng.normal(), -2.0, 2.0))
    return Instrument(shape, spread, scale), np.where(rng.random(n) < 0.02, np.nan, noise)


def noise_of(rng: np.random.Generator, n: int) -> dict[str, Array]:
    """Noise (n,) of every shape, of unit deviation."""
    return {
        "gaussian": rng.normal(size=n), "laplace": rng.laplace(size=n) / math.sqrt(2.0),
        "flat": rng.uniform(-math.sqrt(3.0), math.sqrt(3.0), n),
        "lognormal": (np.exp(0.5 * rng.normal(size=n)) - math.exp(0.125)) / 0.604,
    }  # fmt: skip


def seen(by: Instrument, noise: Array, error: tuple[float, float], column: Array) -> Array:
    """Return what is read of a column (n,), with its error as stated: a number and a fraction."""
    return np.asarray(column * by.scale + np.hypot(error[0], error[1] * column) * noise)


def _order(truth: Truth, rng: np.random.Generator) -> Indices:
    """Place of each trial in the order of testing, from 0."""
    for effect in truth.effects:
        if effect.name == "drift-with-order":
            return np.random.default_rng(int(effect.numbers["seed"])).permutation(
                len(truth.rig.which)
            )
    return rng.permutation(len(truth.rig.which))


def table(
    rig: Rig, speed: Array, read: dict[str, Array], rows: Indices, *, first: int
) -> list[list[str]]:
    """Return trials.csv with its header.

    `rig`: its settings, n of them; `speed`, `read`: (n,) as stated, and as read by column; `rows`:
    which, in the order of testing; `first`: number of the first.
    """
    pressed, hot = bool(np.any(rig.load > 0.0)), bool(np.ptp(rig.temperature) > 0.0)
    aslant = rig.oblique and not rig.rods
    head = ["trial", "striker", "angle_deg", "order"]
    head += ["angle_deg_std"] * rig.rods + ["drop_height_m", "drop_height_m_std"] * rig.heights
    head += ["impact_speed_m_s"] * (not rig.heights) + ["approach_tangential_m_s"] * aslant
    head += ["temperature_K"] * hot + ["load_N"] * pressed + list(read)
    found = [head]
    for place, i in enumerate(rows, start=first):
        v, press = float(speed[i]), rig.load[i] > 0.0
        cells = [f"t{place:03d}", rig.strikers[rig.which[i]].name,
                 f"{math.degrees(rig.angle[i]):g}", str(place)]  # fmt: skip
        cells += [f"{math.degrees(TOLERANCE['angle']):.3g}"] * rig.rods
        height = v * v / (2.0 * 9.81)
        struck = [f"{height:.5g}", f"{HEIGHT * height:.3g}"] if rig.heights else [f"{v:.6g}"]
        struck += [f"{-v / math.tan(rig.angle[i]):.6g}"] * aslant
        cells += [""] * len(struck) if press else struck
        cells += [f"{rig.temperature[i]:g}"] * hot
        cells += [f"{rig.load[i]:g}" if press else ""] * pressed
        cells += ["" if np.isnan(c[i]) else f"{c[i]:.6g}" for c in read.values()]
        found.append(cells)
    return found


def _about(value: float, fraction: float) -> str:
    return f"{{ value = {value:.6g}, std = {abs(value) * fraction:.3g} }}"


def _metal(metal: Metal, *, known: float) -> list[str]:
    lines = [f'material = "{metal.name}"', f"E_Pa = {_about(metal.E, TOLERANCE['modulus'])}",
             f"nu = {metal.nu:g}", f"density_kg_m3 = {metal.density:g}"]  # fmt: skip
    return lines + [f"Sy_Pa = {_about(metal.Sy, known)}"] * math.isfinite(metal.Sy)


def _sheet(rig: Rig, name: str) -> str:
    lines = [
        'format = "recording-set/1"', f'name = "{name}"',
        'description = "hard strikers on a flat, made by a generator"',
        'source = "generated for a blind test"', 'licence = "CC0-1.0"', "", "[target]",
        'shape = "flat"', *_metal(rig.flat, known=TOLERANCE["strength"]),
    ]  # fmt: skip
    lines += ['law = "elastic"'] * math.isinf(rig.flat.Sy)
    if rig.bench == "heated":
        lines += [f"cp_J_kgK = {rig.flat.cp:g}", f"melting_K = {rig.flat.melting:g}"]
    lines += ['flow_curve = "curve.csv"'] * (rig.curve is not None)
    lines += [f"{key} = {_about(value, 0.01)}" for key, value in rig.told.items()] + [""]
    for body in rig.strikers:
        lines += [
            f'[strikers."{body.name}"]', f'shape = "{"rod" if body.length else "sphere"}"',
            f"tip_radius_m = {_about(body.tip_radius, TOLERANCE['tip'])}",
            f"mass_kg = {_about(body.mass, TOLERANCE['mass'])}", *_metal(body.metal, known=0.05),
        ]  # fmt: skip
        if body.length:
            lines += [f"radius_m = {body.radius:g}", f"length_m = {body.length:g}"]
        lines.append("")
    lines += ["[friction]", f"coefficient = {_about(rig.mu, TOLERANCE['friction'])}", ""]
    if rig.fluid:
        lines += ["[environment]", 'fluid = "oil"', f"viscosity_Pa_s = {rig.fluid:.3g}", ""]
    lines.append("[noise]")
    for column, (number, fraction) in rig.noise.items():
        lines.append(f"{column} = {number:.4g}")
        lines += [f"{column}_relative = {fraction:.4g}"] * (fraction > 0.0)
    if not rig.heights:
        lines.append(f"impact_speed_relative = {math.hypot(TOLERANCE['speed'], SPEED):.4g}")
    if rig.gauge:
        lines += ["", "[gauge]", *(f"{k} = {v:g}" for k, v in rig.gauge.items())]
    return "\n".join(lines) + "\n"
