"""Reductions written into a recording set: rows, curves, and a record of where they came from.

A trial that the set already has keeps what it holds, but for the columns that were measured now. A
folder without set.toml gets one with the body that was measured, in which the rest is to be filled
in; of an existing one only what was measured changes. Nothing is written before the whole set, as
it would be, has been read without a mistake.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.names import ALLOWED, names_a_file, trial_name
from ...core.inputs.toml_input import parse_model, read_toml
from ...core.observables import LOAD
from ...core.output import csv_text, finish_pending, locked, write_files
from ...core.rig import Quantity
from ...recordings.columns import CONDITIONS, MEASURED, STD_SUFFIX
from ...recordings.recording_set import RecordingSet, files_of, read, read_as
from ...recordings.setup_file import SetFile, flowing, setup_text, without_marks
from ...recordings.template import Shape, template_text
from ...recordings.trials import Trials
from ..measured import Measured, Trial
from ..reduced import Reduced
from .record import write_record
from .row import Row

_TEXTS = ("trial", "striker", "spot", "note")
_CONDITIONS = tuple(n for n in CONDITIONS if n not in _TEXTS and not n.endswith(STD_SUFFIX))


@dataclass(frozen=True)
class Stored:
    """What was written: rows of trials.csv, the record, the picture, a flow curve, and remarks."""

    trials: tuple[str, ...]
    record: Path
    picture: Path
    notes: tuple[str, ...]
    flow: Path | None = None


def store(
    reduced: Reduced, folder: Path, row: Row, *, kind: str, options: Mapping[str, Any],
    setup: SetFile | None = None, strikers: Sequence[str] = (),
) -> Stored:  # fmt: skip
    """Write a reduction into a set, new or existing, in a row with conditions that the file lacks.

    `kind` and `options` are kept in the record. A new set gets `setup`, or else one to fill in, of
    these `strikers`. A set that would not be sound is refused.
    """
    # another reduction may write the same set: what it added must not be lost
    with locked(folder):
        finish_pending(folder)
        shape = _shape(kind, options)
        before, text = _set_before(folder, setup, shape=shape, strikers=strikers)
        striker = _striker(before, row)
        after, curves = before, dict[str, Trial]()
        _check_one_approach(reduced, row)
        own = row.trial or trial_name(reduced.source, **options)
        # a reader need not label its trials: no row may take another one's place
        apart = len({trial.label for trial in reduced.trials}) == len(reduced.trials)
        for k, trial in enumerate(reduced.trials, start=1):
            name = "-".join(filter(None, (own, trial.label, "" if apart else str(k))))
            if not names_a_file(name):  # a label may be the raw file's own
                raise InputError(repr(name), key="trial", allowed=ALLOWED)
            after = _with_trial(after, name, striker, trial, row)
            curves[name] = trial
        new = not (folder / "set.toml").exists() and setup is None
        stated = _stated_body(shape, options) if new else {}
        after = _with_flow(_with_setup(after, striker, reduced, stated), reduced)
        text = setup_text(after.setup, before=before.setup, text=text)
        open_keys = without_marks(tomllib.loads(text))[1]
        notes = (f"{folder / 'set.toml'}: to fill in: {', '.join(open_keys)}",) if open_keys else ()
        kept, told = _kept_flows(after, _flow_path(reduced, folder), folder)
        _write_whole(after, text, curves, folder, kept)
    record, picture = write_record(
        reduced, folder / "reduced", own, kind=kind, options=options, trials=[*curves]
    )
    return Stored(tuple(curves), record, picture, (*notes, *told), _flow_path(reduced, folder))


def store_each(
    items: Iterable[tuple[str, Callable[[], tuple[Reduced, Row, Mapping[str, Any]]]]],
    folder: Path, *, kind: str, setup: Mapping[str, Any],
) -> tuple[int, list[str]]:  # fmt: skip
    """Write many raw files into one set, those that show nothing left out.

    An item is the name of a raw file and what reduces it: the reduction, the conditions that the
    file does not tell, the options that were used. Returns how many trials were written, and a line
    for each raw file that was left out.
    """
    made, left_out = 0, list[str]()
    new: SetFile | None = SetFile.model_validate(setup)
    for name, make in items:
        try:
            reduced, row, options = make()
            done = store(reduced, folder, row, kind=kind, options=options, setup=new)
            made, new = made + len(done.trials), None
        except InputError as error:
            left_out += [f"{name}: {line}" for line in str(error).splitlines()]
    if new and not left_out:
        left_out.append("no raw file of the kind that the recipe reads")
    return made, left_out


def _shape(kind: str, options: Mapping[str, Any]) -> Shape:
    """Return what struck: as the options say, else a ball where bounces are heard or timed."""
    usual = "rod" if kind in ("video", "tip", "mocap", "scan") else "sphere"
    return "rod" if options.get("shape", usual) == "rod" else "sphere"


def _stated_body(shape: Shape, options: Mapping[str, Any]) -> dict[str, Measured]:
    """Return what the options of a reduction tell of the striker."""

    def told(key: str) -> Measured | None:
        value, std = options.get(key), options.get(f"{key}_std", 0.0)
        return None if value is None else Measured(float(value), float(std))

    size = told("diameter_m")
    half = None if size is None else size.scaled(0.5)
    body = {"mass_kg": told("mass_kg"), "tip_radius_m": told("tip_radius_m")}
    if shape == "rod":
        body |= {"radius_m": half, "length_m": told("length_m")}
    else:
        body["tip_radius_m"] = body["tip_radius_m"] or half
    return {key: value for key, value in body.items() if value is not None}


def _set_before(
    folder: Path, setup: SetFile | None, *, shape: Shape, strikers: Sequence[str]
) -> tuple[RecordingSet, str]:
    """Return the set as it is, or an empty one, and its set.toml as text."""
    if folder.exists() and not folder.is_dir():
        raise InputError("not a folder", source=str(folder), allowed="the folder of a set")
    file = folder / "set.toml"
    if not file.exists():
        if setup is not None:
            return _empty(setup, None), setup_text(setup)
        text = template_text(shape, folder.resolve().name, strikers)
        content = without_marks(tomllib.loads(text))[0]
        return _empty(parse_model(content, SetFile, source=str(file)), None), text
    content, _ = without_marks(read_toml(file))
    old = parse_model(content, SetFile, source=str(file))
    text = file.read_text(encoding="utf-8")
    rows = (folder / "trials.csv").exists() and _has_rows(folder / "trials.csv")
    found = read(folder, unfinished=True) if rows else _empty(old, folder)
    if setup is not None:
        text = setup_text(setup, before=old, text=text)
    # as the file says it: a strength read from a flow curve is not written
    return replace(found, setup=setup or old), text


def _has_rows(path: Path) -> bool:
    return len([line for line in path.read_bytes().splitlines() if line.strip(b" ,")]) > 1


def _empty(setup: SetFile, folder: Path | None) -> RecordingSet:
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

    varied = {
        k: [*old.varied.get(k, [""] * len(old)), *([""] if new else [])]
        for k in dict.fromkeys([*old.varied, *row.varied])
    }
    for key, text in row.varied.items():
        varied[key][place] = text
    texts = {k: [*getattr(old, k), *([""] if new else [])] for k in _TEXTS}
    texts["trial"][place] = name
    texts["striker"][place] = row.striker or texts["striker"][place] or striker
    texts["spot"][place] = row.spot or trial.spot or texts["spot"][place]
    texts["note"][place] = trial.note or texts["note"][place]
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
    if np.isnan([numbers[k][place] for k in ("impact_speed_m_s", "drop_height_m", LOAD)]).all():
        raise InputError(
            f"the approach of trial {name!r} is not known", key="impact_speed_m_s",
            allowed="impact_speed_m_s or drop_height_m as an option, or a trial of the set",
        )  # fmt: skip
    trials = Trials(
        **{k: tuple(v) for k, v in texts.items()}, **numbers,  # type: ignore[arg-type]
        varied={k: tuple(v) for k, v in varied.items()},
        observables=observables, observables_std=stds,
    )  # fmt: skip
    return replace(found, trials=trials)


def _given(row: Row) -> dict[str, Measured]:
    std = {"impact_speed_m_s": row.impact_speed_m_s_std or 0.0}
    given = {k: getattr(row, k, None) for k in _CONDITIONS}
    return {k: Measured(v, std.get(k, 0.0)) for k, v in given.items() if v is not None}


def _with_setup(
    found: RecordingSet, striker: str, reduced: Reduced, stated: Mapping[str, Measured]
) -> RecordingSet:
    noise = {**reduced.noise, **found.setup.noise}
    body = found.setup.strikers[striker]
    measured = {
        k: Quantity(value=v.value, std=v.std) for k, v in {**stated, **reduced.striker}.items()
    }
    strikers = {**found.setup.strikers, striker: body.model_copy(update=measured)}
    setup = found.setup.model_copy(update={"noise": noise, "strikers": strikers})
    return replace(found, setup=setup)


def _with_flow(found: RecordingSet, reduced: Reduced) -> RecordingSet:
    """Put a measured flow curve beside set.toml and name it there; a stated strength stays."""
    if reduced.flow is None:
        return found
    body, flow = reduced.flow
    key = "target" if body == "target" else f"strikers.{body}"
    if key not in found.setup.bodies:
        raise InputError(
            repr(body), key="body", allowed=", ".join(["target", *found.setup.strikers])
        )
    named = {"flow_curve": _flow_file(body)}
    target, strikers = found.setup.target, dict(found.setup.strikers)
    if body == "target":
        target = target.model_copy(update=named)
    else:
        strikers[body] = strikers[body].model_copy(update=named)
    setup = found.setup.model_copy(update={"target": target, "strikers": strikers})
    return replace(found, setup=setup, flows={**found.flows, key: flow})


def _flow_file(body: str) -> str:
    return f"{body}-flow.csv"


def _flow_path(reduced: Reduced, folder: Path) -> Path | None:
    return None if reduced.flow is None else folder / _flow_file(reduced.flow[0])


def _kept_flows(
    after: RecordingSet, measured: Path | None, folder: Path
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Return the flow curves of the folder that stay as they are, and a line for one renamed."""
    named = {body.flow_curve for body in flowing(after.setup).values()}
    files = {
        name: (folder / name).read_bytes()
        for name in named if (folder / name) != measured and (folder / name).is_file()
    }  # fmt: skip
    if measured is None or not measured.is_file():
        return files, ()
    before = measured.read_bytes()
    if before == str(files_of(after)[measured.name]).encode():
        return files, ()
    copies = (measured.with_name(f"{measured.stem}-{k}.csv") for k in count(1))
    copy = next(path for path in copies if not path.exists())
    note = f"{measured}: there was another one, kept as {copy.name}"
    return {**files, copy.name: before}, (note,)


def _write_whole(
    after: RecordingSet, text: str, curves: Mapping[str, Trial], folder: Path,
    kept: Mapping[str, bytes],
) -> None:  # fmt: skip
    files = {**files_of(after), **kept, "set.toml": text}
    for name, trial in curves.items():
        for kind, columns in (("traces", trial.trace), ("profiles", trial.profile)):
            if columns:
                files[f"{kind}/{name}.csv"] = _curve_text(columns)
    if len(after.trials):
        places = {name: trial.place for name, trial in curves.items() if trial.place}
        read_as(folder, files, unfinished=True, places=places)
    else:
        del files["trials.csv"]
    write_files(folder, files)


def _curve_text(columns: Mapping[str, Array]) -> str:
    return csv_text(
        (
            ["" if np.isnan(v) else f"{v:.9g}" for v in point]
            for point in zip(*columns.values(), strict=True)
        ),
        header=columns,
    )
