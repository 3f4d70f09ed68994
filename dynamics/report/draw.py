"""Figures of impacts, drawn without a screen."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Mapping, Sequence
from itertools import cycle
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.observables import OBSERVABLES
from ...core.output import panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..columns import Impacts

# limit: relative difference that is none [-]: round-off
_NONE = 1e-6

SWEPT = (
    "restitution", "permanent_depth_m", "contact_time_s", "peak_force_N", "rebound_spin_rad_s",
    "sliding_length_m",
)  # fmt: skip
"""Observables that the picture of a sweep shows, where they are anything."""

CONDITIONS = {
    "impact_speed_m_s": "impact speed [m/s]", "drop_height_m": "drop height [m]",
    "angle_deg": "angle [degrees]", "friction": "friction [-]", "mass_kg": "mass [kg]",
    "approach_tangential_m_s": "tangential speed before [m/s]",
    "approach_spin_rad_s": "spin before [rad/s]",
}  # fmt: skip
"""The conditions that may be swept, in words; of any other number of a file its key."""


def looks(laws: Iterable[str], doubts: Container[str] = ()) -> dict[str, dict[str, Any]]:
    """Return colour and dash of each law, by its place; what is spoken against is thin and pale.

    The first is whole, the others lie on it broken, so that none hides another.
    """
    breaks = cycle(("-", "--", ":", "-.", (0, (6, 2, 1, 2, 1, 2))))
    return {
        # nine, for five dashes and ten colours make law 11 the first again
        law: {"color": f"C{k % 9}", "ls": dash}
        | ({"lw": 1.0, "alpha": 0.5} if law in doubts else {})
        for k, (law, dash) in enumerate(zip(laws, breaks, strict=False))
    }


def draw_sweep(
    swept: Mapping[str, Sequence[float]], curves: Mapping[str, Impacts], *,
    stds: Mapping[str, np.ndarray] = MappingProxyType({}),
) -> Figure:  # fmt: skip
    """Return observables against the condition with the most values, one curve a law.

    Where several conditions are swept, the others stand at their first values. `stds` are standard
    deviations of the first law's numbers, drawn as a band.
    """
    from matplotlib.ticker import LogLocator

    across = max(swept, key=lambda name: len(swept[name]))
    lengths = [len(v) for v in swept.values()]
    place = tuple(slice(None) if name == across else 0 for name in swept)
    rows = np.arange(math.prod(lengths)).reshape(lengths)[place]
    shown = [
        name for name in SWEPT
        if any(np.nanmax(np.abs(found[name][rows]), initial=0.0) > 0.0 for found in curves.values())
    ]  # fmt: skip
    made, axes = panels(len(shown))
    first = next(iter(curves.values()))
    scale = "log" if _by_ratio(swept[across]) else "linear"
    alone, look = len(set(swept[across])) == 1, looks(curves)
    for axis, name in zip(axes, shown, strict=True):
        told = OBSERVABLES[name]
        for law, found in curves.items():
            values = told.scale * found[name][rows]
            (drawn,) = axis.plot(
                swept[across], values, label=law, marker="o" if alone else "", **look[law]
            )
            if name in stds and found is first:
                off = told.scale * stds[name][rows]
                low = np.maximum(values - off, 0.0) if told.low == 0.0 else values - off
                axis.fill_between(
                    swept[across], low, values + off, color=drawn.get_color(), alpha=0.2,
                    lw=float(alone), label="its standard deviation",
                )  # fmt: skip
        axis.set(xlabel=CONDITIONS.get(across, across), ylabel=told.axis, xscale=scale)
        if scale == "log" and max(swept[across]) < 300.0 * min(swept[across]):
            # over a decade or two powers of ten have factors, which overlap
            axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.xaxis.set_major_formatter("{x:g}")
            axis.xaxis.set_minor_formatter("")
        axis.grid(alpha=0.3)
    fixed = ", ".join(f"{CONDITIONS.get(k, k)} = {v[0]:g}" for k, v in swept.items() if k != across)
    made.suptitle(fixed, fontsize=9)
    axes[0].legend(fontsize=7)
    return made


def swept_in_vain(swept: Mapping[str, Sequence[float]], curves: Mapping[str, Impacts]) -> list[str]:
    """Return the conditions of a sweep along which nothing that the picture shows changes."""
    if not any((found["outcome"] == "completed").any() for found in curves.values()):
        return []
    shape = [len(values) for values in swept.values()]
    tables = [found[name].reshape(shape) for found in curves.values() for name in SWEPT]

    def idle(axis: int) -> bool:
        return all(
            np.allclose(t, t.take([0], axis), rtol=_NONE, atol=0.0, equal_nan=True) for t in tables
        )

    return [
        name for axis, (name, values) in enumerate(swept.items())
        if len(set(values)) > 1 and idle(axis)
    ]  # fmt: skip


def _by_ratio(values: Sequence[float]) -> bool:
    """Whether values grow by one factor over a decade or more."""
    given = np.asarray(values, dtype=float)
    if given.size < 3 or given.min() <= 0.0 or given.max() < 10.0 * given.min():
        return False
    steps = np.diff(np.log(given))
    return bool(np.ptp(steps) < 0.05 * abs(steps.mean()))
