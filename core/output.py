"""Files for people and programs, each written whole or not at all.

One file: a draft beside it is filled, synchronised and renamed. Several files of one folder that
belong together: their contents first go to one pending file, so that whoever comes next finishes
what a kill or a loss of power interrupted. A folder that several processes change is locked.
Figures need no screen.
"""

from __future__ import annotations

import csv
import errno
import fcntl
import hashlib
import io
import json
import math
import os
import stat
import time
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .disk import DISK
from .errors import InputError
from .inputs.input_file import read_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

from .inputs.names import NAME_BYTES

# limit: largest unfinished file that is read again [bytes]: memory of a small machine
_PENDING_BYTES = 500_000_000

# limit: wait for another process that changes the same folder [s]: a large set is written in less
_FOLDER_WAIT_S = 300.0

PENDING = ".dentscope-pending"

NO_ROOM = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "a file may not be larger here",
}
_NO_LOCKS = (errno.EBADF, errno.ENOLCK, errno.EOPNOTSUPP, errno.EINVAL)
"""Errors of file systems, over a network, that cannot lock a folder: there nothing is held."""

_MAGIC = b"dentscope-pending-1\n"
_DIGEST = 32


def cannot_write(error: OSError, path: Path | str) -> InputError:
    """Return the one line for a file that cannot be written."""
    if error.errno in NO_ROOM:
        return InputError(NO_ROOM[error.errno], source=str(path), allowed="make room and run again")
    reason = error.strerror or str(error) or type(error).__name__
    return InputError(
        f"cannot be written ({reason.lower()})", source=str(path),
        allowed="a place where you may write",
    )  # fmt: skip


def folder_for_output(folder: Path) -> Path:
    """Make a folder, and those that it lies in; refused where that cannot be."""
    try:
        _make_folder(folder)
    except (OSError, ValueError) as error:
        raise _one_line(error, folder) from None
    return folder


def write_file(path: Path, content: bytes | str) -> Path:
    """Write a file whole, or leave what was there as it was; its folder is made if needed."""
    # a name that is no text in UTF-8 is no reason to fail
    data = content.encode(errors="replace") if isinstance(content, str) else content
    try:
        _make_folder(path.parent)
        _replace(Path(os.path.realpath(path)), data)
    except (OSError, ValueError) as error:
        raise _one_line(error, path) from None
    return path


def write_files(folder: Path, files: Mapping[str, bytes | str]) -> None:
    """Write several files of one folder, all or none; the caller holds its lock.

    `files` are contents by path within the folder, which is made if needed. Where they cannot be
    written the folder is as it was, or is finished when it is next looked at.
    """
    contents = {k: v.encode() if isinstance(v, str) else v for k, v in files.items()}
    for name in contents:
        _check_inside(folder, name)
    finish_pending(folder)
    write_file(folder / PENDING, _pending(folder, contents))
    _apply(folder, contents)


def finish(folder: Path) -> None:
    """Finish what another process had begun to write into a folder; do nothing if there is nothing.

    Refused where it belongs to another state of this folder, is damaged, or cannot be written.
    """
    if (folder / PENDING).exists():
        with locked(folder):
            finish_pending(folder)


