"""Friction that is not Coulomb's: it depends on the sliding speed, or the tip ploughs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..scene import Scene
from .arithmetic import is_oblique
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


class SlidingMechanism(Mechanism):
    """A mechanism of the motion along the flat."""

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs sliding."""
        if not any(is_oblique(scene) for scene, _ in situations):
            return "every impact is normal: nothing slides"
        return ""


class VelocityDependentFriction(SlidingMechanism):
    """The friction coefficient depends on the sliding speed."""

    name = "velocity-dependent-friction"
    title = "friction depends on the sliding speed"
    equations = "mu(v) = mu_d + (mu_s - mu_d) exp(-v/v_0), stated mu = mu_d^(1-w) mu_s^w"
    aslant = True
    parameters = (
        Parameter(
            "static_over_dynamic", "-", 0.3, 3.0, "log", 1.0,
            "dry metals: 1.2-2 falling; boundary-lubricated rising", nodes=6,
            literature=Literature(1.5, "dry steel is that much stickier at rest"),
        ),
        Parameter(
            "friction_speed_m_s", "m/s", 0.03, 3.0, "log", 1.0,
            "0.01-1 m/s in collections of friction laws; wider for what an impact can see", nodes=4,
            literature=Literature(0.3, "within collections of friction laws"),
        ),
        Parameter(
            "friction_stated_slow", "-", 0.0, 1.0, "linear", 0.0,
            "0: the stated coefficient is that of fast sliding, 1: of a slow test; sheets rarely "
            "say which", nodes=3,
            literature=Literature(0.0, "the coefficient is that of sliding"),
        ),
    )  # fmt: skip

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the friction law."""
        ratio = values["static_over_dynamic"]
        fast = scene.friction.mu * ratio ** -values["friction_stated_slow"]
        friction = replace(
            scene.friction, mu=fast, mu_static=ratio * fast, speed=values["friction_speed_m_s"]
        )
        return scene.with_(friction=friction)


class PloughingFriction(SlidingMechanism):
    """The tip pushes metal ahead of it."""

    name = "ploughing-friction"
    title = "the tip ploughs"
    equations = "mu + s (4/(3 pi)) a/R"
    aslant = True
    parameters = (
        Parameter(
            "ploughing_scale", "-", 0.3, 5.0, "log", 0.0,
            "1 is the front of a rigid sphere (Bowden and Tabor); pile-up raises it",
            literature=Literature(1.0, "the front of a rigid sphere, Bowden and Tabor"),
        ),
    )  # fmt: skip
    direction = {"friction_impulse_ratio": 1, "sliding_length_m": -1}

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the friction law."""
        total = scene.friction.ploughing + values["ploughing_scale"]
        return scene.with_(friction=replace(scene.friction, ploughing=total))
