"""Stage campaigns: hundreds of finite-element cases into one HDF5 file."""

from __future__ import annotations

from .case import Case, standard_case
from .designs import DESIGNS, Design, design_named, distinct_cases
from .publish import largest_difference, publish, read_published
from .run import Status, Step, run_design, status_of
from .store import CaseRecord, Store, UnloadingRecord, read_curves

__all__ = [
    "DESIGNS",
    "Case",
    "CaseRecord",
    "Design",
    "Status",
    "Step",
    "Store",
    "UnloadingRecord",
    "design_named",
    "distinct_cases",
    "largest_difference",
    "publish",
    "read_curves",
    "read_published",
    "run_design",
    "standard_case",
    "status_of",
]
