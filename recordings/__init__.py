"""Stage recordings: measured impacts, reduced and checked."""

from .audit import Audit, Finding, Severity, audit
from .columns import CONDITIONS, OBSERVABLES
from .noise import Noise
from .recording_set import Approach, RecordingSet, read, write
from .setup_file import FORMAT, Environment, Friction, Quantity, Setup, Striker, Target
from .trials import Trials

__all__ = [
    "CONDITIONS",
    "FORMAT",
    "OBSERVABLES",
    "Approach",
    "Audit",
    "Environment",
    "Finding",
    "Friction",
    "Noise",
    "Quantity",
    "RecordingSet",
    "Setup",
    "Severity",
    "Striker",
    "Target",
    "Trials",
    "audit",
    "read",
    "write",
]
