"""Discretisation uncertainty of a loading curve, from a second, coarser solve.

The second solve has twice the element size along the path of the contact edge, larger elements
elsewhere and longer steps, so that the difference of the two holds the mesh's and the step's part.
Contact radius and ripple are of first order in the element size: the difference is then an estimate
of the finer solve's own error. Because the ripple of the two crosses zero here and there, the
estimate at a depth is the root mean square over the neighbouring depths.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .problem import Accuracy
from .solution import Curve

Floats = npt.NDArray[np.float64]

_NEIGHBOURS = 3  # depths on either side that the mean takes in


@dataclass(frozen=True)
class Uncertainty:
    """Standard uncertainty of a loading curve's columns, each of shape (n,).

    Parameters
    ----------
    force
        [N].
    radius, radius_last_node
        [m].
    sphere_share
        [-].
    hardness
        [Pa].
    """

    force: Floats
    radius: Floats
    radius_last_node: Floats
    sphere_share: Floats
    hardness: Floats


def coarser(accuracy: Accuracy) -> Accuracy:
    """Return the settings of the second solve, about a quarter of the first one's cost."""
    return accuracy.with_(
        level=f"{accuracy.level}, coarser",
        fine=2.0 * accuracy.fine,
        coarse=max(1.3 * accuracy.coarse, 2.0 * accuracy.fine),
        divisions=2 * round(0.375 * accuracy.divisions),
        step_ratio=1.0 + 1.5 * (accuracy.step_ratio - 1.0),
    )


def discretisation_uncertainty(curve: Curve, coarse: Curve) -> Uncertainty:
    """Compare two solves of one problem.

    Parameters
    ----------
    curve
        The finer solve.
    coarse
        The coarser one at the same depths; where it ended earlier, its last relative difference
        is carried on.

    Returns
    -------
    Uncertainty
        Of the finer solve; nan where the coarser one has no depth at all.
    """
    n = min(len(curve.delta), len(coarse.delta))

    def estimate(fine_values: Floats, coarse_values: Floats, *, scale: Floats) -> Floats:
        if n == 0:
            return np.full(len(curve.delta), np.nan)
        relative = (coarse_values[:n] - fine_values[:n]) / scale[:n]
        relative = np.append(relative, np.full(len(scale) - n, relative[-1]))
        padded = np.pad(relative**2, _NEIGHBOURS, mode="edge")
        window = np.ones(2 * _NEIGHBOURS + 1) / (2 * _NEIGHBOURS + 1)
        return np.asarray(np.sqrt(np.convolve(padded, window, mode="valid")) * scale)

    return Uncertainty(
        **{
            name: estimate(getattr(curve, name), getattr(coarse, name), scale=getattr(curve, name))
            for name in ("force", "radius", "radius_last_node", "hardness")
        },
        sphere_share=estimate(
            curve.sphere_share, coarse.sphere_share, scale=np.ones(len(curve.delta))
        ),
    )
