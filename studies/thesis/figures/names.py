"""What `dentscope figures` may be asked for; apart from what draws it, so that asking is quick."""

from __future__ import annotations

CHAPTERS = ("1", "2", "3", "4 and 5")
"""Chapters in reading order."""

FIELDS = ("2.2", "2.3", "2.4", "3.7")
"""Figures whose stress field is solved."""
