"""What the fitted law adds to the compact one: its numbers of a pair, moved smoothly over pairs.

Gaussian bumps stand over five groups of the pair; each moves every entry of `CHANNELS` by a weight.
They act on the numbers from which a pair's curves are drawn, never on the curves, so that limits,
bounds, rise of the force and balance of energy stay what they are. Away from all bumps, outside the
data, nothing moves: there the fitted law is the compact one.

C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (2006), 8.3: subset of
regressors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..core.arrays import Array
from .closed_form import Bodies, Groups, PairNumbers, groups_of

GROUPS = Groups._fields
"""The coordinates of a pair."""

MOST = 4.0
"""Units by which a number may be moved; its shift is bent towards this bound."""


class Channel(NamedTuple):
    """How a number of the pair is moved."""

    factor: bool  # by a factor exp(unit shift), else by unit shift
    unit: float


def _factors(**units: float) -> dict[str, Channel]:
    return {name: Channel(True, unit) for name, unit in units.items()}


def _summands(**units: float) -> dict[str, Channel]:
    return {name: Channel(False, unit) for name, unit in units.items()}


CHANNELS: dict[str, Channel] = {
    **_summands(fin=0.5),
    **_factors(c=0.03, g_a=0.3, g_b=0.3, y_b=0.5),
    **_summands(g_t=0.5, z=0.2, c_s=1.0, c_f=0.7, t=0.3),
    **_factors(y_c=0.5),
    **_summands(c_m=0.2),
    **_factors(h=0.05),
    **_summands(B_s=0.5, B_f=0.2, r=0.2, B_e=15.0, even=0.1),
    **_factors(k=0.3),
    **_summands(m=0.15, k_a=0.5),
    **_factors(g_0=0.3),
    **_summands(g_2=0.1, g_4=0.1),
    **_factors(a_t=0.15, p=0.3, f_1=0.2, lag=0.3, l_0=0.3, l_1=0.1, l_2=0.2),
    **_summands(l_3=0.05),
    **_factors(u_1=0.7, u_2=0.4, u_4=0.3, u_5=0.6),
}
"""The numbers of a pair that are moved, in the order of the weights."""

_UNITS = np.array([channel.unit for channel in CHANNELS.values()])


@dataclass(frozen=True)
class PairCorrection:
    """Bumps and weights.

    `centres`: of the bumps in the groups, shape (m, 5); `reaches`: widths of the bumps, shape (5,);
    `weights`: shift of each channel by each bump, shape (m, n_channels).
    """

    centres: Array
    reaches: Array
    weights: Array

    def of(self, bodies: Bodies, numbers: PairNumbers) -> PairNumbers:
        """Return the numbers moved; fields of shape (n,), real or complex."""
        shifts = bumps(coordinates(bodies, numbers), self.centres, self.reaches) @ self.weights
        return moved(numbers, shifts)


def coordinates(bodies: Bodies, numbers: PairNumbers) -> Any:
    """`Groups` of pairs side by side, shape (n, 5)."""
    return np.stack(groups_of(bodies, numbers), axis=-1)


def bumps(groups: Any, centres: Array, reaches: Array) -> Any:
    """Value of every bump at every pair, shape (n, m)."""
    away = (groups[:, None, :] - centres) / reaches
    return np.exp(-0.5 * np.sum(away * away, axis=-1))


def moved(numbers: PairNumbers, shifts: Any) -> PairNumbers:
    """Return the numbers with shifts of shape (n, n_channels) applied."""
    bent = _UNITS * shifts / np.sqrt(1.0 + (shifts / MOST) ** 2)
    changed: dict[str, Any] = {}
    for k, (name, channel) in enumerate(CHANNELS.items()):
        number, by = getattr(numbers, name), bent[:, k]
        changed[name] = number * np.exp(by) if channel.factor else number + by
    return numbers._replace(**changed)
