"""The gates between a reduction and its numbers.

Every check that a reduction makes passes, widens the stated error by what it means, or refuses with
the reason and a picture of the record. None is only a note.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..core.errors import InputError
from .measured import Measured
from .rules import RULES


def is_restitution(value: Measured) -> bool:
    """Whether a value and its error tell a part of the speed that a contact can give back.

    One of which nothing is known but that it lies between 0 and 1 has a deviation of 1/12^(1/2).
    """
    off = max(-value.value, value.value - 1.0, 0.0)
    most = min(RULES.own_error * abs(value.value), 12.0**-0.5)
    return off <= RULES.by_chance * value.std and value.std < most


class Refused(InputError):
    """A record that gives no number, and what draws it with the reason."""

    def __init__(self, found: str, *, source: str, allowed: str, key: str = "") -> None:
        super().__init__(found, source=source, key=key, allowed=allowed)
        self.draw: Callable[[Path], None] | None = None
