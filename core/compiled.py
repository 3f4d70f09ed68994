"""Where numba keeps its compiled code: one folder for each state of the source.

numba renews a cached function when the file that holds it changes, but not when a function that
it calls, in another file, does. A folder named after all compiled sources can never be stale, and
it works where the package itself cannot be written to.
"""

from __future__ import annotations

import hashlib
import os
import re
from pathlib import Path

_STAGES = ("core", "fem", "models", "impact", "discrepancy", "studies")
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
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    digest = source_digest(Path(__file__).resolve().parents[1])
    os.environ[_VARIABLE] = str(Path(base) / "dentscope" / f"compiled-{digest}")
