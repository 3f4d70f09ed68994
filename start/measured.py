"""What people measure of a pressed pair: pressures, the dent, what comes back of the energy."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.arrays import Array
from ..dynamics.report.onset import FirstYield, first_yield
from .rules import RULES

if TYPE_CHECKING:
    from ..fem.solution import Solution, Unloading

# limit: part of the approach below which nothing is permanent [-]: round-off
KEPT_ROUND_OFF = 1e-9

_STANDARD_GRAVITY = 9.80665  # m/s2; hardness after Brinell is in kgf/mm2


@dataclass(frozen=True)
class PressedContact:
    """The contact at the deepest approach whose pressure was kept."""

    depth: float  # Delta/R
    mean_pressure: float  # F/(pi a^2) [Pa]
    largest_pressure: float  # over the contact [Pa]
    largest_at: float  # radius [m]


@dataclass(frozen=True)
class Dent:
    """What one unloading leaves.

    The rim is the highest circle of the flat around the dent, between the nodes: nan and 0 where
    the flat sinks in. Hardness after Brinell is nan where the ball keeps more than 5 % of the
    permanent approach, or there is no such diameter.
    """

    depth: float  # Delta/R from which it was unloaded
    load: float  # force there [N]
    left_sphere: float  # permanent displacement of the pole [m]
    left_flat: float  # and of the flat below it [m]
    contact_diameter: float  # under the load [m]
    rim_diameter: float  # [m]
    rim_height: float  # over the flat that was [m]
    brinell_by_contact: float  # [kgf/mm2]
    brinell_by_rim: float  # [kgf/mm2]
    energy_returned: float  # work on the way back over that on the way in [-]

    def lines(self) -> Iterator[str]:
        """Yield what there is to say, for people."""
        sphere, flat = 1e6 * self.left_sphere, 1e6 * self.left_flat
        yield (
            f"unloaded from Delta/R = {self.depth:.4g}: left in the sphere {sphere:.4g} um, in the "
            f"flat {flat:.4g} um; {self.energy_returned:.1%} of the energy returned"
        )
        rim = "no rim"
        if not math.isnan(self.rim_diameter):
            rim = f"{_length(self.rim_diameter)} by rim, {1e6 * self.rim_height:.3g} um high"
        hardness = [
            f"HB {x:.0f} by {name}"
            for name, x in (("contact", self.brinell_by_contact), ("rim", self.brinell_by_rim))
            if not math.isnan(x)
        ]
        words = (f"{_length(self.contact_diameter)} by contact", rim, *hardness)
        yield f"  diameter {', '.join(words)}"


@dataclass(frozen=True)
class MeasuredContact:
    """What people measure of a solved pair: first yield, the deepest pressures, what is left."""

    first_yield: FirstYield | None  # none where neither body yields
    pressed: PressedContact | None  # none where that depth was not reached
    dents: tuple[Dent, ...]  # one of every unloading

    def to_dict(self) -> dict[str, Any]:
        """Return everything in SI units, Brinell's hardness in kgf/mm2; None for what is not."""
        return {
            "first_yield": self.first_yield and _numbers(self.first_yield),
            "pressed": self.pressed and _numbers(self.pressed),
            "dents": [_numbers(one) for one in self.dents],
        }

    def lines(self, mass: float = math.nan) -> Iterator[str]:
        """Yield what there is to say, for people; with the sphere's mass [kg] a speed too."""
        first, at = self.first_yield, self.pressed
        if first is None:
            yield "neither body yields"
        else:
            speed = ""
            if not math.isnan(mass):
                speed = f", {first.speed(mass):.3g} m/s for the ball's {1e3 * mass:.4g} g"
            yield f"first yield: {1e6 * first.depth:.3g} um, {first.load:.3g} N{speed}"
        if at is not None:
            yield (
                f"pressure at Delta/R = {at.depth:.4g}: mean {1e-6 * at.mean_pressure:.4g} MPa, "
                f"largest {1e-6 * at.largest_pressure:.4g} MPa at r = {_length(at.largest_at)}"
            )
        for dent in self.dents:
            yield from dent.lines()


def measured(solution: Solution) -> MeasuredContact:
    """Return what people measure, from a solve."""
    dents = tuple(_dent(solution, one) for one in solution.unloadings)
    return MeasuredContact(first_yield(solution.problem.pair), _pressed(solution), dents)


