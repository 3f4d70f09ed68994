"""Stage start: what a newcomer calls: a blow, a pair by finite elements or laws, a diagnosis.

Each takes the file that the command of the same name takes, and returns something that shows
itself in a notebook, plots itself and gives a data frame.
Each is loaded when it is first asked for: to refuse a file needs neither solver nor diagnosis.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .blows import impact, sweep
    from .checked import Material, Pair, material
    from .comparison import LawComparison, compare_laws
    from .diagnosis import Diagnosis, diagnose
    from .pair import Solved, case

_FROM = {
    "blows": ("impact", "sweep"),
    "checked": ("Material", "Pair", "material"),
    "comparison": ("LawComparison", "compare_laws"),
    "diagnosis": ("Diagnosis", "diagnose"),
    "pair": ("Solved", "case"),
}

__all__ = [
    "Diagnosis", "LawComparison", "Material", "Pair", "Solved", "case", "compare_laws", "diagnose",
    "impact", "material", "sweep",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Load a name when it is first asked for."""
    for module, names in _FROM.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
