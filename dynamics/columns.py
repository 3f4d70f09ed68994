"""The result of many impacts: columns with the names of trials.csv, to a file or a data frame."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Array, Integers, Mask
from ..core.errors import InputError
from ..core.output import write_csv, write_file
from ..core.tables import frame, html_table, parquet, text_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN = (
    "law", "impact_speed_m_s", "angle_deg", "restitution", "permanent_depth_m", "contact_time_s",
    "peak_force_N", "outcome",
)  # fmt: skip

# limit: rows that are shown [-]: a screen
_ROWS_SHOWN = 12


@dataclass(frozen=True, eq=False)
class Impacts:
    """Conditions and observables of n impacts, by column; the names are those of trials.csv.

    `columns`: each of shape (n,): the conditions, what trials.csv may hold, all other observables,
    then `contacts`, `route` (`work` or `steps`) and `outcome`. `swept`: the conditions whose
    combinations they are, each with its values.
    """

    columns: Mapping[str, NDArray[Any]]
    swept: Mapping[str, Sequence[float]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self.columns:
            raise InputError(f"no column {name!r}", key="column", allowed=", ".join(self.columns))
        return self.columns[name]

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield one dictionary an impact."""
        for values in zip(*(x.tolist() for x in self.columns.values()), strict=True):
            yield dict(zip(self.columns, values, strict=True))

    def _shown(self) -> list[list[str]]:
        """Names and first rows of the columns that are shown."""
        names = [k for k in dict.fromkeys((*self.swept, *_SHOWN)) if k in self.columns]
        shown = {k: self.columns[k][:_ROWS_SHOWN].tolist() for k in names}
        rows = zip(*shown.values(), strict=True)
        cells = ([f"{x:.4g}" if isinstance(x, float) else str(x) for x in row] for row in rows)
        return [list(shown), *cells]

    def __repr__(self) -> str:
        told = f"{len(self)} impacts, {len(self.columns)} columns"
        return f"{told}\n{text_table(self._shown(), numbers=True)}"

    def _repr_html_(self) -> str:
        head, *rows = self._shown()
        return html_table(head, rows, title=f"{len(self)} impacts")

    def at(self, rows: Integers | Mask) -> Impacts:
        """Return these rows, by number or mask."""
        return Impacts({k: v[rows] for k, v in self.columns.items()}, self.swept)

    def joined(self, *others: Impacts) -> Impacts:
        """Return these rows and those of `others`, which have the same columns."""
        columns = {k: np.concatenate([v, *(o[k] for o in others)]) for k, v in self.columns.items()}
        return Impacts(columns, self.swept)

    def with_stds(self, stds: Mapping[str, Array]) -> Impacts:
        """Return the columns with `NAME_std` behind each NAME; nan where there is none."""
        columns: dict[str, NDArray[Any]] = {}
        for name, values in self.columns.items():
            columns[name] = values
            if name in stds:
                columns[f"{name}_std"] = np.pad(
                    stds[name], (0, len(self) - len(stds[name])), constant_values=np.nan
                )
        return Impacts(columns, self.swept)

    def to_csv(self, path: Path | str) -> None:
        """Write a CSV file, floats with all digits; an empty cell where there is no number."""
        write_csv(Path(path), self.rows(), header=self.columns)

    def frame(self) -> Any:
        """Return a pandas data frame; refused without pandas."""
        return frame(self.columns)

    def plot(self) -> Figure:
        """Return observables against the condition of a sweep with the most values, by law."""
        from .report.draw import draw_sweep

        if not self.swept:
            raise InputError("no sweep", key="plot", allowed="what ds.sweep returns")
        laws = dict.fromkeys(self["law"].tolist())
        return draw_sweep(self.swept, {law: self.at(self["law"] == law) for law in laws})

    def to_parquet(self, path: Path | str) -> None:
        """Write a Parquet file; refused without pyarrow."""
        write_file(Path(path), parquet(self.columns))
