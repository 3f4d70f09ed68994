"""The thesis's own forms (2.13-2.43, 3.7) as functions of the data and of their coefficients.

The reading is that of the equation audit: 2.14 with 1.035 pi, the root in 2.21, powers of Sy* as
exponents, R' by the other body's share.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.arrays import Array, Integers, Mask
from ...models.published.hardness import jackson_green_2007, slip_line

Values = Mapping[str, Any]

BORDER = 1.07  # Sy* at which the weak body changes
_LEAST = 5.0  # delta_n from which the thesis means its radius and force
_HIGH = 408.0


@dataclass(frozen=True)
class Rows:
    """What the forms take, each of shape (n,)."""

    case: Integers
    D: Array
    w: Array
    q: Array
    ratio: Array
    share: Array
    radius: Array
    force: Array
    stiff: Array
    n: Array
    delta: Array
    updated: Array
    total: Array

    def of(self, mask: Mask) -> Rows:
        """Return the rows of `mask`."""
        return Rows(**{k: v[mask] for k, v in vars(self).items()})


@dataclass(frozen=True)
class ThesisForm:
    """One form: where it applies, its printed coefficients, what it says and of what.

    Parameters
    ----------
    title
        Equation and quantity.
    printed
        Coefficients in the corrected reading.
    applies
        Mask of the rows that the thesis gives it for.
    value
        Prediction from rows and coefficients.
    target
        Name of the column that it predicts.
    relative
        Whether its error counts relatively.
    """

    title: str
    printed: Values
    applies: Callable[[Rows], Mask]
    value: Callable[[Rows, Values], Any]
    target: str
    relative: bool


def _share_low(r: Rows, k: Values) -> Any:
    first = np.sin(k["C1"] * r.D ** k["C2"] + k["C3"])
    second = np.sin(k["C4"] * r.ratio ** k["C5"] + k["C6"])
    return k["C7"] * r.D ** k["C8"] * first * second


def _share_middle(r: Rows, k: Values) -> Any:
    first = np.sin(k["C1"] * r.D ** k["C2"] + k["C3"] * r.ratio ** k["C4"])
    second = np.sin(k["C5"] * r.ratio ** k["C6"] + k["C7"])
    return k["C8"] * r.q ** k["C9"] * first * second


def _share_high(r: Rows, k: Values) -> Any:
    exponent = k["C1"] * r.D ** (k["C2"] * r.ratio) - k["C3"]
    angle = np.arctan(k["C4"] * np.log(r.ratio) ** (k["C5"] * r.D) + k["C6"])
    front = k["C7"] * r.q ** k["C8"] * r.D ** k["C9"] * r.ratio ** k["C10"]
    return front * angle * np.exp(exponent)


def _radius_by(r: Rows, k: Values, power: Any, *, high: bool) -> Any:
    B = k["B1"] * np.exp(k["B2"] / r.q)
    if high:
        x = np.maximum(r.n - _HIGH, 1e-9)
        chi = k["X1"] - k["X2"] * x ** k["X3"] + (k["X4"] + k["X5"] * x) * power
    else:
        chi = k["X1"] + k["X2"] * r.n ** k["X3"] + k["X4"] / np.sqrt(r.n) * power
    return chi * np.sqrt(r.updated * r.delta * (r.n / 1.9) ** B)


def _radius_low_flattening(r: Rows, k: Values) -> Any:
    return _radius_by(r, k, r.ratio ** k["X6"], high=False)


def _radius_low_indentation(r: Rows, k: Values) -> Any:
    return _radius_by(r, k, r.ratio ** (k["X6"] * np.exp(k["X7"] * r.n)), high=False)


def _radius_high_flattening(r: Rows, k: Values) -> Any:
    return _radius_by(r, k, r.ratio ** k["X6"], high=True)


def _radius_high_indentation(r: Rows, k: Values) -> Any:
    x = np.log(np.maximum(r.n - _HIGH, 1.0))
    return _radius_by(r, k, r.ratio ** (k["X6"] * x ** k["X7"]), high=True)


def _hardness(r: Rows, k: Values) -> Any:
    flat, dent = jackson_green_2007(r.radius), slip_line(r.radius)
    weight = np.arctan(k["C1"] * np.log(np.maximum(r.ratio - k["C2"], 1e-3))) / np.pi + 0.5
    return (dent - flat) * weight + flat


def _force(r: Rows, k: Values) -> Any:
    known = {"C1": 300.0, "C2": 0.06}
    plastic = np.pi * r.radius**2 * _hardness(r, known) / r.q
    elastic = 4.0 / 3.0 * np.sqrt(r.updated) * r.stiff * r.delta**1.5
    we = np.exp(-k["E1"] * np.maximum(r.n - 1.9, 0.0) ** k["E2"])
    return we * elastic + (k["P1"] - np.exp(-k["P2"] * r.n ** k["P3"])) * plastic


def _left(r: Rows, k: Values) -> Any:
    return k["C1"] * (1.0 - ((r.w + k["C2"]) / (1.0 + k["C2"])) ** -k["C3"])


def _flattening(r: Rows) -> Mask:
    return r.ratio <= BORDER


_CHI_LOW = {"B1": 0.14, "B2": 23.0, "X1": 0.4, "X2": 0.55, "X3": 0.022, "X4": 0.283}
_CHI_HIGH = {
    "B1": 0.14, "B2": 23.0, "X1": 1.024, "X2": 0.004, "X3": 0.3814, "X4": 0.013, "X5": 2.2e-5,
}  # fmt: skip

LOADING_FORMS: tuple[ThesisForm, ...] = (
    ThesisForm(
        "2.13, delta_s*, Sy* up to 1",
        {"C1": 5.592, "C2": 1.37, "C3": np.pi / 2.37, "C4": 0.625, "C5": 2.0, "C6": np.pi / 2.16,
         "C7": 1.115, "C8": 0.0528},
        lambda r: (r.ratio <= 1.0) & (r.w >= 1.0), _share_low, "share", False,
    ),
    ThesisForm(
        "2.14, delta_s*, Sy* 1 to 1.53",
        {"C1": 45.63, "C2": 1.75, "C3": 0.094 * np.pi, "C4": 4.01, "C5": 1.546, "C6": -9.22,
         "C7": 1.035 * np.pi, "C8": -22.49, "C9": -0.7},
        lambda r: (r.ratio > 1.0) & (r.ratio <= 1.53) & (r.w >= 1.0), _share_middle, "share", False,
    ),
    ThesisForm(
        "2.15-2.16, delta_s*, Sy* above 1.53",
        {"C1": 2.307, "C2": 0.46, "C3": 0.7, "C4": 0.142, "C5": 1.06, "C6": 3.22, "C7": 0.852,
         "C8": -0.7, "C9": -0.41, "C10": 0.031},
        lambda r: (r.ratio > 1.53) & (r.w >= 1.0), _share_high, "share", False,
    ),
    ThesisForm(
        "2.21-2.23, a, flattening, delta_n 5 to 408", {**_CHI_LOW, "X6": 6.0},
        lambda r: _flattening(r) & (r.n >= _LEAST) & (r.n <= _HIGH), _radius_low_flattening,
        "radius", True,
    ),
    ThesisForm(
        "2.24-2.25, a, flattening, delta_n above 408", {**_CHI_HIGH, "X6": 6.0},
        lambda r: _flattening(r) & (r.n > _HIGH), _radius_high_flattening, "radius", True,
    ),
    ThesisForm(
        "2.28-2.30, a, indentation, delta_n 5 to 408", {**_CHI_LOW, "X6": -0.091, "X7": -0.008},
        lambda r: ~_flattening(r) & (r.n >= _LEAST) & (r.n <= _HIGH), _radius_low_indentation,
        "radius", True,
    ),
    ThesisForm(
        "2.31-2.33, a, indentation, delta_n above 408", {**_CHI_HIGH, "X6": -0.0091, "X7": 3.53},
        lambda r: ~_flattening(r) & (r.n > _HIGH), _radius_high_indentation, "radius", True,
    ),
    ThesisForm(
        "2.37-2.42, F, flattening",
        {"E1": 1.6, "E2": 0.16, "P1": 0.95, "P2": 0.58, "P3": 0.3},
        lambda r: _flattening(r) & (r.n >= _LEAST), _force, "force", True,
    ),
    ThesisForm(
        "2.37-2.43, F, indentation",
        {"E1": 1.7, "E2": 0.26, "P1": 1.0, "P2": 0.465, "P3": 0.45},
        lambda r: ~_flattening(r) & (r.n >= _LEAST), _force, "force", True,
    ),
)  # fmt: skip
"""The forms on loading, in the thesis's order."""

UNLOADING_FORM = ThesisForm(
    "3.7, residual depth",
    {"C1": 0.8, "C2": 5.5, "C3": 2.0},
    lambda r: r.w >= 1.0, _left, "total", True,
)  # fmt: skip
