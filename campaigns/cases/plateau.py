"""Cases drawn over metals whose flow curve bends: plateaus, knees, saturation, upper yield points.

A plateau of 1 to 4 % strain is what hot-rolled and annealed steels have, its end the Lueders
strain; a knee what quenched, cold-drawn and austenitic ones have. Half of the curves have a
plateau, a tenth an upper yield point before it. What follows is Swift's law, by its ratio to the
plateau a strain of 0.2 later. All are tables, as a measured curve is.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from ...core.arrays import Array
from ...core.flow import Flow, FlowCurve, tabulated
from ...core.material import Material, Pair
from ..case import Case
from .pairs import deep_case, digits, sobol, two_metals

_YIELD_STRAINS = (4e-4, 4e-3)
_RATIOS = (0.1, 10.0)  # Sy*
_AFTER = 0.2  # plastic strain past the plateau at which its ratio is taken
_LAST, _ROWS = 2.0, 24

# plastic strain, true stress [MPa]
ASTM_1016 = (
    (0.0, 330.0), (0.001, 364.5), (0.002, 373.4), (0.005, 375.1), (0.01, 378.9), (0.0175, 392.0),
    (0.03, 439.2), (0.05, 488.0), (0.08, 523.0), (0.12, 561.6), (0.15, 587.0), (0.2, 625.7),
    (0.234, 649.0), (0.5, 780.0), (1.0, 930.0),
)  # fmt: skip
"""Low-carbon steel with a plateau: tension, strains corrected by the elastic slope, a power law
past the tensile strength; data of the Universidade Federal de Minas Gerais
(github.com/pedrodamas0803/mechtest_ufmg, data/astm1016.tsv)."""

ASTM_1055 = (
    (0.0, 300.0), (0.0005, 342.1), (0.001, 443.6), (0.002, 541.6), (0.005, 630.9), (0.01, 711.1),
    (0.02, 799.1), (0.03, 846.9), (0.05, 928.2), (0.08, 1012.6), (0.097, 1042.0), (0.5, 1290.0),
    (1.0, 1440.0),
)  # fmt: skip
"""Medium-carbon steel with a knee; as `ASTM_1016`, data/astm1055.tsv."""

STAINLESS_304L = (
    (0.0, 160.0), (0.0005, 192.8), (0.001, 222.8), (0.002, 250.1), (0.005, 289.5), (0.01, 316.0),
    (0.02, 347.7), (0.03, 367.7), (0.05, 404.9), (0.08, 455.9), (0.12, 516.7), (0.2, 627.0),
    (0.3, 753.2), (0.4, 863.8), (0.6, 1048.0), (1.0, 1340.0),
)  # fmt: skip
"""Austenitic steel: mean of 14 bars in tension at 1e-4 per second, a power law past a strain of
0.4; data of Sandia National Laboratories (github.com/sandialabs/matcal, BSD-3-Clause,
304L_viscoplastic_calibration)."""


@cache
def plateau() -> tuple[Case, ...]:
    """48 scrambled Sobol points; in a third one body alone has a flow curve."""
    points = sobol(14, seed=20144, power=6)[:48]
    return tuple(deep_case(f"plateau-{k:02}", _pair(u, k)) for k, u in enumerate(points))


@cache
def validation_plateau() -> tuple[Case, ...]:
    """24 pairs kept out of every fit: 18 of the same ranges, six of measured steels."""
    draw = np.random.default_rng(77006).random((18, 14))
    pairs = [*(_pair(u, k) for k, u in enumerate(draw)), *_measured_pairs()]
    return tuple(deep_case(f"validation-plateau-{k:02}", pair) for k, pair in enumerate(pairs))


def measured(rows: tuple[tuple[float, float], ...]) -> FlowCurve:
    """Flow curve through rows of plastic strain and true stress [MPa]."""
    strain, stress = np.array(rows).T
    return tabulated(strain, stress * 1e6)


def _measured_pairs() -> list[Pair]:
    """A hard ball on each steel, a ball of one on a hard plate, and two of two steels."""
    ball = Material(E=210e9, nu=0.29, Sy=2e9)
    soft, knee, stainless = (
        _with_curve(Material(E=E, nu=0.29, Sy=rows[0][1] * 1e6), measured(rows))
        for E, rows in ((203e9, ASTM_1016), (203e9, ASTM_1055), (195e9, STAINLESS_304L))
    )
    both = ((ball, soft), (ball, knee), (ball, stainless), (soft, ball), (knee, soft),
            (stainless, knee))  # fmt: skip
    return [Pair(sphere=sphere, flat=flat, R=1e-3) for sphere, flat in both]


def _pair(u: Array, k: int) -> Pair:
    """Pair from 14 numbers in [0, 1): moduli and Poisson ratios linear, yield strain of the weaker
    body and Sy* logarithmic, then four of each curve; in every third one body alone has a curve.
    """  # noqa: D205
    strain, ratio = _between(_YIELD_STRAINS, u[4]), _between(_RATIOS, u[5])
    pair = two_metals(u[:4], strain=strain, ratio=ratio)
    sphere, flat = pair.sphere, pair.flat
    return replace(
        pair,
        sphere=sphere if k % 6 == 5 else _with_curve(sphere, _curve(sphere.Sy, u[6:10])),
        flat=flat if k % 6 == 4 else _with_curve(flat, _curve(flat.Sy, u[10:])),
    )


def _curve(Sy: float, u: Array) -> FlowCurve:
    """Curve from four numbers in [0, 1): which kind, and three of its measures."""
    if u[0] < 0.5:
        return _plateau(Sy, u[1:])
    if u[0] < 0.6:
        return _upper_yield(Sy, u[1:])
    if u[0] < 0.8:
        return _knee(Sy, u[1:])
    return _saturation(Sy, u[1:])


def _plateau(Sy: float, u: Array) -> FlowCurve:
    """Plateau to a strain of 0.01 to 0.04, 1.1 to 2 times as much 0.2 later, by Swift's law."""
    end = round(float(0.01 + 0.03 * u[0]), 4)
    later, S = _swift_after(end, 1.1 + 0.9 * u[1], _between((0.01, 0.06), u[2]))
    return _table(np.append([0.0, end], later), Sy * np.append([1.0, 1.0], S))


