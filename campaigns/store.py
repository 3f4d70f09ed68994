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
from pathlib import Path

import h5py

from ..core.errors import Ending, InputError
from ..core.provenance import environment
from ..fem import Solution
from .case import Case
from .fields import FOLDER, write_fields
from .journal import changing, journal_of, lock, recover
from .records import CaseRecord, Summary, read_case, read_summary
from .schema import FORMAT
from .writing import put_solution


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
        with _appending(self.path) as cases:
            if cases.get(case.id, getlink=True) is not None:
                del cases[case.id]
            group = cases.create_group(case.id)
            done = solution is not None and solution.outcome.completed
            group.attrs["specification"] = json.dumps(case.specification())
            group.attrs["environment"] = json.dumps(environment())
            ending = solution.outcome.ending if solution else Ending.WORKER_LOST
            group.attrs["outcome"] = ending.value
            group.attrs["message"] = "" if done else (message or str(solution and solution.outcome))
            if solution is not None:
                put_solution(group, solution)
                files = write_fields(solution, self.path.parent / FOLDER, name=case.id[:16])
                group.attrs["fields"] = json.dumps([file.name for file in files])
            # last: a group without a status is one whose writing was cut short
            group.attrs["status"] = "done" if done else "failed"

    def summaries(self) -> list[Summary]:
        """Read what is known of every case but its arrays, in the order of their ids."""
        if not (self.path.exists() or journal_of(self.path).exists()):
            return []
        with _reading(self.path) as file:
            return [
                read_summary(key, group, self.path)
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
            return read_case(found[0], file["cases"][found[0]], self.path)

    def read_all(self) -> list[CaseRecord]:
        """Read every case, in the order of their ids."""
        with _reading(self.path) as file:
            return [
                read_case(key, group, self.path)
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
