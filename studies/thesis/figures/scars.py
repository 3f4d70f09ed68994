"""Figures 5.4-5.7: the scars that one contact of the rigid rod leaves, beside the measured ones.

The tip, a sphere, moves along its computed path; what it has swept below the surface is the imprint
at the largest load. The elastic part springs back, so that the deepest point keeps the residual
depth of the law: the whole imprint is lowered in that proportion. Pile-up is not modelled.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.arrays import Array
from ....core.inputs.toml_input import read_toml
from ....dynamics.integrate import Trace
from ....models.base import ContactLaw
from ...plot import Picture, finish, look, sheet
from ..chapter3 import REFERENCE

_GRID = 241


@dataclass(frozen=True, slots=True)
class Scar:
    """A predicted dent.

    Parameters
    ----------
    x, y
        Along the sliding direction and across it, shapes (n,) and (m,) [m].
    depth
        Permanent depth, shape (m, n) [m].
    """

    x: Array
    y: Array
    depth: Array

    @property
    def deepest(self) -> float:
        """Largest depth [m]."""
        return float(self.depth.max())

    @property
    def length(self) -> float:
        """Largest extent along the sliding direction [m]."""
        inside = np.any(self.depth > 0.0, axis=0)
        return float(np.ptp(self.x[inside]))

    @property
    def width(self) -> float:
        """Extent across at the deepest place [m]."""
        column = int(np.argmax(self.depth.max(axis=0)))
        return float(np.ptp(self.y[self.depth[:, column] > 0.0]))

    @property
    def sliding_length(self) -> float:
        """Length minus width at the deepest place, the thesis's measure of sliding (5.3) [m]."""
        return self.length - self.width


def scar(trace: Trace, radius: float) -> Scar:
    """Sweep a tip of `radius` [m] along the path of `trace` and let the dent spring back."""
    path, height = trace.column("slip_m"), trace.column("tip_height_m")
    touching = height <= 0.0
    path, height = path[touching], height[touching]
    reach = 1.15 * np.sqrt(2.0 * radius * -height.min())
    x = np.linspace(path.min() - reach, path.max() + reach, _GRID)
    y = np.linspace(-reach, reach, _GRID)
    across = y[:, None] ** 2 / (2.0 * radius)
    deepest = np.full((len(y), len(x)), np.inf)
    for place, low in zip(path, height, strict=True):
        np.minimum(deepest, low + (x[None, :] - place) ** 2 / (2.0 * radius) + across, out=deepest)
    kept = trace.impact.residual_flat_m / -height.min()
    return Scar(x, y, kept * np.maximum(-deepest, 0.0))


def pictures(
    traces: Mapping[float, Sequence[tuple[ContactLaw, Trace]]], radius: float
) -> list[Picture]:
    """Figures 5.4-5.6, one for each angle [degrees], from the traces of several laws."""
    measured = {
        float(e["angle_deg"]): e for e in read_toml(REFERENCE / "chapter45.toml")["experiment"]
    }
    numbers = {20.0: "5.4", 45.0: "5.5", 70.0: "5.6"}
    return [_scar(numbers[a], a, traces[a], measured[a], radius) for a in sorted(traces)]


def _scar(
    number: str, angle: float, traces: Sequence[tuple[ContactLaw, Trace]],
    experiment: Mapping[str, Any], radius: float,
) -> Picture:  # fmt: skip
    made, axes = sheet(2, size=(5.6, 4.4))
    first = scar(traces[0][1], radius)
    middle = float(first.x[np.argmax(first.depth.max(axis=0))])
    drawn = axes[0].contourf(1e6 * (first.x - middle), 1e6 * first.y, 1e6 * first.depth, levels=12,
                             cmap="viridis")  # fmt: skip
    axes[0].contour(1e6 * (first.x - middle), 1e6 * first.y, 1e6 * first.depth, levels=[1e-3],
                    colors="w", linewidths=1.0)  # fmt: skip
    made.colorbar(drawn, ax=axes[0], label="depth [um]", shrink=0.85)
    axes[0].set_aspect("equal")
    axes[0].set_title(f"{traces[0][0].name}, {angle:g} degrees", fontsize=9)
    finish(axes[0], x="along the sliding direction [um]", y="across [um]")
    told = []
    for law, trace in traces:
        found = scar(trace, radius)
        row = int(np.argmax(found.depth.max(axis=1)))
        shift = float(found.x[np.argmax(found.depth.max(axis=0))])
        axes[1].plot(1e6 * (found.x - shift), -1e6 * found.depth[row], **look(law))
        told.append(f"{law.name} {1e6 * found.deepest:.0f}, {1e6 * found.sliding_length:.0f}")
    depth, slid = -1e6 * experiment["depth_m"], -1e6 * experiment["sliding_m"]
    half = 0.5 * (slid + 2.0 * np.sqrt(2e6 * radius * depth))
    axes[1].plot([-half, -half, half, half], [0.0, -depth, -depth, 0.0], "k--", lw=1.0,
                 label="measured depth and length")  # fmt: skip
    axes[1].set_title("section along the middle", fontsize=9)
    finish(axes[1], x="along the sliding direction [um]", y="height [um]")
    note = (
        f"Depth, and length minus width [um]: {'; '.join(told)}; measured {depth:.0f}, "
        f"{slid:.0f}. {_WHY[number]}"
    )
    return Picture(number, f"Predicted scar, {angle:g} degrees", made, note)


_WHY = {
    "5.4": "One contact of a rigid rod leaves a nearly round dent, three times too deep and far "
    "too short: the rod vibrates and touches again.",
    "5.5": "As at 20 degrees; the measured scar deepens early and is drawn out afterwards.",
    "5.6": "The measured scar is shallower by half, short, and deepest at its end: there the tip "
    "stuck or rolled, which constant friction of 0.10 does not give.",
}
