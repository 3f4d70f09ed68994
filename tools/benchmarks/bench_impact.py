"""Speed of the compiled impact integrator, and its agreement with the library's on many impacts.

python tools/benchmarks/bench_impact.py [rates]    the marks: steps, work and table, beside Hertz
python tools/benchmarks/bench_impact.py agree 1000 largest difference to the reference integrator
python tools/benchmarks/bench_impact.py agree 1000 300 the same from number 300 on
"""

from __future__ import annotations

import math
import runpy
import sys
import time
import timeit
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from dentscope.core import Material
from dentscope.dynamics import (
    Approach,
    Friction,
    Impact,
    Scene,
    Settings,
    Striker,
    arrays_of,
    impacts,
    rod_modes,
    scene_of,
    strike,
    strike_rows,
    tabulated,
)
from dentscope.dynamics.stepping import layout as c
from dentscope.dynamics.tabulated.energy_route import energy_impacts
from dentscope.models import LAWS
from dentscope.studies.oracle import oracle_impact

STEEL = Material(E=200e9, nu=0.3, Sy=760e6, density=7800.0)
IRON = Material(E=200e9, nu=0.3, Sy=305e6, density=7870.0)
ROD = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, radius=0.0088)
FAST = Settings(tolerance=1e-7)
EXACT = Settings(tolerance=3e-13)
ROOT = Path(__file__).parents[2]
# what the tests draw imports as they do
sys.path.insert(0, str(ROOT / "tests/faults"))
DRAWN = runpy.run_path(str(ROOT / "tests/contract/test_impact_integrators.py"))


def thesis_scene(law: str, angle: float, *, modes: int) -> Scene:
    return scene_of(
        LAWS[law], sphere=STEEL, flat=IRON, striker=ROD, friction=Friction(0.13),
        approach=Approach(1.0, math.radians(angle)),
        modes=rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=modes),
    )  # fmt: skip


def rates() -> None:
    """What is asked for, each figure the best of three, processor time of one core."""
    print("impacts a second, 0.5-4 m/s, by steps: tolerance 1e-7, with modes 1e-6; by work: 1e-7")
    laws = {"hertz": LAWS["hertz"], "fitted": LAWS["fitted"], "table": tabulated(LAWS["fitted"])}
    for angle, modes, count, mark in (
        (90.0, 0, 20_000, 100_000), (45.0, 0, 20_000, 50_000),
        (90.0, 20, 2_000, 10_000), (45.0, 20, 1_000, 4_000),
    ):  # fmt: skip
        found = []
        for name, law in laws.items():
            scene = thesis_scene("hertz", angle, modes=modes).with_(law=law)
            settings = FAST if modes == 0 else Settings(tolerance=1e-6)
            body = np.tile(arrays_of(scene, settings).body, (count, 1))
            body[:, c.V_Y] = -np.linspace(0.5, 4.0, count)
            strike_rows(scene, body[:2], settings)
            seconds = best(lambda s=scene, b=body, t=settings: strike_rows(s, b, t))
            found.append(f"{name} {count / seconds:8.0f}")
        print(f"  {angle:3.0f} degrees, {modes:2d} modes: {', '.join(found)}  (mark {mark})")
    speeds = np.random.default_rng(1).uniform(0.5, 4.0, 500_000)
    mass = np.full(len(speeds), ROD.mass)
    for name in ("hertz", "fitted"):
        scene = thesis_scene(name, 90.0, modes=0)
        energy_impacts(scene.law, scene.pair, mass[:2], speeds[:2], gravity=9.81)
        seconds = best(
            lambda s=scene: energy_impacts(s.law, s.pair, mass, speeds, gravity=s.gravity)
        )
        rows = best(lambda s=scene: impacts(s, speeds=speeds))
        print(
            f"  by work, {name}: {len(speeds) / seconds:9.0f}  (mark 3000000), "
            f"with all columns {len(speeds) / rows:9.0f}"
        )
    pair = thesis_scene("fitted", 90.0, modes=0).pair
    depth = pair.R * 10.0 ** np.random.default_rng(2).uniform(-6.0, -1.0, 1_000_000)
    for name, law in (laws | {"jackson-green": LAWS["jackson-green"]}).items():
        law.loading(pair, depth[:2])
        print(f"  a million forces, {name}: {best(lambda x=law: x.loading(pair, depth)):.4f} s")
    print("  (mark of the table 0.02 s)")


