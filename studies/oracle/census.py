"""Random impacts by the walk, judged by their balances: python -m dentscope.studies.oracle.census.

Balls and rods of 10 to 600 mm, rigid, with axial and with bending modes, 10 to 90 degrees, friction
0 to 0.5, 0.05 to 20 m/s, on rigid, sprung and radiating flats. For each it counts: a striker that
is below the surface or moves into it at the end, a balance of energy or momentum that does not
close, a contact that returns more than it took, more energy out than in, a restitution above 1
where it is one of energy, and in the history depth without force.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ...core.material import Material
from ...dynamics import (
    Approach,
    ForceTransform,
    Friction,
    Impact,
    Modes,
    Scene,
    Settings,
    Striker,
    Support,
    Trace,
    rod_modes,
    scene_of,
    traced,
)
from ...dynamics.support import half_space_radiation
from ...models import LAWS

ACCURACY = Settings(tolerance=1e-8)
BALANCE = 1e-6
HIDDEN = 1e-9
"""Depth without force [m] that counts."""
DEEPEST = 0.3
"""Depth over tip radius beyond which no law reaches; such an impact is made at half the speed."""


def random_scene(rng: np.random.Generator) -> Scene:
    """Draw one impact."""
    is_rod = rng.random() < 0.7
    length = float(np.exp(rng.uniform(math.log(0.01), math.log(0.6))))
    radius = length * float(np.exp(rng.uniform(math.log(1 / 60), math.log(1 / 8)))) if is_rod \
        else 0.5 * length  # fmt: skip
    sphere = Material(E=float(rng.uniform(60e9, 210e9)), nu=0.3, density=7800.0,
                      Sy=float(np.exp(rng.uniform(math.log(3e8), math.log(2e9)))))  # fmt: skip
    flat = Material(E=float(rng.uniform(60e9, 210e9)), nu=0.3, density=7800.0,
                    Sy=float(np.exp(rng.uniform(math.log(1e8), math.log(2e9)))))  # fmt: skip
    volume = math.pi * radius**2 * length if is_rod else 4.0 / 3.0 * math.pi * radius**3
    striker = Striker(mass=7800.0 * volume, tip_radius=radius, radius=radius,
                      length=length if is_rod else 0.0)  # fmt: skip
    angle = math.radians(rng.uniform(10.0, 90.0)) if is_rod else math.pi / 2.0
    speed = float(np.exp(rng.uniform(math.log(0.05), math.log(20.0))))
    along = 0.0 if is_rod else speed / math.tan(math.radians(rng.uniform(10.0, 90.0)))
    scene = scene_of(
        LAWS["fitted"], sphere=sphere, flat=flat, striker=striker,
        approach=Approach(speed, angle, tangential=along),
        friction=Friction(float(rng.choice([0.0, rng.uniform(0.0, 0.5)]))),
    )  # fmt: skip
    if is_rod:
        scene = scene.with_(modes=_modes(rng, striker, sphere))
    kind = rng.integers(3)
    if kind == 1:
        mass = striker.mass * float(np.exp(rng.uniform(0.0, math.log(100.0))))
        stiffness = float(np.exp(rng.uniform(math.log(1e6), math.log(1e9))))
        damping = 0.04 * math.sqrt(stiffness * mass)
        scene = scene.with_(support=Support(mass, stiffness, damping))
    if kind == 2:
        scene = scene.with_(force=ForceTransform(radiation=half_space_radiation(flat)))
    return scene


def _modes(rng: np.random.Generator, striker: Striker, material: Material) -> Modes:
    kind, count = rng.integers(3), int(rng.integers(2, 16))
    if kind == 0:
        return Modes()
    all_modes = rod_modes(
        striker.length, striker.radius, material, mass=striker.mass, count=count,
        loss_factor=float(rng.choice([0.0, 0.01])),
    )  # fmt: skip
    if kind == 2:
        return all_modes
    keep = [i for i, a in enumerate(all_modes.axial) if a != 0.0]
    return Modes(
        tuple(all_modes.frequencies[i] for i in keep), tuple(all_modes.axial[i] for i in keep),
        (0.0,) * len(keep), (0.0,) * len(keep), all_modes.loss_factor,
    )  # fmt: skip


@dataclass(slots=True)
class Count:
    """What was found in a census."""

    impacts: int = 0
    failures: dict[str, list[str]] = field(default_factory=dict)
    worst: dict[str, float] = field(default_factory=dict)
    contacts: dict[int, int] = field(default_factory=dict)
    turned: dict[str, list[str]] = field(default_factory=dict)

    def note(self, kind: str, number: int, value: float) -> None:
        """Enter one failure."""
        self.failures.setdefault(kind, []).append(f"{number} ({value:.3g})")

    def largest(self, name: str, value: float) -> None:
        """Keep the largest of a residual."""
        self.worst[name] = max(self.worst.get(name, 0.0), value)


def hidden_depth(trace: Trace) -> float:
    """Largest depth below the remembered surface at which no force acts [m]."""
    without = trace.column("normal_force_N") == 0.0
    gap = trace.column("clearance_m")[without]
    return float(max(-gap.min(initial=0.0), 0.0))


def judge(number: int, scene: Scene, trace: Trace, count: Count) -> None:
    """Enter what one impact shows."""
    impact = trace.impact
    count.impacts += 1
    count.contacts[impact.contacts] = count.contacts.get(impact.contacts, 0) + 1
    if not impact.outcome.completed:
        count.note(f"unfinished: {impact.outcome.message}", number, impact.contacts)
        return
    count.largest("energy", abs(impact.energy_residual))
    count.largest("momentum", impact.momentum_residual)
    count.largest("angular momentum", impact.angular_residual)
    if abs(impact.energy_residual) > BALANCE:
        count.note("energy does not close", number, impact.energy_residual)
    if max(impact.momentum_residual, impact.angular_residual) > BALANCE:
        count.note("momentum does not close", number, impact.momentum_residual)
    if impact.clearance_m < -HIDDEN:
        count.note("ends below the surface", number, impact.clearance_m)
    if impact.clearance_rate_m_s < 0.0 or impact.restitution < 0.0:
        count.note("ends moving into the surface", number, impact.restitution)
    if impact.energetic_restitution > 1.0 + BALANCE:
        count.note("contact returns more than it took", number, impact.energetic_restitution)
    if gains(impact) > BALANCE:
        count.note("gains energy", number, gains(impact))
    if excess(scene, impact) > BALANCE:
        count.note("restitution above 1", number, impact.restitution)
    elif impact.restitution > 1.0 + BALANCE:
        count.turned.setdefault(turned_by(scene), []).append(f"{number} ({impact.restitution:.6f})")
        count.largest("energetic restitution of those above 1", impact.energetic_restitution)
        count.largest("share of the energy kept by those above 1", 1.0 + gains(impact))
    if scene.force.radiation == 0.0:
        hidden = hidden_depth(trace)
        count.largest("depth without force [m]", hidden)
        if hidden > HIDDEN:
            count.note("depth without force", number, hidden)


def excess(scene: Scene, impact: Impact) -> float:
    """By how much e^2 is above 1 and gravity's work, where rebound over approach measures energy.

    A push turns a leaning rod, and the wall of its crater throws a grazing ball upwards: either
    may leave faster than it came, though its contact returns less than it took and energy is lost
    (Stronge, Impact Mechanics, Cambridge 2000, chapter 3).
    """
    upright = scene.striker.length == 0.0 or scene.approach.angle > 0.5 * math.pi - 1e-9
    if not upright or impact.contacts > 1:
        return 0.0
    approach = 0.5 * scene.striker.mass * scene.approach.speed**2
    return impact.restitution**2 - 1.0 - impact.gravity_work_J / approach


def turned_by(scene: Scene) -> str:
    """Why a point may leave faster than it came though energy is lost."""
    if scene.striker.length > 0.0 and scene.approach.angle < 0.5 * math.pi - 1e-9:
        return "leaning rods, whose tip the push turns up"
    if scene.approach.tangential != 0.0:
        return "balls that the wall of their crater throws up out of their sliding"
    return "several touches"


def gains(impact: Impact) -> float:
    """Share of the kinetic energy by which the striker leaves with more than it came with."""
    kept = impact.kinetic_after_J + impact.modal_energy_J + impact.support_energy_J
    came = impact.kinetic_before_J + impact.gravity_work_J
    return (kept - came) / impact.kinetic_before_J


def census(count: int, seed: int, *, first: int = 0) -> Count:
    """Count what goes wrong in `count` random impacts."""
    found = Count()
    for number in range(first, first + count):
        rng = np.random.default_rng([seed, number])
        scene = random_scene(rng)
        trace = traced(scene, ACCURACY, points=60)
        while trace.impact.peak_depth_m > DEEPEST * scene.striker.tip_radius:
            a = scene.approach
            slower = replace(a, speed=0.5 * a.speed, tangential=0.5 * a.tangential)
            scene = scene.with_(approach=slower)
            trace = traced(scene, ACCURACY, points=60)
        judge(number, scene, trace, found)
    return found


def told(found: Count) -> str:
    """Return the count in words."""
    lines = [f"{found.impacts} impacts; contacts: {dict(sorted(found.contacts.items()))}"]
    lines += [f"  largest residual, {name}: {x:.1e}" for name, x in sorted(found.worst.items())]
    for why, members in sorted(found.turned.items()):
        lines.append(
            f"  restitution above 1, losing energy, {why}: {len(members)}; "
            f"first {', '.join(members[:4])}"
        )
    for kind, members in sorted(found.failures.items()):
        lines.append(f"  {kind}: {len(members)}; first {', '.join(members[:4])}")
    return "\n".join(lines)


def main(arguments: NDArray[np.str_] | list[str]) -> None:
    """Run a census of the stated size, seed and first number."""
    size, seed, first = (int(x) for x in [*arguments, *("1000", "1", "0")[len(arguments) :]])
    sys.stdout.write(told(census(size, seed, first=first)) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
