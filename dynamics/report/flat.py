"""What is said of a flat and of a rod: thickness, how either bends, waves that run off."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.material import Material
from ...core.rig import value_of
from ..mechanisms.base import Surroundings
from ..mechanisms.half_space_waves import HalfSpaceWaves
from ..result import Impact
from ..scene import Scene
from ..support import plate_support
from .band import repeated
from .effect import ATOM, effect
from .flow import Lack
from .onset import effective_mass

if TYPE_CHECKING:
    from ..files.setup import Setup

FREE_PLATE = "with nothing behind the plate and its edges far, waves in it take energy"
"""What a plate without a stated support might be."""

_THICK = 8.0
"""Thickness over the depth of a dent that counts as thick [-] (ISO 6506-1, 6.3)."""

# limit: deflection of a plate over its thickness up to which it bends alone [-]
_SMALL = 0.5


def flat_checks(
    setup: Setup, scene: Scene, found: Impact, lacks: Mapping[str, Lack]
) -> Iterator[str]:
    """Yield what is to be said of the flat of a blow."""
    yield from _plate(setup, scene, found)
    yield from bending(setup, scene, found)
    yield from _rod_bending(scene, found)
    yield from _struck_rod(setup, scene, found)
    yield from _waves(setup, scene, found, lacks)


def _plate(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    thickness = setup.file.target.thickness_m
    if thickness is None:
        return
    h = thickness.value
    dent, into, pair = found.residual_flat_m, found.peak_depth_m, scene.pair
    if math.isnan(pair.Sy_ratio):
        into *= 1.0 - pair.elastic_share
    elif pair.Sy_ratio <= 1.0:
        into = dent
    if into >= h:
        yield (
            f"the approach, {into * 1e3:.3g} mm of it into the flat, is more than that is thick, "
            f"{h * 1e3:.3g} mm: it would be pierced, and no number here holds"
        )
    a = float(scene.law.contact_radius(scene.pair, found.peak_depth_m))
    if dent > ATOM:
        # the standard's dents are wider than 0.24 of the ball, and 8 of their depths than a radius
        enough = "thick" if h >= max(_THICK * dent, a) else "NOT thick"
        yield (
            f"the flat, {h * 1e3:.3g} mm, is {enough} enough for the dent: {_THICK:g} times "
            f"its depth is {_THICK * dent * 1e3:.2g} mm (ISO 6506-1), the contact's radius "
            f"{a * 1e3:.2g} mm"
        )
    elif a > 0.0:
        yield f"the flat, {h * 1e3:.3g} mm, is {h / a:.3g} times the contact radius thick"


def bending(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    """Yield how far a plate gives way, and the stress that bends it, beside its strength.

    Under a force on an endless plate the moment at the radius r is (1 + nu) F/(8 pi) (ln(4 c T/r^2)
    - 1.83), c^2 = D/(rho h), for a half-sine of force of the duration T at its peak (from the
    plate's response to an impulse, Boussinesq); of a small contact r is Westergaard's, 0.325 h.
    """
    flat, h = scene.pair.flat, value_of(setup.file.target.thickness_m)
    if not (scene.support.plate_mobility > 0.0 and h > 0.0) or setup.file.impact.support == "rod":
        return
    impulse = effective_mass(scene) * scene.approach.speed * (1.0 + found.restitution)
    moved = plate_support(flat, thickness=h).plate_mobility * impulse / h
    if moved > _SMALL:
        yield (
            f"the plate gives way by {moved:.2g} of its thickness: beyond {_SMALL:g} it stiffens "
            "as a membrane (Timoshenko and Woinowsky-Krieger), which is not in this"
        )
    a = float(scene.law.contact_radius(scene.pair, found.peak_depth_m))
    r = math.hypot(math.sqrt(1.6) * a, h) - 0.675 * h
    c = h * math.sqrt(flat.plane_strain_modulus / (12.0 * flat.density))
    turns = math.log(8.0 * c * found.loading_time_s / r**2) - 1.83
    stress = 6.0 / h**2 * (1.0 + flat.nu) * found.peak_force_N / (8.0 * math.pi) * turns
    if stress > 0.0:
        yield f"the plate's lower face is bent by some {stress / 1e6:.2g} MPa{_over(stress, flat)}"


def _rod_bending(scene: Scene, found: Impact) -> Iterator[str]:
    """Yield the stress that bends a leaning rod, beside its strength.

    By a force F across its end for a time T: 4/27 F L of a rigid rod, at most 0.53 F (a T)^(1/2)
    before a wave is along it (a half-sine on a free beam, by its modes), a^2 = E I/(rho A).
    """
    striker, rod, lean = scene.striker, scene.pair.sphere, scene.approach.angle
    if striker.length == 0.0 or rod.rigid or math.isnan(rod.density) or math.cos(lean) < 1e-9:
        return
    across = found.peak_force_N * (math.cos(lean) + scene.friction.mu * math.sin(lean))
    a = 0.5 * striker.radius * math.sqrt(rod.E / rod.density)
    arm = min(4.0 / 27.0 * striker.length, 0.53 * math.sqrt(2.0 * a * found.loading_time_s))
    stress = 4.0 * across * arm / (math.pi * striker.radius**3)
    yield f"the rod is bent by up to {stress / 1e6:.2g} MPa{_over(stress, rod)}"


def _over(stress: float, body: Material) -> str:
    if not stress > body.Sy:
        return ""
    return f", more than its strength, {body.Sy / 1e6:.3g} MPa: it bends for good or breaks"


def _struck_rod(setup: Setup, scene: Scene, found: Impact) -> Iterator[str]:
    radius, flat = setup.file.impact.support_radius_m, scene.pair.flat
    if setup.file.impact.support != "rod":
        return
    reach = 0.5 * math.sqrt(flat.E / flat.density) * found.contact_time_s
    a = float(scene.law.contact_radius(scene.pair, found.peak_depth_m))
    yield (
        f"the struck rod is without end: one of less than {reach:.3g} m throws waves back within "
        f"the contact, whose radius is {a / radius:.2g} of the rod's"
    )


def with_waves(setup: Setup, scene: Scene) -> Impact | None:
    """The blow with waves into a plate of the flat's thickness, else a half-space."""
    flat, support = scene.pair.flat, setup.file.impact.support
    other = support not in ("rigid", "plate") or setup.second is not None
    if _asked(setup) or other or flat.rigid or math.isnan(flat.density):
        return None
    # Zener's plate is the thin one; this one has its thickness
    without = scene.with_(support=replace(scene.support, plate_mobility=0.0))
    thick = Surroundings(thickness=value_of(setup.file.target.thickness_m))
    return repeated(setup, HalfSpaceWaves().attach(without, {"wave_scale": 1.0}, thick))


def _asked(setup: Setup) -> bool:
    return any(m.name == "half-space-waves" for m in setup.asked.mechanisms)


def _waves(setup: Setup, scene: Scene, found: Impact, lacks: Mapping[str, Lack]) -> Iterator[str]:
    if setup.file.target.thickness_m and _asked(setup) and math.isfinite(scene.support.mass):
        yield "half-space-waves: the flat moves as a block on its support, and does not bend"
    if "plate" in lacks:
        yield lacks["plate"].told(found)
    elif (waves := with_waves(setup, scene)) is not None:
        where = "waves into a deep flat"
        if setup.file.impact.support == "plate":
            where = "with waves across its thickness too (mechanisms.half-space-waves)"
        elif setup.file.target.thickness_m:
            where = FREE_PLATE
        yield f"{where}: {effect(waves, found)}"
