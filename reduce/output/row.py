"""Conditions of a trial that its raw file does not tell."""

from __future__ import annotations

from pydantic import Field

from ...core.inputs.names import FileNameIfAny
from ...core.inputs.toml_input import InputTable
from ...recordings.columns import VARIED


class Row(InputTable):
    """What the raw file does not tell about the trial."""

    trial: FileNameIfAny = Field(default="", description="name of the trial; default: the file's")
    striker: str = Field(default="", description="name in set.toml; default: the only one")
    angle_deg: float | None = Field(
        default=None, gt=0.0, le=90.0, description="angle of the impact; default: 90"
    )
    impact_speed_m_s: float | None = Field(
        default=None, gt=0.0, description="normal approach speed"
    )
    impact_speed_m_s_std: float | None = Field(
        default=None, gt=0.0, description="its standard deviation"
    )
    drop_height_m: float | None = Field(default=None, gt=0.0, description="height of fall")
    spot: str = Field(default="", description="same text: same place on the flat")
    x: str = Field(
        default="",
        pattern=r"^(\w+=[^,=]*(,\w+=[^,=]*)*)?$",
        description="what else was varied, NAME=VALUE,...: columns x_NAME",
    )

    @property
    def varied(self) -> dict[str, str]:
        """What else was varied, by column."""
        pairs = (pair.partition("=") for pair in self.x.split(",") if pair)
        return {f"{VARIED}{name.strip()}": value.strip() for name, _, value in pairs}
