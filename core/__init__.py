"""Ground floor of dentscope: materials, input errors, outcomes, provenance, input files."""

from __future__ import annotations

from .errors import COMPLETED, Ending, InputError, InputErrors, Outcome
from .material import Material, Pair

__all__ = ["COMPLETED", "Ending", "InputError", "InputErrors", "Material", "Outcome", "Pair"]