def _upper_yield(Sy: float, u: Array) -> FlowCurve:
    """An upper yield point 3 to 15 % above the plateau, which is reached at a strain of 0.004."""
    end = round(float(0.01 + 0.03 * u[0]), 4)
    lower = 1.0 / (1.03 + 0.12 * u[1])
    later, S = _swift_after(end, 1.1 + 0.9 * u[2], 0.03)
    return _table(
        np.append([0.0, 0.004, end], later), Sy * np.append([1.0, lower, lower], lower * S)
    )


def _knee(Sy: float, u: Array) -> FlowCurve:
    """Rises 1.15 to 2.2 times within strains of 0.0005 to 0.01, then with n 0.02 to 0.2."""
    rise, width, n = 0.15 + 1.05 * u[0], _between((5e-4, 0.01), u[1]), 0.02 + 0.18 * u[2]
    p = np.append(0.0, np.geomspace(0.2 * width, _LAST, _ROWS))
    return _table(p, Sy * (1.0 - rise * np.expm1(-p / width)) * (1.0 + p / 0.01) ** n)


def _saturation(Sy: float, u: Array) -> FlowCurve:
    """Voce's law, 1.1 to 2.5 times in the end, within strains of 0.01 to 0.2."""
    rise, width = 0.1 + 1.4 * u[0], _between((0.01, 0.2), u[1])
    p = np.append(0.0, np.geomspace(0.05 * width, _LAST, _ROWS))
    return _table(p, Sy * (1.0 - rise * np.expm1(-p / width)))


def _swift_after(end: float, ratio: float, start: float) -> tuple[Array, Array]:
    """Strains past a plateau's end, and the stresses there over the plateau's."""
    past = np.geomspace(0.1 * start, _LAST, _ROWS)
    n = math.log(ratio) / math.log1p(_AFTER / start)
    return end + past, (1.0 + past / start) ** n


def _table(strain: Array, stress: Array) -> FlowCurve:
    return tabulated(*(np.array([digits(x) for x in row]) for row in (strain, stress)))


def _with_curve(body: Material, curve: FlowCurve) -> Material:
    return replace(body, Sy=curve.strength, flow=Flow(curve=curve))


def _between(bounds: tuple[float, float], u: float) -> float:
    return digits(bounds[0] * (bounds[1] / bounds[0]) ** u)
