"""A recording set: the folder in which measured impacts reach the program.

`read` returns a frozen `RecordingSet` or raises one error that holds every mistake of the folder;
`write` makes the same folder again. The format is described in docs/recording-set.md.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..core.approach import speeds_at_touch
from ..core.arrays import Array, Indices, Mask
from ..core.errors import InputError, InputErrors
from ..core.inputs.csv_table import Problems
from ..core.inputs.flow_curve import SPECIMENS, MeasuredFlow, read_flow_curve
from ..core.inputs.input_file import file_beside
from ..core.inputs.toml_input import parse_model, read_toml
from ..core.observables import LOAD, RELATIVE_SUFFIX
from ..core.output import finish, locked, write_files
from ..core.rig import BodyTable, Quantity, StrikerTable
from . import noise, second_sphere
from .columns import MEASURED
from .noise import Noise
from .notebook import picture_of, table_of
from .questions import notes_of
from .rules import RULES
from .same_file import taken_twice
from .series import read_profile, read_trace, series_in
from .setup_file import SetFile, flowing, setup_text, without_marks
from .trials import Trials, read_trials, trials_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, eq=False)
class ApproachMotion:
    """The motion just before touch, each array of shape (n,).

    - `normal`, `normal_std`: normal approach speed and its standard deviation [m/s]; the second is
      NaN where the set says nothing, both are of a press.
    - `angle`: between axis and flat for a rod, pi/2 for a sphere [rad].
    - `tangential`: velocity of the centre of mass along +x [m/s].
    - `spin`: angular velocity, counter-clockwise [rad/s].
    """

    normal: Array
    normal_std: Array
    angle: Array
    tangential: Array
    spin: Array


@dataclass(frozen=True, eq=False)
class RecordingSet:
    """A recording set in memory.

    - `setup`: everything in set.toml; attributes carry the names of its keys.
    - `trials`: the rows of trials.csv as arrays of shape (n,).
    - `traces`, `profiles`: files by name of the trial; `trace(NAME)` and `profile(NAME)` read them.
    - `folder`: where the set was read from; `None` for one made in memory.
    - `notes`: remarks of the reader that are no mistakes.
    - `to_fill`: keys of set.toml that are still to be filled in; only a set that was read as
      unfinished has some.
    - `flows`: measured flow curves by the key of their body, `target` or `strikers.NAME`.
    """

    setup: SetFile
    trials: Trials
    traces: Mapping[str, Path] = field(default_factory=dict)
    profiles: Mapping[str, Path] = field(default_factory=dict)
    folder: Path | None = None
    notes: tuple[str, ...] = ()
    to_fill: tuple[str, ...] = ()
    flows: Mapping[str, MeasuredFlow] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The set's name, or that of its folder."""
        return self.setup.name or (self.folder.name if self.folder else "")

    @property
    def impacts(self) -> RecordingSet:
        """The set without its quasi-static presses."""
        pressed = self.trials.pressed
        return self.take(~pressed) if pressed.any() else self

    @property
    def presses(self) -> RecordingSet:
        """The set's quasi-static presses alone."""
        return self.take(self.trials.pressed)

    @cached_property
    def observed(self) -> tuple[str, ...]:
        """Observables with at least one value, in the order of the format."""
        found = self.trials.observables
        return tuple(k for k in MEASURED if k in found and not np.isnan(found[k]).all())

    def plot(self) -> Figure:
        """Return the observables over the speed, or over the angle where that is what varies."""
        return picture_of(self)

    def _repr_html_(self) -> str:
        return table_of(self)

    def strikers(self) -> tuple[StrikerTable, ...]:
        """The striker of each trial, n of them."""
        return tuple(self.setup.strikers[name] for name in self.trials.striker)

    def values(self, name: str) -> Array:
        """Return an observable, shape (n,), SI, NaN where not measured."""
        return self.trials.observables[name]

    def std(self, name: str) -> Array:
        """Return the standard deviation of an observable, shape (n,), NaN where not measured."""
        return self.noise(name).std

    def noise(self, name: str) -> Noise:
        """Return the standard deviation of an observable and where it comes from."""
        if name not in self._noises:
            self._noises[name] = noise.noise_of(
                name, self.values(name), self.trials.observables_std.get(name),
                self.setup.noise, self.conditions,
            )  # fmt: skip
        return self._noises[name]

    @cached_property
    def _noises(self) -> dict[str, Noise]:
        return {}

    @cached_property
    def conditions(self) -> Indices:
        """Number of each trial's condition, shape (n,): repeats share a number.

        Same striker, angle within 1 degree, approach speed (or a press's load) within 2 percent,
        same tangential speed and spin within 2 percent of the approach, same entry in every column
        `x_NAME`; a spot that is struck again is its own condition.
        """
        approach, trials = self.approach, self.trials
        struck: dict[str, int] = {}
        blow = []
        for spot in trials.spot:
            struck[spot] = struck.get(spot, -1) + 1
            blow.append(struck[spot] if spot else 0)
        sizes = np.array([s.length / 2.0 or s.body_radius for s in self.strikers()])
        return noise.numbered(
            trials.striker,
            list(noise.bins(np.asarray(trials.angle_deg), width=RULES.angle_bin)),
            list(noise.bins(np.log(approach.normal), width=RULES.speed_bin)),
            list(noise.bins(approach.tangential / approach.normal, width=RULES.speed_bin)),
            list(noise.bins(approach.spin * sizes / approach.normal, width=RULES.speed_bin)),
            list(noise.bins(trials.temperature_K, width=RULES.angle_bin)),
            list(noise.bins(np.log(trials.load_N), width=RULES.speed_bin)),
            list(noise.bins(np.log(trials.press_rate_per_s), width=RULES.rate_bin)),
            *trials.varied.values(),
            blow,
        )

    @cached_property
    def approach(self) -> ApproachMotion:
        """The motion just before touch, from speed or height of fall, angle, and the columns."""
        trials, g = self.trials, self.setup.gravity_m_s2
        rod = np.array([s.shape == "rod" for s in self.strikers()], dtype=bool)
        angle = np.radians(trials.angle_deg)
        normal, along = speeds_at_touch(
            trials.impact_speed_m_s, trials.drop_height_m, angle, rod, gravity=g.value
        )
        fraction = self.setup.noise.get("impact_speed" + RELATIVE_SUFFIX, np.nan)
        std = np.where(
            np.isnan(trials.impact_speed_m_s_std), fraction * normal, trials.impact_speed_m_s_std
        )
        given = trials.approach_tangential_m_s
        along = np.where(trials.pressed, 0.0, np.where(np.isnan(given), along, given))
        return ApproachMotion(
            normal=normal, normal_std=std, angle=np.where(rod, angle, np.pi / 2.0),
            tangential=along, spin=np.nan_to_num(trials.approach_spin_rad_s, nan=0.0),
        )  # fmt: skip

    @cached_property
    def load_std(self) -> Array:
        """Standard deviation of the presses' loads, shape (n,) [N]; nan where it is not stated."""
        stated, table = self.trials.load_N_std, self.setup.noise
        parts = [table.get(LOAD, np.nan), table.get(LOAD + RELATIVE_SUFFIX, np.nan)]
        absolute, fraction = np.nan_to_num(parts) if np.isfinite(parts).any() else parts
        return np.where(np.isnan(stated), np.hypot(absolute, fraction * self.trials.load_N), stated)

    def trace(self, trial: str) -> Mapping[str, Array]:
        """Return the columns of a trial's trace, each of shape (k,)."""
        return read_trace(self.traces[trial])

    def profile(self, trial: str) -> Mapping[str, Array]:
        """Return the columns of a trial's crater profile, each of shape (k,)."""
        return read_profile(self.profiles[trial])

    def take(self, rows: npt.ArrayLike) -> RecordingSet:
        """Return the set with some of its trials and their curves: indices or a mask."""
        trials = self.trials.take(rows)
        kept = set(trials.trial)
        return replace(
            self, trials=trials, traces={k: v for k, v in self.traces.items() if k in kept},
            profiles={k: v for k, v in self.profiles.items() if k in kept},
        )  # fmt: skip


