"""Parameters of the contact laws of discrete-element codes, for one pair, by speed.

Those laws carry neither two yielding bodies nor this loading curve. Each gets the parameters at
which it returns what our law returns for a ball on the flat at a speed; what it then misses in
depth, force and time is stated. `collisions` has the damped ones; beside them:

* Hertz with Tsuji's damping once of the bodies' own stiffness, once so softened that the depth is
  right too;
* linear with two stiffnesses (Luding; Walton and Braun): LIGGGHTS `hooke/hysteresis`, YADE
  `LudingMat`: depth and restitution are right.

LAMMPS, pair_style granular.
S. Luding, Granular Matter 10 (2008) 235.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

from ...core.errors import InputError
from ...core.material import Pair
from ...models.base import ContactLaw
from ..batch import impacts
from ..integrate import Settings
from ..mechanisms.asked import NONE_ASKED, Asked
from ..scene import Approach, Scene, Striker, scene_of
from . import collisions
from .collisions import DASHPOT, HUNT, TSUJI, Damped, ExportedBlow

SOFTENED = "hertz-tsuji-softened"


class Substitute(NamedTuple):
    """A discrete-element law with its parameters and what it makes of the blow."""

    name: str
    stiffness: float  # of Hertz's force [N/m^1.5], or of a straight one [N/m]
    unloading: float  # stiffness of unloading [N/m]; nan for Hertz
    entered: float  # restitution to enter; nan where other numbers give it
    damping: float  # of a dashpot [N s/m], of Hunt and Crossley [s/m]; nan where there is none
    blow: ExportedBlow

    def missed(self, law: ExportedBlow) -> tuple[float, float, float, float]:
        """Depth, force and time over the law's, less one; restitution less the law's."""
        mine = self.blow
        return (
            mine.depth / law.depth - 1.0, mine.force / law.force - 1.0,
            mine.time / law.time - 1.0, mine.restitution - law.restitution,
        )  # fmt: skip

    def told(self, law: ExportedBlow) -> str:
        """Say what it returns, and what it misses, in per cent."""
        depth, force, time, _ = (100.0 * x for x in self.missed(law))
        return (
            f"restitution {law.restitution:.4f}; depth {depth:+.1f} %, peak force {force:+.1f} %, "
            f"time {time:+.1f} %"
        )


class ExportedRow(NamedTuple):
    """One speed: our law's blow and its substitutes."""

    law: ExportedBlow
    substitutes: tuple[Substitute, ...]
    left_out: Mapping[str, str] = MappingProxyType({})  # why, by the name of what cannot do it

    def named(self, name: str) -> Substitute | None:
        """Return one of the substitutes; none: it is left out."""
        return next((s for s in self.substitutes if s.name == name), None)

    def without(self, name: str) -> str:
        """Say at which speed something is left out, and why."""
        return f"{self.law.speed:g} m/s: no {name}: {self.left_out[name]}"


def substitutes(
    law: ContactLaw, pair: Pair, *, mass: float, speeds: Sequence[float], asked: Asked = NONE_ASKED
) -> list[ExportedRow]:
    """Return the parameters at each speed [m/s] of a ball of mass [kg] on a flat.

    For two balls `two_balls` gives pair and mass; `asked` are mechanisms that act beside the law. A
    speed at which nothing comes back is refused.
    """
    scene = ball_scene(law, pair, mass=mass, speed=speeds[0])
    found = impacts(scene, speeds=speeds, asked=asked, settings=Settings())
    rows = []
    for k, speed in enumerate(speeds):
        blow = ExportedBlow(
            speed, float(found["peak_depth_m"][k]), float(found["peak_force_N"][k]),
            float(found["contact_time_s"][k]), float(found["restitution"][k]),
        )  # fmt: skip
        if not blow.restitution > 0.0:
            raise InputError(f"nothing comes back at {speed:g} m/s", key="speed")
        rows.append(_row(blow, pair, mass))
    return rows


def ball_scene(law: ContactLaw, pair: Pair, *, mass: float, speed: float) -> Scene:
    """Return the scene of a ball that meets the flat straight, without gravity."""
    return scene_of(
        law, sphere=pair.sphere, flat=pair.flat, gravity=0.0,
        striker=Striker(mass=mass, tip_radius=pair.R), approach=Approach(speed),
    )  # fmt: skip


