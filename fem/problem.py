"""What is to be solved and how finely: the contact problem and the accuracy settings."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

import numpy as np

from ..core.errors import InputError
from ..core.material import Pair
from ..core.rules import RULES

NUMERICS_VERSION = 5
"""Raised only when results change; stored with every case."""


@dataclass(frozen=True)
class Accuracy:
    """Numerical settings; every number here influences results.

    - `level`: name of the settings, for tables.
    - `divisions`: elements over the quarter arc.
    - `coarse`, `fine`: ring width over radius away from the plastic contact edge and along its
      path.
    - `step_ratio`, `elastic_step_ratio`: largest ratio of successive approaches after and before
      first yield.
    - `penalty`: contact stiffness in E' over the edge length.
    - `crowding`: angle of the elements at the axis over that of those at the surface.
    - `flat_radius`: radius of the meshed half-space [R]; the truncation error of the force is 0.55
      a/L.
    """

    level: str
    divisions: int
    coarse: float
    fine: float
    step_ratio: float
    elastic_step_ratio: float = 1.3
    penalty: float = 10.0
    crowding: float = 1.5
    flat_radius: float = 200.0

    @classmethod
    def production(cls) -> Accuracy:
        """Settings of published results."""
        return cls(
            level="production", divisions=16, coarse=0.1, fine=0.025, step_ratio=1.035,
            elastic_step_ratio=1.06, penalty=20.0,
        )  # fmt: skip

    @classmethod
    def quick(cls) -> Accuracy:
        """About three times faster than production, with twice its element size."""
        return cls.production().with_(level="quick", fine=0.05, step_ratio=1.04)

    @classmethod
    def smoke(cls) -> Accuracy:
        """For a first look: ripple of F about 2 %."""
        return cls(level="smoke", divisions=12, coarse=0.13, fine=0.1, step_ratio=1.05)

    def with_(self, **changes: Any) -> Accuracy:
        """Return a copy with some settings replaced."""
        return replace(self, **changes)

    def as_dict(self) -> dict[str, Any]:
        """Return the settings as a plain dictionary."""
        return asdict(self)


@dataclass(frozen=True)
class Clock:
    """Time that an approach takes, from its speed by depth.

    `speeds`: rows of Delta/R and speed [m/s], the depths increasing; linear between them, constant
    beyond. Empty: so slow that no rate counts. `R`: radius [m].
    """

    speeds: tuple[tuple[float, float], ...]
    R: float

    def seconds(self, start: float, end: float) -> float:
        """Time between two Delta/R, up or down [s]; infinite without a speed."""
        if not self.speeds:
            return math.inf
        depth, speed = np.array(self.speeds).T
        low, high = sorted((start, end))
        inner = depth[(depth > low) & (depth < high)]
        ends = np.concatenate([[low], inner, [high]])
        v = np.interp(ends, depth, speed)
        # between two rows dt = d Delta/v, v linear: the logarithmic mean of the speeds
        ratio = v[1:] / v[:-1]
        mean = np.where(
            np.abs(ratio - 1.0) < 1e-6,
            0.5 * (v[1:] + v[:-1]),
            (v[1:] - v[:-1]) / np.log(np.where(ratio == 1.0, 2.0, ratio)),
        )
        return float((np.diff(ends) / mean).sum() * self.R)


@dataclass(frozen=True)
class ContactProblem:
    """A sphere pressed into a flat, and at which depths to look.

    The top face of the hemisphere moves down by Delta; yield is a true (Cauchy) stress.

    - `pair`: the two bodies and the radius.
    - `depths`: increasing Delta/R at which results are recorded.
    - `unload_from`: Delta/R from which the contact is also unloaded to zero force.
    - `reload`: also load again after each unloading, up to where it began.
    - `radius_at_least`: go on past the last depth until the contact radius a/R reaches this (0:
      stop there).
    - `snapshots`: Delta/R at which the full fields are kept.
    - `profiles`: Delta/R at which contact pressure and surface profiles are kept.
    - `top`: whether the driven face is `free` to move radially or `held`.
    - `speeds`: speed of the approach by depth, as in `Clock`; only a flow stress that feels the
      rate needs it.
    - `friction`: Coulomb's coefficient between sphere and flat, 0 to 20; where it is large nothing
      slides.

    Raises `InputError`: depths that are not increasing or out of range.
    """

    pair: Pair
    depths: tuple[float, ...]
    unload_from: tuple[float, ...] = ()
    radius_at_least: float = 0.0
    snapshots: tuple[float, ...] = ()
    profiles: tuple[float, ...] = ()
    reload: bool = False
    top: Literal["free", "held"] = "free"
    speeds: tuple[tuple[float, float], ...] = ()
    friction: float = 0.0

    @property
    def clock(self) -> Clock:
        """Time that the approach takes."""
        return Clock(self.speeds, self.pair.R)

    def __post_init__(self) -> None:
        self._check_speeds()
        if not self.depths:
            raise InputError("no depth given", key="depths", allowed="at least one Delta/R")
        previous, allowed = 0.0, f"Delta/R in (0, {RULES.deepest:g}]"
        for depth in self.depths:
            if not previous < depth <= RULES.deepest:
                raise InputError(f"{depth:g}", key="depths", allowed=f"increasing {allowed}")
            previous = depth
        for name in ("unload_from", "snapshots", "profiles"):
            for depth in getattr(self, name):
                if not 0.0 < depth <= RULES.deepest:
                    raise InputError(f"{depth:g}", key=name, allowed=allowed)
        for name, most in (("radius_at_least", 0.8), ("friction", 20.0)):
            if not 0.0 <= (value := getattr(self, name)) <= most:
                raise InputError(f"{value:g}", key=name, allowed=f"0 to {most:g}")

    def _check_speeds(self) -> None:
        hurried = [body.flow and body.flow.rate for body in (self.pair.sphere, self.pair.flat)]
        if any(hurried) and not self.speeds:
            raise InputError(
                "missing", key="speed_m_s", allowed="a speed [m/s] where a body has a rate law"
            )
        previous = -math.inf
        for depth, speed in self.speeds:
            if not (depth > previous and 0.0 < speed < math.inf):
                raise InputError(
                    f"[{depth:g}, {speed:g}]",
                    key="speed_m_s",
                    allowed="a speed above 0, or rows [Delta/R, speed] of increasing Delta/R",
                )
            previous = depth


def geometric_depths(first: float, last: float, n: int) -> tuple[float, ...]:
    """`n` depths in constant ratio from `first` to `last`, both included."""
    if n < 2 or not 0.0 < first < last:
        raise InputError(f"{n} depths from {first:g} to {last:g}", key="depths", allowed="n >= 2")
    ratio = (last / first) ** (1.0 / (n - 1))
    return (*(first * ratio**k for k in range(n - 1)), last)
