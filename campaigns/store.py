"""The campaign file: one writer, opened, appended and closed for each case.

A case is appended whole or not at all (see `campaigns.journal`), so that the file is readable at
any moment and survives the death of its writer and a full disk; what a kill costs is at most the
cases in flight. A second writer is refused through a lock file that names its process.
"""

from __future__ import annotations

import errno
import fcntl
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from ..core.errors import InputError
from ..core.provenance import environment
from ..fem import Curve, Solution
from .case import Case
from .fields import FOLDER, write_fields
from .journal import changing, journal_of, lock, recover
from .quality import Quality, quality_of
from .schema import CURVE, FORMAT, PROFILES, UNLOADING_PROFILES, Dataset

Floats = npt.NDArray[np.float64]

_PROFILE_REACH = 2.0  # profiles are kept out to this many contact radii
_WORTH_COMPRESSING = 512  # values; below it a chunk's index takes more room than it saves


@dataclass(frozen=True)
class UnloadingRecord:
    """One stored unloading; see `campaigns.schema` for units."""

    depth: float
    curve: dict[str, Floats]
    residual_sphere: float
    residual_flat: float
    profiles: dict[str, Floats]


@dataclass(frozen=True)
class CaseRecord:
    """One stored case.

    Parameters
    ----------
    id
        Case id.
    case
        Its specification.
    status
        `done` or `failed`.
    message
        Why it failed; empty when done.
    curve
        Loading results by name, shape (n,), SI (see `campaigns.schema.CURVE`).
    unloadings
        In the order of their depth.
    profiles
        Contact pressure and surfaces by name (see `campaigns.schema.PROFILES`).
    counters
        Work that the solve took.
    accuracy
        Settings that it was solved with: finer than the specification's after a retry.
    environment
        Versions and commit that computed it.
    mesh
        Digest of its mesh.
    """

    id: str
    case: Case
    status: str
    message: str
    curve: dict[str, Floats]
    unloadings: tuple[UnloadingRecord, ...]
    profiles: dict[str, Floats]
    counters: dict[str, float]
    accuracy: dict[str, Any]
    environment: dict[str, str]
    mesh: str

    @property
    def quality(self) -> Quality:
        """Balances, smoothness and reach of the loading curve."""
        return quality_of(self.curve or {"delta": np.zeros(0)}, self.case.pair.R)


@dataclass(frozen=True)
class Summary:
    """One stored case without its arrays; `quality` is none where the solver gave nothing."""

    id: str
    case: Case
    status: str
    message: str
    cpu_s: float
    quality: Quality | None

    @property
    def stale(self) -> bool:
        """Whether the present solver would give other numbers."""
        return self.id != self.case.id


class Store:
    """A campaign file.

    Parameters
    ----------
    path
        The HDF5 file; it need not exist yet.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the lock of this file, so that nobody else writes it.

        Raises
        ------
        InputError
            Another living process holds it.
        """
        lock = self.path.with_suffix(".lock")
        self.path.parent.mkdir(parents=True, exist_ok=True)
        # the system drops a flock with its process, however that ended; the number is for people
        with lock.open("a+") as handle:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                handle.seek(0)
                raise InputError(
                    f"process {handle.read().strip() or '(unknown)'} is writing this campaign",
                    source=str(self.path),
                    allowed="one run at a time; wait for it or stop it",
                ) from None
            handle.truncate(0)
            handle.write(str(os.getpid()))
            handle.flush()
            yield

    def statuses(self) -> dict[str, str]:
        """Status of every stored case by id."""
        if not (self.path.exists() or journal_of(self.path).exists()):
            return {}
        with _reading(self.path) as file:
            return {
                key: str(group.attrs["status"])
                for key, group in file["cases"].items()
                if _ended(group)
            }

    def put(self, case: Case, solution: Solution | None, *, message: str = "") -> None:
        """Append one ended case.

        Parameters
        ----------
        case
            The case.
        solution
            What the solver gave; none when the worker gave nothing.
        message
            Why there is no solution.
        """
        with self._appending() as cases:
            if cases.get(case.id, getlink=True) is not None:
                del cases[case.id]
            group = cases.create_group(case.id)
            done = solution is not None and solution.outcome.completed
            group.attrs["specification"] = json.dumps(case.specification())
            group.attrs["environment"] = json.dumps(environment())
            group.attrs["outcome"] = solution.outcome.ending.value if solution else "worker-lost"
            group.attrs["message"] = "" if done else (message or str(solution and solution.outcome))
            if solution is not None:
                _put_solution(group, solution)
                files = write_fields(solution, self.path.parent / FOLDER, name=case.id[:16])
                group.attrs["fields"] = json.dumps([file.name for file in files])
            # last: a group without a status is one whose writing was cut short
            group.attrs["status"] = "done" if done else "failed"

    def _appending(self) -> Any:
        return _appending(self.path)

    def summaries(self) -> list[Summary]:
        """Read what is known of every case but its arrays, in the order of their ids."""
        if not (self.path.exists() or journal_of(self.path).exists()):
            return []
        with _reading(self.path) as file:
            return [
                _summary(key, group, self.path)
                for key, group in file["cases"].items()
                if _ended(group)
            ]

    def read(self, case_id: str) -> CaseRecord:
        """Read one case, named by its id or the beginning of it."""
        with _reading(self.path) as file:
            found = [key for key in file["cases"] if key.startswith(case_id)]
            if len(found) != 1:
                raise InputError(
                    f"{len(found)} cases begin with {case_id!r}",
                    source=str(self.path),
                    key="case",
                    allowed="an id from `campaign status`, or an unambiguous beginning",
                )
            return _read_case(found[0], file["cases"][found[0]], self.path)

    def read_all(self) -> list[CaseRecord]:
        """Read every case, in the order of their ids."""
        with _reading(self.path) as file:
            return [
                _read_case(key, group, self.path)
                for key, group in file["cases"].items()
                if _ended(group)
            ]


