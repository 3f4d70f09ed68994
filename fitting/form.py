"""Where the regression of the compact law starts, and between which bounds it looks."""

from __future__ import annotations

from ..models.closed_form import COEFFICIENTS

_START: dict[str, tuple[float, float, float]] = {
    # start, smallest, largest
    "b0": (0.75, 0.05, 3.0),
    "b1": (-0.9, -4.0, 4.0),
    "b2": (0.085, 0.01, 1.0),
    "b3": (1.4, -4.0, 6.0),
    "b4": (3.0, -3.0, 8.0),
    "z": (0.31, -1.0, 1.0),
    "c_s": (-2.0, -20.0, 5.0),
    "c_f": (-1.0, -20.0, 5.0),
    "h": (2.87, 2.5, 3.5),
    "B_s": (1.2, 0.0, 20.0),
    "B_f": (0.35, 0.0, 4.0),
    "B_e": (42.0, 0.0, 200.0),
    "k0": (0.24, 0.02, 3.0),
    "k1": (1.9, -4.0, 5.0),
    "k2": (-1.0, -8.0, 8.0),
    "m0": (0.15, -1.0, 1.0),
    "m1": (-0.6, -3.0, 3.0),
    "g0": (6.7, 2.0, 20.0),
    "g2": (0.24, 0.0, 2.0),
    "g4": (0.2, 0.0, 2.0),
    "s0": (0.26, 0.05, 1.0),
    "s2": (0.61, 0.2, 3.0),
    "s3": (0.147, 0.0, 1.0),
    "p0": (1.33, 0.3, 10.0),
    "p1": (3.4, 0.0, 10.0),
    "f1": (0.141, 0.0, 0.5),
    "f3": (1.0, 0.05, 20.0),
    "l1": (0.15, 0.0, 0.5),
    "u2": (0.07, 0.0, 0.4),  # u2 + u4 below 0.9: no cycle gives back more than was spent
    "u4": (0.06, 0.0, 0.4),
}
assert tuple(_START) == COEFFICIENTS

START = {name: start for name, (start, _, _) in _START.items()}
"""First value of every coefficient."""

LIMITS = {name: (low, high) for name, (_, low, high) in _START.items()}
"""Smallest and largest value of every coefficient that the regression may take."""
