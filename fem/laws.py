"""The metals' flow laws in the solver's units, R = 1 and E' = 1."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..core.flow import Flow, Heating, Rate
from ..core.material import Material
from .material import FlowLaws, no_laws
from .material.flow import COWPER_SYMONDS, JOHNSON_COOK, NO_RATE, OVERSTRESS

_RATES = {
    "cowper-symonds": COWPER_SYMONDS,
    "johnson-cook": JOHNSON_COOK,
    "overstress": OVERSTRESS,
}
_SLOW = Rate("overstress", 1.0, 1.0)
_COLD = Heating(0.0, 1.0, 1.0)


def laws_of(bodies: Sequence[tuple[Material, float]], unit: float) -> FlowLaws:
    """Laws of bodies that have one, each with its shear modulus [Pa]; `unit` is E' [Pa]."""
    if not bodies:
        return no_laws()
    flows = [body.flow or Flow() for body, _ in bodies]
    per_stress = [math.sqrt(2.0 / 3.0) / (2.0 * shear) for _, shear in bodies]
    rates = [flow.rate or _SLOW for flow in flows]
    heats = [flow.heating or _COLD for flow in flows]
    most = max(2 if flow.curve is None else len(flow.curve.strain) for flow in flows)
    return FlowLaws(
        curve=np.array(
            [_table(body, scale, most) for (body, _), scale in zip(bodies, per_stress, strict=True)]
        ),
        rate=np.array([_RATES[flow.rate.law] if flow.rate else NO_RATE for flow in flows]),
        reference=np.array([rate.reference for rate in rates]),
        number=np.array([rate.number for rate in rates]),
        overstress=np.array([r.stress * s for r, s in zip(rates, per_stress, strict=True)]),
        rise=np.array([h.fraction * unit / (h.capacity * h.range) for h in heats]),
        exponent=np.array([h.exponent for h in heats]),
    )


def _table(body: Material, scale: float, rows: int) -> np.ndarray:
    """Plastic strain, radius and slope by row, the last stress repeated up to so many rows."""
    curve = body.flow.curve if body.flow else None
    strain, stress, slope = (
        ([0.0, 1.0], [body.Sy] * 2, [0.0] * 2)
        if curve is None
        else (list(curve.strain), list(curve.stress), list(curve.slope))
    )
    while len(strain) < rows:
        strain.append(2.0 * strain[-1])
        stress.append(stress[-1])
        slope.append(0.0)
    return np.array([strain, np.array(stress) * scale, np.array(slope) * scale])
