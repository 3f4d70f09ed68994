"""Chapter 3 again: the thesis's upright rod dropped on the thesis's flat, with our laws."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.inputs.toml_input import read_toml
from ...core.material import Material
from ...core.output import figure, write_figure
from ...dynamics.integrate import strike
from ...dynamics.result import Impact
from ...dynamics.scene import Approach, Scene, Striker, scene_of
from ...models.base import ContactLaw

REFERENCE = Path(__file__).resolve().parents[2] / "data" / "reference"


@dataclass(frozen=True, slots=True)
class Bench:
    """The rod, the flat and the measured values of chapter 3."""

    sphere: Material
    flat: Material
    striker: Striker
    mass_that_fits: float
    heights: tuple[float, float]
    measured: tuple[Mapping[str, Any], ...]
    thesis: Mapping[str, float]
    density: float

    def scene(self, law: ContactLaw, *, height: float, mass: float) -> Scene:
        """Return the drop from `height` [m] with the rod's mass replaced [kg]."""
        rod = Striker(
            mass=mass,
            tip_radius=self.striker.tip_radius,
            length=self.striker.length,
            radius=self.striker.radius,
        )
        return scene_of(
            law,
            sphere=self.sphere,
            flat=self.flat,
            striker=rod,
            approach=Approach.dropped(height),
        )


@dataclass(frozen=True, slots=True)
class Curve:
    """Impacts of one law and one mass over the drop heights."""

    law: ContactLaw
    mass: float
    heights: Array
    impacts: tuple[Impact, ...]


def bench() -> Bench:
    """Read chapter 3's inputs and measured values."""
    data = read_toml(REFERENCE / "chapter3.toml")
    rod, flat, nu = data["rod"], data["flat"], data["assumed"]["nu"]
    density = data["assumed"]["steel_density_kg_m3"]
    return Bench(
        Material(rod["E_Pa"], nu, rod["Sy_Pa"], density=density, name=rod["material"]),
        Material(flat["E_Pa"], nu, flat["Sy_Pa"], density=density, name=flat["material"]),
        Striker(
            mass=rod["mass_kg"],
            tip_radius=rod["tip_radius_m"],
            length=rod["length_m"],
            radius=0.5 * rod["diameter_m"],
        ),
        data["mass_that_fits"]["value_kg"],
        (data["heights"]["first_m"], data["heights"]["last_m"]),
        tuple(data["measured"]),
        data["simulated_by_thesis"],
        density,
    )


def curves(
    found: Bench, laws: Sequence[ContactLaw], *, masses: Sequence[float], count: int = 9
) -> list[Curve]:
    """Drop the rod from `count` heights for each law and each mass."""
    heights = np.unique(
        np.concatenate(
            [
                np.linspace(*found.heights, count),
                [row["drop_height_m"] for row in found.measured],
            ]
        )
    )
    return [
        Curve(
            law,
            mass,
            heights,
            tuple(strike(found.scene(law, height=float(h), mass=mass)) for h in heights),
        )
        for mass in masses
        for law in laws
    ]


def contradictions(found: Bench) -> list[str]:
    """Return what the stated inputs of chapter 3 contradict, one line each with its number."""
    rod, thesis = found.striker, found.thesis
    area = math.pi * rod.radius**2
    geometric = found.density * area * rod.length
    top = Approach.dropped(thesis["drop_height_m"]).speed
    energy = 0.5 * rod.mass * top**2
    work = 0.4 * thesis["peak_force_N"] * thesis["peak_depth_m"]
    strength = found.sphere.Sy * area
    speed = math.sqrt(found.sphere.E / found.density)
    wave = found.density * speed * area * top
    edge = rod.radius**2 / (2.0 * rod.tip_radius)
    reach = math.sqrt(rod.tip_radius * thesis["peak_depth_m"])
    dents = {
        row["drop_height_m"]: 2.84 * found.flat.Sy * math.pi * rod.tip_radius * row["value"] ** 2
        for row in found.measured
        if row["observable"] == "residual_depth"
    }
    lines = [
        f"mass: {rod.mass:g} kg is stated, the stated diameter and length of steel weigh "
        f"{geometric:.3f} kg",
        f"energy: {energy:.2f} J at {thesis['drop_height_m']:g} m cannot do the {work:.1f} J "
        f"of work under a 3/2-power curve through {thesis['peak_force_N'] / 1e3:.2f} kN at "
        f"{thesis['peak_depth_m'] * 1e6:.0f} um; {found.mass_that_fits:g} kg can, and is shown too",
        *(
            f"dent: {value * 1e6:.0f} um takes about {dents[h]:.2f} J (2.84 Sy times the cap), the "
            f"drop of {h:g} m brings {rod.mass * 9.81 * h:.2f} J"
            for h, value in (
                (row["drop_height_m"], row["value"])
                for row in found.measured
                if row["observable"] == "residual_depth"
            )
        ),
        f"edge: the contact radius at {thesis['peak_depth_m'] * 1e6:.0f} um is "
        f"{reach * 1e3:.2f} mm by Hertz, the rod's own radius "
        f"{rod.radius * 1e3:g} mm (the cap is {edge * 1e6:.0f} um high there)",
        f"tip radius: {rod.tip_radius * 1e3:g} mm was read from a sag of 22 um on a photograph "
        "with 24.7 um per pixel",
        f"force: {thesis['peak_force_N'] / 1e3:.1f} kN is {thesis['peak_force_N'] / strength:.1f} "
        f"times the rod's yield force and {thesis['peak_force_N'] / wave:.1f} times what a wave in "
        f"it can carry, rho c v A = {wave / 1e3:.1f} kN",
        f"duration: a rigid rod is in contact for about half of the wave's round trip, "
        f"{2e3 * rod.length / speed:.3f} ms",
    ]
    return lines


def deviation(curve: Curve, measured: Mapping[str, Any]) -> tuple[float, float]:
    """Return our value at a measured height and its relative deviation."""
    place = int(np.argmin(np.abs(curve.heights - measured["drop_height_m"])))
    impact = curve.impacts[place]
    ours = impact.restitution if measured["observable"] == "restitution" else impact.residual_flat_m
    return ours, ours / measured["value"] - 1.0


def draw_chapter3(found: Bench, curves: Sequence[Curve], path: Path) -> None:
    """Restitution and residual depth against drop height (figures 3.11 and 3.12)."""
    made, axes = figure(1, 2, size=(11.0, 4.6))
    panels = (("restitution", "restitution", 1.0), ("residual_depth", "residual depth [um]", 1e6))
    styles = dict(zip(sorted({c.mass for c in curves}), ("-", "--", ":", "-."), strict=False))
    names = list(dict.fromkeys(c.law.name for c in curves))
    for axis, (key, label, factor) in zip(axes[0], panels, strict=True):
        for curve in curves:
            y = [
                i.restitution if key == "restitution" else i.residual_flat_m for i in curve.impacts
            ]
            axis.plot(
                curve.heights, factor * np.array(y), styles[curve.mass],
                color=f"C{names.index(curve.law.name)}",
                label=f"{curve.law.name}, {curve.mass:g} kg",
            )  # fmt: skip
        for row in found.measured:
            if row["observable"] == key:
                axis.plot(row["drop_height_m"], factor * row["value"], "kx", ms=9, mew=2)
        axis.set(xlabel="drop height [m]", ylabel=label, ylim=(0.0, None))
        axis.grid(alpha=0.3)
    axes[0, 1].legend(fontsize=7, ncols=2, title="crosses: measured", title_fontsize=7)
    write_figure(made, path, dpi=130)