def best(run: Callable[[], object]) -> float:
    """Shortest processor time of three runs [s]."""
    return min(timeit.repeat(run, timer=time.process_time, number=1, repeat=3))


def random_scene(rng: np.random.Generator, number: int) -> Scene:
    """That of the test, by each law in turn; every fourth contact gives way sideways."""
    scene: Scene = DRAWN["random_scene"](rng, number)
    stiffness = 0.82 if number % 4 == 3 else math.inf
    return scene.with_(
        law=list(LAWS.values())[number % len(LAWS)],
        friction=replace(scene.friction, stiffness=stiffness),
    )


def differences(scene: Scene, ours: Impact, theirs: Impact) -> dict[str, float]:
    """Differences relative to the observable, or to the impact's own scale if that is larger."""
    if ours.contacts != theirs.contacts or not theirs.outcome.completed:
        return {f"contacts: {ours.contacts} and {theirs.contacts}": math.inf}
    m, v = scene.striker.mass, max(scene.approach.speed, abs(scene.approach.tangential))
    found = {}
    for name, value in ours.observables.items():
        other = theirs.observables[name]
        if name.endswith("residual") or (math.isnan(value) and math.isnan(other)):
            continue
        scale = {"J": 0.5 * m * v * v, "Ns": m * v, "m": ours.peak_depth_m}.get(
            name.rsplit("_", 1)[-1], 1.0 if "restitution" in name or "ratio" in name else 0.0
        )
        scale = v if name.endswith("m_s") else scale
        if name == "rebound_spin_rad_s":
            scale = v * math.sqrt(m / scene.striker.inertia)
        found[name] = abs(value - other) / max(abs(value), abs(other), scale, 1e-300)
    return found


def agree(count: int, first: int = 0) -> None:
    """Largest differences of many random impacts."""
    rng = np.random.default_rng(2024)
    worst: dict[str, float] = {}
    beyond = []
    for number in range(count):
        scene = random_scene(rng, number)
        if number < first:
            continue
        ours = strike(scene, EXACT)
        while ours.peak_depth_m > 0.5 * scene.striker.tip_radius:
            # no law reaches so deep: the same impact at a lower speed
            slower = replace(scene.approach, speed=0.5 * scene.approach.speed)
            scene = scene.with_(approach=slower)
            ours = strike(scene, EXACT)
        found = differences(scene, ours, oracle_impact(scene))
        if max(found.values()) > 1e-8:
            # where the outcome hangs on small things the reference is made as exact as it can be
            found = differences(scene, ours, oracle_impact(scene, tolerance=1e-13))
        for name, off in found.items():
            worst[name] = max(worst.get(name, 0.0), off)
        off, name = max((off, name) for name, off in found.items())
        if off > 1e-8:
            where = f"{scene.law.name}, {ours.contacts} contacts"
            beyond.append(f"{number}: {off:.1e} in {name} ({where})")
            print(f"  {beyond[-1]}", flush=True)
        if number % 100 == 99:
            print(f"  {number + 1} done, {len(beyond)} beyond 1e-8", flush=True)
    print(f"{count - first} random impacts, largest difference of the two integrators:")
    print(f"  {count - first - len(beyond)} agree to 1e-8 in every observable")
    for name, off in sorted(worst.items(), key=lambda item: -item[1]):
        print(f"  {name:28s} {off:.1e}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["agree"]:
        agree(*map(int, sys.argv[2:]))
    else:
        rates()
