"""What one blow differs from another by, in per cent."""

from __future__ import annotations

from ..result import Impact

ATOM = 1e-10
"""Diameter of an atom [m]: no dent is less deep."""


def effect(other: Impact, found: Impact) -> str:
    """Return how `other` differs in dent and restitution from `found`."""
    if not other.outcome.completed:
        return "the tip does not part within the budgets"
    e = f"restitution {_percent(other.restitution / found.restitution)}"
    if not found.residual_flat_m > ATOM:
        return e
    return f"dent {_percent(other.residual_flat_m / found.residual_flat_m)}, {e}"


def _percent(ratio: float) -> str:
    """A change to two digits; what rounding alone makes is none."""
    change = round(100.0 * (ratio - 1.0), 3) + 0.0
    return f"{change:+.2g} %" if abs(change) < 99.5 else f"{change:+.0f} %"
