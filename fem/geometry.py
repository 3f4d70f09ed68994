"""Radii of the element rings: small where the contact edge will pass, growing outwards.

The mesh is self-similar: rings about the first contact point whose width is a fixed fraction of
their radius, so that a contact of any size sees the same number of elements. The fraction is fine
wherever plastic contact will have its edge, because there the element size sets the ripple of force
and contact radius, and coarse inside and outside of that range.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RingDesign:
    """Radii between which the rings are fine, in units of R.

    Parameters
    ----------
    core
        Radius of the innermost block.
    fine_from, fine_to
        Range of the contact edge that is meshed finely.
    """

    core: float
    fine_from: float
    fine_to: float


def graded_rings(design: RingDesign, *, coarse: float, fine: float, grade: float) -> Floats:
    """Ring radii from the core to `fine_to`.

    Parameters
    ----------
    design
        The radii to connect.
    coarse, fine
        Ring width over radius outside and inside the fine range.
    grade
        Largest ratio of neighbouring relative ring widths; an abrupt change of size makes the
        smoothed contact surface wavy.

    Returns
    -------
    ndarray
        Increasing radii, shape (n,) [R].
    """
    n_grade = math.ceil(math.log(coarse / fine) / math.log(grade)) if coarse > fine else 0
    widths = [coarse * (fine / coarse) ** ((k + 1) / n_grade) for k in range(n_grade)]
    start = design.fine_from / math.prod(1.0 + w for w in widths)
    core = min(design.core, start)
    radii = [core]
    n = max(1, round(math.log(start / core) / math.log1p(coarse))) if start > core else 0
    radii += [core * (start / core) ** ((k + 1) / n) for k in range(n)]
    for width in widths:
        radii.append(radii[-1] * (1.0 + width))
    base = radii[-1]
    n = math.ceil(math.log(design.fine_to / base) / math.log1p(fine))
    radii += [base * (design.fine_to / base) ** ((k + 1) / n) for k in range(n)]
    return np.array(radii)


def outer_rings(start: float, end: float, *, fine: float, coarse: float, grade: float) -> Floats:
    """Ring radii from `start` (included) to `end`, the relative width growing to `coarse`."""
    radii = [start]
    width = fine
    while radii[-1] < end:
        width = min(width * grade, coarse)
        radii.append(radii[-1] * (1.0 + width))
    r = np.array(radii)
    return np.asarray(start * (r / start) ** (math.log(end / start) / math.log(r[-1] / start)))
