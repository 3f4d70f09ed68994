"""Units mistaken: a number of the sheet, or all readings of an observable, off by powers of ten."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...core.arrays import Array
from ..unknowns.wrong_number import NEAR_UNIT, WrongNumber
from .forward import Point, Simulator
from .problem import Problem

# limit: powers of ten of a unit [-]: um for m in readings
_POWERS = np.array([*range(-6, 0), *range(1, 7)])
# limit: and of numbers [-]: g or N for kg; heights go as the square of the speed; less is no more
# than any wrong number is off
_OF_KIND: Mapping[str, tuple[float, ...]] = {
    "mass": (-3, -1, 1, 3), "radius": (-1, 1), "strength": (-1, 1), "modulus": (-1, 1),
    "speed": (-1.5, -1, 1, 1.5),
}  # fmt: skip
# limit: misfit from which units are looked for [-], and how much of it the right one leaves; share
# of the readings that another unit has to explain, since some are stray; most that one counts;
# deviations of the noise above which a prediction is seen
_FAR, _LEFT, _MOST, _STRAY, _SEEN = math.log(1.6), 0.35, 0.7, 10.0, 3.0


def with_units(simulator: Simulator) -> Problem:
    """Return the problem with what no stated uncertainty, but a power of ten, explains.

    `misread` names it. A reading that is too small by it would lie below its own noise and say
    nothing: the noise is in the same unit.
    """
    problem, cells = simulator.problem, simulator.problem.cells
    off = _off(simulator)
    here = {name: np.array(cells.observable) == name for name in dict.fromkeys(cells.observable)}

    def misfit(off: Array) -> float:
        most = np.minimum(np.abs(off), _STRAY)
        return float(max(np.mean(most[some]) for some in here.values()))

    if not misfit(off) > _FAR:
        return problem
    numbers = {
        (number.key, 10.0**power): misfit(_off(simulator, number, times=10.0**power))
        for number in problem.wrong_numbers
        if number.of_rig and problem.by_density.get(number.key, True)
        for power in _OF_KIND.get(number.kind, ())
    }  # fmt: skip
    best = min(numbers, key=lambda x: numbers[x], default=("", 1.0))
    misread, read_right = {}, off.copy()
    for name, some in here.items():
        near = np.abs(off[some, None] - _POWERS * math.log(10.0)) < math.log(NEAR_UNIT)
        if near.mean(axis=0).max() > _MOST:
            power = float(_POWERS[int(near.mean(axis=0).argmax())])
            misread[name] = 10.0**power
            read_right[some] -= power * math.log(10.0)
    if numbers.get(best, math.inf) < min(_LEFT * misfit(off), misfit(read_right)):
        return replace(problem, misread=dict([best]))
    less = [min(misread.get(name, 1.0), 1.0) for name in cells.observable]
    return replace(problem, misread=misread, cells=replace(cells, std=cells.std * np.array(less)))


def _off(simulator: Simulator, *of: WrongNumber, times: float = 1.0) -> Array:
    """Ln of readings over what is predicted with the stated numbers, some of them multiplied.

    0 where a ratio says nothing: of unlike signs, or of what is predicted within the noise.
    """
    cells, at = simulator.problem.cells, {n.name: {n.parameters[0].name: times} for n in of}
    there = simulator.predict(of, [Point(np.zeros(simulator.problem.n_z), at)])[0]
    seen = (np.sign(cells.value) == np.sign(there)) & (np.abs(there) > _SEEN * cells.std)
    ratio = np.log(np.divide(cells.value, there, out=np.ones_like(there), where=seen))
    return np.asarray(np.where(cells.is_log, cells.value - there, ratio))
