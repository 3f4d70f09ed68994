"""Write a concealed set as the folder that a user has: set.toml, trials.csv, a curve."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from ...core.arrays import Array, Indices
from ..concealed import Metal
from .benches import TOLERANCE, Rig
from .draw import Truth, readings

_RELEASE, _SPEED = 0.012, 0.003
"""Scatter of the release, and of the speed's reading; fractions."""

_HEIGHT = 0.008
"""Error of a height, which all its trials share, as a fraction."""

_SIGNED = {"rebound_spin_rad_s", "tangential_rebound_m_s"}
_SHAPES = ("gaussian", "laplace", "flat", "lognormal")


def write(truth: Truth, folder: Path, *, name: str) -> None:
    """Make the recordings of a set.

    Parameters
    ----------
    truth
        The set.
    folder, name
        Where and under which name; neither says what it conceals.
    """
    rng, rig = np.random.default_rng(truth.seed), truth.rig
    n = len(rig.which)
    if rig.heights:
        steps, group = np.unique(rig.speed, return_inverse=True)
        release = (1.0 + 0.5 * _HEIGHT * rng.normal(size=len(steps)))[group]
        stated = rig.speed
    else:
        release = 1.0 + _RELEASE * rng.normal(size=n)
        stated = rig.speed * release * (1.0 + _SPEED * rng.normal(size=n))
    clean = readings(rig, truth.law, truth.z, truth.effects, release)
    read = {k: _read(rng, rig, k, column) for k, column in clean.items()}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "set.toml").write_text(_sheet(rig, name), encoding="utf-8")
    if rig.curve is not None:
        rows = [f"{e:.5g},{s * rig.flat.Sy:.6g}" for e, s in rig.curve.T]
        text = "\n".join(["plastic_strain,true_stress_Pa", *rows]) + "\n"
        (folder / "curve.csv").write_text(text, encoding="utf-8")
    _trials(rig, folder / "trials.csv", stated, read, _order(truth, rng))


def _read(rng: np.random.Generator, rig: Rig, name: str, column: Array) -> Array:
    """Readings with noise of some shape, a gauge's error, outliers and empty cells."""
    n = len(column)
    number, fraction = rig.noise[name]
    shape = str(rng.choice(_SHAPES))
    noise = {
        "gaussian": rng.normal(size=n), "laplace": rng.laplace(size=n) / math.sqrt(2.0),
        "flat": rng.uniform(-math.sqrt(3.0), math.sqrt(3.0), n),
        "lognormal": (np.exp(0.5 * rng.normal(size=n)) - math.exp(0.125)) / 0.604,
    }[shape]  # fmt: skip
    noise = noise * rng.uniform(0.85, 1.15)  # a stated noise is an estimate
    wild = rng.random(n) < 0.01
    noise = np.where(wild, noise + rng.choice([-1.0, 1.0], n) * rng.uniform(5.0, 9.0, n), noise)
    scale = 1.0 + rig.gauge.get(name, 0.0) * float(np.clip(rng.normal(), -2.0, 2.0))
    value = column * scale + np.hypot(number, fraction * column) * noise
    if name not in _SIGNED:
        value = np.where(value > 0.0, value, np.nan)
    return np.where(rng.random(n) < 0.02, np.nan, value)


def _order(truth: Truth, rng: np.random.Generator) -> Indices:
    """Place of each trial in the order of testing, from 0."""
    for effect in truth.effects:
        if effect.name == "drift-with-order":
            return np.random.default_rng(int(effect.numbers["seed"])).permutation(
                len(truth.rig.which)
            )
    return rng.permutation(len(truth.rig.which))


def _trials(rig: Rig, path: Path, speed: Array, read: dict[str, Array], order: Indices) -> None:
    pressed, hot = bool(np.any(rig.load > 0.0)), bool(np.ptp(rig.temperature) > 0.0)
    aslant = rig.oblique and not rig.rods
    head = ["trial", "striker", "angle_deg", "order"]
    head += ["angle_deg_std"] * rig.rods + ["drop_height_m", "drop_height_m_std"] * rig.heights
    head += ["impact_speed_m_s"] * (not rig.heights) + ["approach_tangential_m_s"] * aslant
    head += ["temperature_K"] * hot + ["load_N"] * pressed + list(read)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(head)
        for place, i in enumerate(np.argsort(order)):
            v, press = float(speed[i]), rig.load[i] > 0.0
            cells = [f"t{place + 1:03d}", rig.strikers[rig.which[i]].name,
                     f"{math.degrees(rig.angle[i]):g}", str(place + 1)]  # fmt: skip
            cells += [f"{math.degrees(TOLERANCE['angle']):.3g}"] * rig.rods
            height = v * v / (2.0 * 9.81)
            if rig.heights:
                cells += [f"{height:.5g}", f"{_HEIGHT * height:.3g}"]
            else:
                cells.append("" if press else f"{v:.6g}")
            cells += [f"{-v / math.tan(rig.angle[i]):.6g}"] * aslant
            cells += [f"{rig.temperature[i]:g}"] * hot
            cells += [f"{rig.load[i]:g}" if press else ""] * pressed
            cells += ["" if np.isnan(c[i]) else f"{c[i]:.6g}" for c in read.values()]
            writer.writerow(cells)


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
        lines.append(f"impact_speed_relative = {math.hypot(TOLERANCE['speed'], _SPEED):.4g}")
    if rig.gauge:
        lines += ["", "[gauge]", *(f"{k} = {v:g}" for k, v in rig.gauge.items())]
    return "\n".join(lines) + "\n"