def finish_pending(folder: Path) -> None:
    """Do what `finish` does; the caller holds the lock."""
    place = folder / PENDING
    if not place.exists():
        return
    found = _read_pending(folder)
    for name, (before, content) in found.items():
        now = _digest_of(folder / name)
        if now not in (before, hashlib.sha256(content).hexdigest()):
            raise InputError(
                f"belongs to another state of this folder: {name} is not what it was",
                source=str(place),
                allowed="no such file: remove it to keep the folder as it is",
            )
    _apply(folder, {name: content for name, (_, content) in found.items()})


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder, there or not yet, for oneself; wait for another process that does.

    Refused where it cannot be locked, or another holds it for longer than `_FOLDER_WAIT_S`.
    """
    # what lies in it may still be refused, and then nothing new should lie anywhere: the lock is
    # one of the folder around it, and leaves no file
    place = folder_for_output(folder.resolve().parent)
    handle = os.open(place, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        until = time.monotonic() + _FOLDER_WAIT_S
        while not _taken(handle):
            if time.monotonic() > until:
                raise InputError(
                    "another process writes here", source=str(folder), allowed="one at a time"
                )
            time.sleep(0.02)
        yield
    finally:
        os.close(handle)


@contextmanager
def in_use(folder: Path) -> Iterator[bool]:
    """Mark a folder as in use, and tell whether another process has marked it before."""
    handle = os.open(folder_for_output(folder), os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        yield not _taken(handle)
    finally:
        os.close(handle)


def _taken(handle: int) -> bool:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
    return True


def csv_text(rows: Iterable[Iterable[Any]], *, header: Iterable[str]) -> str:
    """Return rows as comma-separated text, floats with every digit, formulas as text."""
    from .inputs.csv_table import inert

    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([inert(c) if isinstance(c, str) else c for c in row] for row in rows)
    return stream.getvalue()


def write_csv(path: Path, rows: Iterable[Mapping[str, Any]], *, header: Collection[str]) -> Path:
    """Write rows by their names, floats with all digits; an empty cell where there is no number."""
    cells = (["" if row[name] != row[name] else row[name] for name in header] for row in rows)
    return write_file(path, csv_text(cells, header=header))


def figure(rows: int, columns: int, *, size: tuple[float, float]) -> tuple[Figure, Any]:
    """Return a figure of some size [inch] and its axes (rows, columns)."""
    from .notebook_figure import NotebookFigure

    made = NotebookFigure(figsize=size, layout="constrained")
    return made, made.subplots(rows, columns, squeeze=False)


def panels(count: int) -> tuple[Figure, list[Any]]:
    """Return a figure of `count` panels and no empty one, two or three a row."""
    columns = 2 if count in (2, 4) else max(min(count, 3), 1)
    rows = max(math.ceil(count / columns), 1)
    made, axes = figure(rows, columns, size=(4.4 * columns, 3.6 * rows))
    for spare in axes.flat[count:]:
        spare.remove()
    return made, list(axes.flat[:count])


def write_figure(figure: Any, path: Path, *, dpi: float, **options: Any) -> Path:
    """Write a matplotlib figure as PNG, whole or not at all."""
    stream = io.BytesIO()
    # of matplotlib, on how long a legend takes
    with warnings.catch_warnings(action="ignore", category=UserWarning):
        figure.savefig(stream, format="png", dpi=dpi, **options)
    return write_file(path, stream.getvalue())


def _one_line(error: OSError | ValueError, path: Path) -> InputError:
    if isinstance(error, InputError):
        return error
    if isinstance(error, OSError):
        return cannot_write(error, path)
    return InputError("no name of a file", source=repr(str(path)), allowed="text without NUL")


def _make_folder(folder: Path) -> None:
    if folder.is_dir():
        return
    if folder.parent != folder:
        _make_folder(folder.parent)
    # another process may have made it a moment ago; a file of that name is no folder
    with suppress(FileExistsError):
        DISK.make_folder(folder)
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    DISK.sync_folder(folder.parent)


def _replace(path: Path, data: bytes) -> None:
    mode = 0o666
    if path.exists():
        about = path.stat()
        if not stat.S_ISREG(about.st_mode):
            raise OSError(errno.EINVAL, "a folder, a pipe or a device")
        mode = stat.S_IMODE(about.st_mode)
    # a name that nobody else has, on whatever machine, and that no killed process left behind
    draft = path.with_name(f".{path.name[:NAME_BYTES]}.{os.urandom(8).hex()}.part")
    try:
        file = DISK.create(draft, mode)
        try:
            DISK.write(file, data)
            DISK.sync(file)
        finally:
            DISK.close(file)
        DISK.rename(draft, path)
    except OSError:
        with suppress(OSError):
            DISK.remove(draft)
        raise
    DISK.sync_folder(path.parent)


def _pending(folder: Path, contents: Mapping[str, bytes]) -> bytes:
    head = [[name, len(data), _digest_of(folder / name)] for name, data in contents.items()]
    text = json.dumps(head).encode()
    body = _MAGIC + len(text).to_bytes(8, "little") + text + b"".join(contents.values())
    return body + hashlib.sha256(body).digest()


def _read_pending(folder: Path) -> dict[str, tuple[str, bytes]]:
    place, remedy = folder / PENDING, "remove it to go on without its one change"
    content = read_bytes(place, most=_PENDING_BYTES, allowed=remedy)
    body, digest = content[:-_DIGEST], content[-_DIGEST:]
    if not body.startswith(_MAGIC) or hashlib.sha256(body).digest() != digest:
        raise InputError("damaged", source=str(place), allowed=remedy)
    at = len(_MAGIC) + 8
    end = at + int.from_bytes(body[at - 8 : at], "little")
    found: dict[str, tuple[str, bytes]] = {}
    try:
        for name, size, before in json.loads(body[at:end]):
            found[str(name)] = (str(before), body[end : end + size])
            end += size
    except (ValueError, TypeError, RecursionError):
        raise InputError("damaged", source=str(place), allowed=remedy) from None
    for name in found:
        _check_inside(folder, name)
    return found


def _check_inside(folder: Path, name: str) -> None:
    """Refuse a name that leads out of its folder: the folder may be somebody else's."""
    try:
        inside = (folder / name).resolve().is_relative_to(folder.resolve())
        (folder / name).stat()
    except FileNotFoundError:
        pass
    except (OSError, ValueError, RuntimeError):  # no name of a file, or a circle of links
        inside = False
    if not inside:
        raise InputError(
            f"{name[:80]!r} is no file within this folder",
            source=str(folder),
            allowed="a folder that writes to no other",
        )


def _digest_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


def _apply(folder: Path, contents: Mapping[str, bytes]) -> None:
    for name, data in contents.items():
        write_file(folder / name, data)
    try:
        DISK.remove(folder / PENDING)
    except FileNotFoundError:
        pass  # a reader was faster
    except OSError as error:
        raise cannot_write(error, folder / PENDING) from None
