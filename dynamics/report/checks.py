"""What speaks against a blow as it was set up, in words and with its effect in numbers.

Each check simulates what the set-up leaves out, or names the rule that it is judged by.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.errors import InputError
from ...core.inputs.flow_curve import SPECIMENS
from ...core.inputs.materials import materials, unlisted
from ...core.inputs.rig_numbers import solid_mass
from ...core.rig import Quantity
from ...core.tables import counted
from ...models.base import ContactLaw, DomainWarning, unwarned
from ...models.choose import demand, follows_flow
from ...models.turned import as_made
from ..result import Impact
from ..scene import Scene
from .band import last_blow, repeated
from .effect import effect
from .flat import FREE_PLATE, bending, flat_checks, with_waves
from .flow import Lack, flow_checks, lacking
from .onset import as_strong, effective_mass, first_yield_speed, largest_mean_pressure

if TYPE_CHECKING:
    from ..columns import Impacts
    from ..files.setup import Setup

# limit: part of the dent that one specimen or the next moves, from which it is told [-]
_MAY_MATTER = 0.25

# limit: departure from a solid sphere's mass that is told [-]; three digits of a sheet
_MASS_OFF = 0.01

# limit: the same of a rod [-]; bores and collars
_ROD_OFF = 0.05

# limit: restitution from which it is told to be above 1 [-]; half of its last digit shown
_ABOVE_ONE = 1.0 + 5e-4

# limit: coefficient of friction that is asked back [-]: above those of clean metals in air
_RUBS = 2.0

# limit: rho v^2 over strength from which inertia of the metal is told of [-]
_DAMAGE = 1.0
# limit: part of the approach's speed below which a sphere is at rest [-]: round-off
_ROUND_OFF = 1e-9
# limit: relative effect that is worth a line [-]
_WORTH_A_LINE = 1e-3


def lacks_of(setup: Setup, law: ContactLaw, found: Impact) -> dict[str, Lack]:
    """Return what the file leaves open and the table of materials, or a plate's bending, fills."""
    scene = setup.scene(law)
    with unwarned():
        lacks = lacking(setup, scene, found)
        waves = None
        if setup.file.target.thickness_m and "support" not in setup.content.get("impact", {}):
            waves = with_waves(setup, scene)
    if waves is not None:
        lacks["plate"] = Lack(FREE_PLATE, (waves,), "impact.support")
    return {
        what: one for what, one in lacks.items()
        if all(end.outcome.completed for end in one.ends) and any(
            sum(one.moved(name, found)) > _WORTH_A_LINE * getattr(found, name)
            for name in ("restitution", "residual_flat_m")
        )
    }  # fmt: skip


def checks(
    setup: Setup, law: ContactLaw, found: Impact, lacks: Mapping[str, Lack] = MappingProxyType({})
) -> list[str]:
    """Return a line for each check, by one law and its blow; none where that did not end."""
    if not found.outcome.completed:
        return []
    scene = setup.scene(law)
    if not found.restitution > 0.0:
        # what has made it stay
        return [
            *_repeats(setup), *_resting(scene, found), *bending(setup, scene, found),
            *_mechanisms(setup, law, found),
        ]  # fmt: skip
    with unwarned():
        parts = (
            _repeats(setup), _deep(setup, scene, found), _onset(setup, scene, found),
            flow_checks(setup, scene, found, lacks), _either(scene, found),
            flat_checks(setup, scene, found, lacks), _walls(scene, found),
            _gravity(setup, scene, found), _friction(setup, scene, found), _rod(scene, found),
            _two_radii(setup), _edge(setup, scene, found), _second(setup, scene, found),
            _bodies(setup, law), _mechanisms(setup, law, found),
        )  # fmt: skip
        return [line for part in parts for line in part]


