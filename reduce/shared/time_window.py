"""The part of a record that is used."""

from __future__ import annotations

import numpy as np
from pydantic import Field, ValidationInfo, field_validator

from ...core.arrays import Array, Mask
from ...core.inputs.toml_input import InputTable


class TimeWindow(InputTable):
    """Options that pick a part of a record by its own time."""

    first_s: float | None = Field(None, description="beginning of the part to use, in its own time")
    last_s: float | None = Field(None, description="its end")

    @field_validator("last_s")
    @classmethod
    def _order(cls, given: float | None, info: ValidationInfo) -> float | None:
        first = info.data.get("first_s")
        if first is not None and given is not None and given <= first:
            raise ValueError(f"later than first_s, {first:g}")
        return given

    def keeps(self, time: Array) -> Mask:
        """Whether each instant, (n,) [s], lies in the part."""
        first = -np.inf if self.first_s is None else self.first_s
        last = np.inf if self.last_s is None else self.last_s
        return np.asarray((time >= first) & (time <= last))
