"""Made-up cases and solves for the tests: what is stored of them is what is tried."""

import numpy as np
from dentscope import fem
from dentscope.campaigns import standard_case
from dentscope.core import COMPLETED, Material, Pair
from dentscope.fem import Counters, Curve, Solution
from dentscope.models.table import LoadingCurve, PairTable, Turns, energy_exponent


def case_of(name="one", *, scale=1.0, R=1e-3, Sy=5e8, n_depths=4, **asked):
    """A case of two metals of unlike strengths; all stresses and sizes scaled."""
    sphere = Material(E=200e9 * scale, nu=0.3, Sy=Sy * scale)
    flat = Material(E=100e9 * scale, nu=0.3, Sy=3e8 * scale)
    return standard_case(
        name, Pair(sphere, flat, R), deepest=0.01, n_depths=n_depths,
        accuracy=fem.Accuracy.smoke(), **asked,
    )  # fmt: skip


def solution_of(case, outcome=COMPLETED, *, line=None, **parts):
    """A solve whose columns are all a line from 1 to 2, or what is given; no unloading."""
    line = np.linspace(1.0, 2.0, len(case.depths)) if line is None else line
    curve = Curve(**{**dict.fromkeys(Curve.__dataclass_fields__, line), **parts})
    counters = Counters(**dict.fromkeys(Counters.__dataclass_fields__, 1))
    return Solution(case.problem, case.accuracy, outcome, curve, (), (), counters, "mesh")


def table_of(record, *, error):
    """The table of a stored solve, every number of its loading known to `error`."""
    pair, c = record.case.pair, record.curve
    rows = []
    for u in record.unloadings:
        left = u.residual_sphere + u.residual_flat
        exponent = energy_exponent(u.curve["delta"], u.curve["force"], left)
        rows.append((u.depth, left / (u.depth * pair.R), u.residual_sphere / left, exponent))
    known = np.full(len(c["delta"]), error)
    curve = LoadingCurve(
        c["delta"] / pair.R, c["force"] / (pair.E_reduced * pair.R**2), c["radius"] / pair.R,
        c["sphere"] / (c["sphere"] + c["flat"]), known, known, known,
    )  # fmt: skip
    return PairTable(pair, curve, Turns(*np.array(sorted(rows)).T))
