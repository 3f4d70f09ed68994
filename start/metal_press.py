"""Which presses of a metal by finite elements stand for the impacts of a recording set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .. import fem
from ..core.arrays import Array
from ..core.flow import Flow, Rate, ludwik, tabulated
from ..core.material import Pair
from ..core.rules import RULES as CORE
from ..discrepancy.comparison.problem import Problem
from ..discrepancy.rules import RULES as DIAGNOSIS
from ..dynamics import Scene
from ..dynamics.mechanisms.base import Constants, Mechanism
from ..models.anchored import AnchoredLaw
from .rules import RULES

Clock = tuple[tuple[float, float], ...]
"""Rows of Delta/R and speed [m/s]."""


class MetalPress(NamedTuple):
    """One solve, and the conditions that it is of."""

    problem: fem.ContactProblem
    conditions: tuple[int, ...]


def presses(
    problem: Problem, z: Array, carried: Sequence[Mechanism], constants: Constants, peaks: Array
) -> Iterator[MetalPress]:
    """Yield what to solve: a pair for all its sizes, or every speed where a rate acts."""
    scenes = problem.scenes(z)
    depth = peaks / np.array([s.pair.R for s in scenes])
    if any(m.name == "strain-rate-hardening" for m in carried):
        for k in _ends(problem):
            turns = tuple(float(x * depth[k]) for x in (0.7, 0.85, 1.0))
            clock = _clock(depth[k], scenes[k].approach.speed)
            yield MetalPress(_press(scenes[k], constants, turns, clock), (k,))
        # what is pressed slowly needs no clock
        numbers = [k for k, c in enumerate(problem.conditions) if c.press is not None]
    else:
        numbers = list(range(len(scenes)))
    alike: dict[tuple[object, ...], list[int]] = {}
    for k in numbers:
        alike.setdefault((scenes[k].pair.sphere, scenes[k].pair.flat), []).append(k)
    for these in alike.values():
        low, high = depth[these].min(), depth[these].max()
        turns = tuple(np.geomspace(min(low, 0.3 * high), high, DIAGNOSIS.solve_turns).tolist())
        yield MetalPress(_press(scenes[these[0]], constants, turns, ()), tuple(these))


def _ends(problem: Problem) -> list[int]:
    """Slowest and fastest condition of each striker on fresh metal."""
    found: list[int] = []
    struck = [(k, c) for k, c in enumerate(problem.conditions) if c.press is None]
    for name in dict.fromkeys(c.striker for _, c in struck):
        own = [k for k, c in struck if c.striker == name and c.after < 0]
        own.sort(key=lambda k: problem.conditions[k].speed)
        found += dict.fromkeys([own[0], own[-1]])
    return found


def _clock(depth: float, speed: float) -> Clock:
    """Rows of Delta/R and speed of a striker that a plastic contact stops at a depth."""
    x = np.linspace(0.0, 1.0, 12)
    slowing = np.sqrt(np.maximum(1.0 - x**2, RULES.clock_end**2))
    return tuple((float(a * depth), float(speed * b)) for a, b in zip(x, slowing, strict=True))


def _press(
    scene: Scene, constants: Constants, turns: tuple[float, ...], clock: Clock
) -> fem.ContactProblem:
    known = scene.law.metal(scene.pair) if isinstance(scene.law, AnchoredLaw) else scene.pair
    metal = _flowing(known, scene.pair, constants)
    last = min(RULES.press_deeper * max(turns), CORE.deepest)
    first = min(0.3 * metal.first_yield, 1e-2 * last)
    return fem.ContactProblem(
        pair=metal, depths=fem.geometric_depths(first, last, DIAGNOSIS.solve_depths),
        unload_from=turns, speeds=clock,
    )  # fmt: skip


def _flowing(metal: Pair, stated: Pair, constants: Constants) -> Pair:
    """The metal with the flow law in the body that yields first."""
    weak = "flat" if stated.flat.strength <= stated.sphere.strength else "sphere"
    body = getattr(metal, weak)
    curve = body.flow and body.flow.curve
    rate = None
    if "work-hardening" in constants:
        k = constants["work-hardening"]
        ratio, n = k["hardening_ratio"], k["hardening_exponent"]
        if curve is None:
            curve = ludwik(Sy=body.Sy, K=ratio * body.Sy, n=n)
        else:
            # what is named acts on top of the curve that the set came with
            p = np.array(curve.strain)
            curve = tabulated(p, np.array(curve.stress) * (1.0 + ratio * p**n))
    if "strain-rate-hardening" in constants:
        k = constants["strain-rate-hardening"]
        q = 1.0 / k["rate_exponent"]
        rate = Rate("cowper-symonds", 1000.0 / k["rise_at_1000_per_s"] ** q, q)
    return replace(metal, **{weak: body.with_(flow=Flow(curve=curve, rate=rate))})
