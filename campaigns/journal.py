"""All or nothing: a change of an HDF5 file that no kill, full disk or loss of power leaves half.

HDF5 rewrites parts of its file in place, so that a writer that dies in the middle can damage what
was complete before. Here the writer works on a copy in memory; the pages that it changed go to a
journal beside the file (written whole, then renamed), and only then into the file. Whoever opens
the file next finishes a journal that it finds. This is the redo log of databases. The journal knows
by digests which file it belongs to, at whatever point its writing was interrupted, and touches no
other.
"""

from __future__ import annotations

import fcntl
import hashlib
import io
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import h5py

from ..core.disk import DISK
from ..core.errors import InputError
from ..core.inputs.input_file import read_bytes
from ..core.output import write_file
from .contents import MOST_BYTES, SEALED_FROM, check_seal, seal

PAGE = 4096
_MAGIC = b"dentscope-journal-2\n"
_NUMBER = 8  # bytes of a number in the journal
_DIGEST = 32
_LAYOUT = ("v110", "v110")  # of HDF5: the first whose headers carry checksums at no cost of room
PATIENCE_S = 300.0
"""How long to wait for another process that has the file open; ours have it for moments only."""


@contextmanager
def changing(path: Path) -> Iterator[h5py.File]:
    """Open a sealed HDF5 file for a change that happens whole or not at all.

    Parameters
    ----------
    path
        The file; made if there is none. The caller sees to it that nobody else changes it.

    Raises
    ------
    InputError
        The file or its journal is damaged, or the change cannot be written, for example because
        the disk is full or the file would be larger than what is read; the file is as it was, or
        the journal holds the whole change.
    """
    recover(path)
    before = path.read_bytes() if path.exists() else b""
    if before:
        check_seal(before, path)
    with new_image(before) as changed:
        yield changed.file
    if len(changed.sealed) > MOST_BYTES:  # nobody could read it any more
        raise InputError(
            f"would hold {len(changed.sealed) / 1e9:.2f} GB; all that it holds is kept",
            source=str(path),
            allowed=f"up to {MOST_BYTES / 1e9:g} GB; a file elsewhere goes on",
        )
    write_file(journal_of(path), journalled(before, changed.sealed))
    recover(path)


@dataclass
class Image:
    """A file that is made in memory: `file` while it is open, then its bytes, sealed."""

    file: h5py.File
    sealed: bytes = b""


@contextmanager
def new_image(before: bytes = b"") -> Iterator[Image]:
    """Make a sealed HDF5 file in memory, from nothing or from one that is to be changed."""
    copy = io.BytesIO(before)
    block = {} if before else {"userblock_size": SEALED_FROM}
    with h5py.File(copy, "r+" if before else "w", libver=_LAYOUT, **block) as file:
        made = Image(file)
        yield made
    image = copy.getvalue()
    made.sealed = seal(image) + image[SEALED_FROM:]


def journal_of(path: Path) -> Path:
    """Return the journal's place beside a file."""
    return path.with_name(f"{path.name}.journal")


def recover(path: Path) -> None:
    """Finish a change whose writer died after it was journalled; do nothing if there is none.

    Raises
    ------
    OSError
        There is no room for it; the file is as it was, and the journal stays.
    InputError
        The journal is damaged, or belongs to another file.
    """
    journal = journal_of(path)
    while journal.exists():
        if not path.exists():
            _begin(path, journal)
            continue
        with path.open("rb") as file:
            lock(file, fcntl.LOCK_EX)
            # a repair may have put another file in its place meanwhile
            if not os.path.samestat(os.fstat(file.fileno()), path.stat()):
                continue
            if journal.exists():  # or its writer, or another reader, was faster
                _finish(path, journal, file.read())
            return


def _begin(path: Path, journal: Path) -> None:
    """Make the empty file into which a first change is written; another process may be faster."""
    refused = None
    try:
        if _read_journal(journal).size_before:
            refused = _stale(journal)
    except InputError as error:
        refused = error
    if refused and journal.exists() and not path.exists():
        raise refused
    if not refused:
        with suppress(FileExistsError):
            DISK.close(DISK.create(path))
        DISK.sync_folder(path.parent)


def _finish(path: Path, journal: Path, image: bytes) -> None:
    """Finish a change; the caller holds the lock.

    The journal is read under the lock: before it, this could have been the journal of an earlier
    change, and what is removed here the next one's, unread.
    """
    change = _read_journal(journal)
    if hashlib.sha256(image).digest() != change.after:
        if not change.belongs_to(image):
            raise _stale(journal)
        _write_pages(path, len(image), change)
    DISK.remove(journal)


