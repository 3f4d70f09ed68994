"""Ground floor of dentscope: bodies, rigs, observables, errors, outcomes, reading and writing."""

from __future__ import annotations

from .errors import COMPLETED, Ending, InputError, InputErrors, Outcome
from .material import Material, Pair

__all__ = ["COMPLETED", "Ending", "InputError", "InputErrors", "Material", "Outcome", "Pair"]
