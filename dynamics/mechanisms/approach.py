"""Before touch: a drop that loses speed, and a striker that leans."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ..rules import RULES
from ..scene import Scene
from .arithmetic import is_oblique
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values

# limit: least angle that a tilt leaves a rod [rad]: grids go beyond what can be
_FLATTEST = 0.02
# limit: least normal speed that it leaves a ball [m/s]: likewise
_SLOWEST = 1e-3


class ImpactSpeedLoss(Mechanism):
    """Release, guide or air take speed before the touch; only where it was not measured."""

    name = "impact-speed-loss"
    title = "the striker arrives slower than its height of fall says"
    equations = "v = sqrt(2 g H) (1 - zeta)^((H/H_max)^p (m_min/m)^q)"
    parameters = (
        Parameter(
            "speed_loss", "-", 0.01, 0.3, "log", 0.0,
            "at the largest height: guides and releases take 1-30 %; what air takes is `air-drag`",
            nodes=7,
        ),
        Parameter(
            "loss_growth", "-", -0.5, 1.0, "linear", 0.0,
            "0 for a guide, 1 for air drag, -1/2 for a release that takes a fixed speed", nodes=4,
        ),
        Parameter(
            "loss_by_mass", "-", 0.0, 1.0, "either", 0.0,
            "0 for one share of all strikers, 1 for a guide's force, the same on each", nodes=2,
            power_of="mass_share",
        ),
    )  # fmt: skip
    direction = {"permanent_depth_m": -1, "peak_force_N": -1}
    form = 0.05
    in_flight = True

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs speeds computed from heights."""
        if not any(around.from_height for _, around in situations):
            return "the impact speed was measured, so losses before it do not matter"
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the approach."""
        share = _kept(values, around)
        old = scene.approach
        return scene.with_(
            approach=replace(old, speed=share * old.speed, tangential=share * old.tangential)
        )


def _kept(values: Values, around: Surroundings) -> float:
    if not around.from_height:
        return 1.0
    part = around.height_share ** values["loss_growth"]
    part *= around.mass_share ** values.get("loss_by_mass", 0.0)
    return float((1.0 - values["speed_loss"]) ** part)


class Tilt(Mechanism):
    """The striker is not at the stated angle."""

    name = "tilt"
    title = "the striker leans more or less than stated"
    equations = "theta + d_theta"
    parameters = (
        Parameter(
            "tilt_deg", "deg", -8.0, 8.0, "linear", 0.0, "thesis: +-5 degrees", nodes=9,
            literature=Literature(5.0, "the tolerance that the thesis states"),
        ),
    )  # fmt: skip
    form = 0.05
    in_flight = True
    aslant = True

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a rod, or a tangential motion."""
        if not any(s.striker.length > 0.0 or is_oblique(s) for s, _ in situations):
            return "a sphere without tangential motion has no angle"
        return ""

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Upright rods lean either way alike, and no farther than an eye lets pass."""
        if any(is_oblique(s) for s, _ in situations):
            return self.parameters
        return (replace(self.parameters[0], low=0.5, high=RULES.by_eye),)

    @staticmethod
    def cut(scene: Scene, values: Values) -> bool:
        """Whether it would turn a rod, or a ball's way, onto the flat: `attach` stops short."""
        turn, a = math.radians(values["tilt_deg"]), scene.approach
        if scene.striker.length > 0.0:
            return a.angle + turn < _FLATTEST
        left = a.speed * math.cos(turn) - a.tangential * math.sin(turn)
        return a.tangential != 0.0 and left < _SLOWEST

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the approach."""
        turn = math.radians(values["tilt_deg"])
        old = scene.approach
        if scene.striker.length > 0.0:
            angle = 0.5 * math.pi - abs(0.5 * math.pi - old.angle - turn)
            return scene.with_(approach=replace(old, angle=max(angle, _FLATTEST)))
        if old.tangential == 0.0:
            return scene
        cosine, sine = math.cos(turn), math.sin(turn)
        speed = old.speed * cosine - old.tangential * sine
        along = old.tangential * cosine + old.speed * sine
        return scene.with_(approach=replace(old, speed=max(speed, _SLOWEST), tangential=along))
