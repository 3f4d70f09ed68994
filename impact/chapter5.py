"""Chapter 5: what an inverse file asks for, and the thesis's oblique rows beside our own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import Field

from ..core.errors import InputError
from ..core.material import Material
from ..core.toml_input import InputTable, parse_model, read_toml
from ..models.base import ContactLaw
from .chapter3 import REFERENCE
from .integrate import strike
from .inverse import Inferred, Measured, infer
from .result import Impact
from .scene import Approach, Friction, Striker, scene_of


class _RodTable(InputTable):
    """`[striker]` of an inverse file."""

    tip_radius_m: float = Field(gt=0.0)
    mass_kg: float = Field(gt=0.0)
    length_m: float = Field(gt=0.0)
    radius_m: float | None = Field(default=None, gt=0.0)
    inertia_kg_m2: float | None = Field(default=None, gt=0.0)


class _TrialTable(InputTable):
    """`[[trial]]` of an inverse file, named as the columns of trials.csv."""

    trial: str = ""
    angle_deg: float = Field(gt=0.0, lt=90.0)
    impact_speed_m_s: float = Field(gt=0.0)
    rebound_m_s: float | None = None
    friction_impulse_ratio: float = Field(ge=0.0)
    restitution: float = Field(ge=0.0)
    permanent_depth_m: float = Field(gt=0.0)
    sliding_length_m: float = Field(gt=0.0)
    printed_duration_s: float | None = None
    printed_mean_force_N: float | None = None


class _InverseFile(InputTable):
    striker: _RodTable
    trial: list[_TrialTable] = Field(min_length=1)


@dataclass(frozen=True, slots=True)
class Row:
    """One oblique impact: what was measured, what follows, what the thesis printed."""

    name: str
    measured: Measured
    inferred: Inferred
    printed_duration: float = math.nan
    printed_force: float = math.nan


def read_inverse(path: Path) -> tuple[Striker, list[Row]]:
    """Read an inverse file and infer each trial.

    Raises
    ------
    InputError
        One line for each mistake, also for a friction coefficient at which the tip sticks.
    """
    source = str(path)
    found = parse_model(read_toml(path), _InverseFile, source=source)
    table = found.striker
    rod = Striker(
        mass=table.mass_kg, tip_radius=table.tip_radius_m, length=table.length_m,
        radius=table.radius_m or table.tip_radius_m, inertia=table.inertia_kg_m2 or math.nan,
    )  # fmt: skip
    rows = []
    for i, trial in enumerate(found.trial, start=1):
        measured = Measured(
            math.radians(trial.angle_deg), trial.impact_speed_m_s, trial.friction_impulse_ratio,
            trial.restitution, trial.permanent_depth_m, trial.sliding_length_m,
            math.nan if trial.rebound_m_s is None else trial.rebound_m_s,
        )  # fmt: skip
        try:
            inferred = infer(rod, measured)
        except InputError as error:
            raise InputError(
                error.message, source=source, key=f"trial {i}.{error.key}", allowed=error.allowed
            ) from None
        rows.append(
            Row(
                trial.trial or str(i), measured, inferred,
                trial.printed_duration_s or math.nan, trial.printed_mean_force_N or math.nan,
            )
        )  # fmt: skip
    return rod, rows


def thesis_rod(*, mass: float | None = None) -> Striker:
    """Return chapter 5's rod; its inertia is m L^2 / 12 as in the thesis."""
    rod = read_toml(REFERENCE / "chapter45.toml")["rod"]
    m = mass or rod["mass_kg"]
    return Striker(
        mass=m, tip_radius=rod["radius_m"], length=rod["length_m"], radius=rod["radius_m"],
        inertia=m * rod["length_m"] ** 2 / 12.0, name=rod["material"],
    )  # fmt: skip


def thesis_rows(*, mass: float | None = None) -> tuple[Striker, list[Row]]:
    """Infer chapter 5's three experiments from their measured values."""
    rod = thesis_rod(mass=mass)
    rows = []
    for e in read_toml(REFERENCE / "chapter45.toml")["experiment"]:
        measured = Measured(
            math.radians(e["angle_deg"]), -e["approach_m_s"], e["friction"], e["restitution"],
            -e["depth_m"], -e["sliding_m"], e["rebound_m_s"],
        )  # fmt: skip
        rows.append(
            Row(
                f"{e['angle_deg']} degrees", measured, infer(rod, measured),
                e["printed_duration_s"], e["printed_mean_force_N"],
            )
        )  # fmt: skip
    return rod, rows


def simulate_experiment(experiment: Mapping[str, Any], law: ContactLaw, *, mass: float) -> Impact:
    """Simulate one row of tables 5.2-5.4 with the rigid rod of the given mass."""
    data = read_toml(REFERENCE / "chapter45.toml")
    rod, flat = (
        Material(b["E_Pa"], b["nu"], b["Sy_Pa"], density=b["density_kg_m3"])
        for b in (data["rod"], data["flat"])
    )
    return strike(
        scene_of(
            law, sphere=rod, flat=flat, striker=thesis_rod(mass=mass),
            approach=Approach(
                -experiment["approach_m_s"], math.radians(experiment["angle_deg"])
            ),
            friction=Friction(experiment["friction"]),
        )
    )  # fmt: skip
