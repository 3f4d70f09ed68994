"""Stage verification: the solver against exact solutions, published numbers and another code.

`CHECKS` lists every check in the order in which the report shows them; `run_checks` measures them
one by one and keeps what it measured, `write_report` turns that into docs/verification.md.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .bench import Bench, Effort
    from .checks import CHECKS, Check, check_named
    from .report import write_report
    from .result import Measurement, Result, Table
    from .runner import run_checks

_FROM = {
    "Bench": "bench",
    "CHECKS": "checks",
    "Check": "checks",
    "Effort": "bench",
    "Measurement": "result",
    "Result": "result",
    "Table": "result",
    "check_named": "checks",
    "run_checks": "runner",
    "write_report": "report",
}

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


def __getattr__(name: str) -> Any:
    """Load a name when it is first asked for: the names of the checks need no solver."""
    if name not in _FROM:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_FROM[name]}", __name__), name)
