"""The surfaces stick to each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...core.arrays import Array
from ..scene import Scene
from .arithmetic import energy, slower
from .base import Mechanism, Parameter, Situation, Surroundings, Values


class Adhesion(Mechanism):
    """Pull-off work is lost when the bodies part."""

    name = "adhesion"
    title = "the surfaces stick to each other"
    equations = "work of parting 7.09 (W^5 R^4/E'^2)^(1/3)"
    parameters = (
        Parameter(
            "work_of_adhesion_J_m2", "J/m^2", 0.05, 2.0, "log", 0.0,
            "Thornton and Ning, Powder Technol. 99 (1998) 154; clean metals up to 2 J/m^2",
        ),
    )  # fmt: skip
    direction = {"restitution": -1}
    rests_on = ("target", "striker")

    def applies(self, situations: Sequence[Situation]) -> str:
        """Compare the work of parting with the energy of the slowest impact."""
        shares = [self._work(s, 2.0) / energy(s) for s, _ in situations]
        largest = max(shares)
        if largest < 1e-3:
            pull = max(1.5 * math.pi * 2.0 * s.pair.R for s, _ in situations)
            return (
                f"pulling the bodies apart takes at most {pull:.2g} N and {largest:.1e} of the "
                "approach energy"
            )
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Leave the motion; the loss is taken after it."""
        return scene

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Take the work of parting from the rebound's energy."""
        lost = np.array(
            [self._work(s, values["work_of_adhesion_J_m2"]) / energy(s) for s, _ in situations]
        )
        return slower(seen, np.sqrt(np.maximum(seen["restitution"] ** 2 - lost, 0.0)))

    @staticmethod
    def _work(scene: Scene, W: float) -> float:
        return float(7.09 * (W**5 * scene.pair.R**4 / scene.pair.E_reduced**2) ** (1.0 / 3.0))
