"""Air, or the liquid that is stated, brakes the striker before the contact and after it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...core.arrays import Array
from ...core.drag import DRAG_COEFFICIENT_STD, Fluid, air
from ..drag import flown
from ..rules import RULES
from ..scene import Scene, Striker
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values

# limit: fall below which none is followed [m]
_SHORTEST = 1e-9
_GASES = ("", "air", "none", "dry", "nitrogen")


class AirDrag(Mechanism):
    """Drag between contact and reading, which was taken for a flight under gravity alone.

    A speed that follows from a height of fall is too high; a speed read above the flat and carried
    to it by gravity is too high before the contact and too low after it.
    """

    name = "air-drag"
    title = "air, or the liquid around, brakes the striker between reading and contact"
    equations = (
        "(m + m_a) v' = -(m - rho V) g - k C_D(Re) A rho v |v|/2 from release, or from a distance "
        "s above the flat, to the contact and back over s"
    )
    parameters = (
        Parameter(
            "drag", "-", 0.8, 1.25, "log", 0.0,
            f"times the standard curve (Clift, Grace and Weber 1978), which is good to "
            f"{DRAG_COEFFICIENT_STD:.0%}; seams, spin and a stirred room do the rest", nodes=3,
            literature=Literature(1.0, "Clift, Grace and Weber, Bubbles, Drops, and Particles"),
        ),
        Parameter(
            "reading_m", "m", 1e-3, 1.0, "log", 0.0,
            "where speeds were read: light gates and scans close to the flat, parabolas of whole "
            "bounces far from it", nodes=5,
        ),
    )  # fmt: skip
    direction = {"restitution": -1, "permanent_depth_m": -1}
    form = 0.05
    in_flight = True
    reads = tuple(
        f"environment.{name}"
        for name in ("fluid", "viscosity_Pa_s", "density_kg_m3", "pressure_Pa", "temperature_K")
    )

    def certain(self, around: Surroundings) -> bool:
        """A ball that falls from a stated height is braked on its way."""
        return around.from_height

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs what `idle` does, and speeds that a flight under gravity can have given."""
        reason = self.idle(situations)
        if not reason and (largest := self._largest(situations)) > RULES.stopped:
            what = situations[0][1].fluid.strip() or "air"
            reason = f"{what} takes {largest:.0%} of a speed: no flight under gravity was read"
        return reason

    def idle(self, situations: Sequence[Situation]) -> str:
        """Needs a light or a fast striker in air, or a liquid of stated density and viscosity."""
        around = situations[0][1]
        if around.struck is not None and around.struck.free:
            return "the struck sphere is free: what brakes its flight is not simulated"
        liquid = around.fluid.strip().lower() not in _GASES
        if liquid and not (around.density > 0.0 and around.viscosity > 0.0):
            return (
                f"the fluid is stated as {around.fluid.strip()}, without both density_kg_m3 and "
                "viscosity_Pa_s"
            )
        if 0.0 in (around.pressure, around.density, around.viscosity):
            return "there is no air, as stated"
        if around.from_height and not all(
            _arriving(s, self.published(around), around) > 0.0 for s, _ in situations
        ):
            return f"{around.fluid.strip()} bears the striker: it does not fall"
        if (largest := self._largest(situations)) < RULES.visible:
            what = around.fluid.strip() if liquid else "air"
            return f"{what} takes at most {largest:.1e} of a speed"
        return ""

    def _largest(self, situations: Sequence[Situation]) -> float:
        """Largest part of a speed that it may take, before the contact or after it."""
        most = {p.name: p.high for p in self.parameters}
        seen = {"restitution": np.ones(len(situations)), "rebound_speed_m_s": np.ones(1)}
        taken = float(np.max(1.0 - self.after(situations, most, seen)["restitution"]))
        return max(taken, *(1.0 - _arriving(s, most, a) / s.approach.speed for s, a in situations))

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Slow the approach."""
        if values["drag"] == 0.0:
            return scene
        old, speed = scene.approach, _arriving(scene, values, around)
        along = old.tangential * (speed / old.speed if _leans(scene, around) else 1.0)
        return scene.with_(approach=replace(old, speed=speed, tangential=along))

    def after(
        self, situations: Sequence[Situation], values: Values, seen: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        """Refer the rebound, as it was read, to the approach as it was stated."""
        if values["drag"] == 0.0:
            return seen
        read, left = np.empty(len(situations)), np.empty(len(situations))
        for i, (scene, around) in enumerate(situations):
            left[i] = seen["restitution"][i] * _arriving(scene, values, around)
            read[i] = _read_after(scene, left[i], values, around)
        stated = np.array([scene.approach.speed for scene, _ in situations])
        kept = np.divide(read, left, out=np.ones_like(left), where=left > 0.0)
        return {
            **seen,
            "restitution": np.where(left > 0.0, read / stated, seen["restitution"]),
            "rebound_speed_m_s": seen["rebound_speed_m_s"] * kept,
        }


def _fluid(values: Values, around: Surroundings) -> Fluid:
    """Fluid around, its drag `drag` times the standard one: Reynolds number kept, density scaled.

    What is not stated is air's.
    """
    still = air(around.ambient, *([around.pressure] if around.pressure > 0.0 else []))
    density = around.density if around.density > 0.0 else still.density
    viscosity = around.viscosity if around.viscosity > 0.0 else still.viscosity
    return Fluid(values["drag"] * density, values["drag"] * viscosity)


def _leans(scene: Scene, around: Surroundings) -> bool:
    """Whether a ball falls from a height on a flat that leans: braked along its path."""
    return around.from_height and scene.striker.length == 0.0 and scene.approach.tangential != 0.0


def _arriving(scene: Scene, values: Values, around: Surroundings) -> float:
    """Normal speed at the flat of a striker whose stated speed is gravity's alone [m/s]."""
    a, g, leans = scene.approach, scene.gravity, _leans(scene, around)
    stated = math.hypot(a.speed, a.tangential) if leans else a.speed
    whole = stated**2 / (2.0 * g) if g > 0.0 else math.inf
    fall = whole if around.from_height else min(values["reading_m"], whole)
    start = math.sqrt(max(stated**2 - 2.0 * g * fall, 0.0))
    fluid, along = _fluid(values, around), 0.0 if leans else a.tangential
    arrived = _fallen(scene.striker, fluid, start, fall, along, a.angle, g)
    # one that the fluid stops keeps a twentieth, so that there is an impact
    kept = float(np.fmax(arrived, 0.0 if around.from_height else 0.05 * stated))
    return kept * (a.speed / stated) if leans else kept


