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
    "ApproachMotion": "recording_set",
    "Audit": "checks",
    "CONDITIONS": "columns",
    "FORMAT": "setup_file",
    "Finding": "checks",
    "MEASURED": "columns",
    "Noise": "noise",
    "RecordingSet": "recording_set",
    "SetFile": "setup_file",
    "Severity": "checks",
    "Trials": "trials",
    "audit": "checks",
    "read": "recording_set",
    "write": "recording_set",
}

__all__ = [
    "CONDITIONS",
    "FORMAT",
    "MEASURED",
    "ApproachMotion",
    "Audit",
    "Finding",
    "Noise",
    "RecordingSet",
    "SetFile",
    "Severity",
    "Trials",
    "audit",
    "read",
    "write",
]


def __getattr__(name: str) -> Any:
    """Load a name when it is first asked for: the audit alone takes two seconds of scipy."""
    if name not in _FROM:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_FROM[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted(__all__)
