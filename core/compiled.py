"""Where numba keeps its compiled code: one folder for each state of the source.

numba renews a cached function when the file that holds it changes, but not when a function that
it calls, in another file, does. A folder named after all compiled sources can never be stale, and
it works where the package itself cannot be written to.
"""

from __future__ import annotations

import hashlib
import os
import re
import stat
import tempfile
from contextlib import suppress
from pathlib import Path

_STAGES = ("core", "fem", "models", "impact", "discrepancy", "studies")
_MOST_NAMES = 20
_VARIABLE = "NUMBA_CACHE_DIR"
_RELATIVE = re.compile(r"^from (\.+)([\w.]+) import ", re.MULTILINE)


def source_digest(root: Path) -> str:
    """First 16 hexadecimal digits of the SHA-256 of the sources under `root` that are compiled.

    These are the files that use numba and, because compiled code freezes the constants that it
    takes from elsewhere, the files of this package that they import from.
    """
    files: set[Path] = set()
    for stage in _STAGES:
        for path in (root / stage).rglob("*.py"):
            text = path.read_text(encoding="utf-8")
            if "njit" in text:
                files |= {path, *_imported(path, text)}
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _imported(path: Path, text: str) -> list[Path]:
    """Files of this package that a file imports from; a package's own file for a whole package."""
    found = []
    for dots, name in _RELATIVE.findall(text):
        base = path.parents[len(dots) - 1].joinpath(*name.split("."))
        found += [
            file for file in (base.with_suffix(".py"), base / "__init__.py") if file.is_file()
        ]
    return found


def keep_compiled_code() -> None:
    """Point numba at this source's folder, unless the user chose one.

    To be called before numba is imported; afterwards it has no effect.
    """
    if os.environ.get(_VARIABLE):
        return
    digest = source_digest(Path(__file__).resolve().parents[1])
    os.environ[_VARIABLE] = str(cache_folder(f"compiled-{digest}"))


def cache_folder(name: str) -> Path:
    """Return the user's own folder for what can be made again; made if there is none."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return _own(_own(base / "dentscope") / name)


def _own(place: Path) -> Path:
    """Return a folder that is this user's and that nobody else may write; made if there is none.

    numba runs what it finds there: where the name is taken by a folder of others, or by one that
    others may have put something into, the next name is.
    """
    for name in (place.name, *(f"{place.name}-{k}" for k in range(2, _MOST_NAMES))):
        folder = place.with_name(name)
        with suppress(OSError):
            folder.parent.mkdir(parents=True, exist_ok=True)
            folder.mkdir(mode=0o700)
        with suppress(OSError):
            about = folder.lstat()
            if _is_own(about):
                return folder
    return Path(tempfile.mkdtemp(prefix="dentscope-"))


def _is_own(about: os.stat_result) -> bool:
    others = stat.S_IWGRP | stat.S_IWOTH
    return (
        stat.S_ISDIR(about.st_mode) and about.st_uid == os.geteuid() and not about.st_mode & others
    )
