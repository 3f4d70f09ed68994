"""Traces and profiles as numbers: one reduction for the recording, its noise and the simulation."""

from __future__ import annotations

from .readings import Readings, readings_of

__all__ = ["Readings", "readings_of"]
