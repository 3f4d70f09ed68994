"""The flat moves on its support."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ..rules import RULES
from ..scene import Scene, Support
from .arithmetic import density_of, shortest_contact, wave_speed
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


class SupportCompliance(Mechanism):
    """The flat moves on its support."""

    name = "support-compliance"
    title = "the flat moves on its support"
    equations = "M w'' + c w' + k w = F"
    parameters = (
        Parameter(
            "support_stiffness_N_m", "N/m", 1e6, 1e10, "log", math.inf,
            "blocks on foam or clamped to a bench; frames 1e8-1e10 N/m", nodes=9,
            literature=Literature(4e8, "a clamped plate of 30 mm and 10 kg at 1 kHz"),
        ),
        Parameter(
            "support_mass_kg", "kg", 0.1, 100.0, "log", math.inf,
            "from the flat alone to the bench with it", nodes=5,
            literature=Literature(10.0, "a clamped plate of 30 mm and 10 kg at 1 kHz"),
        ),
        Parameter(
            "support_damping_ratio", "-", 0.005, 0.5, "log", 0.0,
            "bare metal 0.01, bolted joints 0.02-0.07 (Newmark and Hall, Earthquake Spectra and "
            "Design, 1982), soil, rubber and foam 0.05-0.5", nodes=4,
            literature=Literature(0.03, "a bolted frame"),
        ),
    )  # fmt: skip
    direction = {"restitution": -1, "permanent_depth_m": -1}
    rests_on = ("target", "striker")

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a support."""
        struck = situations[0][1].struck
        if struck is not None and struck.free:
            return "the struck sphere is free: nothing holds it"
        return ""

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Stated values narrow the ranges; strikers, thickness and the pulse bound the mass.

        What moves with a flat of thickness h is at least as wide as thick: rho h^3. A flat of which
        no thickness is stated is at least what a wave reaches and comes back from, or a block. A
        held sphere moves at least itself.
        """
        around = situations[0][1]
        k, m, loss = self.parameters
        heaviest = max(scene.striker.mass for scene, _ in situations)
        low, high = 2.0 * heaviest, 300.0 * heaviest
        flat = situations[0][0].pair.flat
        if around.struck is not None:
            ball = 4.0 / 3.0 * math.pi * max(around.struck.radius, 0.0) ** 3
            low = max(low, density_of(flat) * ball)
        elif around.thickness > 0.0:
            low = max(low, density_of(flat) * around.thickness**3)
        elif not flat.rigid:
            reach = 0.5 * wave_speed(flat) * max(shortest_contact(scene) for scene, _ in situations)
            low = max(low, min(density_of(flat) * reach**3, RULES.block_mass))
        m = replace(m, low=low, high=max(high, RULES.support_span * low))
        stated = around.support_stiffness, around.support_mass
        if stated[0] > 0.0:
            k = replace(k, low=stated[0] / 2.0, high=stated[0] * 2.0, source="stated", nodes=3)
        if stated[1] > 0.0:
            m = replace(m, low=stated[1] / 1.5, high=stated[1] * 1.5, source="stated", nodes=3)
        return k, m, loss

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid base."""
        mass = values["support_mass_kg"]
        k = values["support_stiffness_N_m"]
        damping = 2.0 * values["support_damping_ratio"] * math.sqrt(k * mass)
        return scene.with_(
            # what moves as a block is no endless plate
            support=Support(mass, k, damping)
        )
