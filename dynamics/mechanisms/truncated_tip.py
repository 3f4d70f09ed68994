"""A flat at the tip's end, or an edge around it, ends the tip's curvature."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ..scene import Scene
from .arithmetic import needs_yielding_law
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


class TruncatedTip(Mechanism):
    """A flat at the tip's end, or an edge around it, ends the tip's curvature."""

    name = "truncated-tip"
    title = "the tip is flat at its end, or its curvature stops at an edge"
    equations = (
        "a (a^2 - b^2)^(1/2) = R d elastically; the law at d + b^2/(2R) once it yields; a <= c, "
        "beyond it dF/dd = 2 E' c up to a punch's plastic limit"
    )
    parameters = (
        Parameter(
            "flat_radius_over_R", "-", 0.003, 0.12, "log", 0.0,
            "0.05-1 mm on tips of 9 mm: handling wear to a turned-off centre", nodes=5,
            literature=Literature(0.03, "the middle of that range"),
        ),
        Parameter(
            "edge_radius_over_radius", "-", 0.1, 1.0, "log", math.inf,
            "of the rod's radius: from a narrow land left by turning to no chamfer at all", nodes=5,
            literature=Literature(1.0, "a tip that reaches the rod's side"),
        ),
        Parameter(
            "flat_by_radius", "-", 0.0, 1.0, "either", 1.0,
            "0 for one flat on all tips, 1 for one share of each radius", nodes=2,
            power_of="tip_share",
        ),
    )  # fmt: skip
    direction = {
        "contact_time_s": -1,
        "permanent_depth_m": -1,
        "peak_force_N": 1,
    }

    static = True
    law_error = 2.5
    """The law is that of a sphere, pressed deeper by the missing cap; about 5 % of the force."""

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a machined tip and a metal that yields."""
        if all(scene.striker.length == 0.0 for scene, _ in situations):
            return "every striker is a ball, which turns: a flat on it would not meet every impact"
        return needs_yielding_law(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the tip."""
        share = around.tip_share ** (1.0 - values.get("flat_by_radius", 1.0))
        b = values["flat_radius_over_R"] * share * scene.striker.tip_radius
        if scene.striker.length == 0.0:
            return scene
        flat = math.hypot(b, scene.striker.tip_flat_radius)
        edge = min(scene.force.edge, values["edge_radius_over_radius"] * scene.striker.radius)
        return scene.with_(
            striker=replace(scene.striker, tip_flat_radius=flat),
            force=replace(scene.force, edge=edge),
        )
