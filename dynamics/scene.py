"""What strikes what: a frozen description of one impact, with a named seam for each assumption.

The baseline fills every seam with the thesis's choice: flow stress free of rate, an unmodified
normal force, Coulomb friction, a rigid striker, a rigid base, the stated approach, a perfect
instrument. A mechanism replaces one seam by `Scene.with_`; nothing is ever written in place.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from operator import attrgetter
from typing import Any, Protocol

import numpy as np

from ..core.arrays import Array, one_number
from ..core.errors import InputError
from ..core.inputs.rig_numbers import solid_inertia
from ..core.material import Material, Pair
from ..core.unstated import unstated_equal
from ..models.base import ContactLaw
from .beam import Modes
from .strength import StrengthTable
from .surface import Spot

STANDARD_GRAVITY = 9.81


def _check(value: float, key: str, *, least: str = "a number above 0") -> None:
    """Refuse a number below its least, or what is none: "1 m/s", `True`, a series."""
    if not isinstance(value, float):
        value = one_number(value, key=key, allowed=least)
    if not math.isfinite(value) or value < 0.0 or (value == 0.0 and least != "0 or more"):
        raise InputError(f"{value:g}", key=key, allowed=least)


@unstated_equal
@dataclass(frozen=True, slots=True)
class Striker:
    """A sphere, or a rod with two spherical tips, as a rigid body.

    - `mass`: [kg].
    - `tip_radius`: radius of the striking tip sphere [m].
    - `length`: distance between the centres of the two tip spheres [m]; 0 for a sphere.
    - `radius`: radius of the shank [m]; a sphere's own radius.
    - `inertia`: about the centre of mass, across the axis [kg m^2]; by default m (L^2/12 + r^2/4)
      for a rod and 2/5 m r^2 for a sphere.
    - `tip_flat_radius`: radius of a flat worn or cut on the tip [m].
    """

    mass: float
    tip_radius: float
    length: float = 0.0
    radius: float = math.nan
    inertia: float = math.nan
    tip_flat_radius: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        _check(self.mass, "mass_kg")
        _check(self.tip_radius, "tip_radius_m")
        if math.isnan(self.radius):
            object.__setattr__(self, "radius", self.tip_radius)
        if math.isnan(self.inertia):
            inertia = solid_inertia(self.mass, self.radius, self.length)
            object.__setattr__(self, "inertia", inertia)

    def arm(self, angle: float) -> tuple[float, float]:
        """Return (c, s): how far the centre of mass lies beside and above the contact point [m].

        c = (L/2) cos(theta), s = (L/2) sin(theta) + R (Eq. 5.1).
        """
        return (
            0.5 * self.length * math.cos(angle),
            0.5 * self.length * math.sin(angle) + self.tip_radius,
        )


class FlowStress(Protocol):
    """Seam: the strength of the metal at the conditions of this impact."""

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        """Return relative strengths at the depths of `table`, shape (nodes,)."""


@dataclass(frozen=True, slots=True)
class ForceTransform:
    """Seam: what is done to the law's normal force; neutral by default.

    - `damping`: chi of F (1 + chi d'), Hunt and Crossley's form [s/m].
    - `damping_exponent`: q of chi (4/3 E' a 10 um / F)^q: at 1 the viscous force goes with the
      contact radius (Kuwabara and Kono).
    - `radiation`: kappa [m s/N]: waves sent into a half-space take F up by kappa (dF/d(depth))^2 d'
      (elastically 2 E' a): their power is kappa (dF/dt)^2.
    - `factors`: multiply the loading force, interpolated in ln(depth / R) between equally spaced
      nodes from `force.LOG_DEPTH_FIRST` to `force.LOG_DEPTH_LAST`; empty for none.
    - `recovery_factors`: multiply the elastic recovery (peak depth minus residual depth) of a peak
      at the nodes of `factors`.
    - `shape`: added to the exponent of the recovery (3/2 for Hertz's).
    - `given_back`: multiplies the force of the recovery: the share of the elastic work that comes
      back.
    - `edge`: radius at which the tip ends [m]: beyond it a flat punch with its plastic limit.
    """

    damping: float = 0.0
    damping_exponent: float = 0.0
    radiation: float = 0.0
    factors: tuple[float, ...] = ()
    edge: float = math.inf
    recovery_factors: tuple[float, ...] = ()
    shape: float = 0.0
    given_back: float = 1.0


@unstated_equal
@dataclass(frozen=True, slots=True)
class Friction:
    """Seam: the tangential law; Coulomb friction with stick by default.

    - `mu`: coefficient of friction at speed [-].
    - `mu_static`: coefficient at rest [-]; by default equal to `mu`.
    - `speed`: sliding speed over which `mu_static` decays to `mu` [m/s].
    - `ploughing`: multiplies the ploughing term (4 / 3 pi) a / R that is added to `mu` [-].
    - `stiffness`: tangential over normal stiffness of the contact, 2 E' a, before it slips at its
      edge (Mindlin); infinite for one that slides or sticks without giving way [-].
    """

    mu: float = 0.0
    mu_static: float = math.nan
    speed: float = 1.0
    ploughing: float = 0.0
    stiffness: float = math.inf

    def __post_init__(self) -> None:
        _check(self.mu, "friction.coefficient", least="0 or more")
        if math.isnan(self.mu_static):
            object.__setattr__(self, "mu_static", self.mu)


@dataclass(frozen=True, slots=True)
class Support:
    """Seam: how the flat is held; rigid by default.

    - `mass`, `stiffness`, `damping`: a flat of this mass [kg] on a spring [N/m] with a dashpot [N
      s/m].
    - `plate_mobility`: Zener's plate: the surface moves at this speed per force [m/(N s)], 1 / (8
      sqrt(rho h D)); of a rod's end 1 / (rho c A).
    """

    mass: float = math.inf
    stiffness: float = 0.0
    damping: float = 0.0
    plate_mobility: float = 0.0


@dataclass(frozen=True, slots=True)
class Approach:
    """Seam: the motion at first touch.

    - `speed`: normal approach speed [m/s], positive.
    - `angle`: between the rod's axis and the flat [rad]; pi/2 when upright.
    - `tangential`: speed of the centre of mass along +x [m/s].
    - `spin`: angular velocity, counter-clockwise positive [rad/s].
    """

    speed: float
    angle: float = math.pi / 2.0
    tangential: float = 0.0
    spin: float = 0.0

    def __post_init__(self) -> None:
        _check(self.speed, "impact_speed_m_s")
        if not 0.0 <= self.angle <= math.pi / 2.0 + 1e-12:
            raise InputError(f"{math.degrees(self.angle):g}", key="angle_deg", allowed="0 to 90")

    @property
    def incidence(self) -> float:
        """Angle to the flat [rad]: a rod's lean, and where nothing leans that of the path."""
        if self.angle < math.pi / 2.0 - 1e-9:
            return self.angle
        return math.atan2(self.speed, abs(self.tangential))

    def inclined(self, incidence: float) -> Approach:
        """Return the approach at another incidence [rad], of the same normal speed."""
        if self.angle < math.pi / 2.0 - 1e-9 or self.tangential == 0.0:
            return replace(self, angle=incidence)
        along = math.copysign(self.speed / math.tan(incidence), self.tangential)
        return replace(self, tangential=along)

    @classmethod
    def dropped(cls, height: float, **others: float) -> Approach:
        """Return the approach after a free fall over `height` [m]: v = sqrt(2 g H)."""
        _check(height, "drop_height_m")
        return cls(speed=math.sqrt(2.0 * STANDARD_GRAVITY * height), **others)


CREEP = Approach(1e-5)
"""Approach of a quasi-static press, 0.6 mm/min; nothing follows from its size."""


@dataclass(frozen=True, slots=True)
class Press:
    """Seam: the striker is pressed on the flat without impact, and taken off.

    `load`: largest load [N]; `rate`: representative strain rate of the metal under it [1/s]; 0 for
    none.
    """

    load: float
    rate: float = 0.0

    def __post_init__(self) -> None:
        _check(self.load, "load_N")


@dataclass(frozen=True, slots=True)
class Instrument:
    """Seam: how a scar is read: by default as the union of the circles of contact.

    A profilometer samples it every `scan_step` [m], and it ends where it is `scan_height` [m] below
    the flat; 0, the default, for none.
    """

    scan_step: float = 3e-6
    scan_height: float = 0.0

    def __post_init__(self) -> None:
        _check(self.scan_step, "scan_step_m")
        _check(self.scan_height, "scan_height_m", least="0 or more")


_RIGID, _FRESH = Modes(), Spot()


@dataclass(frozen=True, slots=True)
class Scene:
    """One impact: law, pair, striker, approach, and the seams; or, with `press`, one press."""

    law: ContactLaw
    pair: Pair
    striker: Striker
    approach: Approach
    gravity: float = STANDARD_GRAVITY
    flow: tuple[FlowStress, ...] = ()
    force: ForceTransform = ForceTransform()
    friction: Friction = Friction()
    modes: Modes = _RIGID
    support: Support = Support()
    instrument: Instrument = Instrument()
    spot: Spot = _FRESH
    press: Press | None = None

    def __post_init__(self) -> None:
        if not math.isclose(self.pair.R, self.striker.tip_radius, rel_tol=1e-12):
            raise InputError(
                f"the pair's radius {self.pair.R:g} is not the tip radius "
                f"{self.striker.tip_radius:g}",
                key="tip_radius_m",
            )

    def strengths(self, table: StrengthTable) -> Array:
        """Return the strengths of `flow`, multiplied, at the depths of `table`; all 1 without."""
        if not self.flow:
            return np.ones_like(table.depth)
        return np.asarray(np.prod([part.profile(self, table) for part in self.flow], axis=0))

    def with_(self, **changes: Any) -> Scene:
        """Return a copy with some seams replaced."""
        # `dataclasses.replace` takes twice as long; a diagnosis makes a hundred thousand copies
        return Scene(**dict(zip(_SEAMS, _seams_of(self), strict=True)) | changes)


_SEAMS = tuple(f.name for f in fields(Scene))
_seams_of = attrgetter(*_SEAMS)


def scene_of(
    law: ContactLaw, *, sphere: Material, flat: Material, striker: Striker, approach: Approach,
    **seams: Any,
) -> Scene:  # fmt: skip
    """Return a scene; the pair's radius is the striker's tip radius."""
    return Scene(law, Pair(sphere, flat, striker.tip_radius), striker, approach, **seams)
