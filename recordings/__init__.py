"""Stage recordings: measured impacts, reduced and checked."""

from .audit import Audit, Finding, Severity, audit
from .columns import CONDITIONS, MEASURED
from .noise import Noise
from .recording_set import Approach, RecordingSet, read, write
from .setup_file import FORMAT, Setup
from .trials import Trials

__all__ = [
    "CONDITIONS",
    "FORMAT",
    "MEASURED",
    "Approach",
    "Audit",
    "Finding",
    "Noise",
    "RecordingSet",
    "Setup",
    "Severity",
    "Trials",
    "audit",
    "read",
    "write",
]
