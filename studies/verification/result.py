"""What a check returns: numbers with marks and sources, tables; as JSON and back."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...core.output import write_file

Cell = str | float | int


@dataclass(frozen=True)
class Measurement:
    """One measured number and the range it should lie in.

    - `what`: name of the number.
    - `value`: the number; nan if it could not be measured, which never meets a mark.
    - `unit`: its unit, `"%"` for percent.
    - `low`, `high`: mark: the range to be kept; none: open on that side, both none: reported only.
    - `source`: where the reference or the mark comes from.
    """

    what: str
    value: float
    unit: str = ""
    low: float | None = None
    high: float | None = None
    source: str = ""

    @property
    def met(self) -> bool | None:
        """Whether the mark is met; none if there is no mark."""
        if self.low is None and self.high is None:
            return None
        above = self.low is None or self.value >= self.low
        below = self.high is None or self.value <= self.high
        return math.isfinite(self.value) and above and below

    @property
    def used(self) -> float:
        """How much of what the mark allows is used: 1 at the mark, more if it is missed."""
        if not math.isfinite(self.value) or self.met is False:
            return math.inf
        if self.low is not None and self.high is not None:
            middle, half = 0.5 * (self.low + self.high), 0.5 * (self.high - self.low)
            return abs(self.value - middle) / half
        if self.high is not None:
            return self.value / self.high if self.high > 0.0 else 0.0
        return self.low / self.value if self.low and self.value else -1.0

    @property
    def mark(self) -> str:
        """The mark in words."""
        if self.low is not None and self.high is not None:
            return f"{self.low:g} to {self.high:g}"
        if self.high is not None:
            return f"at most {self.high:g}"
        return "" if self.low is None else f"at least {self.low:g}"


@dataclass(frozen=True)
class Table:
    """A table of the report; numbers are shown with four digits."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]


@dataclass(frozen=True, kw_only=True)
class Result:
    """What one check found.

    - `name`: of the check, as the runner writes it.
    - `title`: in the report.
    - `about`: how it was done, a sentence or two.
    - `measurements`, `tables`: the numbers.
    - `notes`: what a reader must know to judge the numbers.
    - `effort`: at which effort it was run.
    - `numerics_version`: of the solver that gave the numbers.
    - `cpu_s`: processor time of the check in seconds, solves from earlier checks included.
    - `complete`: whether all of it is measured; if not, the next run goes on.
    """

    name: str = ""
    title: str
    about: str
    measurements: tuple[Measurement, ...] = ()
    tables: tuple[Table, ...] = ()
    notes: tuple[str, ...] = ()
    effort: str = ""
    numerics_version: int = 0
    cpu_s: float = 0.0
    complete: bool = True

    @property
    def missed(self) -> tuple[Measurement, ...]:
        """The measurements that miss their marks."""
        return tuple(m for m in self.measurements if m.met is False)


def write_result(result: Result, path: Path) -> None:
    """Write a result as JSON."""
    write_file(path, json.dumps(asdict(result), indent=1) + "\n")


def read_result(path: Path) -> Result:
    """Read what `write_result` wrote."""
    raw: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    raw["measurements"] = tuple(Measurement(**m) for m in raw["measurements"])
    raw["tables"] = tuple(
        Table(t["title"], tuple(t["columns"]), tuple(tuple(row) for row in t["rows"]))
        for t in raw["tables"]
    )
    raw["notes"] = tuple(raw["notes"])
    return Result(**raw)
