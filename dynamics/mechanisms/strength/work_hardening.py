"""The flow stress rises with plastic strain."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ....core.arrays import Array
from ....models.anchored import AnchoredLaw
from ....models.hardening import mean_over_strains
from ...scene import Scene
from ...strength import StrengthTable, strength_table
from ..arithmetic import deepest
from ..base import Literature, Parameter, Situation
from .flow_stress import FallingStrength, FlowMechanism, settled_strain, strain


def measured_further(situations: Sequence[Situation]) -> str:
    """Return why the flow curve that the law follows leaves nothing to add, or ""."""
    reached, known = 0.0, math.inf
    for scene, _ in situations:
        law = scene.law
        if not (isinstance(law, AnchoredLaw) and law.hardens):
            return ""
        weak = law.at.sphere if law.stated.weaker is law.stated.sphere else law.at.flat
        curve = weak.flow.curve if weak.flow is not None else None
        table = strength_table(law, scene.pair)
        at = float(np.interp(math.log(deepest(scene)), table.log_depth, strain(scene, table)))
        reached, known = max(reached, at), min(known, curve.strain[-1] if curve else 0.0)
    if not reached < known:
        return ""
    return (
        f"the flow curve is measured to a strain of {known:.2g}; the contacts reach {reached:.2g}"
    )


def _hardened(scene: Scene, table: StrengthTable, rise: float, exponent: float) -> Array:
    """Mean of 1 + K p^n over the strains under the contact, as the law of metals that harden."""
    rise = rise * mean_over_strains(exponent)

    def strength(p: Array) -> Array:
        return np.asarray(1.0 + rise * p**exponent)

    return strength(settled_strain(scene, table, strength))


class WorkHardening(FlowMechanism):
    """The flow stress rises with plastic strain."""

    name = "work-hardening"
    title = "the metal hardens as it is deformed"
    equations = "S = S_y (1 + K p^n)"
    parameters = (
        Parameter(
            "hardening_ratio", "-", 0.15, 12.0, "log", 0.0,
            "B/A of Johnson and Cook's metals: 0.6 (4340) to 3.2 (OFHC copper); 7 of 304 and 8 of "
            "copper, annealed (K of W. D. Callister's tables over the yield strength)", nodes=8,
            literature=Literature(0.79, "B/A = 275/350 of 1006 steel, Johnson and Cook 1983"),
        ),
        Parameter(
            "hardening_exponent", "-", 0.15, 1.0, "linear", 1.0,
            "0.26 (4340) to 0.36 (1006); 1 for linear hardening", nodes=3,
            literature=Literature(0.36, "n of 1006 steel, Johnson and Cook 1983"),
        ),
    )  # fmt: skip
    relative = staticmethod(_hardened)

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields, and no flow curve that says what it does."""
        return super().applies(situations) or measured_further(situations)


class StrainSoftening(FallingStrength):
    """The flow stress falls with plastic strain: cold-worked metals, glasses, many polymers."""

    name = "strain-softening"
    title = "the metal softens as it is deformed"
    equations = "S = S_y/(1 + K p^n)"
    parameters = (
        Parameter(
            "softening_ratio", "-", 0.15, 12.0, "log", 0.0,
            "down to a half at a representative strain of 1 to 10 %", nodes=7,
        ),
        Parameter("softening_power", "-", 0.15, 1.0, "linear", 1.0, "as of hardening", nodes=3),
    )  # fmt: skip
    falls = True
    relative = staticmethod(_hardened)

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields, and no flow curve that says what it does."""
        return super().applies(situations) or measured_further(situations)
