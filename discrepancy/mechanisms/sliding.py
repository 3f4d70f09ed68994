"""Mechanisms of the tangential motion: friction that is not Coulomb's, and elastic displacement."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

from ...impact import Scene
from .base import Mechanism, Parameter, Situation, Surroundings, Values, is_oblique


def _needs_sliding(situations: Sequence[Situation]) -> str:
    if not any(is_oblique(scene) for scene, _ in situations):
        return "every impact is normal: nothing slides"
    return ""


class VelocityDependentFriction(Mechanism):
    """The friction coefficient depends on the sliding speed."""

    name = "velocity-dependent-friction"
    title = "friction depends on the sliding speed"
    equations = "mu(v) = mu_d + (mu_s - mu_d) exp(-v/v_0), stated mu = mu_d^(1-w) mu_s^w"
    parameters = (
        Parameter(
            "static_over_dynamic", "-", 0.3, 3.0, "log", 1.0,
            "dry metals: 1.2-2 falling; boundary-lubricated rising", nodes=6,
        ),
        Parameter(
            "friction_speed_m_s", "m/s", 0.03, 3.0, "log", 1.0,
            "0.01-1 m/s in collections of friction laws; wider for what an impact can see", nodes=4,
        ),
        Parameter(
            "friction_stated_slow", "-", 0.0, 1.0, "linear", 0.0,
            "0: the stated coefficient is that of fast sliding, 1: of a slow test; sheets rarely "
            "say which", nodes=3,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs sliding."""
        return _needs_sliding(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the friction law."""
        ratio = values["static_over_dynamic"]
        if ratio == 1.0:
            return scene
        fast = scene.friction.mu * ratio ** -values["friction_stated_slow"]
        friction = replace(
            scene.friction, mu=fast, mu_static=ratio * fast, speed=values["friction_speed_m_s"]
        )
        return scene.with_(friction=friction)


class PloughingFriction(Mechanism):
    """The tip pushes metal ahead of it."""

    name = "ploughing-friction"
    title = "the tip ploughs"
    equations = "mu + s (4/(3 pi)) a/R"
    parameters = (
        Parameter(
            "ploughing_scale", "-", 0.3, 5.0, "log", 0.0,
            "1 is the front of a rigid sphere (Bowden and Tabor); pile-up raises it",
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"friction_impulse_ratio": 1, "sliding_length_m": -1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs sliding."""
        return _needs_sliding(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the friction law."""
        total = scene.friction.ploughing + values["ploughing_scale"]
        return scene.with_(friction=replace(scene.friction, ploughing=total))


class TangentialCompliance(Mechanism):
    """The contact gives way sideways before it slides (Mindlin; Maw, Barber and Fawcett)."""

    name = "tangential-compliance"
    title = "the contact gives way sideways before it slides"
    equations = "a spring k_t = s 2 E' a carries the tangential force up to mu F_n, then it slides"
    parameters = (
        Parameter(
            "tangential_stiffness_ratio",
            "-",
            0.3,
            1.5,
            "log",
            math.inf,
            "2 (1 - nu)/(2 - nu) = 0.82 (Mindlin 1949); plastic contacts +-50 %",
            nodes=5,
        ),
    )
    direction: ClassVar[Mapping[str, int]] = {}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs sliding."""
        return _needs_sliding(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the friction law."""
        ratio = values["tangential_stiffness_ratio"]
        if not math.isfinite(ratio) or not is_oblique(scene):
            return scene
        return scene.with_(friction=replace(scene.friction, stiffness=ratio))
