"""The rows of trials.csv: conditions and observables as arrays, read, checked and written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..core.arrays import Array, Mask
from ..core.inputs.csv_table import Problems, TextTable, numbers, read_text_table, shown
from ..core.inputs.names import ALLOWED, names_a_file
from ..core.observables import LOAD, OBSERVABLES
from ..core.output import csv_text
from .columns import CONDITIONS, MEASURED, STD_SUFFIX, TRIAL_COLUMNS, VARIED
from .rules import RULES

_TEXTS = tuple(name for name, column in TRIAL_COLUMNS.items() if column.kind == "text")
_NUMBERS = tuple(name for name, column in CONDITIONS.items() if column.kind != "text")
_STDS = {name + STD_SUFFIX: name for name in MEASURED}
_APPROACH = ("impact_speed_m_s", "drop_height_m")
NORMAL = 90.0
_SHOWN_BY_PRESS = tuple(name for name in MEASURED if "press" in OBSERVABLES[name].of)
_OF_PRESSES = {
    "press_rate_per_s", "load_N_std",
    *(name for name in MEASURED if "impact" not in OBSERVABLES[name].of),
}  # fmt: skip
_OF_IMPACTS = {
    "impact_speed_m_s_std", "drop_height_m_std", "approach_tangential_m_s", "approach_spin_rad_s",
    *(name for name in MEASURED if name not in _SHOWN_BY_PRESS),
}  # fmt: skip
"""Columns that only rows of one kind may fill."""


@dataclass(frozen=True, eq=False)
class Trials:
    """The rows of trials.csv, n of them; the attributes carry the names of the columns.

    Every array has shape (n,), is read-only, and holds NaN where the table has an empty cell.

    - `trial`, `striker`: name of the trial; name of its striker in set.toml.
    - `angle_deg`: angle [deg]: rod, between axis and flat; sphere, between velocity and flat; 90 of
      a press.
    - `impact_speed_m_s`, `drop_height_m`: as the table gives them: normal approach speed [m/s],
      height of fall [m]; at least one of an impact, none of a press.
    - `angle_deg_std`, `impact_speed_m_s_std`, `drop_height_m_std`: standard deviations [deg, m/s,
      m]; that of a height is common to all trials of it.
    - `temperature_K`, `order`, `batch`: temperature [K]; place in the order of testing; session, 1
      where it is not told.
    - `approach_tangential_m_s`, `approach_spin_rad_s`: tangential speed of the centre [m/s] and
      angular velocity [rad/s] before.
    - `load_N`, `load_N_std`: largest load of a quasi-static press and its standard deviation [N].
    - `press_rate_per_s`: strain rate of a press [1/s].
    - `spot`, `note`: same text: same place on the flat; free text.
    - `varied`: columns `x_NAME` by name: conditions that no simulation knows, as they are written.
    - `observables`: measured columns by name.
    - `observables_std`: standard deviations that the table gives (`NAME_std`), by the observable's
      name.
    """

    trial: tuple[str, ...]
    striker: tuple[str, ...]
    angle_deg: Array
    impact_speed_m_s: Array = field(default_factory=lambda: np.empty(0))
    drop_height_m: Array = field(default_factory=lambda: np.empty(0))
    angle_deg_std: Array = field(default_factory=lambda: np.empty(0))
    impact_speed_m_s_std: Array = field(default_factory=lambda: np.empty(0))
    drop_height_m_std: Array = field(default_factory=lambda: np.empty(0))
    temperature_K: Array = field(default_factory=lambda: np.empty(0))
    order: Array = field(default_factory=lambda: np.empty(0))
    batch: Array = field(default_factory=lambda: np.empty(0))
    approach_tangential_m_s: Array = field(default_factory=lambda: np.empty(0))
    approach_spin_rad_s: Array = field(default_factory=lambda: np.empty(0))
    load_N: Array = field(default_factory=lambda: np.empty(0))
    load_N_std: Array = field(default_factory=lambda: np.empty(0))
    press_rate_per_s: Array = field(default_factory=lambda: np.empty(0))
    spot: tuple[str, ...] = ()
    note: tuple[str, ...] = ()
    varied: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    observables: Mapping[str, Array] = field(default_factory=dict)
    observables_std: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = len(self.trial)
        for name in ("spot", "note"):
            object.__setattr__(self, name, tuple(getattr(self, name)) or ("",) * n)
        for name in _NUMBERS:
            object.__setattr__(self, name, _column(getattr(self, name), n, name))
        for name in ("observables", "observables_std"):
            columns = {k: _column(v, n, k) for k, v in getattr(self, name).items()}
            object.__setattr__(self, name, columns)

    def __len__(self) -> int:
        return len(self.trial)

    @property
    def pressed(self) -> Mask:
        """Which rows are quasi-static presses, shape (n,)."""
        return np.asarray(~np.isnan(self.load_N))

    @property
    def sessions(self) -> Array:
        """Which session each row is of, shape (n,)."""
        return np.nan_to_num(self.batch, nan=1.0)

    @property
    def entries(self) -> Mapping[str, tuple[str, ...]]:
        """What readings may follow, n entries each: `varied`, and sessions if there were some."""
        if not np.ptp(self.sessions):
            return self.varied
        return {**self.varied, "batch": tuple(f"{k:g}" for k in self.sessions)}

    def take(self, rows: npt.ArrayLike) -> Trials:
        """Return some of the rows: indices or a mask."""
        index = np.arange(len(self))[np.asarray(rows)]
        changes: dict[str, object] = {}
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, tuple):
                changes[item.name] = tuple(value[i] for i in index)
            elif isinstance(value, np.ndarray):
                changes[item.name] = value[index]
            else:
                changes[item.name] = {
                    k: v[index] if isinstance(v, np.ndarray) else tuple(v[i] for i in index)
                    for k, v in value.items()
                }
        return replace(self, **changes)  # type: ignore[arg-type]


def _column(values: npt.ArrayLike, n: int, name: str) -> Array:
    given = np.array(values, dtype=float)
    if given.size == 0 and n > 0:
        given = np.full(n, np.nan)
    if given.shape != (n,):
        raise ValueError(f"{name} has shape {given.shape}, not ({n},)")
    given.flags.writeable = False
    return given


def read_trials(path: Path, strikers: frozenset[str], problems: Problems) -> Trials | None:
    """Read trials.csv of these `strikers`; mistakes go to `problems`; None if there is no table."""
    table = read_text_table(path, TRIAL_COLUMNS, problems, free=VARIED)
    return None if table is None else trials_in(table, strikers, problems)


def trials_in(table: TextTable, strikers: frozenset[str], problems: Problems) -> Trials | None:
    """Return the trials of the rows of such a table, as `read_trials` does."""
    approached = bool(set(_APPROACH) & set(table.columns))
    # a press is normal: presses alone need no angle
    needed = ("trial", "striker", "angle_deg") if approached else ("trial", "striker")
    missing = [name for name in needed if name not in table.columns]
    for name in missing:
        problems.add("missing", row=1, column=name, allowed="this column is needed")
    if not approached and LOAD not in table.columns:
        problems.add("no approach", row=1, allowed=f"a column {' or '.join(_APPROACH)}; of "
                     f"quasi-static presses {LOAD}")  # fmt: skip
    if not table.rows:
        problems.add("no trial", allowed="at least one row below the header")
    values = {
        name: numbers(table, name, problems)
        for name in table.columns if name in TRIAL_COLUMNS and name not in _TEXTS
    }  # fmt: skip
    _check_ranges(table, values, problems)
    _check_texts(table, strikers, problems)
    _check_approach(table, values, problems)
    if missing:
        return None
    return _as_trials(table, values)


def _as_trials(table: TextTable, values: Mapping[str, Array]) -> Trials:
    texts = {name: table.cells[name] for name in _TEXTS if name in table.columns}
    angle = values.get("angle_deg", np.full(len(table.rows), np.nan))
    if LOAD in values:
        angle = np.where(np.isnan(angle) & ~np.isnan(values[LOAD]), NORMAL, angle)
    values = {**values, "angle_deg": angle}
    return Trials(
        **texts,  # type: ignore[arg-type]
        **{name: values[name] for name in _NUMBERS if name in values},  # type: ignore[arg-type]
        varied={name: table.cells[name] for name in table.columns if name not in TRIAL_COLUMNS},
        observables={name: values[name] for name in MEASURED if name in values},
        observables_std={_STDS[name]: values[name] for name in _STDS if name in values},
    )


def _check_ranges(table: TextTable, values: Mapping[str, Array], problems: Problems) -> None:
    for name, column in values.items():
        rule = TRIAL_COLUMNS[name]
        for i in map(int, np.flatnonzero(~np.isnan(column))):
            if not rule.accepts(float(column[i])):
                problems.add(f"{column[i]:g}", row=table.rows[i], column=name, allowed=rule.allowed)
    for name, of in _STDS.items():
        if name in values and of not in values:
            problems.add(f"there is no column {of}", row=1, column=name, allowed=f"a column {of}")


def _check_texts(table: TextTable, strikers: frozenset[str], problems: Problems) -> None:
    seen: dict[str, int] = {}
    for row, name in zip(table.rows, table.cells.get("trial", ()), strict=False):
        if not name:
            problems.add("empty", row=row, column="trial", allowed="a name")
        elif name in seen:
            problems.add(
                f"{shown(name)} is also in row {seen[name]}", row=row, column="trial",
                allowed="each name once",
            )  # fmt: skip
        elif not names_a_file(name):
            problems.add(f"{shown(name)}", row=row, column="trial", allowed=ALLOWED)
        seen.setdefault(name, row)
    for column in ("spot", "note"):
        for row, text in zip(table.rows, table.cells.get(column, ()), strict=False):
            if not text.replace("\n", " ").isprintable():
                problems.add(
                    shown(text), row=row, column=column, allowed="text without control characters"
                )
    for row, name in zip(table.rows, table.cells.get("striker", ()), strict=False):
        # where there is none, or set.toml is not read, one line has said so
        if strikers and name not in strikers:
            known = ", ".join(sorted(strikers))
            problems.add(f"no striker {shown(name)}", row=row, column="striker", allowed=known)


def _check_approach(table: TextTable, values: Mapping[str, Array], problems: Problems) -> None:
    cells = table.cells
    # without any such column one line has said so
    approached = bool({*_APPROACH, LOAD} & set(cells))
    for i, row in enumerate(table.rows):
        if _filled(cells, LOAD, i):
            _check_press(table, i, values, problems)
            continue
        if "angle_deg" in cells and not cells["angle_deg"][i]:
            problems.add("empty", row=row, column="angle_deg", allowed="90 for a normal impact")
        if approached and not any(_filled(cells, k, i) for k in _APPROACH):
            problems.add("no approach", row=row, allowed=" or ".join((*_APPROACH, LOAD)))
        for name in sorted(_OF_PRESSES):
            if _filled(cells, name, i):
                problems.add(
                    f"{shown(cells[name][i])} of an impact", row=row, column=name,
                    allowed=f"empty but for a press, a row with {LOAD}",
                )  # fmt: skip
    for name, of in _STDS.items():
        if name in values and of in values:
            for i in map(int, np.flatnonzero(~np.isnan(values[name]) & np.isnan(values[of]))):
                if not cells[of][i]:
                    problems.add(
                        f"{of} is empty", row=table.rows[i], column=name,
                        allowed="a standard deviation only where there is a value",
                    )  # fmt: skip


def _filled(cells: Mapping[str, Sequence[str]], name: str, i: int) -> bool:
    return name in cells and bool(cells[name][i])


def _check_press(table: TextTable, i: int, values: Mapping[str, Array], problems: Problems) -> None:
    """A row with a load: normal, without approach, with what a press shows."""
    cells, row = table.cells, table.rows[i]
    both = [k for k in _APPROACH if _filled(cells, k, i)]
    if both:
        problems.add(
            f"{LOAD} beside {both[0]}", row=row, column=LOAD,
            allowed="a press has a load, an impact a speed or a height",
        )  # fmt: skip
        return
    if (
        "angle_deg" in values
        and not np.isnan(values["angle_deg"][i])
        # all presses lie in one bin of the angle
        and abs(values["angle_deg"][i] - NORMAL) > 0.5 * RULES.angle_bin
    ):
        problems.add(
            f"{values['angle_deg'][i]:g}", row=row, column="angle_deg",
            allowed=f"{NORMAL:g} or empty for a press",
        )  # fmt: skip
    for name in sorted(_OF_IMPACTS):
        if _filled(cells, name, i):
            problems.add(
                f"{shown(cells[name][i])} of a press", row=row, column=name,
                allowed=f"empty in a row with {LOAD}: a press shows {', '.join(_SHOWN_BY_PRESS)}",
            )  # fmt: skip


def trials_text(trials: Trials) -> str:
    """Return trials.csv; columns without any entry are left out, numbers keep every digit."""
    columns: dict[str, list[str]] = {}
    for name in CONDITIONS:
        value = getattr(trials, name)
        cells = list(value) if name in _TEXTS else _cells(value)
        if any(cells) or name in ("trial", "striker", "angle_deg"):
            columns[name] = cells
    for name in MEASURED:
        if name in trials.observables:
            columns[name] = _cells(trials.observables[name])
        if name in trials.observables_std:
            columns[name + STD_SUFFIX] = _cells(trials.observables_std[name])
    columns |= {name: list(cells) for name, cells in trials.varied.items()}
    if any(trials.note):
        columns["note"] = list(trials.note)
    return csv_text(zip(*columns.values(), strict=True), header=columns)


def _cells(values: Array) -> list[str]:
    return ["" if np.isnan(v) else repr(float(v)) for v in values]
