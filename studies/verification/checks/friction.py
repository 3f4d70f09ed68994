"""Friction: elastic contact in which nothing slides, and what leaving friction out costs."""

from __future__ import annotations

import math
from dataclasses import replace

from scipy.integrate import quad

from .... import fem
from ....campaigns.case import Case
from ....core.material import Material, Pair
from ..bench import Bench, Effort, Solved
from ..pairs import RIGID, R
from ..result import Cell, Measurement, Result, Table

_STUCK = 20.0
_SOURCE = "Borodich and Keer, Proc. R. Soc. A 460 (2004) 507"
_JUDGED = 6e-5  # Delta/R: the first equilibrium slides freely and is forgotten by then
_COEFFICIENTS = (0.1, 0.3)
_STRENGTHS = ((1000e6, 500e6), (500e6, 500e6), (500e6, 1000e6))
_DEEPEST = 0.04


def run(bench: Bench) -> Result:
    """Compare full stick with its exact solution; solve three pairs with and without friction."""
    quick = bench.effort is Effort.QUICK
    accuracy = fem.Accuracy.quick() if quick else fem.Accuracy.production()
    measurements = [m for nu in (0.0, 0.3) for m in _stuck(bench, nu, accuracy)]
    rows = [row for pair in _STRENGTHS for row in _effect(bench, *pair)]
    return Result(
        title="Friction between the bodies",
        about=(
            "A rigid sphere on an elastic flat, mu = 20, against none: where nothing slides, a^2 "
            "is smaller by I = 2 int_0^1 t cos(beta ln((1 - t)/(1 + t))) dt, beta = ln(3 - 4 "
            "nu)/(2 pi), and F larger by (1 - nu) ln(3 - 4 nu)/(1 - 2 nu) sqrt(I). Then three "
            f"pairs of E = 200 GPa, nu = 0.3 at level `quick`, to Delta/R = {_DEEPEST}."
        ),
        measurements=tuple(measurements),
        tables=(
            Table(
                "What friction adds to the frictionless result",
                (
                    "Sy sphere, flat [MPa]", "mu", "Delta/R", "F", "a", "share",
                    "dent of the sphere", "dent of the flat",
                ),
                tuple(rows),
            ),
        ),
        notes=(
            "Bodies of equal elastic constants do not slide on each other before they yield. Dents "
            "are the residual depths of each body after unloading, at the last depth.",
        ),
    )  # fmt: skip


def stuck_ratios(nu: float) -> tuple[float, float]:
    """F and a at one depth over those without friction, where nothing slides."""
    beta = math.log(3.0 - 4.0 * nu) / (2.0 * math.pi)
    area, _ = quad(lambda t: 2.0 * t * math.cos(beta * math.log((1.0 - t) / (1.0 + t))), 0.0, 1.0)
    stiffer = (1.0 - nu) * math.log(3.0 - 4.0 * nu) / (1.0 - 2.0 * nu)
    return stiffer * math.sqrt(area), math.sqrt(area)


def _stuck(bench: Bench, nu: float, accuracy: fem.Accuracy) -> list[Measurement]:
    pair = Pair(RIGID, Material(E=200e9, nu=nu), R)
    problem = fem.ContactProblem(pair, fem.geometric_depths(1e-5, 2e-4, 24))
    free, held = (
        bench.solve(Case(f"stuck-{nu:g}-{mu:g}", replace(problem, friction=mu), accuracy))
        for mu in (0.0, _STUCK)
    )
    judged = free["delta"] / R > _JUDGED
    found = []
    for name, exact in zip(("force", "radius"), stuck_ratios(nu), strict=True):
        ratio = float((held[name] / free[name])[judged].mean())
        what = f"nu = {nu:g}, nothing slides: {name} over that without friction ({exact:.4f})"
        off = 100.0 * (ratio / exact - 1.0)
        found.append(Measurement(what, off, "%", -0.5, 0.5, _SOURCE))
    return found


def _effect(bench: Bench, sphere: float, flat: float) -> list[tuple[Cell, ...]]:
    pair = Pair(Material(200e9, 0.3, sphere), Material(200e9, 0.3, flat), R)
    first = 0.3 * pair.first_yield
    problem = fem.ContactProblem(
        pair, fem.geometric_depths(first, _DEEPEST, 24), unload_from=(_DEEPEST,)
    )
    name = f"rubbed-{sphere / 1e6:.0f}-{flat / 1e6:.0f}"
    free, *rubbed = (
        bench.solve(Case(f"{name}-{mu:g}", replace(problem, friction=mu), fem.Accuracy.quick()))
        for mu in (0.0, *_COEFFICIENTS)
    )
    return [
        _row(f"{sphere / 1e6:.0f}, {flat / 1e6:.0f}", mu, k, free, with_mu)
        for mu, with_mu in zip(_COEFFICIENTS, rubbed, strict=True)
        for k in (11, 23)
    ]


def _row(pair: str, mu: float, k: int, free: Solved, rubbed: Solved) -> tuple[Cell, ...]:
    def change(name: str) -> str:
        return f"{100.0 * float(rubbed[name][k] / free[name][k] - 1.0):+.2f} %"

    dents = ["", ""]
    if k == len(free["delta"]) - 1:
        was, now = free.unloadings[0], rubbed.unloadings[0]
        whole = was.residual_sphere + was.residual_flat
        dents = [
            f"{100.0 * (getattr(now, part) - getattr(was, part)) / whole:+.2f} % of both"
            for part in ("residual_sphere", "residual_flat")
        ]
    share = f"{float(rubbed.share[k] - free.share[k]):+.4f}"
    depth = f"{float(free['delta'][k] / R):.4f}"
    return (pair, mu, depth, change("force"), change("radius"), share, *dents)
