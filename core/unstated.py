"""Values of which some numbers may be left unstated, as nan."""

from __future__ import annotations

from dataclasses import fields
from operator import attrgetter
from typing import Any, TypeVar

Value = TypeVar("Value")


def unstated_equal(cls: type[Value]) -> type[Value]:
    """Let two values of a frozen dataclass be equal if both leave the same numbers unstated.

    nan differs from itself, and Python compares dataclasses by their numbers since 3.13 (before, by
    tuples, in which the same nan object counts as equal). Without this a metal of unknown density
    is not the one that was stored, and a cache never finds it again.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> steel = Material(E=200e9, nu=0.3, density=float("nan"))
    >>> steel == Material(E=200e9, nu=0.3), len({steel, Material(E=200e9, nu=0.3)})
    (True, 1)
    """
    numbers = attrgetter(*(f.name for f in fields(cls) if f.compare))  # type: ignore[arg-type]

    def key(value: Any) -> tuple[Any, ...]:
        found: tuple[Any, ...] = numbers(value)
        # caches ask a million times in a diagnosis: no look at each number where all are stated
        for v in found:
            if v != v:
                return tuple([None if isinstance(v, float) and v != v else v for v in found])
        return found

    def equal(self: Any, other: object) -> Any:
        if self is other:
            return True
        return key(self) == key(other) if other.__class__ is self.__class__ else NotImplemented

    def hashed(self: Any) -> int:
        return hash(key(self))

    cls.__eq__ = equal  # type: ignore[method-assign]
    cls.__hash__ = hashed  # type: ignore[method-assign]
    return cls
