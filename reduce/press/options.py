"""Options of the reduction of a press."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ..shared.time_window import TimeWindow


class PressOptions(TimeWindow):
    """Options of the reduction of a press."""

    load: str = Field(
        "", description="column of the load, by name or number; default: the one named so"
    )
    depth: str = Field("", description="column of the depth; default: the one named so")
    time: str = Field("", description="column of the time; default: the one named so, if any")
    load_unit: str = Field("file", description="as N, kN, mN; file: what the column's name says")
    depth_unit: str = Field("file", description="as mm, um, nm")
    time_unit: Literal["file", "s", "ms", "min"] = Field("file", description="file: else seconds")
    sheet: str = Field("", description="of a workbook or a ZIP file; default: the first")
    cycles: Literal["largest", "each"] = Field(
        "largest", description="rows of the largest press, or of each that goes beyond those before"
    )
    machine_compliance_m_N: float | None = Field(
        None, ge=0.0, description="that is still in the depth; 0: taken off; default: the "
        "file's, or what four cycles or more show"
    )  # fmt: skip
    machine_compliance_m_N_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    load_std_N: float = Field(
        0.0, ge=0.0, description="standard deviation of the load cell at the largest load"
    )
    tip_radius_m: float | None = Field(None, gt=0, le=1, description="of the ball, of a new set")


Options = PressOptions
"""By this name a kind is found."""