def _row(blow: ExportedBlow, pair: Pair, mass: float) -> ExportedRow:
    """The substitutes of a blow; a damping that cannot take so much is left out with its laws."""
    found: list[Substitute] = []
    left_out: dict[str, str] = {}
    for names, make in (
        (("hertz-tsuji", SOFTENED), _hertz),
        (("linear-hysteretic",), _hysteretic),
        ((DASHPOT.name,), partial(_straight, DASHPOT)),
        ((HUNT.name,), partial(_straight, HUNT)),
    ):
        try:
            found += make(blow, pair, mass)
        except InputError as error:
            left_out |= dict.fromkeys(names, str(error))
    return ExportedRow(blow, tuple(found), left_out)


def _hertz(blow: ExportedBlow, pair: Pair, mass: float) -> list[Substitute]:
    own = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R)
    damping, soft = _as_deep(TSUJI, blow, mass)
    entered, found = collisions.entered_for(damping), list[Substitute]()
    for name, k in (("hertz-tsuji", own), (SOFTENED, soft)):
        made = collisions.blow_on(TSUJI, k, damping, mass, blow.speed)
        found.append(Substitute(name, k, math.nan, entered, math.nan, made))
    return found


def _hysteretic(blow: ExportedBlow, _: Pair, mass: float) -> list[Substitute]:
    first = mass * (blow.speed / blow.depth) ** 2
    second = first / blow.restitution**2
    quarter = 0.5 * math.pi * math.sqrt(mass)
    linear = ExportedBlow(
        blow.speed, blow.depth, first * blow.depth,
        quarter * (first**-0.5 + second**-0.5), blow.restitution,
    )  # fmt: skip
    return [Substitute("linear-hysteretic", first, second, math.nan, math.nan, linear)]


def _straight(damped: Damped, blow: ExportedBlow, _: Pair, mass: float) -> list[Substitute]:
    c, k = _as_deep(damped, blow, mass)
    with_unit = c * math.sqrt(mass * k) if damped is DASHPOT else c / blow.speed
    found = collisions.blow_on(damped, k, c, mass, blow.speed)
    return [Substitute(damped.name, k, math.nan, math.nan, with_unit, found)]


def _as_deep(damped: Damped, blow: ExportedBlow, mass: float) -> tuple[float, float]:
    """Damping without dimension and stiffness at which restitution and depth are the blow's."""
    damping = collisions.damping_for(damped, blow.restitution)
    return damping, collisions.stiffness_for(damped, blow.depth, damping, mass, blow.speed)


HEAD = (
    "contact", "model", "speed_m_s", "stiffness", "stiffness_unit", "unloading_stiffness_N_m",
    "damping", "damping_unit", "restitution_entered", "depth_m", "peak_force_N",
    "contact_time_s", "restitution",
    "depth_missed_percent", "peak_force_missed_percent", "contact_time_missed_percent",
    "restitution_missed",
)  # fmt: skip


def table(rows: Sequence[ExportedRow], *, law: str, contact: str) -> list[tuple[str | float, ...]]:
    """Rows under `HEAD`: at each speed our law, then its substitutes."""
    out: list[tuple[str | float, ...]] = []
    for row in rows:
        b = row.law
        out.append((contact, law, b.speed, *[""] * 6, *b[1:], 0.0, 0.0, 0.0, 0.0))
        for s in row.substitutes:
            percent = [100.0 * x for x in s.missed(b)[:3]]
            unit = "N/m" if math.isnan(s.entered) else "N/m^1.5"
            per = {DASHPOT.name: "N s/m", HUNT.name: "s/m"}.get(s.name, "")
            back, damping, entered = (
                "" if math.isnan(x) else x for x in (s.unloading, s.damping, s.entered)
            )
            out.append(
                (contact, s.name, b.speed, s.stiffness, unit, back, damping, per, entered,
                 *s.blow[1:], *percent, s.missed(b)[3])
            )  # fmt: skip
    return out


def two_balls(pair: Pair, mass: float) -> tuple[Pair, float]:
    """Return pair and mass of two balls like this one as a ball on a flat of the same metal.

    1/R = 1/R_1 + 1/R_2 and 1/m = 1/m_1 + 1/m_2: half the radius and half the mass. Their law is
    `models.turned.similar` at a ratio of 2.
    """
    return Pair(pair.sphere, pair.sphere, 0.5 * pair.R), 0.5 * mass
