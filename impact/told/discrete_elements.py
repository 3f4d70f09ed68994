"""Parameters of the contact laws of discrete-element codes, for one pair, by speed.

Those laws carry neither two yielding bodies nor this loading curve. Each gets the parameters at
which it returns what our law returns for a ball on the flat at a speed; what it then misses in
depth, force and time is stated. Two families cover what LAMMPS, LIGGGHTS and YADE offer:

* Hertz with Tsuji's damping (LAMMPS `hertz ... damping tsuji`, LIGGGHTS and YADE by restitution),
  once of the bodies' own stiffness, once so softened that the depth is right too;
* linear with two stiffnesses (Luding; Walton and Braun): LIGGGHTS `hooke/hysteresis`, YADE
  `LudingMat`: depth and restitution are right.

References
----------
Y. Tsuji, T. Tanaka, T. Ishida, Powder Technol. 71 (1992) 239; LAMMPS, pair_style granular.
S. Luding, Granular Matter 10 (2008) 235.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

from numpy.polynomial import polynomial
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ...core.errors import InputError
from ...core.material import Pair
from ...models.base import ContactLaw
from ..integrate import strike
from ..scene import Approach, Striker, scene_of

TSUJI = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)
"""Damping over sqrt(m k) as a polynomial of the restitution that a user enters (LAMMPS)."""

_MOST_DAMPING = TSUJI[0]  # of a restitution of 0 entered


class ExportedBlow(NamedTuple):
    """A normal impact."""

    speed: float  # [m/s]
    depth: float  # largest approach [m]
    force: float  # largest force [N]
    time: float  # in contact [s]
    restitution: float


class Substitute(NamedTuple):
    """A discrete-element law with its parameters and what it makes of the blow."""

    name: str
    stiffness: float  # F = stiffness depth^1.5 [N/m^1.5], or F = stiffness depth [N/m]
    unloading: float  # stiffness of unloading [N/m]; nan for Hertz
    entered: float  # restitution to enter; nan where the stiffnesses give it
    blow: ExportedBlow

    def missed(self, law: ExportedBlow) -> tuple[float, float, float, float]:
        """Depth, force and time over the law's, less one; restitution less the law's."""
        mine = self.blow
        return (
            mine.depth / law.depth - 1.0, mine.force / law.force - 1.0,
            mine.time / law.time - 1.0, mine.restitution - law.restitution,
        )  # fmt: skip


class ExportedRow(NamedTuple):
    """One speed: our law's blow and its substitutes."""

    law: ExportedBlow
    substitutes: tuple[Substitute, ...]


def substitutes(
    law: ContactLaw, pair: Pair, *, mass: float, speeds: Sequence[float]
) -> list[ExportedRow]:
    """Return the parameters at each speed.

    Parameters
    ----------
    law
        Ours, or a published one.
    pair
        Ball and flat.
    mass
        Of the ball [kg]; for two balls `two_balls` gives pair and mass.
    speeds
        Of the approach [m/s].

    Raises
    ------
    InputError
        A speed at which nothing comes back.
    """
    rows = []
    for speed in speeds:
        found = strike(
            scene_of(
                law, sphere=pair.sphere, flat=pair.flat, gravity=0.0,
                striker=Striker(mass=mass, tip_radius=pair.R), approach=Approach(speed),
            )
        )  # fmt: skip
        blow = ExportedBlow(
            speed, found.peak_depth_m, found.peak_force_N, found.contact_time_s, found.restitution
        )
        if not blow.restitution > 0.0:
            raise InputError(f"nothing comes back at {speed:g} m/s", key="speed")
        rows.append(ExportedRow(blow, _of(blow, pair, mass)))
    return rows


def _of(blow: ExportedBlow, pair: Pair, mass: float) -> tuple[Substitute, ...]:
    own = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R)
    damping = _damping_of(blow.restitution)
    # at one damping the depth goes with stiffness^(-2/5)
    soft = own * (_hertz(own, damping, mass, blow.speed).depth / blow.depth) ** 2.5
    entered = _entered(damping)
    hertz = [
        Substitute(name, stiffness, math.nan, entered, _hertz(stiffness, damping, mass, blow.speed))
        for name, stiffness in (("hertz-tsuji", own), ("hertz-tsuji-softened", soft))
    ]
    first = mass * (blow.speed / blow.depth) ** 2
    second = first / blow.restitution**2
    quarter = 0.5 * math.pi * math.sqrt(mass)
    linear = ExportedBlow(
        blow.speed, blow.depth, first * blow.depth,
        quarter * (first**-0.5 + second**-0.5), blow.restitution,
    )  # fmt: skip
    return (*hertz, Substitute("linear-hysteretic", first, second, math.nan, linear))


