"""Write a concealed case as a recording set: only the files that a user would have."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from ....core.arrays import Array, Indices
from ...concealed import Metal, Striker
from .effects import order_of
from .rig import Rig
from .simulate import noise_std, observables, rows_of
from .truth import FAMILIES, Truth, readings_noise

# resolution of the instruments' displays
_LEAST = {
    "restitution": 1e-4, "permanent_depth_m": 1e-8, "contact_time_s": 1e-8, "peak_force_N": 0.1,
    "rebound_spin_rad_s": 1e-3, "friction_impulse_ratio": 1e-4, "sliding_length_m": 1e-7,
    "tangential_rebound_m_s": 1e-4,
}  # fmt: skip
_POSITIVE = {"contact_time_s", "peak_force_N"}
_SIGNED = {"rebound_spin_rad_s", "tangential_rebound_m_s"}
_RELEASE, _SPEED_READING = 0.01, 0.002


def write_set(truth: Truth, folder: Path, *, name: str) -> None:
    """Simulate a case of a family and write its recording set.

    `folder`: made if missing; receives set.toml and trials.csv; `name`: name of the set; says
    nothing about what it conceals.
    """
    rng = np.random.default_rng(truth.instrument.seed)
    rig = truth.rig
    n = len(rig)
    release = np.ones(n) if rig.drop else 1.0 + _RELEASE * rng.normal(size=n)
    scatter = 1.0 + _SPEED_READING * rng.normal(size=n)
    true_speed = release * scatter if rig.drop else release
    p = rows_of(rig, truth.effects, family=FAMILIES[truth.family], z=truth.z, speed=true_speed)
    clean = observables(rig, p)
    relaxed(clean, truth)
    stated_speed = rig.speed if rig.drop else rig.speed * release * scatter
    readings = read_off(rig, clean, truth, rng)
    write_files(truth, folder, name=name, speed=stated_speed, readings=readings)


def relaxed(clean: dict[str, Array], truth: Truth) -> None:
    """Leave out readings of impacts that have none: a striker that stuck does not rebound."""
    for name, column in clean.items():
        bad = ~np.isfinite(column)
        if name in _POSITIVE:
            bad |= column <= 0.0
        column[bad] = np.nan
    if "restitution" in clean:
        stuck = clean["restitution"] < 0.01
        for column in clean.values():
            column[stuck] = np.nan


def read_off(
    rig: Rig, clean: dict[str, Array], truth: Truth, rng: np.random.Generator
) -> dict[str, Array]:
    """Readings of the instrument: noise, outliers, resolution, missing cells; by column, (n,)."""
    instrument = truth.instrument
    std = noise_std(rig, clean)
    out: dict[str, Array] = {}
    for name, column in clean.items():
        n = len(column)
        noise = readings_noise(rng, instrument.shape, n)
        wild = rng.random(n) < instrument.outliers
        noise[wild] += rng.choice([-1.0, 1.0], size=n)[wild] * rng.uniform(5.0, 9.0, size=n)[wild]
        value = np.round((column + std[name] * noise) / _LEAST[name]) * _LEAST[name]
        if name not in _SIGNED:
            value = np.where(value > 0.0, value, np.nan)
        value[rng.random(n) < instrument.missing] = np.nan
        out[name] = value
    return out


def write_files(
    truth: Truth, folder: Path, *, name: str, speed: Array, readings: dict[str, Array]
) -> None:
    """Write set.toml and trials.csv.

    - `truth`: the case; only its bench and the stated values are written.
    - `folder`, `name`: where and under which name.
    - `speed`: (n,) normal speed as the sheet gives it [m/s].
    - `readings`: column to (n,) readings, NaN for an empty cell.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "set.toml").write_text(_setup_text(truth, name), encoding="utf-8")
    rig = truth.rig
    order = _order(truth)
    header = ["trial", "striker", "angle_deg"]
    oblique = any(s.length > 0.0 for s in rig.strikers)
    if oblique:
        header.append("angle_deg_std")
    header.append("drop_height_m" if rig.drop else "impact_speed_m_s")
    header += ["order", "approach_tangential_m_s"] if _spheres_oblique(rig) else ["order"]
    hot = bool(np.ptp(rig.temperature) > 0.0)
    header += ["temperature_K"] * hot + list(readings)
    by_time = np.argsort(order)
    with (folder / "trials.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        for number, i in enumerate(by_time):
            body = rig.strikers[rig.which[i]]
            cells = [f"t{number + 1:03d}", body.name, f"{math.degrees(rig.angle[i]):.6g}"]
            if oblique:
                cells.append(f"{math.degrees(rig.tolerance['angle']):g}")
            v = float(speed[i])
            cells.append(f"{v * v / (2.0 * 9.81):.6g}" if rig.drop else f"{v:.6g}")
            cells.append(str(number + 1))
            if _spheres_oblique(rig):
                cells.append(f"{rig.tangential[i] * v / rig.speed[i]:.6g}")
            if hot:
                cells.append(f"{rig.temperature[i]:g}")
            cells += ["" if np.isnan(c[i]) else f"{c[i]:.8g}" for c in readings.values()]
            writer.writerow(cells)


def _order(truth: Truth) -> Indices:
    for effect in truth.effects:
        if effect.name == "drift-with-order":
            return order_of(truth.rig, effect.numbers["seed"])
    return np.random.default_rng(truth.instrument.seed + 1).permutation(len(truth.rig))


def _spheres_oblique(rig: Rig) -> bool:
    return rig.bench == "balls-oblique"


def _quantity(value: float, relative: float) -> str:
    return f"{{ value = {value:.6g}, std = {abs(value) * relative:.3g} }}"


def _metal_lines(metal: Metal, tolerance: dict[str, float], *, strong: bool) -> list[str]:
    lines = [
        f'material = "{metal.name}"',
        f"E_Pa = {_quantity(metal.E, tolerance['modulus'])}",
        f"nu = {metal.nu:g}",
        f"density_kg_m3 = {metal.density:g}",
    ]
    if math.isfinite(metal.Sy):
        lines.append(f"Sy_Pa = {metal.Sy:g}" if strong else "")
        if not strong:
            lines[-1] = f"Sy_Pa = {_quantity(metal.Sy, tolerance['strength'])}"
    return lines


def _striker_lines(body: Striker, tolerance: dict[str, float], weighed: float) -> list[str]:
    rod = body.length > 0.0
    lines = [
        f"[strikers.{body.name}]" if "." not in body.name else f'[strikers."{body.name}"]',
        f'shape = "{"rod" if rod else "sphere"}"',
        f"tip_radius_m = {_quantity(body.tip_radius, tolerance['radius'])}",
        f"mass_kg = {_quantity(body.mass * weighed, tolerance['mass'])}",
    ]
    if rod:
        lines += [f"radius_m = {body.radius:.6g}", f"length_m = {body.length:.6g}"]
    return [*lines, *_metal_lines(body.metal, tolerance, strong=True), ""]


def _setup_text(truth: Truth, name: str) -> str:
    rig = truth.rig
    tolerance = rig.tolerance
    lines = [
        'format = "recording-set/1"', f'name = "{name}"',
        'description = "impacts of hard strikers on a flat, made by a generator"',
        'source = "generated for a blind test"', 'licence = "CC0-1.0"', "", "[target]",
        'shape = "flat"', *_metal_lines(rig.target, tolerance, strong=False),
    ]  # fmt: skip
    if rig.law != "elastic-plastic":
        lines.append(f'law = "{rig.law}"')
    if rig.bench == "balls-heated":
        lines += [f"cp_J_kgK = {rig.target.cp:g}", f"melting_K = {rig.target.melting:g}"]
    lines += [f"{key} = {_quantity(value, 0.01)}" for key, value in rig.told.items()]
    lines.append("")
    for body in rig.strikers:
        lines += _striker_lines(body, tolerance, truth.more.get("mass_factor", 1.0))
    lines += ["[friction]", f"coefficient = {_quantity(rig.mu, tolerance['friction'])}", ""]
    if rig.liquid:
        lines += ["[environment]", 'fluid = "oil"', f"viscosity_Pa_s = {rig.liquid:.3g}", ""]
    elif truth.instrument.seed % 3 == 0:
        lines += ["[environment]", 'fluid = "air"', "viscosity_Pa_s = 1.8e-5", ""]
    lines.append("[noise]")
    for column, (number, fraction) in rig.noise.items():
        lines.append(f"{column} = {number:.4g}")
        if fraction:
            lines.append(f"{column}_relative = {fraction:.4g}")
    speed = math.hypot(tolerance["speed"], _SPEED_READING)
    lines.append(f"impact_speed_relative = {speed:.4g}")
    return "\n".join(lines) + "\n"
