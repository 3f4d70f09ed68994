"""Mechanisms that a simulation takes in: forward, with numbers that are stated."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.observables import OBSERVABLES
from ..result import Impact
from ..scene import Scene
from ..stepping.layout import OBSERVABLES as NUMBERS
from .base import Constants, Mechanism, Situation, Surroundings, attached, observed

SIMULATED = {
    **{name: row.simulated for name, row in OBSERVABLES.items() if row.simulated},
    "residual_sphere_m": "residual_sphere_m",
}
"""Column of trials.csv, or what the striker keeps, to number of the impact."""


@dataclass(frozen=True)
class Asked:
    """Mechanisms with their numbers; without any, an impact is the baseline's.

    `mechanisms`, `constants`: in the order of the library, and all their parameters; `around`: what
    they may know of the rig besides the scene; `highest`, `lightest`: square of the speed that the
    largest height of the file gives [m^2/s^2], and the least mass in it [kg].
    """

    mechanisms: tuple[Mechanism, ...] = ()
    constants: Constants = field(default_factory=dict)
    around: Surroundings = field(default_factory=Surroundings)
    highest: float = 0.0
    lightest: float = math.inf

    def __bool__(self) -> bool:
        return bool(self.mechanisms)

    def situations(self, plain: Sequence[Scene]) -> list[Situation]:
        """Return these impacts with what is around each, by its height and mass over the set's."""
        if not self.around.from_height:
            return [(scene, self.around) for scene in plain]
        fallen = [_head(scene) for scene in plain]
        most = max(self.highest, *fallen)
        least = min(self.lightest, *(scene.striker.mass for scene in plain))
        return [
            (s, replace(self.around, height_share=one / most, mass_share=least / s.striker.mass))
            for s, one in zip(plain, fallen, strict=True)
        ]

    def idle(self, plain: Sequence[Scene]) -> dict[str, str]:
        """Return why, by name, for those that would change nothing of these impacts."""
        here = self.situations(plain)
        found = {m.name: m.idle(here) for m in self.mechanisms}
        return {name: reason for name, reason in found.items() if reason}

    def without(self, *names: str) -> Asked:
        """Return the others."""
        return replace(self, mechanisms=tuple(m for m in self.mechanisms if m.name not in names))

    def attached(self, plain: Sequence[Scene]) -> list[Scene]:
        """Return the scenes with them."""
        return [
            attached(self.mechanisms, scene, self.constants, around)
            for scene, around in self.situations(plain)
        ]

    def observed(self, plain: Sequence[Scene], seen: Mapping[str, Array]) -> Mapping[str, Array]:
        """Return observables of impacts, arrays by column, as they are read with them."""
        return observed(self.mechanisms, self.situations(plain), self.constants, seen)

    def read(self, plain: Scene, found: Impact) -> Impact:
        """Return an impact of the scene with them as it is read."""
        if not found.outcome.completed:
            return found
        seen = {k: np.array([getattr(found, name)]) for k, name in SIMULATED.items()}
        after = self.observed([plain], seen)
        changed: dict[str, Any] = {
            SIMULATED[k]: float(after[k][0]) for k in SIMULATED if after[k] is not seen[k]
        }
        if changed.get("peak_depth_m", found.peak_depth_m) == 0.0:
            changed |= {**unstruck(self.attached([plain])[0]), "contacts": 0, "spot": plain.spot}
        return replace(found, **changed)


NONE_ASKED = Asked()


def unstruck(scene: Scene) -> dict[str, float]:
    """Return the observables of a striker that a film has stopped: there was no blow.

    Nothing has acted along the flat; `scene` is the one with its mechanisms.
    """
    kept, a, striker = ("kinetic_before_J", "gravity_work_J"), scene.approach, scene.striker
    return {
        **dict.fromkeys((name for name in NUMBERS if name not in kept), 0.0),
        "tangential_rebound_m_s": a.tangential, "rebound_spin_rad_s": a.spin,
        "kinetic_after_J": 0.5 * (striker.mass * a.tangential**2 + striker.inertia * a.spin**2),
    }  # fmt: skip


def _head(scene: Scene) -> float:
    """Square of the speed that a fall gives: a rod's along the flat is not the fall's."""
    along = 0.0 if scene.striker.length > 0.0 else scene.approach.tangential
    return scene.approach.speed**2 + along**2
