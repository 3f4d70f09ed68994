"""Flow curves of a recording set: a metal's true stress over plastic strain, as it was measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..arrays import Array, Indices
from ..errors import InputErrors
from ..flow import FlowCurve, tabulated
from ..output import csv_text
from ..rules import RULES
from .csv_table import Problems, numbers, read_text_table
from .ranges import STRAINS, STRENGTHS

COLUMNS = ("plastic_strain", "true_stress_Pa", "strain_rate_per_s", "temperature_K")
"""The last two are optional."""

_RANGES = (STRAINS, STRENGTHS, None, None)

PROOF_STRAIN = 0.002

SPECIMENS = RULES.specimens
"""Standard deviation between specimens of one metal, of the stress at 0.2 %: 0.070 and 0.068 in 15
and 9 tensions of one bar of 304L at 1e-4 and 1e-2 1/s (sandialabs/matcal, BSD)."""


class Rise(NamedTuple):
    """What a metal's stress at a rate of strain is over that of its slowest test."""

    rate: float
    """Strain rate [1/s]."""
    ratio: float


@dataclass(frozen=True, eq=False)
class MeasuredFlow:
    """Rows of a measured flow curve: plastic strain, true stress [Pa], rate [1/s], temperature [K].

    Each has shape (n,); rate and temperature are nan where the table does not say them.
    """

    strain: Array
    stress: Array
    rate: Array
    temperature: Array

    @property
    def tests(self) -> list[Indices]:
        """Rows of each test, at one rate and one temperature; the slowest first, then the coldest.

        The order is that of what a handbook's strength is measured at.
        """
        pairs = np.stack([np.nan_to_num(self.rate), np.nan_to_num(self.temperature)], axis=1)
        return [np.flatnonzero((pairs == pair).all(axis=1)) for pair in np.unique(pairs, axis=0)]

    @property
    def strength(self) -> float:
        """Stress at 0.2 % plastic strain of the slowest test, its first row beyond that [Pa]."""
        rows = self.tests[0]
        return float(np.interp(PROOF_STRAIN, self.strain[rows], self.stress[rows]))

    @property
    def rises(self) -> tuple[Rise, ...]:
        """Stress of each faster test at the slowest one's temperature over the slowest one's.

        The geometric mean over the strains, from 0.2 % on, that both reach.
        """
        slow, *others = self.tests
        ambient = np.nan_to_num(self.temperature[slow[0]])
        found = []
        for rows in others:
            rate = float(self.rate[rows[0]])
            alike = np.nan_to_num(self.temperature[rows[0]]) == ambient
            last = min(self.strain[slow[-1]], self.strain[rows[-1]])
            if not (alike and last > PROOF_STRAIN):
                continue
            p = np.geomspace(PROOF_STRAIN, last, 32)
            fast, held = (np.interp(p, self.strain[k], self.stress[k]) for k in (rows, slow))
            found.append(Rise(rate, float(np.exp(np.mean(np.log(fast / held))))))
        return tuple(found)

    def curve(self, strength: float) -> FlowCurve:
        """Return the slowest test as a flow curve whose stress at 0.2 % is `strength` [Pa].

        Rows closer than an eighth of a decade of strain are averaged: slopes of a noisy record
        mean nothing. Up to the first row and beyond the last one the stress stays.
        """
        rows = self.tests[0]
        p, S = self.strain[rows], self.stress[rows] * (strength / self.strength)
        decades = np.log10(np.maximum(p, RULES.strain_seen))
        _, part = np.unique(np.floor(RULES.rows_a_decade * decades), return_inverse=True)
        count = np.bincount(part)
        p, S = np.bincount(part, p) / count, np.bincount(part, S) / count
        if p[0] > 0.0:
            p, S = np.append(0.0, p), np.append(S[0], S)
        return tabulated(p, S)

    def text(self) -> str:
        """Return the table as a file."""
        columns = {
            name: column
            for name, column in zip(
                COLUMNS, (self.strain, self.stress, self.rate, self.temperature), strict=True
            )
            if np.isfinite(column).any()
        }
        rows = ([f"{v:.8g}" for v in row] for row in zip(*columns.values(), strict=True))
        return csv_text(rows, header=columns)


def read_flow_curve(
    path: Path, columns: tuple[str, ...] = COLUMNS, *, also: str = ""
) -> MeasuredFlow:
    """Read a flow curve: `plastic_strain`, `true_stress_Pa`, optional rate and temperature.

    Every mistake is a line with its row. `columns` are names in that order, the first two needed;
    `also` is another one of the second.
    """
    problems = Problems(str(path))
    table = read_text_table(path, (*columns, *filter(None, [also])), problems)
    if table is None:
        raise InputErrors(tuple(problems.found))
    if also in table.columns and columns[1] not in table.columns:
        columns = (columns[0], also, *columns[2:])
    for name in columns[:2]:
        if name not in table.columns:
            problems.add("missing", row=1, column=name, allowed=", ".join(columns))
    values = [np.full(len(table.rows), np.nan) for _ in COLUMNS]
    for k, (name, known) in enumerate(zip(columns, _RANGES, strict=False)):
        if name not in table.columns:
            continue
        values[k] = numbers(table, name, problems)
        for row, cell, value in zip(table.rows, table.cells[name], values[k], strict=True):
            if not cell:
                problems.add("empty", row=row, column=name, allowed="a number")
            elif known and not math.isnan(value) and (wanted := known.wanted(value)):
                problems.add(f"{value:g}", row=row, column=name, allowed=wanted)
            elif value < 0.0 or (value == 0.0 and k):
                problems.add(f"{value:g}", row=row, column=name, allowed="above 0")
    if problems.found:
        raise InputErrors(tuple(problems.found))
    flow = MeasuredFlow(*values)
    for rows in flow.tests:
        if rows.size < 2:
            problems.add(
                "one row at its rate and temperature", row=table.rows[int(rows[0])],
                allowed="two or more rows of each test",
            )  # fmt: skip
        for k in np.flatnonzero(np.diff(flow.strain[rows]) <= 0.0)[:1]:
            problems.add(
                f"{flow.strain[rows[k + 1]]:g} after {flow.strain[rows[k]]:g}",
                row=table.rows[int(rows[k + 1])], column=COLUMNS[0],
                allowed="a strain that increases within each test",
            )  # fmt: skip
    if not table.rows:
        problems.add("no row", allowed="two or more rows")
    if problems.found:
        raise InputErrors(tuple(problems.found))
    return flow
