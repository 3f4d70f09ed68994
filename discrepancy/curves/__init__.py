"""Traces and profiles as numbers: one reduction for the recording, its noise and the simulation."""

from __future__ import annotations

from .readings import Readings, readings_of
from .reduction import FROM_CURVES

__all__ = ["FROM_CURVES", "Readings", "readings_of"]