def _resting(scene: Scene, found: Impact) -> Iterator[str]:
    if math.isfinite(scene.support.mass) and found.tip_rebound_m_s <= 0.0:
        yield "no rebound: what is struck is no heavier, and takes the speed along"
    elif found.contact_time_s > 0.0:
        yield "no rebound: what is taken after the contact leaves nothing of it"
    elif not found.peak_depth_m > 0.0:
        yield "no touch: the film takes the whole approach (below the critical Stokes number)"
    elif not scene.support.plate_mobility > 0.0:
        yield "no rebound: what the contact would give back does not lift the weight: it stays"
    else:
        yield (
            "no rebound: waves along the plate or rod carry the whole blow off; it is without end, "
            "so nothing that comes back from there is in this"
        )


def _repeats(setup: Setup) -> Iterator[str]:
    if setup.repeats > 1:
        yield f"shown is the last of {setup.repeats} blows on one spot; the CSV has each"


def _onset(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    pressure, pair = largest_mean_pressure(scene, found), scene.pair
    mean = "" if math.isnan(pressure) else f"largest mean pressure {pressure / 1e6:.4g} MPa"
    if not math.isfinite(pair.Sy_min):
        asked = setup.file.target.law == "elastic"
        what = "elastic, as target.law has it" if asked else "neither body yields"
        yield f"{what}{': ' if mean else ''}{mean}"
        return
    there = as_strong(scene, found.peak_depth_m)
    over = f"; {mean}, {pressure / there.Sy_min:.3g} times the weaker strength" if mean else ""
    speed = first_yield_speed(scene)
    if speed == 0.0:
        yield "first yield at the edge of the tip's flat, at any speed"
        return
    regime = demand(as_made(scene.law, there)[1], found.peak_depth_m).regime
    yield (
        f"first yield at {speed:.3g} m/s; here {scene.approach.speed / speed:.3g} times that "
        f"({regime}){over}"
    )


def _either(scene: Scene, found: Impact) -> Iterator[str]:
    """Where specimens of one bar decide which body the dent is in."""
    pair = scene.pair
    if not (math.isfinite(pair.sphere.Sy) and math.isfinite(pair.flat.Sy)):
        return
    parts = []
    for factor in (1.0 / (1.0 + SPECIMENS), 1.0 + SPECIMENS):
        other = replace(pair, sphere=pair.sphere.strengthened(factor))
        try:
            sphere, flat = (float(x) for x in scene.law.residual(other, found.peak_depth_m))
        except InputError:  # the table of one pair knows no other
            return
        parts.append(sphere / (sphere + flat) if sphere + flat > 0.0 else 0.5)
    if max(parts) - min(parts) > _MAY_MATTER:
        yield (
            f"either body may take the dent: {100.0 * min(parts):.0f} to {100.0 * max(parts):.0f} "
            f"% of it is the sphere's where a strength is off by {100.0 * SPECIMENS:.0f} %, as "
            "specimens of one bar are"
        )


def _deep(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    radii = [scene.striker.radius, *([setup.second.radius] if setup.second else [])]
    if found.peak_depth_m > min(r for r in radii if r > 0.0):
        yield (
            f"the approach, {found.peak_depth_m * 1e3:.3g} mm, is more than the radius: the bodies "
            "would go through each other, and no number here holds"
        )
    weak = scene.pair.weaker
    damage = weak.density * scene.approach.speed**2 / weak.Sy
    if damage > _DAMAGE:
        yield (
            f"rho v^2/S_y is {damage:.2g}: from 1 on the metal's own inertia counts (W. Johnson, "
            "Impact Strength of Materials, 1972), which no contact law has"
        )


def _gravity(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    if scene.gravity == 0.0:
        return
    without = repeated(setup, scene.with_(gravity=0.0))
    if abs(without.restitution / found.restitution - 1.0) > _WORTH_A_LINE:
        yield (
            f"gravity, {scene.gravity:.4g} m/s^2, acts during the contact; without: "
            f"{effect(without, found)}"
        )


def _straight(scene: Scene) -> bool:
    """Whether nothing moves along the flat."""
    approach = scene.approach
    upright = math.isclose(approach.angle, 0.5 * math.pi, abs_tol=1e-9)
    return approach.tangential == approach.spin == 0.0 and upright


def _friction(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    straight, mu = _straight(scene), scene.friction.mu
    inertia = setup.file.strikers[setup.file.striker].inertia_kg_m2
    if straight and inertia is not None:
        key = f"strikers.{setup.file.striker}.inertia_kg_m2"
        yield f"{key}, {inertia.value:g}, does nothing in a straight blow: nothing turns"
    if straight and mu > 0.0:
        yield (
            f"friction, {mu:g}, does nothing in a straight blow by these laws; "
            "dentscope case solves the contact with it"
        )
    elif not straight and mu > 0.0:
        if mu > _RUBS:
            yield f"friction, {mu:g}, is more than metals have; {mu:g} % would be {mu / 100.0:g}"
        smooth = scene.with_(friction=replace(scene.friction, mu=0.0, mu_static=0.0))
        yield f"without friction: {effect(repeated(setup, smooth), found)}"
    elif not straight and setup.file.friction.coefficient is None:
        yield "friction.coefficient is not stated: nothing acts along the flat"


def _rod(scene: Scene, found: Impact) -> Iterator[str]:
    striker, metal = scene.striker, scene.pair.sphere
    if striker.length == 0.0 or metal.rigid or math.isnan(metal.density):
        return
    c = math.sqrt(metal.E / metal.density)
    limit = metal.density * c * scene.approach.speed * math.pi * striker.radius**2
    count, over = len(scene.modes.frequencies), found.peak_force_N > limit
    axial = sum(map(bool, scene.modes.axial))
    if over and _straight(scene) and (axial or not count):
        few = f"; its {axial} vibrations along the axis are too few for that" if count else ""
        yield (
            f"upright it cannot press with more than rho c v A = {limit:.4g} N before a wave along "
            f"it is back{few}"
        )
    along = "mechanisms.rod-longitudinal-waves" if _straight(scene) else "impact.modes"
    if count:
        if _straight(scene) and not any(scene.modes.axial):
            yield (
                f"impact.modes, {count}, does nothing in a straight blow: the lowest {count} modes "
                f"bend the rod; {along} has those along it"
            )
        return
    there_and_back = 2.0 * (striker.length + 2.0 * striker.tip_radius) / c
    share = there_and_back / found.contact_time_s
    yield (
        f"the rod is taken as rigid: a wave runs along it and back in {there_and_back * 1e6:.4g} "
        f"us, {share:.2g} of the contact; {along} lets it vibrate"
    )


def _two_radii(setup: Setup) -> Iterator[str]:
    ball = setup.file.strikers[setup.file.striker]
    if ball.shape == "sphere" and ball.radius_m is not None:
        tip, body = ball.tip_radius_m, ball.radius_m
        if abs(tip.value - body.value) > max(tip.std, body.std):
            yield (
                f"the ball meets the flat with tip_radius_m = {tip.value:g}; radius_m = "
                f"{body.value:g} is that of its mass and inertia"
            )


def _edge(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    """Whether the curvature of a rod's tip ends before the contact does, or before the touch."""
    striker, lean = scene.striker, math.degrees(0.5 * math.pi - scene.approach.angle)
    if striker.length == 0.0:
        return
    reach = math.degrees(math.asin(min(striker.radius / striker.tip_radius, 1.0)))
    if lean > reach:
        yield (
            f"the rod leans by {lean:.3g} degrees and its round end reaches {reach:.3g} from its "
            "axis: it would touch with its edge, and is taken to be round there"
        )
    if math.isfinite(scene.force.edge):
        return
    ended = repeated(setup, scene.with_(force=replace(scene.force, edge=striker.radius)))
    if abs(ended.restitution / found.restitution - 1.0) > _WORTH_A_LINE:
        yield (
            f"the tip's curvature is taken to go on; ended at the rod's side (impact.finite_tip): "
            f"{effect(ended, found)}"
        )


def _second(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    second = setup.second
    if second is None:
        return
    ball = setup.file.strikers[setup.file.striker]
    yield (
        f"two spheres: R = {scene.pair.R * 1e3:.4g} mm by 1/R = 1/R_1 + 1/R_2, mass "
        f"{scene.striker.mass:.4g} kg; speeds and depths are those of one relative to the other, "
        "spin and a sweep's rebound speeds are the striker's own; the struck sphere is "
        f"{'free' if second.free else 'held'}"
    )
    if turns := second.turned(found.tangential_impulse_Ns):
        yield f"the struck sphere leaves with a spin of {turns:.4g} rad/s"
    if second.free:
        speed = scene.approach.speed
        parted = second.parted(ball.mass_kg.value, speed, found.restitution)
        own, other = (v if abs(v) > _ROUND_OFF * speed else 0.0 for v in parted)
        yield (
            f"along the approach the striker goes on with {own:.4g} m/s, the struck sphere leaves "
            f"with {other:.4g} m/s"
        )
    if scene.approach.speed > first_yield_speed(scene):
        off = float(second.departure(scene.law, scene.pair, found.peak_depth_m))
        yield (
            f"beyond yield two spheres are not quite one of R: off by some {100.0 * off:.2g} % of "
            "the force here, as finite elements have it"
        )
    if second.radius < 0.0:
        a = float(scene.law.contact_radius(scene.pair, found.peak_depth_m))
        yield (
            f"the contact's radius, {a * 1e3:.3g} mm, is {a / ball.tip_radius_m.value:.2g} of the "
            "ball's; a seat is taken as Hertz has it, for contacts that are small beside both"
            f"{': no number here holds' if a > ball.tip_radius_m.value else ''}"
        )


def _mechanisms(setup: Setup, law: ContactLaw, found: Impact) -> Iterator[str]:
    """What each mechanism of the file does to the blow, against the blow with all but it."""
    plain = setup.plain(law)
    idle = setup.asked.idle([plain])
    for name, reason in idle.items():
        yield f"{name} changes nothing here: {reason}"
    for m in setup.acting(plain).mechanisms:
        without = last_blow(setup.with_mechanism(m.name, None), law)
        yield f"{m.name} ({m.title}): {effect(found, without)}"
    met = setup.scene(law).approach.speed
    if found.peak_depth_m > 0.0 and abs(met / plain.approach.speed - 1.0) > _WORTH_A_LINE:
        yield f"it touches with {met:.4g} m/s, in place of {plain.approach.speed:.4g} m/s"


def _bodies(setup: Setup, law: ContactLaw) -> Iterator[str]:
    file = setup.file
    for key, body in file.bodies.items():
        if body.material in materials() and (note := materials()[body.material].note):
            yield f"{body.material}: {note}"
        if body.tabor is not None:
            yield f"{key}: {body.tabor[2]}"
        flows = body.flow_curve or getattr(body, "hardening", None)
        if flows and not follows_flow(law):
            yield f"{law.name} takes the first strength of {key}; hardening follows its curve"
        if not (flows or body.rigid or body.strength or file.target.law == "elastic"):
            yield f"{key}: {unlisted(body.material)}without Sy_Pa it stays elastic"
    name, second = setup.file.striker, file.target
    ball = file.strikers[name]
    yield from _mass(
        f"strikers.{name}", ball.mass_kg, ball.body_radius, ball.density_kg_m3, ball.length
    )
    if second.mass_kg is not None and second.radius_m is not None:
        yield from _mass("target", second.mass_kg, second.radius_m.value, second.density_kg_m3)


def _mass(
    key: str, mass: Quantity, radius: float, density: Quantity | None, length: float = 0.0
) -> Iterator[str]:
    """A mass that is not that of a solid sphere or rod; nothing is said of a seat."""
    if density is None or radius < 0.0:
        return
    off, shape, ends = _MASS_OFF, "sphere of its radius", 0.0
    solid = solid_mass(radius, density.value)
    if length > 0.0:
        # beyond its length the ends have at most a radius each
        off, shape, ends = _ROD_OFF, "rod of its size", 2.0 * radius / length
        solid = density.value * math.pi * radius**2 * length
    if not 1.0 - off < mass.value / solid < (1.0 + ends) * (1.0 + off):
        yield (
            f"{key}: {mass.value:.4g} kg as stated; a solid {shape} and density has {solid:.4g} kg"
            f"{' without its ends' * (ends > 0.0)}"
            f"{'; the contact law takes a shell for solid' * (mass.value < solid)}"
        )


def outside(law: ContactLaw, scene: Scene, found: Impact) -> str:
    """Return which bound of a law's data this pair or depth leaves; empty inside."""
    elastic = demand(scene.pair, found.peak_depth_m).regime == "elastic"
    if elastic or not scene.pair.perfectly_plastic:
        return ""  # Hertz; the law of a flow curve has lines of its own
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", DomainWarning)
        scene.law.warn_outside(scene.pair, found.peak_depth_m)
    return "; ".join(str(one.message) for one in caught)


def _walls(scene: Scene, found: Impact) -> Iterator[str]:
    if climbs(scene) and found.contacts > 1:
        yield (
            f"{found.contacts} touches: the ball leaves its crater sideways, and what it rebounds "
            "with comes from the crater's own wall"
        )


def climbs(scene: Scene) -> bool:
    """Whether a second touch can only be the wall of the ball's own crater."""
    return scene.striker.length == 0.0 and math.isinf(scene.support.mass)


def swept_walls(scene: Scene, swept: Impacts) -> Iterator[str]:
    """Say how many impacts of a sweep met the wall of their own crater."""
    again = swept["contacts"] > 1
    if again.any() and climbs(scene):
        yield (
            f"the rebound of {counted(again.sum(), 'impact')} of the sweep comes from the crater's "
            f"own wall ({', '.join(dict.fromkeys(swept['law'][again]))}): see the column contacts"
        )


_GIVES_BACK = "the law gives back more than it took"


def reason_above_one(scene: Scene, found: Impact) -> str:
    """Say where the energy of a restitution above 1 comes from; empty where it is at most 1."""
    if not found.restitution > _ABOVE_ONE:
        return ""
    before, after = found.kinetic_before_J, found.kinetic_after_J
    beside = before - 0.5 * effective_mass(scene) * scene.approach.speed**2
    if _made_by_the_law(before, after, found.gravity_work_J):
        given = _GIVES_BACK
    elif found.gravity_work_J > beside:
        given = "the fall during the contact feeds the tip's rebound"
    else:
        given = "motion along the flat and spin feed the tip's rebound"
    return (
        f"a restitution of {found.restitution:.4g}: {given}; kinetic energy of the whole "
        f"{before:.3g} J before, {after:.3g} J after"
    )


def swept_above_one(swept: Impacts) -> Iterator[str]:
    """Say of a sweep where the energy of restitutions above 1 comes from, a line for each way."""
    above = swept["restitution"] > _ABOVE_ONE
    made = above & _made_by_the_law(
        swept["kinetic_before_J"], swept["kinetic_after_J"], swept["gravity_work_J"]
    )
    ways = {
        f"{law}: {{}}: {_GIVES_BACK}; it is far beyond what it was made for": made
        & (swept["law"] == law)
        for law in dict.fromkeys(swept["law"][made])
    }
    ways[
        "{}: motion along the flat, spin or a fall during the contact feeds the tip's rebound; "
        "kinetic_before_J and kinetic_after_J in the table hold the whole"
    ] = above & ~made
    for text, rows in ways.items():
        if rows.any():
            yield text.format(
                f"a restitution above 1 of {counted(rows.sum(), 'impact')} of the sweep, up to "
                f"{swept['restitution'][rows].max():.4g}"
            )


def _made_by_the_law(before: Any, after: Any, fall: Any) -> Any:
    """Whether a blow returns more than it had and its fall during the contact [J] gave."""
    return after > (1.0 + 1e-6) * (before + np.maximum(fall, 0.0))
