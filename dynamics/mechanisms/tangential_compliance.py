"""The contact gives way sideways before it slides."""

from __future__ import annotations

import math
from dataclasses import replace

from ..scene import Scene
from .arithmetic import is_oblique
from .base import Parameter, Surroundings, Values
from .friction import SlidingMechanism


class TangentialCompliance(SlidingMechanism):
    """The contact gives way sideways before it slides (Mindlin; Maw, Barber and Fawcett)."""

    name = "tangential-compliance"
    title = "the contact gives way sideways before it slides"
    equations = (
        "a spring 0.77 s 2 E' a (slip from the edge in) carries up to mu F_n, then it slides"
    )
    parameters = (
        Parameter(
            "tangential_stiffness_ratio", "-", 0.3, 1.5, "log", math.inf,
            "2 (1 - nu)/(2 - nu) = 0.82 (Mindlin 1949); plastic contacts +-50 %", nodes=5,
        ),
    )  # fmt: skip
    # of the radius a: at one depth a^2/(2 R delta) falls from 1.43 without hardening to 1.15 at an
    # exponent of 0.2 (Biwa and Storakers, J. Mech. Phys. Solids 43 (1995) 1303): 10 % in a
    scale_error = 0.05
    rests_on = ("target", "striker")
    aslant = True

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the friction law."""
        ratio = values["tangential_stiffness_ratio"]
        if not is_oblique(scene):
            return scene
        return scene.with_(friction=replace(scene.friction, stiffness=ratio))
