"""The few calls by which files are changed.

Everything that the program writes goes through `DISK`, so that one test can let any of these calls
fail, or be the last before a loss of power, and look at what is left.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path

_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC


class Disk:
    """Changes of files; each call is one step, done or failed with `OSError`."""

    def create(self, path: Path, mode: int = 0o666) -> int:
        """Make a file that was not there; return its descriptor."""
        return os.open(path, _NEW, mode)

    def write(self, file: int, content: bytes) -> None:
        """Write all bytes to a file that was just made."""
        view = memoryview(content)
        while view:
            view = view[os.write(file, view) :]

    def sync(self, file: int) -> None:
        """Wait until what was written to a file would survive a loss of power."""
        os.fsync(file)

    def close(self, file: int) -> None:
        """Close a descriptor."""
        os.close(file)

    def rename(self, old: Path, new: Path) -> None:
        """Give a file another name; one that had it is replaced."""
        os.replace(old, new)

    def remove(self, path: Path) -> None:
        """Take a file away."""
        os.unlink(path)

    def make_folder(self, path: Path) -> None:
        """Make a folder in one that is there."""
        os.mkdir(path)

    def sync_folder(self, folder: Path) -> None:
        """Wait until names in a folder would survive a loss of power."""
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        try:
            os.fsync(handle)
        except OSError as error:
            if error.errno != errno.EINVAL:  # file systems that know no such call
                raise
        finally:
            os.close(handle)


DISK = Disk()
"""What every writer uses."""
