"""Stage models: contact laws behind one contract: published, ours, of a solved pair, joined."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches

from ..core.errors import InputError
from ..core.inputs.added import LAWS as LAW_GROUP
from ..core.inputs.added import names_added
from .base import ContactLaw, DomainWarning
from .coefficients import shipped_laws
from .kernel import critical_depth, critical_force, yield_constant
from .law_file import is_file, read_law
from .published import PUBLISHED, UNAVAILABLE
from .shelf import Shelf
from .uncertainty import Uncertainty

try:
    _OURS, _UNREADABLE = shipped_laws(), None
except InputError as error:  # kept for whoever asks for a law: a new fit must still be possible
    _OURS, _UNREADABLE = (), error
LAWS = Shelf((law.name, law) for law in (*PUBLISHED, *_OURS))
"""Every law by name, in reading order: from the simplest assumption to the fullest."""


Laws = str | ContactLaw | Sequence[str | ContactLaw]
"""One or several, by name or as they are: one's own has no name here."""


def laws_named(given: Laws) -> list[ContactLaw]:
    """Return the laws that are asked for; refuse two that bear one name."""
    found: dict[str, ContactLaw] = {}
    for one in [given] if isinstance(given, str) or not isinstance(given, Iterable) else given:
        if not isinstance(one, str | ContactLaw):
            raise InputError(repr(one), key="law", allowed="the name of a law, or a law")
        law = law_named(one) if isinstance(one, str) else one
        if found.setdefault(law.name, law) is not law:
            raise InputError(f"two laws {law.name!r}", key="law", allowed="each name once")
    return list(found.values())


def law_named(name: str) -> ContactLaw:
    """Return the law called `name`.

    `one+other` is one's loading with the other's unloading; the path of a law.json, or of the
    folder in which `dentscope case` wrote it, is the law of that pair; the path of a fitted.json
    that `dentscope fit` wrote is its law (`fitted.json:compact`, `:hardening`: the others).
    Another package may add laws (`core.inputs.added`).

    Raises `InputError`: there is none; the message lists the known ones.
    """
    if is_file(name):
        return read_law(name)
    if name in ("compact", "fitted") and _UNREADABLE is not None:
        raise _UNREADABLE
    if name in UNAVAILABLE:
        raise InputError(f"{name!r} is not offered: {UNAVAILABLE[name]}", key="law")
    if name.count("+") == 1:
        first, second = name.split("+")
        return law_named(first).with_unloading(law_named(second))
    if name in (known := (*LAWS, *names_added(LAW_GROUP))):
        return LAWS[name]
    near = get_close_matches(name, LAWS, n=1)
    meant = f"; did you mean {near[0]!r}?" if near else ""
    allowed = f"{', '.join(known)}, a law.json or a fitted.json"
    raise InputError(f"{name!r}{meant}", key="law", allowed=allowed)


__all__ = [
    "LAWS",
    "UNAVAILABLE",
    "Uncertainty",
    "ContactLaw",
    "DomainWarning",
    "critical_depth",
    "critical_force",
    "law_named",
    "yield_constant",
]
