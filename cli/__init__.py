"""Command line, the only place that prints: one file per command group, assembled in `app`."""

from __future__ import annotations

from .app import run

__all__ = ["run"]