@dataclass(frozen=True)
class Change:
    """What a journal says.

    Parameters
    ----------
    size_before, size
        Of the file [bytes].
    rest
        Digest of the file before, its changed pages blank.
    after
        Digest of the file when the change is complete.
    pages
        Place, content before and content after of each changed page.
    """

    size_before: int
    size: int
    rest: bytes
    after: bytes
    pages: tuple[tuple[int, bytes, bytes], ...]

    def belongs_to(self, image: bytes) -> bool:
        """Whether a file is the one before the change, however much of it is written already."""
        if not self.size_before <= len(image) <= max(self.size, self.size_before):
            return False
        old = bytearray(image[: self.size_before])
        for at, before, content in self.pages:
            if not _in_between(image[at : at + PAGE], before, content):
                return False
            old[at : at + PAGE] = bytes(len(old[at : at + PAGE]))
        return hashlib.sha256(old).digest() == self.rest


def journalled(before: bytes, after: bytes) -> bytes:
    """Return a journal: what turns a file's bytes into others, and the digests of both."""
    blank = bytearray(before)
    pages = []
    for at in range(0, len(after), PAGE):
        old, new = before[at : at + PAGE], after[at : at + PAGE]
        if old != new:
            pages.append(_number(at) + old.ljust(PAGE, b"\0") + new.ljust(PAGE, b"\0"))
            blank[at : at + PAGE] = bytes(len(old))
    body = b"".join(
        (
            _MAGIC, *map(_number, (len(before), len(after), len(pages))),
            hashlib.sha256(blank).digest(), hashlib.sha256(after).digest(), *pages,
        )
    )  # fmt: skip
    return body + hashlib.sha256(body).digest()


def lock(file: BinaryIO, kind: int) -> None:
    """Wait for a lock that lasts until the file is closed.

    Parameters
    ----------
    file
        What is locked.
    kind
        `fcntl.LOCK_EX` keeps readers out for the moment of writing, `fcntl.LOCK_SH` writers for
        that of reading. HDF5 takes the same locks when it opens a file.

    Raises
    ------
    BlockingIOError
        Another process holds it for longer than `PATIENCE_S`.
    """
    until = time.monotonic() + PATIENCE_S
    while True:
        try:
            fcntl.flock(file, kind | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > until:
                raise
            time.sleep(0.02)
        else:
            return


def _write_pages(path: Path, size: int, change: Change) -> None:
    file = DISK.open(path)
    try:
        if size < change.size:
            try:
                DISK.write(file, bytes(change.size - size), size)
                DISK.sync(file)
            except OSError:
                with suppress(OSError):
                    DISK.resize(file, size)
                raise
        # the room is there: from here on only a kill can interrupt, and then all is done again
        for at, _, content in change.pages:
            DISK.write(file, content[: change.size - at], at)
        if size > change.size:
            DISK.sync(file)
            DISK.resize(file, change.size)
        DISK.sync(file)
    finally:
        DISK.close(file)


def _stale(journal: Path) -> InputError:
    return InputError(
        f"belongs to another {journal.name.removesuffix('.journal')}, which is left as it is",
        source=str(journal),
        allowed="a journal beside its own file: move it away, or bring the file back",
    )


def _read_journal(journal: Path) -> Change:
    remedy = "remove it to go on without its one change"
    content = read_bytes(journal, most=MOST_BYTES, allowed=remedy)
    body, digest = content[:-_DIGEST], content[-_DIGEST:]
    damaged = InputError("damaged", source=str(journal), allowed=remedy)
    if not body.startswith(_MAGIC) or hashlib.sha256(body).digest() != digest:
        raise damaged
    at = len(_MAGIC) + 3 * _NUMBER
    before, size, count = (_value(body, at - k * _NUMBER) for k in (3, 2, 1))
    rest, after = (body[at + k * _DIGEST : at + (k + 1) * _DIGEST] for k in range(2))
    at += 2 * _DIGEST
    split = _NUMBER + PAGE
    step = split + PAGE
    if len(body) != at + count * step:
        raise damaged
    pages = tuple(
        (_value(body, k), body[k + _NUMBER : k + split], body[k + split : k + step])
        for k in range(at, at + count * step, step)
    )
    # all that a file grows by stands in pages
    if any(k % PAGE or k >= size for k, _, _ in pages) or size > max(
        (before, *(k + PAGE for k, _, _ in pages))
    ):
        raise damaged
    return Change(before, size, rest, after, pages)


def _in_between(found: bytes, before: bytes, content: bytes) -> bool:
    """Whether each byte of a page is as it was, or as it will be; none yet counts as zero."""
    page = found.ljust(PAGE, b"\0")
    return page in (before, content) or all(
        byte in (old, new) for byte, old, new in zip(page, before, content, strict=True)
    )


def _number(value: int) -> bytes:
    return value.to_bytes(_NUMBER, "little")


def _value(content: bytes, at: int) -> int:
    return int.from_bytes(content[at : at + _NUMBER], "little")
