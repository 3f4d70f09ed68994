"""A pulse of force or acceleration in a record, and what the record shows beside it."""

from .find import Pulse, find_pulse

__all__ = ["Pulse", "find_pulse"]
