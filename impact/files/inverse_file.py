"""Inverse file: the trials of a rod whose duration and mean force are to be inferred."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import Field

from ...core.errors import InputError
from ...core.inputs.toml_input import InputTable, parse_model, read_toml
from ...core.rig import Length, Radius, StrikerTable
from ...core.unstated import unstated_equal
from ..inverse import Inferred, Measured, infer
from ..scene import Striker
from .bodies import striker_of


class _RodTable(StrikerTable):
    """`[striker]` of an inverse file: a rod of one radius, unless it says otherwise."""

    shape: Literal["rod"] = "rod"
    """A rod with two round ends."""
    radius_m: Radius | None = None
    """Radius of the shank."""
    length_m: Length
    """Between the centres of the two tip spheres."""


class _TrialTable(InputTable):
    """`[[trial]]` of an inverse file, named as the columns of trials.csv."""

    trial: str = ""
    """Name of the trial."""
    angle_deg: float = Field(gt=0.0, lt=90.0)
    """Between the rod's axis and the flat."""
    impact_speed_m_s: float = Field(ge=1e-9, le=2e4)
    """Speed of the tip along the flat's normal."""
    rebound_m_s: float | None = None
    """Speed of the centre of mass after, where it was measured."""
    friction_impulse_ratio: float = Field(ge=0.0, le=20.0)
    """Tangential over normal impulse."""
    restitution: float = Field(ge=0.0, le=2.0)
    """Rebound over approach speed of the tip."""
    permanent_depth_m: float = Field(ge=1e-12, le=0.1)
    """Depth of the crater."""
    sliding_length_m: float = Field(ge=1e-12, le=1.0)
    """Length of the scar less its width."""
    printed_duration_s: float | None = None
    """A published duration to show beside."""
    printed_mean_force_N: float | None = None
    """A published mean force to show beside."""


class InverseFile(InputTable):
    """The keys of an inverse file."""

    striker: _RodTable
    """The rod."""
    trial: list[_TrialTable] = Field(min_length=1)
    """The trials: `[[trial]]`, as many as there are."""


@unstated_equal
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
    found = parse_model(read_toml(path), InverseFile, source=source)
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
