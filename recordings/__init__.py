"""Stage recordings: measured impacts, reduced and checked."""

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
    "Environment",
    "Friction",
    "Noise",
    "Quantity",
    "RecordingSet",
    "Setup",
    "Striker",
    "Target",
    "Trials",
    "read",
    "write",
]
