"""A verdict for people: the page, and the lines of a terminal."""

from __future__ import annotations

from .page import page, write_report
from .story import Story, story_of
from .text import headline, lines

__all__ = ["Story", "headline", "lines", "page", "story_of", "write_report"]
