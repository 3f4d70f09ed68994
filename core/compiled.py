"""Where numba keeps its compiled code: one folder for each state of the source.

numba renews a cached function when the file that holds it changes, but not when a function that
it calls, in another file, does. A folder named after all sources can never be stale, and it works
where the package itself cannot be written to.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

_STAGES = ("core", "fem", "models", "impact", "discrepancy")
_VARIABLE = "NUMBA_CACHE_DIR"


def source_digest(root: Path) -> str:
    """First 16 hexadecimal digits of the SHA-256 of all compiled stages' sources under `root`."""
    text = hashlib.sha256()
    for stage in _STAGES:
        for path in sorted((root / stage).rglob("*.py")):
            text.update(path.read_bytes())
    return text.hexdigest()[:16]


def keep_compiled_code() -> None:
    """Point numba at this source's folder, unless the user chose one.

    To be called before numba is imported; afterwards it has no effect.
    """
    if os.environ.get(_VARIABLE):
        return
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    digest = source_digest(Path(__file__).resolve().parents[1])
    os.environ[_VARIABLE] = str(Path(base) / "dentscope" / f"compiled-{digest}")