def _ended(group: h5py.Group | None) -> bool:
    """Whether a case was written to its end; one that a kill cut short may not even open."""
    return group is not None and "status" in group.attrs


@contextmanager
def _appending(path: Path) -> Iterator[h5py.Group]:
    if path.exists() or journal_of(path).exists():
        with _reading(path):
            pass  # a damaged file is reported, never written to
    try:
        with changing(path) as file:
            if "cases" not in file:
                file.attrs["format"] = FORMAT
                file.create_group("cases")
            yield file["cases"]
    except OSError as error:
        reasons = {
            errno.ENOSPC: "the disk is full",
            errno.EDQUOT: "the disk quota is used up",
            errno.EFBIG: "a file may not be larger here",
        }
        reason = reasons.get(error.errno or 0, f"cannot be written ({error})")
        raise InputError(
            f"{reason}; all completed cases are kept",
            source=str(path),
            allowed="make room and run again" if error.errno in reasons else "",
        ) from None


@contextmanager
def _reading(path: Path) -> Iterator[h5py.File]:
    with suppress(OSError):
        recover(path)  # where it cannot be finished the file is still as it was
    if not path.exists():
        raise InputError("no such file", source=str(path), allowed="a campaign file (.h5)")
    try:
        file = _opened(path)
    except OSError as error:
        reason = str(error).split("(", 1)[-1].rstrip(")")
        raise InputError(
            f"not a readable HDF5 file ({reason})",
            source=str(path),
            allowed=f"a campaign file; move this one to {path.name}.damaged to start again",
        ) from None
    with file:
        if file.attrs.get("format") != FORMAT or "cases" not in file:
            raise InputError(
                f"format {file.attrs.get('format')!r}", source=str(path), allowed=FORMAT
            )
        try:
            yield file
        except InputError:
            raise
        except (KeyError, OSError, RuntimeError, ValueError) as error:
            raise InputError(f"damaged ({error})", source=str(path)) from None


def _opened(path: Path) -> h5py.File:
    """Open what the file holds at this moment, in memory: a slow reader stops no writer."""
    with path.open("rb") as file:
        lock(file, fcntl.LOCK_SH)
        image = file.read()
    try:
        return h5py.File(h5py.h5f.open_file_image(image))
    except ValueError:
        raise OSError("cut short, or of another kind") from None


def _put_solution(group: h5py.Group, solution: Solution) -> None:
    # a retried case may have been solved more finely than its specification asks
    group.attrs["accuracy"] = json.dumps(solution.accuracy.as_dict())
    group.attrs["mesh"] = solution.mesh_digest
    group.attrs["boundary"] = solution.boundary
    group.attrs["yield_measure"] = solution.yield_measure
    quality = quality_of(vars(solution.loading), solution.problem.pair.R)
    group.attrs["quality"] = json.dumps(asdict(quality))
    counters = solution.counters
    for name in counters.__dataclass_fields__:
        group.attrs[f"counter_{name}"] = float(getattr(counters, name))
    _put_curve(group.create_group("loading"), solution.loading)
    for number, unloading in enumerate(solution.unloadings, start=1):
        part = group.create_group(f"unload-{number}")
        part.attrs["depth"] = unloading.depth
        part.attrs["residual_sphere_m"] = unloading.residual_sphere
        part.attrs["residual_flat_m"] = unloading.residual_flat
        part.attrs["steps"] = unloading.steps
        part.attrs["outcome"] = unloading.outcome.ending.value
        _put_curve(part, unloading.curve)
        for name, about in UNLOADING_PROFILES.items():
            _put_array(part, name, getattr(unloading, name), about)
    if solution.profiles:
        _put_profiles(group.create_group("profiles"), solution)


