"""Where the regression of the closed form starts, and between which bounds it looks."""

from __future__ import annotations

from ..models.closed_form import COEFFICIENTS

_START: dict[str, tuple[float, float, float]] = {
    # start, smallest, largest
    "n": (10.0, 3.0, 40.0),
    "wy": (1.29, 0.7, 2.5),
    "c": (2.72, 2.2, 3.4),
    "b0": (0.262, 0.02, 1.0),
    "b1": (-1.0, -4.0, 4.0),
    "b2": (0.43, 0.05, 3.0),
    "b3": (1.58, -4.0, 6.0),
    "b4": (3.05, -3.0, 8.0),
    "b5": (12.7, 1.0, 100.0),
    "z": (0.225, -1.0, 1.0),
    "c_s": (-2.9, -20.0, 5.0),
    "c_f": (-1.2, -20.0, 5.0),
    "t": (3.57, 1.2, 8.0),
    "y1": (104.0, 5.0, 2000.0),
    "c_m": (0.148, 0.0, 1.0),
    "h": (2.98, 2.5, 3.5),
    "B_s": (1.04, 0.0, 4.0),
    "B_f": (0.35, 0.0, 4.0),
    "r": (1.39, 0.8, 3.0),
    "k0": (0.218, 0.01, 3.0),
    "k1": (1.89, -4.0, 5.0),
    "k2": (0.87, -4.0, 5.0),
    "m0": (0.72, 0.2, 3.0),
    "m1": (1.08, -4.0, 4.0),
    "e0": (0.25, 0.0, 0.31),  # e0 sqrt(1e-5) stays below 0.1 %
    "g0": (6.48, 2.0, 20.0),
    "g1": (1830.0, 10.0, 1e5),
    "g2": (0.585, 0.0, 2.0),
    "g3": (39.0, 1.0, 1000.0),
    "s0": (0.8, 0.1, 3.0),
    "s1": (0.2, 0.01, 1.0),
    "s2": (0.42, -1.0, 2.0),
    "s3": (0.15, 0.0, 0.6),
    "s4": (0.13, -0.3, 0.5),
    "p0": (2.8, 0.3, 10.0),
    "p1": (1.95, 0.0, 5.0),
    "f1": (0.132, 0.0, 0.5),
    "f2": (1.17, 0.5, 2.0),
    "f3": (1.18, 0.05, 20.0),
    "l1": (0.128, 0.0, 0.5),
    "l2": (0.896, 0.5, 2.0),
    "d1": (1.0, -4.0, 4.0),
    "u1": (0.108, 0.0, 1.5),
    "u2": (0.141, 0.01, 20.0),
    "u3": (359.0, 10.0, 1e5),
}
assert tuple(_START) == COEFFICIENTS

START = {name: start for name, (start, _, _) in _START.items()}
"""First value of every coefficient."""

LIMITS = {name: (low, high) for name, (_, low, high) in _START.items()}
"""Smallest and largest value of every coefficient that the regression may take."""
