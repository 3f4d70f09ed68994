"""What one blow differs from another by, in per cent."""

from __future__ import annotations

from ..result import Impact

ATOM = 1e-10
"""Diameter of an atom [m]: no dent is less deep."""


def effect(other: Impact, found: Impact) -> str:
    """Return how `other` differs in dent and restitution, in spin where both stay as they are."""
    if not other.outcome.completed:
        return "the tip does not part within the budgets"
    back = found.restitution
    ratios = {"restitution": other.restitution / back} if back > 0.0 else {}
    # the dent of the body that keeps most of it
    key = max(("residual_flat_m", "residual_sphere_m"), key=lambda name: getattr(found, name))
    if getattr(found, key) > ATOM:
        ratios = {"dent": getattr(other, key) / getattr(found, key), **ratios}
    told = {name: _percent(ratio) for name, ratio in ratios.items()}
    if not back > 0.0:
        other_back = other.restitution
        told["restitution"] = f"{other_back:.3g} in place of 0" if other_back else "0 either way"
    if set(told.values()) == {_percent(1.0)} and found.rebound_spin_rad_s != 0.0:
        told["spin"] = _percent(other.rebound_spin_rad_s / found.rebound_spin_rad_s)
    return ", ".join(f"{name} {change}" for name, change in told.items())


def _percent(ratio: float) -> str:
    """A change to two digits; what rounding alone makes is none."""
    change = round(100.0 * (ratio - 1.0), 3) + 0.0
    return f"{change:+.2g} %" if abs(change) < 99.5 else f"{change:+.0f} %"
