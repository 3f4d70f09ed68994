"""Stage models: closed-form contact laws behind one contract."""

from __future__ import annotations

from ..core.errors import InputError
from .base import (
    ContactLaw,
    Domain,
    DomainWarning,
    Kernels,
    critical_depth,
    critical_force,
    yield_constant,
)
from .fitted import shipped_law
from .ghaednia import GHAEDNIA
from .hertz import HERTZ
from .jackson_green import JACKSON_GREEN

_FITTED = shipped_law()
LAWS: dict[str, ContactLaw] = {
    law.name: law for law in (HERTZ, JACKSON_GREEN, GHAEDNIA, *((_FITTED,) if _FITTED else ()))
}
"""Every law by name, in reading order: from the simplest assumption to the fullest."""


def law_named(name: str) -> ContactLaw:
    """Return the law called `name`.

    Raises
    ------
    InputError
        There is none; the message lists the known ones.
    """
    if name not in LAWS:
        raise InputError(f"{name!r}", key="law", allowed=", ".join(LAWS))
    return LAWS[name]


__all__ = [
    "LAWS",
    "ContactLaw",
    "Domain",
    "DomainWarning",
    "Kernels",
    "critical_depth",
    "critical_force",
    "law_named",
    "yield_constant",
]
