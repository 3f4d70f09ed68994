"""The flow stress rises with the strain rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.arrays import Array
from ....core.inputs.flow_curve import SPECIMENS, Rise
from ...rules import RULES
from ...scene import Scene
from ...strength import StrengthTable
from ..arithmetic import energy
from ..base import Literature, Parameter, Situation
from .flow_stress import RATE, FallingStrength, FlowMechanism

REFERENCE_RATE = 1000.0  # 1/s, within the rates of impacts at a few m/s
# limit: power of the depth in ln(v/v_0) [-]: 3 to 5 are as near to finite elements
_SLOWING = 4


def risen(scene: Scene, table: StrengthTable, rise: float, exponent: float, *_kept: float) -> Array:
    """1 + A (r / 1000 s^-1)^n at r = 0.4 v(depth)/a: the rate falls as the impact slows down.

    At the turning point the metal keeps the strength of the rate just before it: a strength taken
    from the vanishing rate itself would turn the effect on restitution round. The turning point is
    that of the strength so found.
    """
    if scene.press is not None:
        # without a stated rate a press is what the strength was measured at
        pace = scene.press.rate / REFERENCE_RATE
        return np.full(table.depth.shape, 1.0 + (rise * pace**exponent if pace else 0.0))

    def turned_at(deepest: float) -> Array:
        x = table.depth / deepest
        # beyond the turn straight in the logarithms, so that the table's nodes see no corner
        slower = np.where(x < 1.0, x**_SLOWING, 1.0 + _SLOWING * np.log(np.maximum(x, 1.0)))
        rate = RATE * scene.approach.speed * RULES.slowest**slower / table.radius
        return np.asarray(1.0 + rise * (rate / REFERENCE_RATE) ** exponent)

    # once more changes restitution by less than 0.001
    work = energy(scene)
    return turned_at(table.peak(work, turned_at(table.peak(work))))


def rises_misfit(rises: Sequence[Rise], rise: Array, exponent: Array) -> Array:
    """Chi-squared of 1 + A (r/1000)^n against flow curves at several rates, broadcast over A and n.

    Specimens of one metal differ; the slowest one is in every ratio.
    """
    shape = (-1, *(1 for _ in np.broadcast_shapes(np.shape(rise), np.shape(exponent))))
    rate, ratio = (np.array(x).reshape(shape) for x in zip(*rises, strict=True))
    off = np.log1p(rise * (rate / REFERENCE_RATE) ** exponent) - np.log(ratio)
    n = len(rises)
    cause = np.linalg.inv(SPECIMENS**2 * (np.eye(n) + 1.0))
    return np.asarray(np.einsum("i...,ij,j...->...", off, cause, off))


class StrainRateHardening(FlowMechanism):
    """The flow stress rises with the strain rate, as a power (Cowper-Symonds) or a logarithm."""

    name = "strain-rate-hardening"
    title = "the metal is stronger at the rates of the impact"
    equations = "S = S_y [1 + A (r / 1000 s^-1)^n], r = 0.4 v(delta)/a"
    parameters = (
        Parameter(
            "rise_at_1000_per_s", "-", 0.03, 2.5, "log", 0.0,
            "Johnson-Cook C 0.014-0.06 gives 0.1-0.4; Cowper-Symonds (40.4, 5) gives 1.9", nodes=7,
            literature=Literature(1.9, "(1000/40.4)^(1/5), mild steel, Cowper and Symonds 1957"),
        ),
        Parameter(
            "rate_exponent", "-", 0.03, 0.4, "linear", 0.0,
            "Cowper-Symonds 1/q 0.1-0.25; a logarithm looks like C/A", nodes=3,
            literature=Literature(0.2, "q = 5, mild steel, Cowper and Symonds 1957"),
        ),
    )  # fmt: skip
    relative = staticmethod(risen)

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Flow curves at several rates leave the rises within two deviations of the best."""
        rise, exponent = self.parameters
        rises = situations[0][1].rises
        if not rises:
            return self.parameters
        places = np.linspace(0.0, 1.0, 241)
        sizes = rise.value(places)
        # of each rise the exponent counts that fits best
        misfit = rises_misfit(rises, sizes[:, None], exponent.value(places)).min(axis=1)
        left = sizes[misfit <= misfit.min() + RULES.rate_law_apart]
        found = replace(
            rise, low=float(left[0]), high=float(left[-1]), source="flow curves at several rates"
        )
        return found, exponent


class NegativeRateSensitivity(FallingStrength):
    """The flow stress falls with the strain rate: dynamic strain ageing (aluminium-magnesium)."""

    name = "negative-rate-sensitivity"
    title = "the metal is weaker at the rates of the impact"
    equations = "S = S_y/[1 + A (r / 1000 s^-1)^n], r = 0.4 v(delta)/a"
    parameters = (
        Parameter(
            "fall_at_1000_per_s", "-", 0.03, 1.0, "log", 0.0,
            "a few per cent a decade where solute atoms follow the dislocations", nodes=5,
        ),
        Parameter("fall_exponent", "-", 0.03, 0.4, "linear", 0.0, "as of hardening", nodes=3),
    )  # fmt: skip
    falls = True
    relative = staticmethod(risen)
