"""Cost of an impact beside published laws: ratios of one run.

    .venv/bin/python tools/benchmarks/bench_outside.py

Balls of steel straight on a harder flat, each at a speed of its own: our law by work and by steps,
the thesis's law and Jackson and Green's by steps. Processor seconds of one core, the best of three.
Forces alone: bench_impact.py.
"""

from __future__ import annotations

import math

import numpy as np
from bench_impact import FAST, best
from dentscope.core import Material
from dentscope.dynamics import (
    Approach,
    Striker,
    arrays_of,
    impacts,
    scene_of,
    strike_rows,
    tabulated,
)
from dentscope.dynamics.stepping import layout as c
from dentscope.models import LAWS

BALL = Material(E=200e9, nu=0.3, Sy=600e6, density=7800.0)
FLAT = Material(E=210e9, nu=0.3, Sy=1500e6, density=7800.0)
R = 5e-3
MASS = 4.0 / 3.0 * math.pi * R**3 * BALL.density
SLOW, QUICK = 0.5, 4.0


def main() -> None:
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
    base = "fitted, table, by steps"
    print(f"{count:,} impacts")
    for name, seconds in found.items():
        ratio = seconds / found[base]
        print(f"  {name:36s} {seconds:8.3f} s {count / seconds:12,.0f} a second {ratio:7.2f}")
    print(f"  (the last column over {base})")


if __name__ == "__main__":
    main()
