"""All readings of one observable off by one factor: its definition, or how it was calibrated.

What is in the contact shows in all that is measured of it, and differently at every speed. A factor
on one observable alone, the same throughout, is of the instrument, or of what its number means.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...core.observables import OBSERVABLES
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..rules import RULES


class Scaled(NamedTuple):
    """One observable with a factor of its own.

    Parameters
    ----------
    observable
        Which.
    factor
        Likeliest factor on what everything else says.
    gain
        Ln evidence over the baseline.
    """

    observable: str
    factor: float
    gain: float

    @property
    def told(self) -> str:
        """The finding as a clause."""
        return (
            f"all readings of {OBSERVABLES[self.observable].label} are {self.factor:.3g} times "
            "what everything else says: a definition or a calibration would do that"
        )


def scaled_observables(problem: Problem, base: Fit) -> tuple[Scaled, ...]:
    """Return what a factor on each observable would explain, the most first.

    Of a set with one observable, or of few numbers, nothing: it could be anything.
    """
    cells, found = problem.cells, []
    names = tuple(dict.fromkeys(cells.observable))
    for name in names if len(names) > 1 else ():
        here = np.array([o == name for o in cells.observable])
        if here.sum() < RULES.scaled_cells:
            continue
        # of a logarithm the factor's own, of a number in parts of itself
        shape = np.where(here, np.where(cells.is_log, 1.0, cells.value), 0.0)
        column = RULES.scaled * shape
        extra = np.outer(column, column)
        parts = tuple(replace(p, noise=p.noise + extra) for p in base.mixture.parts)
        mixture = replace(base.mixture, parts=parts)
        r = base.residual
        gain = float(mixture.log_likelihood(r) - base.mixture.log_likelihood(r))
        moved = RULES.scaled * float(column @ mixture.likeliest(r).solve(r))
        log = bool(cells.is_log[here][0])
        # the readings' own part: a value that is 1.4 times too large has 0.29 of itself too much
        factor = math.exp(moved) if log else 1.0 / max(1.0 - moved, 0.1)
        found.append(Scaled(name, factor, gain))
    return tuple(sorted(found, key=lambda s: -s.gain))


__all__ = ["Scaled", "scaled_observables"]
