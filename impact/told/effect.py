"""What one blow differs from another by, in per cent."""

from __future__ import annotations

from ..result import Impact


def effect(other: Impact, found: Impact) -> str:
    """Return how `other` differs in dent and restitution from `found`."""
    if not other.outcome.completed:
        return "the tip does not part within the budgets"
    e = f"restitution {100.0 * (other.restitution / found.restitution - 1.0):+.2g} %"
    if not found.residual_flat_m > 0.0:
        return e
    return f"dent {100.0 * (other.residual_flat_m / found.residual_flat_m - 1.0):+.2g} %, {e}"
