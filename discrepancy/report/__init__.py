"""A verdict for people: the page, and the lines of a terminal."""

from __future__ import annotations

from .page import page, write_report
from .sentences import headline, lines
from .story import Story, story_of

__all__ = ["Story", "headline", "lines", "page", "story_of", "write_report"]
