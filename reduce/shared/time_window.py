"""The part of a record that is used."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import Field, model_validator

from ...core.arrays import Array, Mask
from ...core.inputs.toml_input import InputTable


class TimeWindow(InputTable):
    """Options that pick a part of a record by its own time."""

    first_s: float | None = Field(None, description="beginning of the part to use, in its own time")
    last_s: float | None = Field(None, description="its end")

    @model_validator(mode="after")
    def _order(self) -> Any:
        if self.first_s is not None and self.last_s is not None and self.last_s <= self.first_s:
            raise ValueError("last_s is later than first_s")
        return self

    def keeps(self, time: Array) -> Mask:
        """Whether each instant, (n,) [s], lies in the part."""
        first = -np.inf if self.first_s is None else self.first_s
        last = np.inf if self.last_s is None else self.last_s
        return np.asarray((time >= first) & (time <= last))
