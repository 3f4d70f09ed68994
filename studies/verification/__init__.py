"""Stage verification: the solver against exact solutions, published numbers and another code.

`CHECKS` lists every check in the order in which the report shows them; `run_checks` measures them
one by one and keeps what it measured, `write_report` turns that into docs/verification.md.
"""

from __future__ import annotations

from .bench import Bench, Effort
from .checks import CHECKS, Check, check_named
from .report import write_report
from .result import Measurement, Result, Table
from .runner import run_checks

__all__ = [
    "Bench",
    "CHECKS",
    "Check",
    "Effort",
    "Measurement",
    "Result",
    "Table",
    "check_named",
    "run_checks",
    "write_report",
]
