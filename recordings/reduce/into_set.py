"""Reductions written into a recording set: rows, curves, and a record of where they came from.

A trial that the set already has keeps what it holds, but for the columns that were measured now. A
folder without set.toml gets the template to fill in. Nothing is written before the whole set, as it
would be, has been read without a mistake.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from ...core.errors import InputError
from ...core.output import csv_text, finish_pending, locked, write_files
from ...core.rig import Quantity
from ...core.toml_input import InputTable, read_model
from ..columns import CONDITIONS, MEASURED, STD_SUFFIX
from ..csv_table import Array
from ..recording_set import RecordingSet, files_of, read
from ..setup_file import Setup, setup_text
from ..template import write_template
from ..trials import Trials
from .measured import Measured, Trial
from .record import trial_name, write_record
from .reduced import Reduced

_TEXTS = ("trial", "striker", "spot", "note")
_CONDITIONS = tuple(n for n in CONDITIONS if n not in _TEXTS and not n.endswith(STD_SUFFIX))


class Row(InputTable):
    """What the raw file does not tell about the trial."""

    trial: str = Field(default="", description="name of the trial; default: the file's")
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


@dataclass(frozen=True)
class Stored:
    """What was written: rows of trials.csv, the record, the picture, and remarks."""

    trials: tuple[str, ...]
    record: Path
    picture: Path
    notes: tuple[str, ...]


def store(
    reduced: Reduced,
    folder: Path,
    row: Row,
    *,
    kind: str,
    options: Mapping[str, Any],
    setup: Setup | None = None,
) -> Stored:
    """Write a reduction into a set, new or existing.

    Parameters
    ----------
    reduced
        What was measured.
    folder
        Of the set.
    row
        Conditions that the raw file does not tell.
    kind, options
        How it was reduced, for the record.
    setup
        set.toml of a new set; without it a new set gets the template.

    Raises
    ------
    InputError
        A condition is missing or the set would not be sound.
    """
    # another reduction may write the same set: what it added must not be lost
    with locked(folder):
        finish_pending(folder)
        before, notes = _set_before(folder, setup, shape="sphere" if kind == "sound" else "rod")
        striker = _striker(before, row)
        after, curves = before, {}
        names = []
        _check_one_approach(reduced, row)
        for trial in reduced.trials:
            name = "-".join(filter(None, (_name(reduced, row), trial.label)))
            after = _with_trial(after, name, striker, trial, row)
            curves[name] = trial
            names.append(name)
        after = _with_setup(after, striker, reduced)
        _write_whole(before, after, curves, folder)
    record, picture = write_record(
        reduced, folder / "reduced", _name(reduced, row), kind=kind, options=options, trials=names
    )
    return Stored(tuple(names), record, picture, notes)


def store_each(
    items: Iterable[tuple[str, Callable[[], tuple[Reduced, Row, Mapping[str, Any]]]]],
    folder: Path,
    *,
    kind: str,
    setup: Setup,
) -> tuple[list[Stored], list[str]]:
    """Write many raw files into one set, those that show nothing left out.

    Parameters
    ----------
    items
        Name of each raw file, and what reduces it: the reduction, the conditions that the file
        does not tell, the options that were used.
    folder
        Of the set.
    kind
        How all of them are reduced.
    setup
        set.toml of the set if it is new.

    Returns
    -------
    tuple
        What was written, and a line for each raw file that was left out.
    """
    written: list[Stored] = []
    left_out = []
    for name, make in items:
        try:
            reduced, row, options = make()
            done = store(
                reduced, folder, row, kind=kind, options=options,
                setup=None if written else setup,
            )  # fmt: skip
            written.append(done)
        except InputError as error:
            left_out.append(f"{name}: {error}")
    if not written and not left_out:
        left_out.append("no raw file of the kind that the recipe reads")
    return written, left_out


def _name(reduced: Reduced, row: Row) -> str:
    return row.trial or trial_name(reduced.source)


def _set_before(
    folder: Path, setup: Setup | None, *, shape: Literal["rod", "sphere"]
) -> tuple[RecordingSet, tuple[str, ...]]:
    if folder.exists() and not folder.is_dir():
        raise InputError("not a folder", source=str(folder), allowed="the folder of a set")
    if (folder / "trials.csv").exists() or ((folder / "set.toml").exists() and setup is None):
        if not (folder / "trials.csv").exists():
            return _empty(read_model(folder / "set.toml", Setup), folder), ()
        found = read(folder)
        return (found if setup is None else replace(found, setup=setup)), ()
    if setup is not None:
        return _empty(setup, None), ()
    with tempfile.TemporaryDirectory() as place:
        write_template(Path(place), shape=shape)
        template = read_model(Path(place) / "set.toml", Setup)
    note = f"{folder / 'set.toml'} is a template: fill in the bodies before the set is used"
    return _empty(template, None), (note,)


def _empty(setup: Setup, folder: Path | None) -> RecordingSet:
    return RecordingSet(setup, Trials((), (), np.empty(0)), folder=folder)


def _check_one_approach(reduced: Reduced, row: Row) -> None:
    """One approach cannot hold for several impacts that were each measured."""
    measured = [t for t in reduced.trials if "impact_speed_m_s" in t.observables]
    for key in ("impact_speed_m_s", "drop_height_m"):
        if len(measured) > 1 and getattr(row, key) is not None:
            raise InputError(
                f"given for {len(measured)} impacts that were each measured", key=key,
                allowed="left out (release_height_m is that of the first impact)",
            )  # fmt: skip


def _striker(found: RecordingSet, row: Row) -> str:
    names = tuple(found.setup.strikers)
    if row.striker and row.striker not in names:
        raise InputError(repr(row.striker), key="striker", allowed=", ".join(names))
    if not row.striker and len(names) > 1:
        raise InputError("not given", key="striker", allowed=", ".join(names))
    return row.striker or names[0]


def _with_trial(
    found: RecordingSet, name: str, striker: str, trial: Trial, row: Row
) -> RecordingSet:
    """Return the set with one row added, or with the measured columns of a row replaced."""
    old = found.trials
    new = name not in old.trial
    n = len(old) + new
    place = n - 1 if new else old.trial.index(name)

    def grown(values: Array | None) -> Array:
        column = np.full(n, np.nan)
        if values is not None and values.size:
            column[: len(old)] = values
        return column

    texts = {k: [*getattr(old, k), *([""] if new else [])] for k in _TEXTS}
    texts["trial"][place] = name
    texts["striker"][place] = row.striker or texts["striker"][place] or striker
    texts["spot"][place] = row.spot or texts["spot"][place]
    numbers = {k: grown(getattr(old, k)) for k in CONDITIONS if k not in _TEXTS}
    observables = {k: grown(v) for k, v in old.observables.items()}
    stds = {k: grown(v) for k, v in old.observables_std.items()}
    for key, value in {**trial.observables, **_given(row)}.items():
        if key in MEASURED:
            observables.setdefault(key, grown(None))[place] = value.value
            stds.setdefault(key, grown(None))[place] = value.std if value.std > 0.0 else np.nan
        else:
            numbers[key][place] = value.value
            if key + STD_SUFFIX in numbers:
                numbers[key + STD_SUFFIX][place] = value.std if value.std > 0.0 else np.nan
    if np.isnan(numbers["angle_deg"][place]):
        numbers["angle_deg"][place] = 90.0
    if np.isnan([numbers[k][place] for k in ("impact_speed_m_s", "drop_height_m")]).all():
        raise InputError(
            f"the approach of trial {name!r} is not known", key="impact_speed_m_s",
            allowed="impact_speed_m_s or drop_height_m as an option, or a trial of the set",
        )  # fmt: skip
    trials = Trials(
        **{k: tuple(v) for k, v in texts.items()}, **numbers,  # type: ignore[arg-type]
        observables=observables, observables_std=stds,
    )  # fmt: skip
    return replace(found, trials=trials)


def _given(row: Row) -> dict[str, Measured]:
    std = {"impact_speed_m_s": row.impact_speed_m_s_std or 0.0}
    given = {k: getattr(row, k, None) for k in _CONDITIONS}
    return {k: Measured(v, std.get(k, 0.0)) for k, v in given.items() if v is not None}


def _with_setup(found: RecordingSet, striker: str, reduced: Reduced) -> RecordingSet:
    noise = {**reduced.noise, **found.setup.noise}
    body = found.setup.strikers[striker]
    measured = {k: Quantity(value=v.value, std=v.std) for k, v in reduced.striker.items()}
    strikers = {**found.setup.strikers, striker: body.model_copy(update=measured)}
    if noise == found.setup.noise and not measured:
        return found
    setup = found.setup.model_copy(update={"noise": noise, "strikers": strikers})
    return replace(found, setup=setup)


def _write_whole(
    before: RecordingSet, after: RecordingSet, curves: Mapping[str, Trial], folder: Path
) -> None:
    files = files_of(after)
    for name, trial in curves.items():
        for kind, columns in (("traces", trial.trace), ("profiles", trial.profile)):
            if columns:
                files[f"{kind}/{name}.csv"] = _curve_text(columns)
    old = folder / "set.toml"
    if old.exists() and setup_text(before.setup) == setup_text(after.setup):
        del files["set.toml"]  # as a person wrote it, comments and all
    if len(after.trials):
        _read_as(folder, {**files, "set.toml": setup_text(after.setup)})
    else:
        del files["trials.csv"]
    write_files(folder, files)


def _read_as(folder: Path, files: Mapping[str, bytes | str]) -> None:
    """Read the set as it would be; a mistake names the folder that it is meant for."""
    with tempfile.TemporaryDirectory() as made:
        place = Path(made)
        for name, content in files.items():
            path = place / name
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content.encode() if isinstance(content, str) else content)
        try:
            read(place)
        except InputError as error:
            raise InputError(str(error).replace(str(place), str(folder))) from None


def _curve_text(columns: Mapping[str, Array]) -> str:
    return csv_text(
        (
            ["" if np.isnan(v) else f"{v:.9g}" for v in point]
            for point in zip(*columns.values(), strict=True)
        ),
        header=columns,
    )
