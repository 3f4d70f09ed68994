"""Inverse file: the trials of a rod whose duration and mean force are to be inferred."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, field_validator

from ...core.errors import InputError, InputErrors, in_file
from ...core.inputs.ranges import LEAST_KNOWN, SPEEDS, span
from ...core.inputs.toml_input import InputTable, parse_model, read_toml
from ...core.rig import Length, Mass, Positive, Quantity, Radius, possible_inertia, quantities
from ...core.unstated import unstated_equal
from ..inverse import INFERRED, Inferred, MeasuredScar, infer
from ..scene import Striker
from .setup import FlowingStriker


class _RodTable(InputTable):
    """`[striker]` of an inverse file: a rigid rod of one radius, unless it says otherwise."""

    shape: Literal["rod"] = "rod"
    """A rod with two round ends."""
    tip_radius_m: Radius
    """Radius of the round tip."""
    mass_kg: Mass
    """Mass of the rod."""
    radius_m: Radius | None = None
    """Radius of the shank."""
    length_m: Length
    """Between the centres of the two tip spheres."""
    inertia_kg_m2: Positive | None = None
    """Moment of inertia across the axis; left out: of a rod of this mass."""

    _possible_inertia = field_validator("inertia_kg_m2")(possible_inertia)

    def rod(self, values: Mapping[str, float] | None = None) -> Striker:
        """Return the rigid rod, with some of its numbers replaced."""
        given = {**quantities(self), **(values or {})}
        return Striker(
            given["mass_kg"], given["tip_radius_m"], length=given["length_m"],
            radius=given.get("radius_m", math.nan), inertia=given.get("inertia_kg_m2", math.nan),
            name="rod",
        )  # fmt: skip


class _TrialTable(InputTable):
    """`[[trial]]` of an inverse file, named as the columns of trials.csv."""

    trial: str = ""
    """Name of the trial."""
    angle_deg: float = Field(gt=0.0, lt=90.0)
    """Between the rod's axis and the flat."""
    impact_speed_m_s: Annotated[float, AfterValidator(SPEEDS)]
    """Speed of the tip along the flat's normal."""
    rebound_m_s: float | None = None
    """Speed of the tip after, along the flat's normal, where it was measured."""
    friction_impulse_ratio: float = Field(ge=0.0, le=20.0)
    """Tangential over normal impulse."""
    restitution: float = Field(ge=0.0, le=2.0)
    """Rebound over approach speed of the tip."""
    permanent_depth_m: Annotated[float, AfterValidator(span(1e-12, 0.1, um=1e-6))]
    """Depth of the crater."""
    sliding_length_m: Annotated[float, AfterValidator(span(1e-12, 1.0, um=1e-6))]
    """Path of the touching point along the flat; a scar's length less its width is not it."""


class InverseFile(InputTable):
    """The keys of an inverse file."""

    striker: _RodTable
    """The rod."""
    trial: list[_TrialTable] = Field(min_length=1)
    """The trials: `[[trial]]`, as many as there are."""


@unstated_equal
@dataclass(frozen=True, slots=True)
class InverseRow:
    """One oblique impact: what was measured, and what follows."""

    name: str
    measured: MeasuredScar
    inferred: Inferred
    std: Mapping[str, float] = field(default_factory=dict)
    """By field of `Inferred`: what the standard deviations of the rod's numbers make of it."""


def read_inverse(path: Path) -> list[InverseRow]:
    """Read an inverse file and infer each trial; every mistake is a line.

    A friction coefficient at which the tip sticks is one.
    """
    source = str(path)
    content = read_toml(path)
    _check_striker(content, source)
    found = parse_model(content, InverseFile, source=source)
    rod = found.striker.rod()
    rows = []
    for i, trial in enumerate(found.trial, start=1):
        measured = MeasuredScar(
            math.radians(trial.angle_deg), trial.impact_speed_m_s, trial.friction_impulse_ratio,
            trial.restitution, trial.permanent_depth_m, trial.sliding_length_m,
            math.nan if trial.rebound_m_s is None else trial.rebound_m_s,
        )  # fmt: skip
        try:
            inferred = infer(rod, measured)
        except InputError as error:
            key = {"friction": "friction_impulse_ratio"}.get(error.key, error.key)
            raise error.at(source, f"trial {trial.trial or i}: {key}") from None
        std = _deviations(found.striker, measured)
        rows.append(InverseRow(trial.trial or str(i), measured, inferred, std))
    return rows


def _check_striker(content: Mapping[str, Any], source: str) -> None:
    """Refuse what a striker has in other files: a rigid rod has no metal."""
    table = content.get("striker")
    known = set(FlowingStriker.model_fields) - set(_RodTable.model_fields)
    idle = [name for name in table if name in known] if isinstance(table, dict) else []
    allowed = "left out: the rod is rigid; `dentscope impact` takes it"
    told = ((f"striker.{name}", "does nothing here", allowed) for name in idle)
    if errors := in_file(told, source):
        raise InputErrors(errors)


def _deviations(table: _RodTable, measured: MeasuredScar) -> dict[str, float]:
    """Standard deviations of what is inferred, by those of the rod's numbers; others are exact."""
    total = dict.fromkeys(INFERRED, 0.0)
    for name, quantity in table:
        if not isinstance(quantity, Quantity) or not quantity.std > 0.0:
            continue
        ends = []
        for sign in (1.0, 0.0, -1.0):
            moved = quantity.value * math.exp(min(sign * quantity.relative, LEAST_KNOWN))
            try:
                ends.append((sign, infer(table.rod({name: moved}), measured)))
            except InputError:  # at that end the tip would stick: the other one says how far
                continue
        (high, up), (low, down) = ends[0], ends[-1]
        for key in INFERRED:
            change = (getattr(up, key) - getattr(down, key)) / max(high - low, 1.0)
            total[key] = math.hypot(total[key], change)
    return total
