"""All or nothing: a change of an HDF5 file that a kill or a full disk cannot leave half done.

HDF5 rewrites parts of its file in place, so that a writer that dies in the middle can damage what
was complete before. Here the writer works on the file through an overlay in memory; the pages that
it changed go to a journal beside the file (written whole, then renamed), and only then into the
file. Whoever opens the file next finishes a journal that it finds. This is the redo log of
databases.
"""

from __future__ import annotations

import fcntl
import hashlib
import io
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import h5py

_PAGE = 4096
_MAGIC = b"dentscope-journal-1\n"
_NUMBER = 8  # bytes of a number in the journal
_DIGEST = 32
PATIENCE_S = 300.0
"""How long to wait for another process that has the file open; ours have it for moments only."""


@contextmanager
def changing(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file for a change that happens whole or not at all.

    Parameters
    ----------
    path
        The file; made if there is none. The caller sees to it that nobody else changes it.

    Raises
    ------
    OSError
        The change cannot be written, for example because the disk is full; the file is as it was,
        or the journal holds the whole change.
    """
    recover(path)
    overlay = _Overlay(path)
    try:
        with h5py.File(overlay, "r+" if overlay.size else "w") as file:
            yield file
        overlay.write_journal(journal_of(path))
    finally:
        overlay.close()
    recover(path)


def journal_of(path: Path) -> Path:
    """Return the journal's place beside a file."""
    return path.with_name(f"{path.name}.journal")


def recover(path: Path) -> None:
    """Finish a change whose writer died after it was journalled; do nothing if there is none.

    Raises
    ------
    OSError
        There is no room for it; the file is as it was and the journal stays.
    """
    journal = journal_of(path)
    if not journal.exists():
        return
    with path.open("ab"):
        pass  # a file that is new has no bytes yet
    with path.open("r+b") as file:
        lock(file, fcntl.LOCK_EX)
        if not journal.exists():
            return  # its writer, or another reader, was faster
        size, pages = _read_journal(journal)
        before = os.fstat(file.fileno()).st_size
        if before < size:
            try:
                file.seek(before)
                file.write(bytes(size - before))
                file.flush()
                os.fsync(file.fileno())
            except OSError:
                os.ftruncate(file.fileno(), before)
                raise
        # the room is there: from here on only a kill can interrupt, and then all is done again
        for offset, page in pages:
            file.seek(offset)
            file.write(page)
        file.truncate(size)
        file.flush()
        os.fsync(file.fileno())
        journal.unlink()


class _Overlay(io.RawIOBase):
    """A file as its writer sees it: changed pages lie in memory, the file is only read."""

    def __init__(self, path: Path) -> None:
        self._file: BinaryIO | None = path.open("rb") if path.exists() else None
        self._on_disk = os.fstat(self._file.fileno()).st_size if self._file else 0
        self._pages: dict[int, bytearray] = {}
        self._at = 0
        self.size = self._on_disk

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        start = {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self.size}[whence]
        self._at = start + offset
        return self._at

    def tell(self) -> int:
        return self._at

    def truncate(self, size: int | None = None) -> int:
        self.size = self._at if size is None else size
        return self.size

    def flush(self) -> None:
        """Do nothing: what was changed is journalled at the end."""

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
        super().close()

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        count = min(len(buffer), max(0, self.size - self._at))
        for number, within, start, length in self._spans(count):
            page = self._pages.get(number)
            if page is None:
                page = self._from_disk(number)
            buffer[start : start + length] = page[within : within + length]
        self._at += count
        return count

    def write(self, data: bytes) -> int:  # type: ignore[override]
        view = memoryview(data).cast("B")
        for number, within, start, length in self._spans(len(view)):
            if number not in self._pages:
                self._pages[number] = self._from_disk(number)
            self._pages[number][within : within + length] = view[start : start + length]
        self._at += len(view)
        self.size = max(self.size, self._at)
        return len(view)

    def write_journal(self, journal: Path) -> None:
        """Write the changed pages beside the file, whole or not at all."""
        content = bytearray(_MAGIC + _number(self.size) + _number(len(self._pages)))
        for number, page in sorted(self._pages.items()):
            content += _number(number * _PAGE) + page
        unfinished = journal.with_suffix(".unfinished")
        try:
            with unfinished.open("wb") as stream:
                stream.write(content)
                stream.write(hashlib.sha256(content).digest())
                stream.flush()
                os.fsync(stream.fileno())
        except OSError:
            unfinished.unlink(missing_ok=True)
            raise
        unfinished.rename(journal)

    def _spans(self, count: int) -> Iterator[tuple[int, int, int, int]]:
        """Split the next `count` bytes: page, place within it, place in the buffer, length."""
        done = 0
        while done < count:
            number, within = divmod(self._at + done, _PAGE)
            length = min(_PAGE - within, count - done)
            yield number, within, done, length
            done += length

    def _from_disk(self, number: int) -> bytearray:
        page = bytearray(_PAGE)
        if self._file is not None and number * _PAGE < self._on_disk:
            self._file.seek(number * _PAGE)
            found = self._file.read(_PAGE)
            page[: len(found)] = found
        return page


def _read_journal(journal: Path) -> tuple[int, list[tuple[int, bytes]]]:
    content = journal.read_bytes()
    body, digest = content[:-_DIGEST], content[-_DIGEST:]
    if not body.startswith(_MAGIC) or hashlib.sha256(body).digest() != digest:
        raise OSError(f"{journal.name} is damaged; remove it to go on without its one change")
    at = len(_MAGIC)
    size, count = (_value(body, at + k * _NUMBER) for k in range(2))
    at += 2 * _NUMBER
    step = _NUMBER + _PAGE
    starts = range(at, at + count * step, step)
    return size, [(_value(body, k), body[k + _NUMBER : k + step]) for k in starts]


def _number(value: int) -> bytes:
    return value.to_bytes(_NUMBER, "little")


def _value(content: bytes, at: int) -> int:
    return int.from_bytes(content[at : at + _NUMBER], "little")


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
