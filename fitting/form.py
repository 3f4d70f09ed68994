"""Where the regression of the closed form starts, and between which bounds it looks."""

from __future__ import annotations

from ..models.closed_form import COEFFICIENTS

_START: dict[str, tuple[float, float, float]] = {
    # start, smallest, largest
    "n": (8.0, 2.0, 20.0),
    "wy": (1.4, 0.5, 5.0),
    "m": (4.0, 1.5, 12.0),
    "A": (0.087, 0.02, 0.3),
    "a0": (0.18, 0.02, 2.0),
    "a1": (0.38, 0.0, 3.0),
    "e_s": (0.24, -0.31, 0.31),  # |e| sqrt(1e-5) stays below 0.1 %
    "e_f": (0.24, -0.31, 0.31),
    "h_s": (7.0, -20.0, 60.0),
    "h_f": (0.3, -20.0, 60.0),
    "r": (1.1, 0.3, 3.0),
    "y0": (10.0, 0.5, 300.0),
    "c": (2.8, 1.5, 4.0),
    "b0": (4.4, 0.2, 100.0),
    "b1": (0.3, -3.0, 3.0),
    "c_s": (-0.8, -60.0, 60.0),
    "c_f": (0.7, -60.0, 60.0),
    "t": (0.9, 0.3, 3.0),
    "y1": (100.0, 0.5, 1e4),
    "g0": (7.0, 2.0, 40.0),
    "g1": (1.1, -5.0, 10.0),
    "g2": (30.0, 1.0, 1000.0),
    "g3": (400.0, 1.0, 1e5),
    "g4": (0.4, 0.0, 2.0),
    "g5": (0.75, 0.1, 3.0),
    "k1": (0.14, 0.0, 0.5),
    "k2": (5.0, 0.1, 200.0),
    "r1": (0.15, 0.0, 0.5),
    "r2": (5.0, 0.1, 200.0),
    "d1": (0.5, -5.0, 5.0),
    "u1": (0.3, 0.0, 1.5),
    "u2": (5.0, 0.1, 200.0),
    "u3": (100.0, 1.0, 1e6),
}
assert tuple(_START) == COEFFICIENTS

START = {name: start for name, (start, _, _) in _START.items()}
"""First value of every coefficient."""

LIMITS = {name: (low, high) for name, (_, low, high) in _START.items()}
"""Smallest and largest value of every coefficient that the regression may take."""
