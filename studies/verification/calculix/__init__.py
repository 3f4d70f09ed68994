"""The same contact problem for CalculiX: input deck, run, and reading of its output."""

from __future__ import annotations

from .deck import Deck, write_deck
from .output import Reference, load_reference, measure, run_deck, solve_deck

__all__ = [
    "Deck",
    "Reference",
    "load_reference",
    "measure",
    "run_deck",
    "solve_deck",
    "write_deck",
]