def _hertz(stiffness: float, damping: float, mass: float, speed: float) -> ExportedBlow:
    """A blow on F = k d^(3/2) + damping sqrt(m k) d^(1/4) d', from the one of unit m, k, speed."""
    one = _unit_blow(damping)
    length = (mass * speed**2 / stiffness) ** 0.4
    return ExportedBlow(
        speed, one.depth * length, one.force * stiffness * length**1.5,
        one.time * length / speed, one.restitution,
    )  # fmt: skip


@cache
def _unit_blow(damping: float) -> ExportedBlow:
    def force(d: float, rate: float) -> float:
        d = max(d, 0.0)
        return float(d**1.5 + damping * d**0.25 * rate)

    def step(_time: float, state: list[float]) -> list[float]:
        return [state[1], -force(*state)]

    def left(time: float, state: list[float]) -> float:
        return 1.0 if time < 1e-3 else state[0]

    left.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(
        step, (0.0, 60.0), [0.0, 1.0], events=left, rtol=1e-9, atol=1e-12, max_step=0.01
    )
    forces = [force(d, rate) for d, rate in found.y.T]
    return ExportedBlow(
        1.0, float(found.y[0].max()), max(forces), float(found.t[-1]), -float(found.y[1, -1])
    )


@cache
def _damping_of(restitution: float) -> float:
    """Damping at which a ball comes back with this restitution, once its dent has closed."""

    def above(damping: float) -> float:
        return _unit_blow(damping).restitution - restitution

    if restitution >= 1.0 - 1e-9:
        return 0.0
    if above(_MOST_DAMPING) > 0.0:
        raise InputError(
            f"a restitution of {restitution:.3g}", key="restitution",
            allowed=f"above {_unit_blow(_MOST_DAMPING).restitution:.2g}, the least of this damping",
        )  # fmt: skip
    return float(brentq(above, 0.0, _MOST_DAMPING, xtol=1e-6))


def _entered(damping: float) -> float:
    """Restitution to enter for a damping; the polynomial is a fit and misses by up to 0.02."""
    found = float(brentq(lambda e: polynomial.polyval(e, TSUJI) - damping, 0.0, 1.02))
    return min(found, 1.0)  # the polynomial reaches no damping beyond 1


HEAD = (
    "contact", "model", "speed_m_s", "stiffness", "stiffness_unit", "unloading_stiffness_N_m",
    "restitution_entered", "depth_m", "peak_force_N", "contact_time_s", "restitution",
    "depth_missed_percent", "peak_force_missed_percent", "contact_time_missed_percent",
    "restitution_missed",
)  # fmt: skip
"""Columns of the table."""


def table(rows: Sequence[ExportedRow], *, law: str, contact: str) -> list[tuple[str | float, ...]]:
    """Rows under `HEAD`: at each speed our law, then its substitutes."""
    out: list[tuple[str | float, ...]] = []
    for row in rows:
        b = row.law
        out.append((contact, law, b.speed, "", "", "", "", *b[1:], 0.0, 0.0, 0.0, 0.0))
        for s in row.substitutes:
            percent = [100.0 * x for x in s.missed(b)[:3]]
            unit = "N/m^1.5" if math.isnan(s.unloading) else "N/m"
            numbers = ["" if math.isnan(x) else x for x in (s.unloading, s.entered)]
            out.append(
                (contact, s.name, b.speed, s.stiffness, unit, *numbers, *s.blow[1:], *percent,
                 s.missed(b)[3])
            )  # fmt: skip
    return out


def two_balls(pair: Pair, mass: float) -> tuple[Pair, float]:
    """Return pair and mass of two balls like this one as a ball on a flat of the same metal.

    1/R = 1/R_1 + 1/R_2 and 1/m = 1/m_1 + 1/m_2: half the radius and half the mass. Elastic balls
    follow it exactly. Where both yield, the law is that of a sphere and a flat of equal strength.
    """
    return Pair(pair.sphere, pair.sphere, 0.5 * pair.R), 0.5 * mass


