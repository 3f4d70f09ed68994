"""Stage campaigns: finite-element cases by the hundred, a file each; published as parts."""

from __future__ import annotations

from .case import Case, standard_case
from .cost import Forecast, pace_of_this_machine
from .designs import DESIGNS, Design, design_named, distinct_cases
from .publish import (
    largest_difference,
    publish,
    published_designs,
    read_published,
)
from .quality import quality_of
from .read import digest_of_source, read_curves
from .records import CaseRecord
from .rules import RULES
from .run import Share, run_design, status_of
from .store import Store

__all__ = [
    "DESIGNS",
    "RULES",
    "Case",
    "CaseRecord",
    "Design",
    "Forecast",
    "Share",
    "Store",
    "design_named",
    "digest_of_source",
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
