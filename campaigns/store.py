"""A run: a folder with one file a case, which any process may write.

A case lies in `cases/AB/ID.h5`, AB the first two letters of its id; one that failed in
`ID.failed.h5`, so that a listing says what is done. Each file is written under another name,
synchronised and renamed (`core.output`), and holds the digest of its own bytes
(`campaigns.contents`): it is there whole or not at all, whatever dies meanwhile, and no changed
byte is taken for a number. Nothing else is kept: there is no index to fall behind and no lock, and
a put costs the same however many cases there are. Two that write the same case leave one of two
whole files; a completed case is never replaced by a failed one.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TypeVar

import h5py

from ..core.disk import DISK
from ..core.errors import InputError
from ..core.output import NO_ROOM, write_file
from ..fem import Solution
from .case import Case
from .case_file import case_image, write_fields
from .contents import opened
from .records import CaseRecord, Summary, read_case, read_summary
from .schema import FORMAT

# limit: largest file of one case that is read [bytes]: one with its fields takes some megabytes
_CASE_BYTES = 500_000_000

Read = TypeVar("Read")

CASES, FIELDS = "cases", "fields"
"""Folders of a run: its cases, their full fields."""

_ENDS = {"done": ".h5", "failed": ".failed.h5"}
_REPAIR = "`dentscope campaign repair --out {}` sets it aside; the next run computes its case again"


class Store:
    """The cases of a run, in a folder that need not exist yet."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def statuses(self) -> dict[str, str]:
        """Status of every stored case by id, `done` or `failed`; no file is opened."""
        return {key: _status(path) for key, path in self._files().items()}

    def put(
        self,
        case: Case,
        solution: Solution | None,
        *,
        message: str = "",
        computed_by: Mapping[str, str] | None = None,
    ) -> None:
        """Store one ended case, as `campaigns.case_file.case_image` takes it.

        Where it cannot be written all completed cases are kept.
        """
        if self.folder.is_file():
            _refuse_file(self.folder)
        done, failed = (file_of(self.folder, case.id, status) for status in _ENDS)
        with _all_kept():
            folder, name = self.folder / FIELDS, case.id[:16]
            kept = write_fields(solution, folder, name=name) if solution else []
            image = case_image(
                case, solution, message=message, computed_by=computed_by,
                fields=[path.name for path in kept],
            )  # fmt: skip
            if solution is not None and solution.outcome.completed:
                write_file(done, image)
                with suppress(OSError):  # where both are there the completed one counts
                    DISK.remove(failed)
            elif not done.exists():
                write_file(failed, image)

    def files(self) -> list[Path]:
        """Return the file of every case, in the order of their ids."""
        return list(self._files().values())

    def summaries(self) -> list[Summary]:
        """Read what is known of every case but its arrays, in the order of their ids."""
        return [self._read(key, read_summary) for key in self._files()]

    def read(self, case_id: str) -> CaseRecord:
        """Read one case, named by its id or the beginning of it."""
        found = [key for key in self._files() if key.startswith(case_id)]
        if len(found) != 1:
            raise InputError(
                f"{len(found)} cases begin with {case_id!r}",
                source=str(self.folder),
                key="case",
                allowed="an id from `campaign status`, or an unambiguous beginning",
            )
        return self._read(found[0], read_case)

    def read_all(self) -> list[CaseRecord]:
        """Read every case, in the order of their ids."""
        return [self._read(key, read_case) for key in self._files()]

    def repair(self) -> tuple[int, list[str]]:
        """Set aside the cases that are damaged, as `NAME.damaged` beside where they were.

        Returns how many cases are whole, and a line for each that was not.
        """
        lost = []
        files = self._files()
        for key, path in files.items():
            try:
                self._read(key, read_case)
            except InputError as error:
                lost.append(f"{key[:12]}: {error.message}")
                DISK.rename(path, path.with_name(f"{path.name}.damaged"))
                DISK.sync_folder(path.parent)
        return len(files) - len(lost), lost

    def strays(self) -> list[Path]:
        """Return the files among the cases whose names are no case's."""
        return [path for path in self._listed() if not _is_case(path)]

    def _listed(self) -> list[Path]:
        return sorted((self.folder / CASES).glob("[0-9a-f][0-9a-f]/*.h5"))

    def _files(self) -> dict[str, Path]:
        """File of every case by its id, in the order of the ids; a completed one counts."""
        if self.folder.is_file():
            _refuse_file(self.folder)
        found: dict[str, Path] = {}
        for path in filter(_is_case, self._listed()):
            key = path.name.partition(".")[0]
            if key not in found or _status(path) == "done":
                found[key] = path
        return dict(sorted(found.items()))

    def _read(self, key: str, read: Callable[[h5py.Group, Path], Read]) -> Read:
        done, failed = (file_of(self.folder, key, status) for status in _ENDS)
        # a case that had failed may be completed, and its first file removed, meanwhile
        path = done if done.exists() or not failed.exists() else failed
        with opened_case(path) as file:
            if file.attrs["id"] != key:
                raise InputError("holds another case than its name says", source=str(path))
            return read(file, path)


def file_of(folder: Path, key: str, status: str) -> Path:
    """Return where a run's folder holds a case that is `done` or `failed`."""
    return folder / CASES / key[:2] / f"{key}{_ENDS[status]}"


def _is_case(path: Path) -> bool:
    key = path.name.removesuffix(_ENDS["failed"]).removesuffix(_ENDS["done"])
    return re.fullmatch("[0-9a-f]{64}", key) is not None and key[:2] == path.parent.name


def _status(path: Path) -> str:
    return "failed" if path.name.endswith(_ENDS["failed"]) else "done"


@contextmanager
def opened_case(path: Path) -> Iterator[h5py.File]:
    """Open a case's file, or refuse one of which a byte has changed."""
    kind = "a file of one case (.h5)"
    remedy = _REPAIR.format(path.parent.parent.parent)  # of RUN/cases/3f/3f2a....h5
    with opened(path, most=_CASE_BYTES, kind=kind, remedy=remedy) as file:
        if file.attrs.get("format") != FORMAT:
            _refuse_file(path, file.attrs.get("format"))
        yield file


def read_case_file(path: Path) -> CaseRecord:
    """Read the case of one file, such as `result.h5` of `dentscope case`."""
    with opened_case(path) as file:
        return read_case(file, path)


def _refuse_file(path: Path, found: object = None) -> None:
    raise InputError(
        f"format {found!r}" if found else "a file",
        source=str(path),
        allowed=f"{FORMAT}, or the folder of a run",
    )


@contextmanager
def _all_kept() -> Iterator[None]:
    try:
        yield
    except InputError as error:
        if error.message in NO_ROOM.values() or error.message.startswith("cannot be written"):
            raise InputError(
                f"{error.message}; all completed cases are kept",
                source=error.source,
                allowed=error.allowed,
            ) from None
        raise
