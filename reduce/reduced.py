"""What every reduction hands on, whatever the instrument: rows, values, notes and a picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from ..core.errors import InputError
from ..core.inputs.flow_curve import MeasuredFlow
from .measured import Measured, Trial


@dataclass(frozen=True)
class Reduced:
    """One raw file, reduced.

    - `source`: the raw file (or folder of pictures).
    - `values`: everything that was measured, by a name that ends in its unit.
    - `trials`: the rows that it makes of trials.csv; none for a file that shows no impact.
    - `draw`: writes the picture that a person can check the numbers by.
    - `notes`: what the reader should know, a sentence each.
    - `striker`: keys of `[strikers.NAME]` that were measured.
    - `noise`: keys of `[noise]` that were measured; those that a set already has stay.
    - `flow`: `target` or the name of a striker, and its flow curve, if that was measured.
    """

    source: Path
    values: Mapping[str, Measured]
    trials: tuple[Trial, ...]
    draw: Callable[[Path], None]
    notes: tuple[str, ...] = ()
    striker: Mapping[str, Measured] = field(default_factory=dict)
    noise: Mapping[str, float] = field(default_factory=dict)
    flow: tuple[str, MeasuredFlow] | None = None

    def known(self) -> Reduced:
        """Return the same without values that are no number: what was not measured is not told."""
        known = replace(
            self, values=_finite(self.values), striker=_finite(self.striker),
            trials=tuple(replace(t, observables=_finite(t.observables)) for t in self.trials),
        )  # fmt: skip
        rows = (t.observables or t.trace or t.profile for t in known.trials)
        if not (known.values or known.striker or known.flow or any(rows)):
            raise InputError(
                "nothing was measured", source=str(self.source),
                allowed="a recording of the kind that was named",
            )  # fmt: skip
        return known


def _finite(values: Mapping[str, Measured]) -> dict[str, Measured]:
    return {name: v for name, v in values.items() if math.isfinite(v.value)}
