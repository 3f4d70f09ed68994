"""The error of the baseline's contact law, as unknowns inside the law.

The loading force is multiplied by exp(g(ln(delta/R))) and the elastic recovery by
exp(r(ln(delta_p/R))), with g and r smooth random functions (squared-exponential covariance, kept to
their leading components); the exponent of the recovery and the crater's share of the depth have an
error of their own. Their sizes are those of the law's comparison with finite elements on pairs that
it was not fitted to. So a law that is some per cent off never looks like missing physics.

References
----------
K. Sargsyan, X. Huan, H. N. Najm, Int. J. Uncertain. Quantif. 9 (2019) 365: embedded model error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..impact import ForceTransform
from ..impact.force import LOG_DEPTH_FIRST, LOG_DEPTH_LAST
from ..impact.strength import NODES
from ..models.base import ContactLaw
from ..models.fitted import read_coefficients

Array = NDArray[np.float64]

# Depths that impacts reach; outside, the components stay at their end values.
_FIRST, _LAST = math.log(3e-5), math.log(0.2)
_SPLIT = 0.03
FREE = {"force": 0.16, "recovery": 0.5, "recovery exponent": 0.5, "crater": 0.24}
"""Standard deviations of a contact law that is free: what something unknown may make of it."""


@dataclass(frozen=True, eq=False)
class LawError:
    """Components of the law's error.

    Parameters
    ----------
    force, recovery
        (k, NODES) logarithmic change per standard deviation of each component.
    shape
        Standard deviation of the exponent of the recovery.
    split
        (s, NODES) logarithmic change of the crater's share per standard deviation.
    sizes
        Standard deviations behind them, for the report.
    """

    force: Array
    recovery: Array
    shape: float
    split: Array
    sizes: dict[str, float]

    @property
    def count(self) -> int:
        """Number of unknowns."""
        return len(self.force) + len(self.recovery) + (self.shape > 0.0) + len(self.split)

    @property
    def freedom(self) -> Array:
        """Factor on each unknown that makes the law free, shape (count,)."""
        parts = (
            ("force", len(self.force)), ("recovery", len(self.recovery)),
            ("recovery exponent", int(self.shape > 0.0)), ("crater", len(self.split)),
        )  # fmt: skip
        return np.concatenate([np.full(n, FREE[k] / self.sizes[k]) for k, n in parts if n])

    def transform(self, b: Array) -> ForceTransform:
        """Return the force seam at the unknowns b, shape (count,)."""
        if not np.any(b):
            return ForceTransform()
        n, m = len(self.force), len(self.recovery)
        loading = np.exp(b[:n] @ self.force)
        recovery = np.exp(b[n : n + m] @ self.recovery)
        shape = self.shape * float(b[n + m]) if self.shape > 0.0 else 0.0
        return ForceTransform(
            factors=tuple(loading.tolist()), recovery_factors=tuple(recovery.tolist()),
            shape=max(shape, -0.45),
        )  # fmt: skip

    def crater(self, b: Array, depth_over_R: Array) -> Array:
        """Return the logarithmic change of the crater's depth at the peak depths given."""
        part = b[self.count - len(self.split) :]
        grid = np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES)
        curve = part @ self.split
        return np.asarray(np.interp(np.log(np.maximum(depth_over_R, 1e-9)), grid, curve))


def components(spread: float, length: float, *, keep: float = 0.97) -> Array:
    """Leading components (k, NODES) of a smooth random function of ln(depth/R).

    Parameters
    ----------
    spread
        Standard deviation at each depth.
    length
        Correlation length in ln(depth/R).
    keep
        Share of the variance kept.
    """
    grid = np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES)
    x = np.clip(grid, _FIRST, _LAST)
    inner = np.linspace(_FIRST, _LAST, 60)
    cov = np.exp(-0.5 * ((inner[:, None] - inner[None, :]) / length) ** 2)
    size, shape = np.linalg.eigh(cov)
    order = np.argsort(size)[::-1]
    size, shape = size[order], shape[:, order]
    n = int(np.searchsorted(np.cumsum(size) / np.sum(size), keep)) + 1
    curves = (shape[:, :n] * np.sqrt(size[:n])).T * spread
    return np.stack([np.interp(x, inner, curve) for curve in curves])


def law_error(law: ContactLaw) -> LawError:
    """Return the error of the law that the baseline rests on."""
    if law.name == "hertz":
        none = np.zeros((0, NODES))
        return LawError(components(0.02, 6.0, keep=0.9), none, 0.0, none, {"force": 0.02})
    stored = read_coefficients()
    assert stored is not None, "no law but Hertz's is used without coefficients"
    errors = stored["errors"]["left_out"]
    # mean absolute errors; 1.25 of it is a standard deviation
    force = min(max(1.25 * errors["force"][0], 0.02), 0.06)
    recovery = min(max(1.25 * errors["given_back"][0], 0.02), 0.08)
    shape = min(max(1.25 * errors["exponent"][0], 0.02), 0.1)
    return LawError(
        components(force, 1.5), components(recovery, 2.0), shape,
        components(_SPLIT, 2.5, keep=0.95),
        {"force": force, "recovery": recovery, "recovery exponent": shape, "crater": _SPLIT},
    )  # fmt: skip
