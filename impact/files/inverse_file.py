"""Inverse file: the trials of a rod whose duration and mean force are to be inferred."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import Field

from ...core.errors import InputError
from ...core.rig import Positive, StrikerTable
from ...core.toml_input import InputTable, parse_model, read_toml
from ..inverse import Inferred, Measured, infer
from ..scene import Striker
from .bodies import striker_of


class _RodTable(StrikerTable):
    """`[striker]` of an inverse file: a rod of one radius, unless it says otherwise."""

    shape: Literal["rod"] = "rod"
    radius_m: Positive | None = None
    length_m: Positive


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
    rod = striker_of(found.striker, "rod")
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