def tangential_stiffness(pair: Pair) -> float:
    """Mindlin's stiffness over the contact radius, 8 G* [Pa]; 1/G* = sum of (2 - nu)/G.

    References
    ----------
    R. D. Mindlin, J. Appl. Mech. 16 (1949) 259. K. L. Johnson, Contact Mechanics (1985), 7.2.
    """
    bodies = (b for b in (pair.sphere, pair.flat) if not b.rigid)
    return 8.0 / sum((2.0 - b.nu) * 2.0 * (1.0 + b.nu) / b.E for b in bodies)


def lammps_lines(
    rows: Sequence[ExportedRow],
    pair: Pair,
    *,
    friction: float = 0.0,
    of_balls: Sequence[ExportedRow] = (),
) -> str:
    """A fragment of a LAMMPS input: the softened Hertz law at each speed, for wall and balls.

    Parameters
    ----------
    rows, pair
        Of the ball on the flat.
    friction
        Coulomb's coefficient, of both contacts.
    of_balls
        Of two balls, from `two_balls`, at the same speeds.
    """
    lines = [
        "# pair_style granular; units si; one block for a speed: take the one of your impacts.",
        "# fix wall/gran: the ball on the flat (here below it, at z = 0). pair_coeff: two such",
        "# balls; where both yield, by the law of a sphere and a flat of equal strength.",
        f"# tangential: {_tangential_told(friction)}",
    ]
    for k, row in enumerate(rows):
        lines.append(f"# {row.law.speed:g} m/s, the flat: {_told(row)}")
        law = _lammps(row, pair, friction)
        lines.append(f"fix flat all wall/gran granular {law} zplane 0.0 NULL")
        if of_balls:
            balls, _ = two_balls(pair, 1.0)
            lines.append(f"# {row.law.speed:g} m/s, two balls: {_told(of_balls[k])}")
            lines.append(f"pair_coeff * * {_lammps(of_balls[k], balls, friction)}")
    return "\n".join(lines) + "\n"


def _told(row: ExportedRow) -> str:
    depth, force, time, _ = (100.0 * x for x in row.substitutes[1].missed(row.law))
    return (
        f"restitution {row.law.restitution:.4f}; depth {depth:+.1f} %, peak force {force:+.1f} %, "
        f"time {time:+.1f} %"
    )


def _tangential_told(friction: float) -> str:
    if friction > 0.0:
        return (
            f"Mindlin's spring and Coulomb's {friction:g}, softened as the normal one; our own law "
            "has no viscous part"
        )
    return "none, for the file states no friction.coefficient"


def _lammps(row: ExportedRow, pair: Pair, friction: float) -> str:
    own, soft, _ = row.substitutes
    # LAMMPS multiplies by the root of the effective radius
    k = soft.stiffness / math.sqrt(pair.R)
    tangential = "linear_nohistory 0.0 0.0"
    if friction > 0.0:
        # softened as the normal stiffness, so that their ratio stays Mindlin's
        kt = tangential_stiffness(pair) * soft.stiffness / own.stiffness
        tangential = f"mindlin_rescale {kt:.6e} 0.0 {friction:g}"
    return f"hertz {k:.6e} {soft.entered:.6f} tangential {tangential} damping tsuji"


def hysteretic_lines(rows: Sequence[ExportedRow], *, friction: float = 0.0) -> str:
    """Stiffnesses for LIGGGHTS `hooke/hysteresis` and YADE `LudingMat`, a line a speed."""
    lines = [
        "# of the ball on the flat; two such balls have half the mass and other stiffnesses.",
        f"# coefficient of friction: {friction:g}",
        "# linear hysteretic law (Luding): loading k1, unloading k2 [N/m], no cohesion;",
        "# LIGGGHTS hooke/hysteresis: kn2k1 = k1/k2; YADE LudingMat: k1, and kp with which k2 is",
        "# reached at the depth.",
    ]
    for row in rows:
        s = row.substitutes[-1]
        _, force, time, _ = (100.0 * x for x in s.missed(row.law))
        lines.append(
            f"# {row.law.speed:g} m/s: peak force {force:+.1f} %, time {time:+.1f} %\n"
            f"k1 = {s.stiffness:.6e}; k2 = {s.unloading:.6e}; depth_m = {s.blow.depth:.6e}"
        )
    return "\n".join(lines) + "\n"
