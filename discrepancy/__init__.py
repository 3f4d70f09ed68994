"""Stage discrepancy: what physics is missing in a simulation that recordings do not match.

`from dentscope.discrepancy import diagnose`. The names are imported when they are asked for, so
that the proof, which lives in a folder of this one, starts without the tool that it judges.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .findings import Verdict
    from .mechanisms import MECHANISMS, Mechanism, Parameter
    from .verdict import diagnose

__all__ = ["MECHANISMS", "Mechanism", "Parameter", "Verdict", "diagnose"]

_HOMES = {
    "MECHANISMS": "mechanisms", "Mechanism": "mechanisms", "Parameter": "mechanisms",
    "Verdict": "findings", "diagnose": "verdict",
}  # fmt: skip


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(name)
    from importlib import import_module

    return getattr(import_module(f".{_HOMES[name]}", __name__), name)
