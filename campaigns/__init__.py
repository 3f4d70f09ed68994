"""Stage campaigns: hundreds of finite-element cases into one HDF5 file."""

from __future__ import annotations

from .case import Case, standard_case
from .cost import Forecast, pace_of_this_machine
from .designs import DESIGNS, Design, design_named, distinct_cases
from .publish import (
    Difference,
    Published,
    largest_difference,
    publish,
    published_designs,
    read_published,
)
from .quality import MOST_ENERGY_DEFECT, MOST_STEP, Quality, quality_of
from .read import read_curves
from .records import CaseRecord, Summary, UnloadingRecord
from .run import Status, Step, run_design, status_of
from .store import Store

__all__ = [
    "DESIGNS",
    "MOST_ENERGY_DEFECT",
    "MOST_STEP",
    "Case",
    "CaseRecord",
    "Design",
    "Difference",
    "Forecast",
    "Published",
    "Quality",
    "Status",
    "Step",
    "Store",
    "Summary",
    "UnloadingRecord",
    "design_named",
    "distinct_cases",
    "largest_difference",
    "pace_of_this_machine",
    "publish",
    "published_designs",
    "quality_of",
    "read_curves",
    "read_published",
    "run_design",
    "standard_case",
    "status_of",
]
