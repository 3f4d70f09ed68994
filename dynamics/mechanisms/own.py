"""Mechanisms that are not of this package: one's own, and those that other packages add."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...core.errors import InputError
from ...core.inputs.added import MECHANISMS as GROUP
from ...core.inputs.added import added, names_added
from . import MECHANISMS, NAMELESS
from .base import Mechanism


def own_mechanisms(given: Mechanism | Sequence[Mechanism]) -> tuple[Mechanism, ...]:
    """Return those that were given, one or several, and those of other packages; or their classes.

    Raises `InputError`: one is no mechanism, or bears a name of the library or of another.
    """
    found = [
        *(given if isinstance(given, Iterable) else (given,)),
        *(added(GROUP, name) for name in names_added(GROUP)),
    ]
    own = tuple(m() if isinstance(m, type) else m for m in found)
    taken = {m.name for m in (*MECHANISMS, *NAMELESS)}
    for m in own:
        if not isinstance(m, Mechanism):
            raise InputError(f"{m!r}", key="mechanisms", allowed="each a discrepancy.Mechanism")
        if m.name in taken:
            raise InputError(
                f"{m.name!r} is taken", key="mechanisms", allowed="a name of its own for each"
            )
        taken.add(m.name)
    return own


def uncovered(own: Sequence[Mechanism]) -> tuple[str, ...]:
    """Return what a verdict says of mechanisms that are not of this package."""
    return tuple(
        f"{m.name} ({m.title}) is not of this package: it was compared as the others were, but "
        "neither the calibration of the probabilities nor the blind proof covers it"
        for m in own
    )
