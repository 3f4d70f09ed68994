"""Asperities give way before the bulk does, and do not come back whole."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...core.arrays import Array
from ..rules import RULES
from ..scene import Scene
from ..strength import StrengthTable, strength_table
from .arithmetic import needs_yielding_law, times
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


@dataclass(frozen=True, slots=True)
class Layer:
    """A rough layer in series with the bulk, over the depth nodes of a law's table.

    - `force`, `recovery`: (NODES,) factors on the smooth contact's loading force and elastic
      recovery.
    - `dent`: (NODES,) depth that stays over the peak depth less the recovery, which is the
      energy's.
    """

    force: Array
    recovery: Array
    dent: Array

    @classmethod
    def of(cls, table: StrengthTable, sigma: float, start: float, kept: float) -> Layer:
        """Return the layer that closes by sigma ln(1 + F/F_0).

        Asperities with exponential heights carry F = F_0 (exp(closure/sigma) - 1), and open again
        on the same curve until the part `kept` of the closure is left.

        `table`: of the smooth contact; `sigma`: mean height of the asperities [m]; `start`: F_0
        over the force at which the bulk has moved by sigma; `kept`: part of the closure that stays.
        """
        depth, force = table.depth, np.exp(table.stated.force)
        recovered = np.exp(table.stated.recovery)
        scale = start * math.exp(np.interp(math.log(sigma), np.log(depth), np.log(force)))
        turns = np.log1p(force / scale)
        freed = scale * np.expm1(kept * turns)
        given = sigma * (force - freed - scale * (1.0 - kept) * turns)
        back = recovered + (1.0 + RULES.rough_power) * given / force
        total = depth + sigma * turns

        def at_nodes(value: Array) -> Array:
            return np.asarray(np.interp(np.log(depth), np.log(total), value))

        rough_back = np.minimum(np.exp(at_nodes(np.log(back))), depth)
        stays = np.maximum(at_nodes(depth - recovered + kept * sigma * turns), 0.0)
        rest = np.maximum(depth - rough_back, 1e-3 * depth)
        return cls(np.exp(at_nodes(np.log(force))) / force, rough_back / recovered, stays / rest)


class Roughness(Mechanism):
    """Asperities give way before the bulk does, and do not come back whole."""

    name = "roughness"
    title = "asperities give way before the bulk"
    equations = "depth + sigma ln(1 + F/F_0); the part k of the closure stays"
    parameters = (
        Parameter(
            "roughness_m", "m", 1e-7, 1e-5, "log", 0.0,
            "Greenwood and Williamson 1966; ground 0.4 um, turned 1-5 um", nodes=7,
            literature=Literature(4e-7, "a ground surface"),
        ),
        Parameter(
            "asperity_force_ratio", "-", 0.01, 3.0, "log", 1.0,
            "F_0 over the force that dents the bulk by sigma: the part of the area that Gaussian "
            "heights put above three standard deviations (0.001) to one (0.16), each way tenfold",
            nodes=5,
            literature=Literature(0.16, "Gaussian heights above one standard deviation"),
        ),
        Parameter(
            "asperity_flattening", "-", 0.0, 1.0, "linear", 0.0,
            "part of the closure that stays: 0 for elastic asperities, 1 for those that flow "
            "(plasticity index, Greenwood and Williamson 1966)", nodes=3,
            literature=Literature(1.0, "asperities that flow"),
        ),
    )  # fmt: skip
    direction = {"contact_time_s": 1, "peak_force_N": -1}
    static = True
    reads = ("Ra_m",)

    def stated(self, around: Surroundings) -> Values:
        """Heights that fall off exponentially with the mean sigma have Ra = 2 sigma/e."""
        Ra = around.roughness
        return {"roughness_m": 0.5 * math.e * Ra} if Ra >= 0.0 else {}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return needs_yielding_law(situations)

    def idle(self, situations: Sequence[Situation]) -> str:
        """A stated roughness of 0 is none."""
        smooth = situations[0][1].roughness == 0.0
        return "the surfaces are smooth, as stated" if smooth else super().idle(situations)

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated roughness narrows the range."""
        stated = situations[0][1].roughness
        sigma, *rest = self.parameters
        if stated > 0.0:
            sigma = replace(sigma, low=0.5 * stated, high=4.0 * stated)
        return (sigma, *rest)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        layer, now = _layer_of(scene, values), scene.force
        return scene.with_(
            force=replace(
                now, factors=times(now.factors, layer.force),
                recovery_factors=times(now.recovery_factors, layer.recovery),
            )
        )  # fmt: skip

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Set the depth that stays in either body, of bulk and layer."""
        left = []
        for (scene, _), peak in zip(situations, seen["peak_depth_m"], strict=True):
            table, dent = strength_table(scene.law, scene.pair), _layer_of(scene, values).dent
            left.append(np.interp(math.log(max(peak, table.depth[0])), table.log_depth, dent))
        bodies = ("permanent_depth_m", "residual_sphere_m")
        stays = {**seen, **{k: seen[k] * np.array(left) for k in bodies if k in seen}}
        if "recovered_depth_m" in seen:
            # what the recovery gives back in depth is not what it gives back in energy
            whole = seen["press_depth_m"]
            rest = (whole - seen["recovered_depth_m"]) * np.array(left)
            stays["recovered_depth_m"] = whole - rest
        return stays


def _layer_of(scene: Scene, values: Values) -> Layer:
    table = strength_table(scene.law, scene.pair)
    return _layer(
        table, values["roughness_m"], values["asperity_force_ratio"], values["asperity_flattening"]
    )


# all impacts of a pair meet one layer, before the motion and after it
_layer = lru_cache(maxsize=256)(Layer.of)
