"""Opening files that others made: ordinary ones, of a size that the program can hold."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from ..errors import InputError


def checked_file(path: Path, *, most: int, allowed: str) -> Path:
    """Return a path that stands for an ordinary file of at most so many bytes.

    Refused where it is missing, too large, or a pipe or device, which would be waited for without
    end; `allowed` says what it should be.
    """
    try:
        about = path.stat()
    except FileNotFoundError:
        raise InputError("no such file", source=str(path), allowed=allowed) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot be read ({reason})", source=str(path), allowed=allowed) from None
    if stat.S_ISDIR(about.st_mode):
        raise InputError("a folder", source=str(path), allowed=allowed)
    if not stat.S_ISREG(about.st_mode):
        raise InputError("a pipe or a device, no file", source=str(path), allowed=allowed)
    if about.st_size > most:
        raise InputError(
            f"{about.st_size / 1e6:.0f} MB", source=str(path), allowed=f"up to {most / 1e6:g} MB"
        )
    return path


def path_of(given: object, *, key: str, allowed: str) -> Path:
    """Return what a program gave as a path, or refuse what is none."""
    if not isinstance(given, str | os.PathLike):
        raise InputError(repr(given), key=key, allowed=allowed)
    return Path(given)


def file_beside(source: str | Path, name: str, *, key: str) -> Path:
    """Return the file that a key of another one names, from its folder; refused if missing."""
    path = Path(source).parent / name
    if not os.path.exists(path):
        raise InputError(
            f"no such file {name!r}", source=str(source), key=key,
            allowed="a file, from the folder of this one",
        )  # fmt: skip
    return path


def read_bytes(path: Path, *, most: int, allowed: str) -> bytes:
    """Return the content of an ordinary file of a bearable size, as `checked_file`."""
    checked_file(path, most=most, allowed=allowed)
    try:
        with path.open("rb") as stream:
            return stream.read(most + 1)
    except OSError as error:
        raise InputError(
            f"cannot be read ({error.strerror})", source=str(path), allowed=allowed
        ) from None
