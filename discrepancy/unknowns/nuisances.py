"""Nuisances: stated or assumed numbers that are not exactly known, with their priors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.observables import LOAD
from ...core.rig import BodyTable, Quantity
from ...recordings import RecordingSet
from ...recordings.checks.press import LOAD_CLASS
from ..comparison.conditions import Condition
from ..rules import RULES

GAUGE = "gauge."
"""Begins the name of a scale that all readings of an observable share."""
LOAD_SCALE = GAUGE + LOAD
RIM_SCALE = "dent.rim"


@dataclass(frozen=True, slots=True)
class Nuisance:
    """A stated number that is not exactly known.

    - `name`, `unit`: key of set.toml, with its table.
    - `value`: as stated (or assumed where `stated` is false).
    - `spread`: standard deviation: of the logarithm if `log`, else of the number.
    - `log`: whether the logarithm is normal.
    - `stated`: whether the set gives it.
    - `note`: what was assumed in its place, for the reader of a verdict.
    """

    name: str
    unit: str
    value: float
    spread: float
    log: bool = True
    stated: bool = True
    note: str = ""

    def at(self, z: float) -> float:
        """Return the value that lies z standard deviations off."""
        return self.value * math.exp(self.spread * z) if self.log else self.value + self.spread * z


def nuisances_of(recordings: RecordingSet, conditions: Sequence[Condition]) -> tuple[Nuisance, ...]:
    """Return the uncertain numbers of a set, stated and assumed."""
    setup = recordings.setup
    found: list[Nuisance] = []
    found += _of_body(setup.target, "target", setup.target.yields)
    found += _stated(setup.target.radius_m, "target.radius_m", "m")
    found += _stated(setup.target.mass_kg, "target.mass_kg", "kg")
    used = sorted({c.striker for c in conditions})
    for name in used:
        table = setup.strikers[name]
        key = f"strikers.{name}"
        found += _of_body(table, key, False)
        found += _stated(table.tip_radius_m, f"{key}.tip_radius_m", "m")
        # the radius moves the mass of a sphere that was not weighed; its density is left
        mass = table.mass_kg.value
        own = table.mass_kg if table.weighed else table.density_kg_m3
        if own is not None and own.std > 0.0:
            found.append(Nuisance(f"{key}.mass_kg", "kg", mass, own.relative))
    if any(c.press is None for c in conditions):
        measured = not any(c.around.from_height for c in conditions)
        spread = RULES.speed_measured if measured else RULES.speed_from_height
        found.append(Nuisance("speed.scale", "-", 1.0, spread, stated=False))
    found += _gauges(recordings, any(c.press is not None for c in conditions))
    leaning = [c for c in conditions if c.angle < math.pi / 2.0 - 1e-6]
    oblique = leaning or [c for c in conditions if c.tangential != 0.0 or c.spin != 0.0]
    if leaning:
        found.append(
            Nuisance("angle.offset", "rad", 0.0, math.radians(0.5), log=False, stated=False)
        )
    if oblique:
        mu = setup.friction.coefficient
        if mu is None:
            note = "friction.coefficient is not stated: 0.15 within a factor of 2 is assumed"
            found.append(Nuisance("friction.coefficient", "-", 0.15, 0.7, stated=False, note=note))
        else:
            spread = max(mu.std / mu.value if mu.value else 0.0, 0.03)
            found.append(Nuisance("friction.coefficient", "-", mu.value, spread))
    if setup.target.law == "measured-restitution":
        e = recordings.values("restitution") if "restitution" in recordings.observed else None
        start = 0.8 if e is None else float(np.nanmedian(e))
        found.append(Nuisance("target.restitution", "-", start, 0.5, stated=False))
    return tuple(found)


def _gauges(recordings: RecordingSet, pressed: bool) -> list[Nuisance]:
    """Scales that all readings of a column share."""
    gauge = recordings.setup.gauge
    found = [
        Nuisance(GAUGE + name, "-", 1.0, gauge[name])
        for name in recordings.observed
        if name in gauge
    ]
    if pressed:
        spread = gauge.get(LOAD, LOAD_CLASS)
        found.append(Nuisance(LOAD_SCALE, "-", 1.0, spread, stated=LOAD in gauge))
    if "dent_diameter_m" in recordings.observed and recordings.setup.dent_edge == "rim":
        note = (
            f"dents are measured at their rim: {RULES.rim:g} times the contact's diameter, within "
            f"{100.0 * RULES.rim_spread:.0f} %, is assumed"
        )
        found.append(Nuisance(RIM_SCALE, "-", RULES.rim, RULES.rim_spread, stated=False, note=note))
    return found


def _of_body(table: BodyTable, key: str, yields: bool) -> list[Nuisance]:
    found = _stated(table.E_Pa, f"{key}.E_Pa", "Pa")
    if table.E_Pa is None:
        E = RULES.assumed_modulus
        note = f"{key}.E_Pa is not stated: {E / 1e9:.0f} GPa within 40 % is assumed"
        found.append(Nuisance(f"{key}.E_Pa", "Pa", E, 0.4, stated=False, note=note))
    found += _stated(table.Sy_Pa, f"{key}.Sy_Pa", "Pa")
    strength = table.strength
    if table.Sy_Pa is None and strength is not None:
        Sy, off = strength.value, strength.relative
        note = (
            f"{key}.Sy_Pa is taken from the hardness: {Sy / 1e6:.0f} MPa within {100.0 * off:.0f} %"
        )
        found.append(Nuisance(f"{key}.Sy_Pa", "Pa", Sy, off, stated=False, note=note))
    elif strength is None and yields:
        note = f"{key}.Sy_Pa is not stated: 350 MPa within a factor of 2 is assumed"
        found.append(Nuisance(f"{key}.Sy_Pa", "Pa", 3.5e8, 0.7, stated=False, note=note))
    return found


def _stated(quantity: Quantity | None, name: str, unit: str) -> list[Nuisance]:
    if quantity is None or not quantity.std > 0.0:
        return []
    return [Nuisance(name, unit, quantity.value, quantity.std / abs(quantity.value))]
