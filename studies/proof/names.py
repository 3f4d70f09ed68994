"""What `dentscope proof` may be asked for; apart from what draws it, so that asking is quick."""

from __future__ import annotations

LISTS = ("full", "small")
"""Lists of sets that a run can have."""

KINDS = ("null", "single", "pair", "outside")
"""Kinds of a sample set."""
