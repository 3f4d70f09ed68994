"""The campaign file: one writer, opened, appended and closed for each case.

A case is appended whole or not at all (see `campaigns.journal`), so that the file is readable at
any moment and survives the death of its writer, a full disk and a loss of power; what a kill costs
is at most the cases in flight. A second writer is refused through a lock file that names its
process. The file is sealed and each case carries its digest (see `campaigns.contents`): no changed
byte is taken for a number.
"""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TypeVar

import h5py

from ..core.errors import Ending, InputError
from ..core.inputs.input_file import checked_file, read_bytes
from ..core.output import NO_ROOM, cannot_write, folder_for_output, write_file
from ..core.provenance import environment
from ..fem import Solution
from .case import Case
from .contents import DAMAGE, DIGEST, MOST_BYTES, check_seal, damage, open_image, read_tree
from .journal import changing, journal_of, lock, new_image, recover
from .records import CaseRecord, Summary, read_case, read_summary
from .schema import FORMAT
from .writing import FIELDS, put_solution, write_fields

Read = TypeVar("Read")

_REPAIR = "`dentscope campaign repair` keeps the cases that are whole"


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
            Another living process holds it, or it cannot be made.
        """
        place = self.path.with_suffix(".lock")
        folder_for_output(self.path.parent)
        try:
            handle = place.open("a+")
        except OSError as error:
            raise cannot_write(error, place) from None
        # the system drops a flock with its process, however that ended; the number is for people
        with handle:
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
        return {} if self._absent() else _each(self.path, _status)

    def put(
        self,
        case: Case,
        solution: Solution | None,
        *,
        message: str = "",
        computed_by: Mapping[str, str] | None = None,
        also: Callable[[h5py.Group], None] | None = None,
    ) -> None:
        """Append one ended case.

        Parameters
        ----------
        case
            The case.
        solution
            What the solver gave; none when the worker gave nothing.
        message
            Why there is no solution.
        computed_by
            Versions and commit of the worker; those of this process by default.
        also
            Writes more into the case's group.

        Raises
        ------
        InputError
            It cannot be written; all completed cases are kept.
        """
        if not self._absent():
            with _reading(self.path):
                pass  # a damaged file is reported, never written to
        with _appending(self.path) as cases:
            if cases.get(case.id, getlink=True) is not None:
                del cases[case.id]
            group = cases.create_group(case.id)
            done = solution is not None and solution.outcome.completed
            group.attrs["specification"] = json.dumps(case.specification())
            group.attrs["environment"] = json.dumps(dict(computed_by or environment()))
            ending = solution.outcome.ending if solution else Ending.WORKER_LOST
            group.attrs["outcome"] = ending.value
            group.attrs["message"] = "" if done else (message or str(solution and solution.outcome))
            if solution is not None:
                put_solution(group, solution)
                files = write_fields(solution, self.path.parent / FIELDS, name=case.id[:16])
                group.attrs["fields"] = json.dumps([file.name for file in files])
            if also is not None:
                also(group)
            group.attrs["status"] = "done" if done else "failed"
            group.attrs[DIGEST] = read_tree(group).digest()

    def summaries(self) -> list[Summary]:
        """Read what is known of every case but its arrays, in the order of their ids."""
        return [] if self._absent() else list(_each(self.path, read_summary).values())

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
        return list(_each(self.path, read_case).values())

    def repair(self) -> tuple[int, list[str]]:
        """Make the file anew from the cases that are whole; what was there is kept beside it.

        Returns
        -------
        tuple
            How many cases were kept, and a line for each that was not.

        Raises
        ------
        InputError
            Nothing of the file can be read, or there is no room for the new one.
        """
        with self.writing():
            return _repaired(self.path)

    def _absent(self) -> bool:
        return not (self.path.exists() or journal_of(self.path).exists())


def _status(_key: str, group: h5py.Group, _path: Path) -> str:
    return str(group.attrs["status"])


def _each(path: Path, read: Callable[[str, h5py.Group, Path], Read]) -> dict[str, Read]:
    with _reading(path) as file:
        return {key: read(key, group, path) for key, group in file["cases"].items()}


@contextmanager
def _appending(path: Path) -> Iterator[h5py.Group]:
    kept = "; all completed cases are kept"
    try:
        with changing(path) as file:
            yield _begun(file)
    except InputError as error:
        if error.message in NO_ROOM.values() or error.message.startswith("cannot be written"):
            raise InputError(
                error.message + kept, source=error.source, allowed=error.allowed
            ) from None
        raise
    except OSError as error:
        told = cannot_write(error, path)
        raise InputError(told.message + kept, source=told.source, allowed=told.allowed) from None


@contextmanager
def _reading(path: Path) -> Iterator[h5py.File]:
    try:
        file = open_image(_image(path))
    except OSError as error:
        raise InputError(f"cannot be read ({error})", source=str(path)) from None
    with file:
        try:
            if file.attrs.get("format") != FORMAT or "cases" not in file:
                raise InputError(
                    f"format {file.attrs.get('format')!r}", source=str(path), allowed=FORMAT
                )
            yield file
        except InputError:
            raise
        except DAMAGE as error:
            raise InputError(damage(error), source=str(path), allowed=_REPAIR) from None


def _image(path: Path, *, again: bool = True) -> bytes:
    """Return the bytes of the file as a whole change left it."""
    try:
        recover(path)
    except OSError:
        pass  # where a change cannot be finished the file is still as it was
    checked_file(path, most=MOST_BYTES, allowed="a campaign file (.h5)")
    with path.open("rb") as stream:
        lock(stream, fcntl.LOCK_SH)
        image = stream.read()
        interrupted = journal_of(path).exists()
    try:
        check_seal(image, path, allowed=_REPAIR)
    except InputError:
        # a writer may have begun a change, and died within it, since the look for one above
        if interrupted and again:
            return _image(path, again=False)
        raise
    return image


def _repaired(path: Path) -> tuple[int, list[str]]:
    recover(path)
    image = read_bytes(path, most=MOST_BYTES, allowed="a campaign file (.h5)")
    lost: list[str] = []
    try:
        with open_image(image) as old, new_image() as new:
            cases = _begun(new.file)
            for key in old["cases"]:
                try:
                    record = read_case(key, old["cases"][key], path)
                    old.copy(old["cases"][key], cases, name=key)
                    cases[key].attrs["quality"] = json.dumps(asdict(record.quality))
                    cases[key].attrs[DIGEST] = read_tree(cases[key]).digest()
                except DAMAGE as error:
                    lost.append(f"{key[:12]}: {damage(error)}")
            kept = len(cases)
    except DAMAGE as error:
        raise InputError(f"nothing in it can be read: {damage(error)}", source=str(path)) from None
    write_file(path.with_name(f"{path.name}.damaged"), image)
    write_file(path, new.sealed)
    return kept, lost


def _begun(file: h5py.File) -> h5py.Group:
    """The group of the cases; made in a file that is new."""
    if "cases" not in file:
        file.attrs["format"] = FORMAT
        file.create_group("cases")
    return file["cases"]
