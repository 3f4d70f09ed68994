"""A bench: what is dropped on what, how well each value is known, what is recorded how well.

`stated` values go into set.toml; the impacts use the true ones, `stated (1 + tolerance z)`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ....core.arrays import Array, Indices
from ...concealed import Metal, Striker
from . import parameters as at
from .base_laws import constants

COLUMNS = {
    "restitution": at.RESTITUTION,
    "permanent_depth_m": at.DEPTH,
    "contact_time_s": at.TIME,
    "peak_force_N": at.PEAK_FORCE,
    "rebound_spin_rad_s": at.REBOUND_SPIN,
    "friction_impulse_ratio": at.IMPULSE_RATIO,
    "sliding_length_m": at.SLIDING,
    "tangential_rebound_m_s": at.TANGENTIAL_REBOUND,
}
"""Columns of trials.csv that a bench may record, and the result that each one shows."""

RATIOS = ("permanent_depth_m", "contact_time_s", "peak_force_N")
"""Columns whose changes are read as ratios: a dent of 5 um and one of 200 um that are both a tenth
too deep are off by the same."""

NUISANCES = ("strength", "modulus", "radius", "mass", "friction", "speed", "angle")
"""What may differ from its stated value; each in units of its stated standard deviation."""


@dataclass(frozen=True)
class Rig:
    """A bench with its list of trials.

    - `bench`: kind of bench.
    - `target`: the flat.
    - `strikers`: all strikers.
    - `which`, `angle`, `speed`, `tangential`, `temperature`: (n,) striker's number, stated angle
      [rad], nominal normal speed [m/s], tangential speed of the centre [m/s], temperature [K].
    - `mu`: stated coefficient of friction.
    - `tolerance`: standard deviation of each nuisance: a fraction, or radians for the angle.
    - `noise`: column to (number, fraction): standard deviation of the instrument.
    - `drop`: whether the sheet states the height instead of the speed.
    - `law`: key `law` of the flat.
    - `told`: further keys of [target] and their numbers.
    - `liquid`: viscosity of a liquid that the sheet states [Pa s], 0 for none.
    - `metal`: place of a parameter to its value: how the metal differs from elastic-perfect
      plasticity.
    - `metal_told`: the same in plain values, for the record.
    """

    bench: str
    target: Metal
    strikers: tuple[Striker, ...]
    which: Indices
    angle: Array
    speed: Array
    tangential: Array
    temperature: Array
    mu: float
    tolerance: dict[str, float]
    noise: dict[str, tuple[float, float]]
    drop: bool = False
    law: str = "elastic-plastic"
    told: dict[str, float] = field(default_factory=dict)
    liquid: float = 0.0
    metal: dict[int, float] = field(default_factory=dict)
    metal_told: dict[str, float | str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.which)

    def rows(self, family: float, z: dict[str, float], *, steps: int = 1200) -> Array:
        """Parameters of every impact, without any mechanism, shape (n, N_PARAMETERS).

        `family`: `CAVITY` or `FOUNDATION`; `z`: nuisances in standard deviations; those left out
        are 0; `steps`: time steps per depth over speed.
        """
        factor = {name: 1.0 + self.tolerance[name] * z.get(name, 0.0) for name in NUISANCES[:-1]}
        p = np.zeros((len(self), at.N_PARAMETERS))
        flat = self.target.E / (1.0 - self.target.nu**2)
        for i, number in enumerate(self.which):
            body = self.strikers[number]
            other = body.metal.E / (1.0 - body.metal.nu**2)
            row = p[i]
            row[at.MASS] = body.mass * factor["mass"]
            row[at.INERTIA] = body.inertia * factor["mass"]
            row[at.LENGTH] = body.length
            row[at.CAVITY_LAW : at.N_PARAMETERS] = constants(self.target, body.metal)
            row[at.TIP] = body.tip_radius * factor["radius"]
            row[at.MODULUS] = factor["modulus"] / (1.0 / flat + 1.0 / other)
            if body.length > 0.0:
                row[at.THETA] = self.angle[i] + self.tolerance["angle"] * z.get("angle", 0.0)
            else:
                row[at.THETA] = 0.5 * math.pi
        p[:, at.NORMAL_SPEED] = self.speed * factor["speed"]
        p[:, at.TANGENTIAL_SPEED] = self.tangential * factor["speed"]
        p[:, at.STRENGTH] = self.target.Sy * factor["strength"]
        p[:, at.POISSON] = self.target.nu
        p[:, at.MU] = self.mu * factor["friction"]
        p[:, at.GRAVITY] = 9.81
        p[:, at.LAW] = family
        p[:, at.STEPS] = steps
        p[:, at.FOLLOW] = 1e-6
        for place, value in self.metal.items():
            p[:, place] = value
        return p
