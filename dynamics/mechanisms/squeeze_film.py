"""A fluid film cushions the touch."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...core.arrays import Array
from ..scene import Scene
from .arithmetic import effective_mass, slower
from .base import Mechanism, Parameter, Situation, Surroundings, Values

_CRITICAL_STOKES = 10.0
"""m v/(6 pi eta R^2) at which immersed spheres begin to rebound [-] (Joseph, Zenit, Hunt and
Rosenwinkel, J. Fluid Mech. 433 (2001) 329; Gondret, Lance, Petit, Phys. Fluids 14 (2002) 643)."""


class SqueezeFilm(Mechanism):
    """A fluid film is squeezed out before the bodies touch, and resists their parting."""

    name = "squeeze-film"
    title = "a fluid film cushions the touch"
    equations = (
        "F = 6 pi eta R^2 v/h, so that v falls by (6 pi eta R^2/m) ln(h_0/h_1) before the touch "
        "and by x times that after it"
    )
    parameters = (
        Parameter(
            "film_drag_Pa_s", "Pa s", 1e-3, 10.0, "log", 0.0,
            "viscosity times ln(h_0/h_1): water 1e-3, oils 0.01-1 Pa s (Davis, Rager and Good, "
            "J. Fluid Mech. 468 (2002) 107)", nodes=17,
        ),
        Parameter(
            "film_exit_share", "-", 0.0, 1.0, "half-low", 0.0,
            "0 where the film cavitates as the bodies part, the rule for a liquid that bears no "
            "tension, so half of the prior; 1 where it does not (Barnocky and Davis, Phys. Fluids "
            "31 (1988) 1324)", nodes=7,
        ),
    )  # fmt: skip
    direction = {"restitution": -1, "permanent_depth_m": -1}
    mutual = True
    reads = ("environment.fluid", "environment.viscosity_Pa_s")

    def applies(self, situations: Sequence[Situation]) -> str:
        """Air and vacuum are too thin."""
        around = situations[0][1]
        eta = around.viscosity
        dry = around.fluid.strip().lower() in ("air", "vacuum", "none", "dry", "nitrogen")
        if not eta > 0.0:
            if around.fluid.strip() and not dry:
                return ""
            eta = 1.85e-5  # air; a liquid would have been stated
        if eta < 1e-4:
            loss = max(_film_loss(s, 8.0 * eta) / s.approach.speed for s, _ in situations)
            return (
                f"air takes at most {loss:.1e} of the approach speed; environment.viscosity_Pa_s "
                "states no liquid"
            )
        return ""

    def usual(self, around: Surroundings, *, sized: bool = False) -> Values:
        """Of a stated viscosity what stops an immersed sphere at the Stokes number that is seen.

        That liquid is all around: it holds the parting bodies back as it held the meeting ones.
        """
        eta = around.viscosity
        if sized or not eta > 0.0:
            return {}
        return {"film_drag_Pa_s": _CRITICAL_STOKES * eta, "film_exit_share": 1.0}

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated viscosity leaves ln(h_0/h_1): films of 1-100 um over asperities of 0.1-1 um.

        Flat in that logarithm: neither thickness has a scale of its own.
        """
        eta = situations[0][1].viscosity
        drag, share = self.parameters
        if not eta > 0.0:
            return drag, share
        return replace(drag, low=0.7 * eta, high=7.0 * eta, scale="linear"), share

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Slow the approach; one that the film stops keeps a twentieth, so that there is a blow."""
        stated = scene.approach.speed
        left = stated - _film_loss(scene, values["film_drag_Pa_s"])
        return scene.with_(approach=replace(scene.approach, speed=max(left, 0.05 * stated)))

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Slow the rebound, and refer it to the speed before the film.

        Below the critical Stokes number m v/(6 pi eta R^2) = ln(h_0/h_1) the bodies do not touch:
        nothing comes back and nothing is marked.
        """
        lost = np.array([_film_loss(s, values["film_drag_Pa_s"]) for s, _ in situations])
        v = np.array([s.approach.speed for s, _ in situations])
        inside = np.maximum(v - lost, 0.0)
        kept = seen["restitution"] * inside - values["film_exit_share"] * lost
        found = slower(seen, np.maximum(kept, 0.0) / v, np.maximum(inside / v, 0.05))
        return {k: np.where(inside > 0.0, x, 0.0) for k, x in found.items()}


def _film_loss(scene: Scene, drag: float) -> float:
    return 6.0 * math.pi * drag * scene.pair.R**2 / effective_mass(scene)
