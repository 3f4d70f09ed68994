"""Stage recordings: sets of measured impacts, read, written, checked and audited."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .checks import Audit, Finding, Severity, audit
    from .columns import CONDITIONS, MEASURED
    from .noise import Noise
    from .recording_set import ApproachMotion, RecordingSet, read, write
    from .setup_file import FORMAT, SetFile
    from .trials import Trials

_FROM = {
    "checks": ("Audit", "Finding", "Severity", "audit"),
    "columns": ("CONDITIONS", "MEASURED"),
    "noise": ("Noise",),
    "recording_set": ("ApproachMotion", "RecordingSet", "read", "write"),
    "setup_file": ("FORMAT", "SetFile"),
    "trials": ("Trials",),
}

__all__ = [
    "CONDITIONS", "FORMAT", "MEASURED", "ApproachMotion", "Audit", "Finding", "Noise",
    "RecordingSet", "SetFile", "Severity", "Trials", "audit", "read", "write",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Load a name when it is first asked for: the audit alone takes two seconds of scipy."""
    for module, names in _FROM.items():
        if name in names:
            return getattr(import_module(f".{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
