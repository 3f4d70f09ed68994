"""The flow stress rises with the strain rate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...impact import Scene
from ...impact.scene import FlowStress
from ...impact.strength import StrengthTable
from .arithmetic import energy
from .base import Array, Literature, Parameter, Surroundings, Values
from .flow_stress import RATE, FlowMechanism, StrengthProfile

_REFERENCE_RATE = 1000.0  # 1/s, within the rates of impacts at a few m/s
_SLOWEST = 0.2  # the rate's memory at the turning point, of the approach speed


@dataclass(frozen=True, slots=True)
class RateProfile(StrengthProfile):
    """1 + A (r/1000)^n with r = 0.4 v(depth)/a: the rate falls as the impact slows down.

    At the turning point the metal keeps the strength of the rate just before it: a strength taken
    from the vanishing rate itself would turn the effect on restitution round.
    """

    rise: float
    exponent: float

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        """Return relative strengths at the depths of `table`, shape (nodes,)."""
        deepest = table.peak(energy(scene))
        slowing = 1.0 - (table.depth / deepest) ** 2
        speed = scene.approach.speed * np.sqrt(np.maximum(slowing, _SLOWEST**2))
        rate = RATE * speed / table.radius
        return np.asarray(1.0 + self.rise * (rate / _REFERENCE_RATE) ** self.exponent)


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

    def strength(self, scene: Scene, values: Values, around: Surroundings) -> FlowStress:
        """Return the profile of this mechanism."""
        return RateProfile(values["rise_at_1000_per_s"], values["rate_exponent"])
