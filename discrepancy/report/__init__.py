"""A verdict for people: one page with figures, and lines for a terminal."""

from __future__ import annotations

from .page import write_report
from .text import lines

__all__ = ["lines", "write_report"]
