"""Standard output that may be closed, full or of no width: a command does its work all the same."""

from __future__ import annotations

import errno
import io
import os
import sys
import warnings
from pathlib import Path

from ..errors import EXIT_INPUT_ERROR


class _Output(io.RawIOBase):
    """A descriptor that takes everything; the first failure is kept, what follows is dropped."""

    def __init__(self, number: int) -> None:
        self.number = number
        self.failure: OSError | None = None

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self.number

    def isatty(self) -> bool:
        return os.isatty(self.number)

    def write(self, data: object) -> int:
        view = memoryview(data)  # type: ignore[arg-type]
        if self.failure is None:
            try:
                return os.write(self.number, view)
            except OSError as error:
                self.failure = error
        return view.nbytes


def steady_streams() -> None:
    """Let nothing that is printed end a command, and no library's warnings be printed.

    A reader that has seen enough (`| head -1`) and a full disk would: files that the command is to
    write would be missing. `left_with` tells of a failure at the end.
    """
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by who started the command
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))
    stream = sys.stdout
    if isinstance(stream, io.TextIOWrapper):
        buffer = io.BufferedWriter(_Output(stream.fileno()))
        # what the terminal's encoding lacks is escaped
        kept = "backslashreplace" if stream.errors == "strict" else stream.errors
        sys.stdout = io.TextIOWrapper(
            buffer, encoding=stream.encoding, errors=kept, line_buffering=stream.line_buffering
        )
    if os.environ.get("COLUMNS", "1").strip("0 ") == "":
        del os.environ["COLUMNS"]
    if not sys.warnoptions:
        warnings.filterwarnings("ignore", category=RuntimeWarning)


def left_with(code: int) -> int:
    """Return the exit code, of a mistake where standard output could not take what was printed."""
    stream = sys.stdout
    stream.flush()
    output = getattr(getattr(stream, "buffer", None), "raw", None)
    failure = getattr(output, "failure", None)
    if failure is None or failure.errno in (errno.EPIPE, errno.EBADF):
        return code
    sys.stderr.write(f"standard output: {failure.strerror}\n")
    return code or EXIT_INPUT_ERROR
