"""Mechanisms in the contact's force: damping, adhesion, film, roughness, the shape of the tip."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ...core.material import Pair
from ...impact import Scene
from ...impact.strength import StrengthTable
from .base import (
    Array,
    Mechanism,
    Parameter,
    Situation,
    Surroundings,
    Values,
    effective_mass,
    energy,
)


class ContactDamping(Mechanism):
    """A viscous part of the contact force."""

    name = "contact-damping"
    title = "the contact loses energy by viscosity"
    equations = "F (1 + chi d')"
    parameters = (
        Parameter(
            "damping_s_m", "s/m", 0.003, 0.3, "log", 0.0,
            "Hunt and Crossley 1975 (e = 1 - alpha v, alpha 0.08-0.32 s/m for metals)",
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1, "permanent_depth_m": -1}

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        chi = scene.force.damping + values["damping_s_m"]
        return scene.with_(force=replace(scene.force, damping=chi))


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
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1}

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
        self, situations: Sequence[Situation], values: Values, seen: dict[str, Array]
    ) -> None:
        """Take the work of parting from the rebound's energy."""
        lost = np.array(
            [self._work(s, values["work_of_adhesion_J_m2"]) / energy(s) for s, _ in situations]
        )
        slower(seen, np.sqrt(np.maximum(seen["restitution"] ** 2 - lost, 0.0)))

    @staticmethod
    def _work(scene: Scene, W: float) -> float:
        return float(7.09 * (W**5 * scene.pair.R**4 / scene.pair.E_reduced**2) ** (1.0 / 3.0))


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
            "J. Fluid Mech. 468 (2002) 107)",
        ),
        Parameter(
            "film_exit_share", "-", 0.0, 1.0, "linear", 0.0,
            "0 where the film cavitates as the bodies part, 1 where it does not (Barnocky and "
            "Davis, Phys. Fluids 31 (1988) 1324)", nodes=3,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1, "permanent_depth_m": -1}

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
            return f"air takes at most {loss:.1e} of the approach speed; no liquid is stated"
        return ""

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated viscosity leaves ln(h_0/h_1): films of 1-100 um over asperities of 0.1-1 um."""
        eta = situations[0][1].viscosity
        drag, share = self.parameters
        if not eta > 0.0:
            return drag, share
        return replace(drag, low=0.5 * eta, high=8.0 * eta), share

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Slow the approach."""
        lost = _film_loss(scene, values["film_drag_Pa_s"])
        speed = max(scene.approach.speed - lost, 0.05 * scene.approach.speed)
        return scene.with_(approach=replace(scene.approach, speed=speed))

    def after(
        self, situations: Sequence[Situation], values: Values, seen: dict[str, Array]
    ) -> None:
        """Slow the rebound, and refer it to the speed before the film."""
        lost = np.array([_film_loss(s, values["film_drag_Pa_s"]) for s, _ in situations])
        v = np.array([s.approach.speed for s, _ in situations])
        inside = np.maximum(v - lost, 0.05 * v)
        kept = seen["restitution"] * inside - values["film_exit_share"] * lost
        slower(seen, np.maximum(kept, 0.0) / v)


def _film_loss(scene: Scene, drag: float) -> float:
    return 6.0 * math.pi * drag * scene.pair.R**2 / effective_mass(scene)


def slower(seen: dict[str, Array], restitution: Array) -> None:
    """Set the restitution, and with it the rebound speed of the centre of mass."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(seen["restitution"] > 0.0, restitution / seen["restitution"], 1.0)
    seen["rebound_speed_m_s"] = seen["rebound_speed_m_s"] * ratio
    seen["restitution"] = restitution


@dataclass(frozen=True, slots=True)
class Series:
    """A soft layer in series, as a strength-free factor on the force."""

    sigma: float

    def factors(self, table: StrengthTable, pair: Pair) -> Array:
        """Return force of the rough over that of the smooth contact, at the table's depths.

        Asperities with exponential heights carry F = F_0 exp(d_r/sigma) once F_0 is reached; F_0
        is the force at which the bulk has moved by sigma.
        """
        force = np.exp(table.log_force[3])
        start = np.interp(math.log(self.sigma), np.log(table.depth), np.log(force))
        layer = self.sigma * np.log1p(force / math.exp(start))
        total = table.depth + layer
        rough = np.exp(np.interp(np.log(table.depth), np.log(total), np.log(force)))
        return np.asarray(rough / force)


class Roughness(Mechanism):
    """Asperities give way before the bulk does."""

    name = "roughness"
    title = "asperities give way before the bulk"
    equations = "depth + sigma ln(1 + F/F_0), F_0 = F(sigma)"
    parameters = (
        Parameter(
            "roughness_m", "m", 1e-7, 1e-5, "log", 0.0,
            "Greenwood and Williamson 1966; ground 0.4 um, turned 1-5 um",
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"contact_time_s": 1, "peak_force_N": -1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return _needs_yielding_law(situations)

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated roughness narrows the range."""
        stated = situations[0][1].roughness
        (sigma,) = self.parameters
        return (replace(sigma, low=0.5 * stated, high=4.0 * stated),) if stated > 0 else (sigma,)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        from ...impact.strength import strength_table

        sigma = values["roughness_m"]
        if sigma == 0.0:
            return scene
        factors = Series(sigma).factors(strength_table(scene.law, scene.pair), scene.pair)
        return scene.with_(force=replace(scene.force, factors=times(scene.force.factors, factors)))


def _needs_yielding_law(situations: Sequence[Situation]) -> str:
    if all(scene.law.name == "hertz" for scene, _ in situations):
        # its recovery is Hertz's own, so another loading curve would lose energy
        return "the bodies do not yield: the surface's shape takes no energy, and is not simulated"
    return ""


def times(present: tuple[float, ...], factors: Array) -> tuple[float, ...]:
    """Multiply two tables over the depth nodes; an empty one is neutral."""
    if not present:
        return tuple(float(x) for x in factors)
    grid = np.linspace(0.0, 1.0, len(factors))
    old = np.interp(grid, np.linspace(0.0, 1.0, len(present)), present)
    return tuple(float(x) for x in old * factors)


class TruncatedTip(Mechanism):
    """A flat, worn or cut, ends the tip's curvature."""

    name = "truncated-tip"
    title = "the tip is flat at its end"
    equations = "a (a^2 - b^2)^(1/2) = R d elastically; the law at d + b^2/(2R) once it yields"
    parameters = (
        Parameter(
            "flat_radius_over_R", "-", 0.003, 0.12, "log", 0.0,
            "0.05-1 mm on tips of 9 mm: handling wear to a turned-off centre",
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {
        "contact_time_s": -1,
        "permanent_depth_m": -1,
        "peak_force_N": 1,
    }

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return _needs_yielding_law(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the tip."""
        b = values["flat_radius_over_R"] * scene.striker.tip_radius
        if b == 0.0:
            return scene
        flat = math.hypot(b, scene.striker.tip_flat_radius)
        return scene.with_(striker=replace(scene.striker, tip_flat_radius=flat))