# every fall is asked for before the motion and after it
@lru_cache(maxsize=8192)
def _fallen(
    striker: Striker, fluid: Fluid, start: float, fall: float, tangential: float, angle: float,
    gravity: float,
) -> float:  # fmt: skip
    """Normal speed after a fall that begins with `start` [m/s]; nan where the fluid stops it.

    A step longer than the way to the terminal speed has no answer: that speed is reached before.
    """
    arrived = flown(
        striker, fluid, normal=-start, rise=-fall, tangential=tangential, angle=angle,
        gravity=gravity,
    )  # fmt: skip
    if start == 0.0 and fall > _SHORTEST and not math.isfinite(arrived.normal):
        return _fallen(striker, fluid, start, 0.5 * fall, tangential, angle, gravity)
    return float(-arrived.normal)


def _read_after(scene: Scene, left: float, values: Values, around: Surroundings) -> float:
    """Rebound speed that a reading above the flat, carried back by gravity, gives [m/s]."""
    g = scene.gravity
    # a flight is read while it rises: to half the height that it would reach
    peak = left**2 / (2.0 * g) if g > 0.0 else math.inf
    rise = min(values["reading_m"], 0.5 * peak)
    if not rise > 0.0:
        return left
    seen = flown(
        scene.striker, _fluid(values, around), normal=left, rise=rise,
        angle=scene.approach.angle, gravity=g,
    )  # fmt: skip
    there = float(seen.normal)
    return math.sqrt(there**2 + 2.0 * g * rise) if math.isfinite(there) else 0.0