def read(folder: Path | str, *, unfinished: bool = False) -> RecordingSet:
    """Read a recording set.

    `folder`: the folder that holds set.toml and trials.csv; `unfinished`: whether values and noise
    of set.toml may still be missing; sizes to be filled in are then 1.

    Raises `InputErrors`: every mistake found in all files of the folder, one line each: file, row,
    column or key, what was found, what is allowed.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError("no such folder", source=str(folder), allowed="a folder with set.toml")
    finish(folder)
    mistakes: list[InputError] = []
    setup, strikers, to_fill = _read_setup(folder / "set.toml", mistakes)
    if not unfinished:
        mistakes += (
            InputError(
                "to fill in", source=str(folder / "set.toml"), key=key,
                allowed="what was measured, or no such key if it is not known",
            )
            for key in to_fill
        )  # fmt: skip
    problems = Problems(str(folder / "trials.csv"))
    trials = read_trials(folder / "trials.csv", strikers, problems)
    names = trials.trial if trials is not None else ()
    mistakes += problems.found
    traces = series_in(folder / "traces", names, mistakes)
    profiles = series_in(folder / "profiles", names, mistakes)
    flows = _read_flows(setup, folder, mistakes) if setup is not None else {}
    mistakes += taken_twice(folder / "reduced", names)
    if setup is None or trials is None or mistakes:
        raise InputErrors(tuple(mistakes))
    found = RecordingSet(
        _with_strengths(setup, flows), trials, traces, profiles, folder, (), tuple(to_fill), flows
    )
    _check_falls(found, folder / "set.toml")
    mistakes += second_sphere.mistakes_of(found)
    mistakes += [*_impossible(found, problems), *_wider(found, problems)]
    if not unfinished:
        mistakes += _without_noise(found)
    if mistakes:
        raise InputErrors(tuple(mistakes))
    return replace(found, notes=tuple(notes_of(found)))


def _read_setup(
    path: Path, mistakes: list[InputError]
) -> tuple[SetFile | None, frozenset[str], list[str]]:
    """Return the set-up, the names of its strikers even when something else is wrong, open keys."""
    content: dict[str, object] = {}
    to_fill: list[str] = []
    setup = None
    try:
        content, to_fill = without_marks(read_toml(path))
        setup = parse_model(content, SetFile, source=str(path))
    except InputError as error:
        mistakes += error.errors if isinstance(error, InputErrors) else [error]
    if setup is not None:
        mistakes += (
            InputError(
                "true", source=str(path), key=f"{key}.rigid", allowed="a body that gives way"
            )
            for key, body in setup.bodies.items()
            if body.rigid
        )
    tables = content.get("strikers")
    return setup, frozenset(tables) if isinstance(tables, dict) else frozenset(), to_fill


def _read_flows(
    setup: SetFile, folder: Path, mistakes: list[InputError]
) -> dict[str, MeasuredFlow]:
    flows = {}
    for key, body in flowing(setup).items():
        if Path(body.flow_curve).name != body.flow_curve:
            mistakes.append(InputError(
                repr(body.flow_curve), source=str(folder / "set.toml"), key=f"{key}.flow_curve",
                allowed="the name of a file beside set.toml",
            ))  # fmt: skip
            continue
        try:
            file = file_beside(folder / "set.toml", body.flow_curve, key=f"{key}.flow_curve")
            flows[key] = read_flow_curve(file)
        except InputError as error:
            mistakes += error.errors if isinstance(error, InputErrors) else [error]
    return flows


def _with_strengths(setup: SetFile, flows: Mapping[str, MeasuredFlow]) -> SetFile:
    """Read the strength of a body from its flow curve unless it is stated.

    The piece that is struck is not the specimen that was pulled.
    """

    def strong(key: str, body: BodyTable) -> BodyTable:
        if key not in flows or body.Sy_Pa is not None:
            return body
        read = flows[key].strength
        return body.model_copy(update={"Sy_Pa": Quantity(value=read, std=SPECIMENS * read)})

    strikers = {k: strong(f"strikers.{k}", b) for k, b in setup.strikers.items()}
    return setup.model_copy(update={"target": strong("target", setup.target), "strikers": strikers})


def _check_falls(found: RecordingSet, path: Path) -> None:
    """Refuse trials with a height of fall and no speed where nothing falls."""
    fallen = np.isnan(found.trials.impact_speed_m_s) & ~np.isnan(found.trials.drop_height_m)
    if found.setup.gravity_m_s2.value == 0.0 and fallen.any():
        first = found.trials.trial[int(np.argmax(fallen))]
        raise InputErrors((
            InputError(
                "0", source=str(path), key="gravity_m_s2",
                allowed=f"above 0 where a trial has a height of fall and no speed, as {first}",
            ),
        ))  # fmt: skip


def _impossible(found: RecordingSet, problems: Problems) -> list[InputError]:
    """Return the rows that rebound faster than they came, beyond their error, without a reason."""
    e, notes = found.trials.observables.get("restitution"), found.trials.note
    if e is None:
        return []
    # smaller gains may be scatter that was not stated: the audit and the diagnosis name them
    gain = np.nan_to_num(e, nan=0.0) - 1.0
    high = np.flatnonzero(_beyond(gain, np.nan_to_num(found.std("restitution"))))
    if high.size < np.count_nonzero(gain > RULES.restitution_slip):
        high = np.flatnonzero(_beyond(gain, _std_of_others(found, gain)))
    return [
        InputError(
            f"{e[k]:g} above 1 without a reason", source=problems.source,
            key=f"trial {found.trials.trial[k]}, column restitution",
            allowed="0 to 1, or a reason in the column note",
        )
        for k in high if not notes[k]
    ]  # fmt: skip


def _beyond(gain: Array, std: Array) -> Mask:
    return gain > np.maximum(RULES.restitution_beyond * std, RULES.restitution_slip)


def _std_of_others(found: RecordingSet, gain: Array) -> Array:
    """Standard deviations of the restitution, shape (n,); repeats do not vouch for themselves.

    A scatter is that of the rows without a gain, and of those with one that these allow.
    """
    known, e = found.noise("restitution"), found.trials.observables["restitution"]
    std, stated = np.nan_to_num(known.std), found.trials.observables_std.get("restitution")
    if np.isinf(known.degrees):
        return std
    of_repeats = np.isnan(np.full(e.shape, np.nan) if stated is None else stated)
    pool = gain <= RULES.restitution_slip
    while True:
        counted = np.where(pool, e, np.nan)
        others = noise.noise_of("restitution", counted, None, {}, found.conditions)
        if np.isinf(others.degrees):  # too few to tell
            return std
        largest = float(np.nanmax(others.std))
        limits = np.where(of_repeats, np.minimum(std, largest), std)
        allowed = ~_beyond(gain, limits)
        if not (allowed & ~pool).any():
            return limits
        pool |= allowed


def _wider(found: RecordingSet, problems: Problems) -> list[InputError]:
    """Return the rows whose dent is wider than the body that made it."""
    diameter = found.trials.observables.get("dent_diameter_m", np.empty(0))
    return [
        InputError(
            f"{d:g}", source=problems.source,
            key=f"trial {found.trials.trial[k]}, column dent_diameter_m",
            allowed=f"up to the tip's own diameter, {2.0 * body.tip_radius_m.value:g}",
        )
        for k, (d, body) in enumerate(zip(diameter, found.strikers(), strict=False))
        if d > 2.0 * body.tip_radius_m.value
    ]  # fmt: skip


def _without_noise(found: RecordingSet) -> list[InputError]:
    source = str((found.folder or Path()) / "set.toml")
    return [
        InputError(
            f"{name} has no standard deviation, and fewer than {RULES.repeats} repeats that "
            "differ",
            source=source, key=f"noise.{name}",
            allowed=f"{name} or {name}{RELATIVE_SUFFIX} in [noise], or a column {name}_std",
        )
        for name in found.observed
        if np.isnan(found.std(name)[~np.isnan(found.values(name))]).any()
    ]  # fmt: skip


def write(found: RecordingSet, folder: Path | str) -> None:
    """Write a recording set; its traces and profiles are copied into the folder.

    `folder`: made if it does not exist; set.toml and trials.csv in it are replaced.

    Raises `InputError`: it cannot be written.
    """
    with locked(Path(folder)):
        write_files(Path(folder), files_of(found))


def files_of(found: RecordingSet) -> dict[str, bytes | str]:
    """Return the files of a set by their place in its folder."""
    curves = {
        f"{kind}/{trial}.csv": path.read_bytes()
        for kind, files in (("traces", found.traces), ("profiles", found.profiles))
        for trial, path in files.items()
    }
    flows = {body.flow_curve: found.flows[key].text()
             for key, body in flowing(found.setup).items() if key in found.flows}  # fmt: skip
    return {
        **curves, **flows, "set.toml": setup_text(found.setup),
        "trials.csv": trials_text(found.trials),
    }  # fmt: skip


def read_as(
    folder: Path, files: Mapping[str, bytes | str], *, unfinished: bool,
    places: Mapping[str, str] = MappingProxyType({}),
) -> None:  # fmt: skip
    """Read a set as it would be with these files; a mistake names the folder they are meant for.

    Of a trial it names the place, a file and its row, that the trial is from.
    """
    with tempfile.TemporaryDirectory() as made:
        place = Path(made)
        for name, content in files.items():
            path = place / name
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content.encode() if isinstance(content, str) else content)
        try:
            read(place, unfinished=unfinished)
        except InputError as error:
            told = str(error).replace(str(place), str(folder))
            for trial, place_of in places.items():
                told = told.replace(f"{folder / 'trials.csv'}: trial {trial},", f"{place_of},")
            raise InputErrors(tuple(map(InputError, told.splitlines()))) from None
