"""New trials into a set: the rows of a table below those that are there, all of them or none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ..core.errors import InputErrors
from ..core.inputs.csv_table import Problems, TextTable, read_text_table, shown
from ..core.inputs.names import trial_name
from ..core.output import csv_text, locked, write_files
from .bench import refuse_beyond
from .columns import TRIAL_COLUMNS, VARIED
from .recording_set import RecordingSet, files_of, read, read_as
from .trials import trials_in


def add_trials(
    folder: Path, rows: Path, *, source: str = ""
) -> tuple[RecordingSet, tuple[str, ...]]:
    """Add trials to a set; what is there stays as it is written. Return the set, and the new names.

    The rows have columns of trials.csv; those that the set has not had yet are added to it. Without
    a column `trial` they are named by their file and row. Where the set has an `order` and the
    table has none, the rows follow in theirs. They are a session of their own, the next `batch`,
    unless they say of which they are. Every mistake of the rows is a line of one error, by file,
    row and column; nothing is written then.
    """
    problems = Problems(source or str(rows))
    table = read_text_table(rows, TRIAL_COLUMNS, problems, free=VARIED)
    if table is None:
        raise InputErrors(tuple(problems.found))
    if "trial" not in table.columns:
        names = tuple(f"{trial_name(rows)}-{row:03d}" for row in table.rows)
        columns, cells = ("trial", *table.columns), {"trial": names, **table.cells}
        table = replace(table, columns=columns, cells=cells)
    read(folder)  # a lock would make the folders around a set that is not there
    # another process may add to the same set: neither's rows must be lost
    with locked(folder):
        before = read(folder)
        new = trials_in(table, frozenset(before.setup.strikers), problems)
        if new is not None:
            for row, name in zip(table.rows, new.trial, strict=True):
                if name in before.trials.trial:
                    problems.add(f"{shown(name)} is in the set already", row=row, column="trial",
                                 allowed="a name of its own")  # fmt: skip
            if not problems.found:
                refuse_beyond(replace(before, trials=new), table.rows, problems)
        if problems.found or new is None:
            raise InputErrors(tuple(problems.found))
        old = read_text_table(folder / "trials.csv", TRIAL_COLUMNS, Problems(""), free=VARIED)
        assert old is not None
        text = _joined(old, table, session=float(before.trials.sessions.max()) + 1.0)
        setup = (folder / "set.toml").read_text(encoding="utf-8")
        after = {**files_of(before), "set.toml": setup, "trials.csv": text}
        read_as(folder, after, unfinished=False)
        write_files(folder, {"trials.csv": text})
    return read(folder), new.trial


def _joined(old: TextTable, new: TextTable, *, session: float) -> str:
    columns = list(dict.fromkeys((*old.columns, *new.columns, "batch")))
    # the head of trials.csv may have been copied: a column without an entry says nothing
    cells: dict[str, Sequence[str]] = {k: x for k, x in new.cells.items() if any(x)}
    cells["batch"] = [x or f"{session:g}" for x in cells.get("batch", ("",) * len(new.rows))]
    if "order" in old.columns and "order" not in cells:
        last = max((float(x) for x in old.cells["order"] if x), default=0.0)
        cells["order"] = [f"{last + k:g}" for k in range(1, len(new.rows) + 1)]
    parts = [
        zip(*(part.get(name, ("",) * n) for name in columns), strict=True)
        for part, n in ((old.cells, len(old.rows)), (cells, len(new.rows)))
    ]
    return csv_text((row for part in parts for row in part), header=columns)
