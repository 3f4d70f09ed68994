"""One normal collision by the damped contact laws of other programs, for unit mass and stiffness.

* Hertz with Tsuji's damping, F = k d^(3/2) + c (m k)^(1/2) d^(1/4) d': LAMMPS, LIGGGHTS, YADE;
* spring and dashpot that do not pull, F = max(k d + c (m k)^(1/2) d', 0): MuJoCo with `solref`
  below 0, Chrono's Hooke, Newton;
* Hunt and Crossley's on a straight spring, F = k d max(1 + chi d', 0): Drake's point contact.

Y. Tsuji, T. Tanaka, T. Ishida, Powder Technol. 71 (1992) 239.
T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465: the dashpot's contact ends where it would
pull.
K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ...core.errors import InputError


class ExportedBlow(NamedTuple):
    """A normal impact."""

    speed: float  # [m/s]
    depth: float  # largest approach [m]
    force: float  # largest force [N]
    time: float  # in contact [s]
    restitution: float


class Damped(NamedTuple):
    """A damped contact law."""

    name: str  # in tables
    power: float  # exponent of its elastic force
    force: Callable[[float, float, float], float]  # of depth, rate, damping, without dimension
    most: float  # largest damping that is looked at


TSUJI_DAMPING = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)
"""Damping over sqrt(m k) as a polynomial of the restitution that a user enters (LAMMPS)."""

TSUJI = Damped("hertz-tsuji", 1.5, lambda d, rate, c: d**1.5 + c * d**0.25 * rate, TSUJI_DAMPING[0])
DASHPOT = Damped("spring-dashpot", 1.0, lambda d, rate, c: max(d + c * rate, 0.0), 20.0)
HUNT = Damped("hunt-crossley", 1.0, lambda d, rate, c: d * max(1.0 + c * rate, 0.0), 200.0)


def blow_on(
    law: Damped, stiffness: float, damping: float, mass: float, speed: float
) -> ExportedBlow:
    """Return a collision, scaled from the one of unit mass, stiffness and speed.

    Stiffness k [N/m^power]; damping without dimension: c, or chi times the speed.
    """
    one = _unit_blow(law, damping)
    length = (mass * speed**2 / stiffness) ** (1.0 / (law.power + 1.0))
    return ExportedBlow(
        speed, one.depth * length, one.force * stiffness * length**law.power,
        one.time * length / speed, one.restitution,
    )  # fmt: skip


def stiffness_for(law: Damped, depth: float, damping: float, mass: float, speed: float) -> float:
    """Return the stiffness at which a collision goes this deep [N/m^power]."""
    whole = _unit_blow(law, damping).depth / depth
    return float(mass * speed**2 * whole ** (law.power + 1.0))


@cache
def damping_for(law: Damped, restitution: float) -> float:
    """Return the damping at which a ball comes back so; refuse what no damping takes."""

    def above(damping: float) -> float:
        return _unit_blow(law, damping).restitution - restitution

    if above(0.0) <= 0.0:  # all comes back, but for what the steps of the blow are off
        return 0.0
    if above(law.most) > 0.0:
        least = _unit_blow(law, law.most).restitution
        raise InputError(
            f"{restitution:.3g} by {law.name}", key="restitution",
            allowed=f"above {least:.2g}, the least of this damping: lower speeds",
        )  # fmt: skip
    return float(brentq(above, 0.0, law.most, xtol=1e-6))


@cache
def _unit_blow(law: Damped, damping: float) -> ExportedBlow:
    def force(d: float, rate: float) -> float:
        return float(law.force(max(d, 0.0), rate, damping))

    def step(_time: float, state: list[float]) -> list[float]:
        return [state[1], -force(*state)]

    def closed(time: float, state: list[float]) -> float:
        return 1.0 if time < 1e-3 else state[0]

    def slack(time: float, state: list[float]) -> float:
        """A dashpot that would pull lets go."""
        return 1.0 if time < 1e-3 or state[1] > 0.0 else state[0] + damping * state[1]

    closed.terminal = slack.terminal = True  # type: ignore[attr-defined]
    ends = (closed, slack) if law is DASHPOT else (closed,)
    found = solve_ivp(
        step, (0.0, 400.0), [0.0, 1.0], events=ends, rtol=1e-9, atol=1e-12, max_step=0.01
    )
    forces = [force(d, rate) for d, rate in found.y.T]
    return ExportedBlow(
        1.0, float(found.y[0].max()), max(forces), float(found.t[-1]), -float(found.y[1, -1])
    )


def entered_for(damping: float) -> float:
    """Return the restitution to enter for Tsuji's damping; none is 1.0007 (the polynomial)."""
    terms = tuple(enumerate(TSUJI_DAMPING))
    return float(brentq(lambda e: math.fsum(a * e**k for k, a in terms) - damping, 0.0, 1.02))
