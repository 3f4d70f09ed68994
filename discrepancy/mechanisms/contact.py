"""Mechanisms in the contact's force: damping, adhesion, film, roughness, the shape of the tip."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ...impact import Scene
from ...impact.strength import UNIT, StrengthTable, strength_table
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

_REFERENCE_DEPTH = 1e-5  # [m], at which the damping is stated


class ContactDamping(Mechanism):
    """A viscous part of the contact force."""

    name = "contact-damping"
    title = "the contact loses energy by viscosity"
    equations = "F (1 + chi d'), chi = chi_10 (10 um/d_m)^q at a largest depth d_m"
    parameters = (
        Parameter(
            "damping_s_m", "s/m", 0.003, 0.3, "log", 0.0,
            "Hunt and Crossley 1975 (e = 1 - alpha v, alpha 0.08-0.32 s/m for metals)",
        ),
        Parameter(
            "damping_depth_exponent", "-", 0.0, 1.0, "linear", 0.0,
            "0 for a loss that follows the speed alone (Hunt and Crossley 1975), 1 for a time of "
            "retardation, chi = 3 tau/(2 d) (Kuwabara and Kono, Jpn. J. Appl. Phys. 26, 1230)",
            nodes=3,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1, "permanent_depth_m": -1}

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        added = values["damping_s_m"]
        if added > 0.0 and values["damping_depth_exponent"] > 0.0:
            deepest = strength_table(scene.law, scene.pair).peak(energy(scene))
            added *= (_REFERENCE_DEPTH / deepest) ** values["damping_depth_exponent"]
        return scene.with_(force=replace(scene.force, damping=scene.force.damping + added))


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
            "J. Fluid Mech. 468 (2002) 107)", nodes=17,
        ),
        Parameter(
            "film_exit_share", "-", 0.0, 1.0, "ends", 0.0,
            "0 where the film cavitates as the bodies part, 1 where it does not (Barnocky and "
            "Davis, Phys. Fluids 31 (1988) 1324)", nodes=5,
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


_POWER = 1.25
"""Exponent of a recovery, between Hertz's 3/2 and a flat punch's 1: for the layer's share alone."""


@dataclass(frozen=True, slots=True)
class Layer:
    """A rough layer in series with the bulk, over the depth nodes of a law's table.

    Parameters
    ----------
    force, recovery
        (NODES,) factors on the smooth contact's loading force and elastic recovery.
    dent
        (NODES,) depth that stays over the peak depth less the recovery, which is the energy's.
    """

    force: Array
    recovery: Array
    dent: Array

    @classmethod
    def of(cls, table: StrengthTable, sigma: float, start: float, kept: float) -> Layer:
        """Return the layer that closes by sigma ln(1 + F/F_0).

        Asperities with exponential heights carry F = F_0 (exp(closure/sigma) - 1), and open again
        on the same curve until the part `kept` of the closure is left.

        Parameters
        ----------
        table
            Of the smooth contact.
        sigma
            Mean height of the asperities [m].
        start
            F_0 over the force at which the bulk has moved by sigma.
        kept
            Part of the closure that stays.
        """
        depth, force = table.depth, np.exp(table.log_force[UNIT])
        recovered = np.exp(table.log_recovery[UNIT])
        scale = start * math.exp(np.interp(math.log(sigma), np.log(depth), np.log(force)))
        turns = np.log1p(force / scale)
        freed = scale * np.expm1(kept * turns)
        given = sigma * (force - freed - scale * (1.0 - kept) * turns)
        back = recovered + (1.0 + _POWER) * given / force
        total = depth + sigma * turns

        def at_nodes(value: Array) -> Array:
            return np.asarray(np.interp(np.log(depth), np.log(total), value))

        rough_back = np.minimum(np.exp(at_nodes(np.log(back))), depth)
        stays = np.maximum(at_nodes(depth - recovered + kept * sigma * turns), 0.0)
        rest = np.maximum(depth - rough_back, 1e-3 * depth)
        return cls(
            np.exp(at_nodes(np.log(force))) / force, rough_back / recovered,
            stays / rest,
        )  # fmt: skip


class Roughness(Mechanism):
    """Asperities give way before the bulk does, and do not come back whole."""

    name = "roughness"
    title = "asperities give way before the bulk"
    equations = "depth + sigma ln(1 + F/F_0); the part k of the closure stays"
    parameters = (
        Parameter(
            "roughness_m", "m", 1e-7, 1e-5, "log", 0.0,
            "Greenwood and Williamson 1966; ground 0.4 um, turned 1-5 um", nodes=7,
        ),
        Parameter(
            "asperity_force_ratio", "-", 0.01, 3.0, "log", 1.0,
            "F_0 over the force that dents the bulk by sigma: the part of the area that Gaussian "
            "heights put above three standard deviations (0.001) to one (0.16), each way tenfold",
            nodes=5,
        ),
        Parameter(
            "asperity_flattening", "-", 0.0, 1.0, "linear", 0.0,
            "part of the closure that stays: 0 for elastic asperities, 1 for those that flow "
            "(plasticity index, Greenwood and Williamson 1966)", nodes=3,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"contact_time_s": 1, "peak_force_N": -1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return _needs_yielding_law(situations)

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated roughness narrows the range."""
        stated = situations[0][1].roughness
        sigma, *rest = self.parameters
        if stated > 0.0:
            sigma = replace(sigma, low=0.5 * stated, high=4.0 * stated)
        return (sigma, *rest)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the transform of the normal force."""
        if values["roughness_m"] == 0.0:
            return scene
        layer, now = _layer_of(scene, values), scene.force
        return scene.with_(
            force=replace(
                now, factors=times(now.factors, layer.force),
                recovery_factors=times(now.recovery_factors, layer.recovery),
            )
        )  # fmt: skip

    def after(
        self, situations: Sequence[Situation], values: Values, seen: dict[str, Array]
    ) -> None:
        """Set the depth that stays, of bulk and layer."""
        if values["roughness_m"] == 0.0:
            return
        for i, (scene, _) in enumerate(situations):
            depth = strength_table(scene.law, scene.pair).depth
            seen["permanent_depth_m"][i] *= np.interp(
                math.log(max(seen["peak_depth_m"][i], depth[0])), np.log(depth),
                _layer_of(scene, values).dent,
            )  # fmt: skip


def _layer_of(scene: Scene, values: Values) -> Layer:
    table = strength_table(scene.law, scene.pair)
    return Layer.of(
        table, values["roughness_m"], values["asperity_force_ratio"], values["asperity_flattening"]
    )


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

    law_error: ClassVar[float] = 2.5
    """The law is that of a sphere, pressed deeper by the missing cap; about 5 % of the force."""

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a machined tip and a metal that yields."""
        if all(scene.striker.length == 0.0 for scene, _ in situations):
            return "every striker is a ball, which turns: a flat on it would not meet every impact"
        return _needs_yielding_law(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the tip."""
        b = values["flat_radius_over_R"] * scene.striker.tip_radius
        if b == 0.0 or scene.striker.length == 0.0:
            return scene
        flat = math.hypot(b, scene.striker.tip_flat_radius)
        return scene.with_(striker=replace(scene.striker, tip_flat_radius=flat))
