"""What traces alone add to detection.

    .venv/bin/python tools/benchmarks/bench_traces.py

Sixteen impacts of two steel balls (8 and 18 mm, 0.4 to 3.2 m/s) on mild steel, recorded by 40
samples a contact of the tip's height (0.5 um), with and without the force (1 %), and by nothing
else. Printed for each: the smallest rise of the strength at a rate of 1000/s that would have been
seen, and what is said when the contact is damped by 0.06 s/m.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from dentscope.core import Material
from dentscope.discrepancy import Verdict, diagnose
from dentscope.dynamics import Approach, ForceTransform, Striker, scene_of, traced
from dentscope.models import LAWS
from dentscope.recordings import read

BALL, FLAT = Material(E=208e9, nu=0.3, Sy=2e9), Material(E=206e9, nu=0.29, Sy=3e8)
RADII, SPEEDS = (4e-3, 9e-3), np.geomspace(0.4, 3.2, 8)
SAMPLES, HEIGHT, FORCE = 40, 5e-7, 0.01


def write_set(folder: Path, *, force: bool, damping: float) -> None:
    """Write a set of traces only, made with the baseline's law."""
    (folder / "traces").mkdir(parents=True)
    rng = np.random.default_rng(1)
    rows, strikers = ["trial,striker,angle_deg,impact_speed_m_s"], []
    for r in RADII:
        name, mass = f"ball-{2e3 * r:g}", 7830.0 * 4.0 / 3.0 * np.pi * r**3
        strikers.append(
            f'[strikers.{name}]\nshape = "sphere"\n'
            f"tip_radius_m = {{ value = {r}, std = {0.01 * r} }}\n"
            f"mass_kg = {mass:.6g}\nE_Pa = 2.08e11\nnu = 0.3\nSy_Pa = 2e9\n"
        )
        for v in SPEEDS:
            scene = scene_of(
                LAWS["fitted"], sphere=BALL, flat=FLAT, approach=Approach(float(v)),
                striker=Striker(mass=float(mass), tip_radius=r),
            ).with_(force=ForceTransform(damping=damping))  # fmt: skip
            impact = traced(scene, points=400)
            T, e = impact.impact.contact_time_s, impact.impact.restitution
            t, first = np.unique(impact.column("time_s"), return_index=True)
            grid = np.arange(-T, 2.0 * T, T / SAMPLES) + 0.03 * T
            tip = np.interp(grid, t, impact.column("tip_height_m")[first])
            height = np.where(grid < 0.0, -v * grid, tip)
            parted = impact.column("tip_height_m")[first][-1]
            height = np.where(grid > T, parted + e * v * (grid - T), height)
            columns = [grid, height + HEIGHT * rng.standard_normal(len(grid))]
            if force:
                F = np.interp(grid, t, impact.column("normal_force_N")[first], left=0.0, right=0.0)
                columns.append(F + FORCE * F.max() * rng.standard_normal(len(grid)))
            name_of_trial = f"t{len(rows)}"
            head = "time_s,tip_height_m" + (",force_N" if force else "")
            lines = [",".join(f"{x:.9g}" for x in row) for row in zip(*columns, strict=True)]
            (folder / "traces" / f"{name_of_trial}.csv").write_text(
                "\n".join([head, *lines]) + "\n"
            )
            rows.append(f"{name_of_trial},{name},90,{v:.6g}")
    (folder / "trials.csv").write_text("\n".join(rows) + "\n")
    noise = f"[noise]\ntip_height_m = {HEIGHT}\n" + (
        f"force_N_relative = {FORCE}\n" if force else ""
    )
    (folder / "set.toml").write_text(
        'format = "recording-set/1"\n[target]\nshape = "flat"\nE_Pa = 2.06e11\nnu = 0.29\n'
        "Sy_Pa = { value = 3e8, std = 1.2e7 }\n" + "".join(strikers) + noise
    )


def said(*, force: bool, damping: float) -> Verdict:
    """Write a set and diagnose it."""
    with tempfile.TemporaryDirectory() as place:
        write_set(Path(place) / "set", force=force, damping=damping)
        return diagnose(read(Path(place) / "set"))


for with_force in (False, True):
    plain, damped = said(force=with_force, damping=0.0), said(force=with_force, damping=0.06)
    limit = plain.limits.get("strain-rate-hardening", float("nan"))
    found = damped.parameters.get("damping_s_m", {}).get("value", float("nan"))
    recorded = "height and force" if with_force else "height"
    sys.stdout.write(
        f"{recorded}: plain {plain.verdict}, smallest rise at 1000/s {limit:.2f}; damped by "
        f"0.06 s/m: {damped.verdict} {', '.join(damped.mechanisms)} {found:.3f} s/m\n"
    )
