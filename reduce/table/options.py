"""Options of the reduction of a table."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ..bounces.options import BounceOptions
from ..shared.time_window import TimeWindow

Holds = Literal[
    "force", "acceleration", "height", "bounces", "rebounds", "leeb", "tension", "trials"
]


class TableOptions(BounceOptions, TimeWindow):
    """Options of the reduction of a table."""

    holds: Holds = Field(
        description="force, acceleration or height against time; times of bounces; rebound heights "
        "beside drop heights; Leeb numbers; stress over strain of a tension test; a row a trial"
    )
    sheet: str = Field(
        "", description="of a workbook, a ZIP file or a tracker's project; default: the first"
    )
    select: str = Field("", description="COLUMN=VALUE: only these rows")
    column: str = Field(
        "", description="of trials, HEADER=quantity unit: what a header means; ; between several"
    )
    time: str = Field("1", description="column of the time, by name or number")
    value: str = Field("2", description="column of what was measured, by name or number")
    time_unit: Literal["file", "s", "ms", "us", "ns", "min"] = Field(
        "file", description="file: what the column's name says, else seconds"
    )
    value_unit: str = Field(
        "file", description="as N, kN, m/s2, g, mm, px; file: what the column's name says"
    )
    gain: float | None = Field(
        None, gt=0.0, description="newtons or m/s2 that one of the column's unit is worth: one "
        "over the sensitivity of a sensor read in volts",
    )  # fmt: skip
    gain_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    strain_is: Literal["engineering", "true"] = Field(
        "engineering", description="of a tension test; stresses likewise"
    )
    E_Pa: float | None = Field(
        None, gt=0.0, description="of the metal in tension; default: the slope of the curve"
    )
    area_mm2: float | None = Field(
        None, gt=0.0, description="of a specimen whose load was recorded; default: the header's"
    )
    gauge_length_mm: float | None = Field(
        None, gt=0.0, description="of an extension that was recorded; default: the header's"
    )
    body: str = Field(
        "target", description="whose flow curve a tension test is: target, or a striker's name"
    )
    rate_hz: float | None = Field(
        None, ge=1e-3, le=1e10, description="samples a second, where the time column counts samples"
    )
    time_std_s: float | None = Field(
        None, gt=0.0, description="of an instant of contact; default: from their scatter"
    )
    value_std: float = Field(
        0.0, ge=0.0, description="standard deviation of a height, in the unit of its column"
    )
    upwards: Literal["up", "down"] = Field(
        "up", description="down: the heights grow downwards, as rows of a picture do"
    )
    approach_speed_m_s: float | None = Field(
        None, gt=0.0,
        description="normal speed before the pulse; with mass_kg gives the restitution",
    )  # fmt: skip
    approach_speed_m_s_std: float = Field(0.0, ge=0.0, description="its standard deviation")


Options = TableOptions
"""By this name a kind is found."""