def _put_profiles(group: h5py.Group, solution: Solution) -> None:
    reach = _PROFILE_REACH * np.nanmax(solution.loading.radius)
    for name, about in PROFILES.items():
        columns = [getattr(p, name) for p in solution.profiles]
        if about.axes[-1] != "node":
            _put_array(group, name, np.array(columns, dtype=np.float32), about)
            continue
        side = "flat_r" if name.startswith("flat") else "sphere_r"
        radii = [getattr(p, side) for p in solution.profiles]
        kept = [
            c[: int(np.searchsorted(r, reach)) + 1] for c, r in zip(columns, radii, strict=True)
        ]
        # the mesh follows the contact, so that the profiles differ in their number of nodes
        values = np.full((len(kept), max(map(len, kept))), np.nan, dtype=np.float32)
        for row, column in zip(values, kept, strict=True):
            row[: len(column)] = column
        _put_array(group, name, values, about)


def _put_curve(group: h5py.Group, curve: Curve) -> None:
    for name, about in CURVE.items():
        _put_array(group, name, getattr(curve, name), about)


def _put_array(
    group: h5py.Group, name: str, values: Floats | npt.NDArray[np.float32], about: Dataset
) -> None:
    packed = {"compression": "gzip", "shuffle": True} if values.size > _WORTH_COMPRESSING else {}
    data = group.create_dataset(name, data=values, **packed)
    data.attrs["unit"] = about.unit
    data.attrs["axes"] = ",".join(about.axes)
    data.attrs["meaning"] = about.meaning


def _summary(key: str, group: h5py.Group, path: Path) -> Summary:
    attrs, quality = group.attrs, None
    if "quality" in attrs:
        quality = Quality(**json.loads(attrs["quality"]))
    elif "loading" in group:  # stored before the quality was
        quality = _read_case(key, group, path).quality
    return Summary(
        id=key,
        case=Case.from_specification(json.loads(attrs["specification"])),
        status=str(attrs["status"]),
        message=str(attrs["message"]),
        cpu_s=float(attrs.get("counter_cpu_s", 0.0)),
        quality=quality,
    )


def _read_case(key: str, group: h5py.Group, path: Path) -> CaseRecord:
    unloadings = []
    for name in sorted((n for n in group if n.startswith("unload-")), key=lambda n: int(n[7:])):
        part = group[name]
        unloadings.append(
            UnloadingRecord(
                depth=float(part.attrs["depth"]),
                curve=_read_arrays(part, CURVE, path),
                residual_sphere=float(part.attrs["residual_sphere_m"]),
                residual_flat=float(part.attrs["residual_flat_m"]),
                profiles=_read_arrays(part, UNLOADING_PROFILES, path),
            )
        )
    prefix = "counter_"
    return CaseRecord(
        id=key,
        case=Case.from_specification(json.loads(group.attrs["specification"])),
        status=str(group.attrs["status"]),
        message=str(group.attrs["message"]),
        curve=_read_arrays(group["loading"], CURVE, path) if "loading" in group else {},
        unloadings=tuple(unloadings),
        profiles=_read_arrays(group["profiles"], PROFILES, path) if "profiles" in group else {},
        counters={
            name[len(prefix) :]: float(value)
            for name, value in group.attrs.items()
            if name.startswith(prefix)
        },
        accuracy=json.loads(group.attrs.get("accuracy", "{}")),
        environment=json.loads(group.attrs["environment"]),
        mesh=str(group.attrs.get("mesh", "")),
    )


def _read_arrays(group: h5py.Group, schema: dict[str, Dataset], path: Path) -> dict[str, Floats]:
    out = {}
    for name, about in schema.items():
        if name not in group:
            raise InputError("missing", source=str(path), key=f"{group.name}/{name}")
        if group[name].attrs.get("unit") != about.unit:
            raise InputError(
                f"unit {group[name].attrs.get('unit')!r}",
                source=str(path),
                key=f"{group.name}/{name}",
                allowed=about.unit,
            )
        out[name] = np.asarray(group[name][()], dtype=float)
    return out