def _pressed(solution: Solution) -> PressedContact | None:
    """Return the pressures at the deepest picture of a solve; none without one.

    The largest is of running medians of three nodes: at the edge of contact single ones alternate.
    """
    if not solution.snapshots:
        return None
    profile, c = solution.snapshots[-1].profile, solution.loading
    p = profile.pressure
    smooth = np.median(np.stack([p[:-2], p[1:-1], p[2:]]), axis=0)
    k = int(smooth.argmax())
    mean = float(np.interp(profile.depth, c.delta / solution.problem.pair.R, c.hardness))
    return PressedContact(profile.depth, mean, float(smooth[k]), float(profile.sphere_r[k + 1]))


def brinell(load: float, ball: float, dent: float) -> float:
    """Hardness after Brinell, 0.102 F over the dent's spherical surface (ISO 6506-1) [kgf/mm2].

    Force [N], diameters of ball and dent [m]; nan for a dent that is no smaller.
    """
    if not dent < ball:
        return math.nan
    area = 0.5 * math.pi * ball * (ball - math.sqrt(ball**2 - dent**2))
    return load / _STANDARD_GRAVITY / (1e6 * area)


def _dent(solution: Solution, u: Unloading) -> Dent:
    R, load = solution.problem.pair.R, float(u.curve.force[0])
    contact = 2.0 * float(u.curve.radius[0])
    top = int(u.crater_z.argmax())
    kept = (u.residual_sphere, u.residual_flat)
    sphere, flat = (x if abs(x) > KEPT_ROUND_OFF * u.depth * R else 0.0 for x in kept)
    # what sinks in rises towards the edge of the mesh, where the flat is as it was
    rises = flat > 0.0 and u.crater_z[top] > max(1e-3 * flat, KEPT_ROUND_OFF * R)
    rim, height = _crest(u.crater_r, u.crater_z, top) if rises else (math.nan, 0.0)
    dented = flat > 0.0 and sphere <= RULES.ball_keeps * (sphere + flat)
    by_contact, by_rim = (brinell(load, 2.0 * R, d) if dented else math.nan for d in (contact, rim))
    back = _returned(solution, u)
    return Dent(
        depth=u.depth, load=load, left_sphere=sphere, left_flat=flat,
        contact_diameter=contact, rim_diameter=rim, rim_height=height,
        brinell_by_contact=by_contact, brinell_by_rim=by_rim, energy_returned=back,
    )  # fmt: skip


def _crest(r: Array, z: Array, top: int) -> tuple[float, float]:
    """Diameter and height [m] of the top of a parabola through the highest node and its neighbours.

    That node itself jumps by a whole element where the next one rises above it.
    """
    if top == len(r) - 1:
        return 2.0 * float(r[top]), float(z[top])
    near = slice(top - 1, top + 2)
    bend, slope, height = np.polyfit(r[near] - r[top], z[near], 2)
    return float(2.0 * r[top] - slope / bend), float(height - 0.25 * slope**2 / bend)


def loading_work(delta: Array, force: Array) -> Array:
    """Work of loading up to each depth [J]; a power law between the depths, Hertz's before."""
    power = np.diff(np.log(force)) / np.diff(np.log(delta))
    step = np.diff(force * delta) / (power + 1.0)
    return np.asarray(np.concatenate([[0.0], np.cumsum(step)]) + 0.4 * force[0] * delta[0])


def _numbers(part: FirstYield | PressedContact | Dent) -> dict[str, float | None]:
    return {k: None if math.isnan(x) else float(x) for k, x in asdict(part).items()}


def _length(x: float) -> str:
    return f"{1e3 * x:.4g} mm" if x >= 1e-3 else f"{1e6 * x:.4g} um"


def _returned(solution: Solution, u: Unloading) -> float:
    """Work of an unloading over that of the loading before it."""
    c, back = solution.loading, u.curve
    before = c.delta < back.delta[0]
    d, F = (np.append(x[before], y[0]) for x, y in ((c.delta, back.delta), (c.force, back.force)))
    given = loading_work((back.delta - u.residual)[::-1], back.force[::-1])
    return float(given[-1] / loading_work(d, F)[-1])
