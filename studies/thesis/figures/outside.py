"""Restitution against speed beside LAMMPS's MDR law, which was made elsewhere on other grounds.

A ball that yields strikes a rigid flat. The numbers of `data/reference/mdr.toml` come from
`run_mdr`, which needs the packages lammps and mpich; the figure itself does not.

MDR: Zunker and Kamrin, J. Mech. Phys. Solids 183 (2024); in LAMMPS `pair_style granular`, normal
model mdr, without adhesion and without damping.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ....campaigns import CaseRecord
from ....core.arrays import Array
from ....core.inputs.toml_input import read_toml
from ....core.material import Material
from ....dynamics.integrate import strike
from ....dynamics.scene import Approach, Striker, scene_of
from ....models.base import ContactLaw
from ...lammps import balls_on_floor, elastic_plastic
from ...plot import Picture, finish, laws, look, sheet
from ..chapter3 import REFERENCE

_STEPS_PER_RISE = 2000  # time steps while the ball comes to rest
_RIGID = Material(E=math.nan, nu=math.nan, rigid=True)


def run_mdr(
    speed: float, *, E: float, nu: float, Sy: float, radius: float, density: float
) -> float:
    """Restitution of a ball on a rigid flat at `speed` [m/s] by LAMMPS's MDR law.

    Raises
    ------
    ImportError
        lammps (or the MPI library that it wants) is not installed.
    """
    mass = 4.0 / 3.0 * math.pi * radius**3 * density
    stiff = E / (1.0 - nu**2) * math.sqrt(radius)
    depth = (15.0 * mass * speed**2 / (16.0 * stiff)) ** 0.4
    solver = balls_on_floor(
        elastic_plastic(E, nu, Sy), radius=radius, density=density, speeds=[speed],
        timestep=depth / speed / _STEPS_PER_RISE,
    )  # fmt: skip
    last = -speed
    for _ in range(400):
        solver.command("run 100 post no")
        now = float(solver.numpy.extract_atom("v")[0][2])
        if now > 0.0 and now == last:  # no force any more
            return now / speed
        last = now
    return math.nan


def reference() -> dict[str, Any]:
    """Content of data/reference/mdr.toml: the ball, and restitution at each speed."""
    return read_toml(REFERENCE / "mdr.toml")


def restitutions(law: ContactLaw, data: dict[str, Any]) -> Array:
    """Restitution of one of our laws for the same ball at the same speeds."""
    ball, R = data["ball"], data["ball"]["radius_m"]
    body = Material(E=ball["E_Pa"], nu=ball["nu"], Sy=ball["Sy_Pa"], density=ball["density_kg_m3"])
    mass = 4.0 / 3.0 * math.pi * R**3 * ball["density_kg_m3"]
    return np.array(
        [
            strike(
                scene_of(
                    law, sphere=body, flat=_RIGID, striker=Striker(mass=mass, tip_radius=R),
                    approach=Approach(float(v)), gravity=0.0,
                )
            ).restitution
            for v in data["mdr"]["speed_m_s"]
        ]
    )  # fmt: skip


def slope(speeds: Array, e: Array) -> float:
    """Exponent of e ~ v^n over the last decade of the speeds."""
    keep = speeds >= 0.1 * speeds[-1]
    return float(np.polyfit(np.log(speeds[keep]), np.log(e[keep]), 1)[0])


def pictures(records: Sequence[CaseRecord]) -> list[Picture]:
    """One figure: e over v of our laws and of MDR, with the slopes."""
    data = reference()
    v, e = (np.array(data["mdr"][k]) for k in ("speed_m_s", "restitution"))
    made, (axis,) = sheet()
    told, off = [f"MDR {slope(v, e):.2f}"], np.zeros(0)
    for law in laws("fitted", "jackson-green", "kogut-etsion", "thornton", "stronge", "ghaednia"):
        ours = restitutions(law, data)
        axis.loglog(v, ours, **look(law))
        told.append(f"{law.name} {slope(v, ours):.2f}")
        if law.name == "fitted":
            off = ours / e - 1.0
    axis.loglog(v, e, "ko", ms=5, label="MDR (LAMMPS)")
    finish(axis, x="speed [m/s]", y="restitution")
    note = f"Slopes over the last decade of speed: {', '.join(told)}; "
    note += "Johnson's plastic limit is -0.25."
    if len(off):
        note += (
            f" Our fitted law differs from MDR by {off[-3:].min():+.0%} to {off[-3:].max():+.0%} "
            f"at the three largest speeds and by {off.min():+.0%} at worst, near first yield, "
            "where MDR stays elastic longer."
        )
    return [Picture("mdr", "Restitution of a ball on a rigid flat", made, note)]
