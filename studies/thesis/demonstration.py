"""Chapter 5 of the thesis as a demonstration: no parameter is fitted to its measurements.

Every mechanism that applies, and every pair, is put into the simulation of the three oblique drops
at constants from the literature. What comes out is compared with the measured crater depth,
sliding length, restitution and impulse ratio. Durations and forces that the thesis inferred are
not used: they are not measurements. The measured impulse ratio is the friction coefficient that
goes in, as in the thesis; it comes out again only while the tip slides one way.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...core.material import Material
from ...core.toml_input import read_toml
from ...discrepancy.forward import ACCURACY, SIMULATED
from ...discrepancy.inference.fit import label
from ...discrepancy.mechanisms import MECHANISMS, Mechanism, Surroundings
from ...discrepancy.mechanisms.base import attached, observed
from ...impact import Approach, Friction, Scene, scene_of, strike_batch
from ...impact import compiled as c
from ...models import LAWS
from .chapter3 import REFERENCE
from .chapter5 import thesis_rod

Array = NDArray[np.float64]

OBSERVED = ("permanent_depth_m", "sliding_length_m", "restitution", "friction_impulse_ratio")


@dataclass(frozen=True, eq=False)
class Row:
    """One explanation at literature constants.

    Parameters
    ----------
    name
        Mechanisms joined by "+".
    predicted
        (angles, observables) as `OBSERVED` [SI].
    miss
        Mean of |ln(predicted/measured)|.
    """

    name: str
    predicted: Array
    miss: float


@dataclass(frozen=True, eq=False)
class Demonstration:
    """All explanations, best first, beside the measurements.

    Parameters
    ----------
    angles
        (3,) [deg].
    measured
        (angles, observables).
    rows
        Best first; the baseline among them.
    permuted
        For each other order of the angles, the names in the order of their miss.
    """

    angles: Array
    measured: Array
    rows: tuple[Row, ...]
    permuted: tuple[tuple[str, ...], ...]


def demonstrate() -> Demonstration:
    """Simulate chapter 5 with every mechanism and pair at literature constants."""
    data = read_toml(REFERENCE / "chapter45.toml")
    experiments = data["experiment"]
    measured = np.array(
        [[-e["depth_m"], -e["sliding_m"], e["restitution"], e["friction"]] for e in experiments]
    )
    scenes = [_scene(data, e) for e in experiments]
    around = Surroundings(thickness=float(data["flat"].get("thickness_m", 0.03)))
    situations = [(s, around) for s in scenes]
    usable = [m for m in MECHANISMS if m.literature and not m.applies(situations)]
    candidates: list[tuple[Mechanism, ...]] = [(), *((m,) for m in usable)]
    candidates += list(itertools.combinations(usable, 2))
    predictions = _predict(scenes, around, candidates)
    rows = [
        Row(label(ms), p, _miss(p, measured)) for ms, p in zip(candidates, predictions, strict=True)
    ]
    permuted = []
    for order in itertools.permutations(range(len(experiments))):
        if order == tuple(range(len(experiments))):
            continue
        misses = [_miss(p, measured[list(order)]) for p in predictions]
        permuted.append(tuple(rows[i].name for i in np.argsort(misses, kind="stable")))
    rows.sort(key=lambda r: r.miss)
    angles = np.array([float(e["angle_deg"]) for e in experiments])
    return Demonstration(angles, measured, tuple(rows), tuple(permuted))


def _scene(data: Mapping[str, Any], experiment: Mapping[str, Any]) -> Scene:
    rod, flat = (
        Material(b["E_Pa"], b["nu"], b["Sy_Pa"], density=b["density_kg_m3"])
        for b in (data["rod"], data["flat"])
    )
    return scene_of(
        LAWS.get("fitted") or LAWS["ghaednia"], sphere=rod, flat=flat, striker=thesis_rod(),
        approach=Approach(-experiment["approach_m_s"], math.radians(experiment["angle_deg"])),
        friction=Friction(experiment["friction"]),
    )  # fmt: skip


def _predict(
    scenes: Sequence[Scene], around: Surroundings, candidates: Sequence[tuple[Mechanism, ...]]
) -> list[Array]:
    constants = {m.name: m.literature for m in MECHANISMS}
    changed = [
        attached(mechanisms, scene, constants, around)
        for mechanisms in candidates
        for scene in scenes
    ]
    rows = strike_batch(changed, ACCURACY)
    situations = [(s, around) for s in scenes]
    n, found = len(scenes), []
    for i, mechanisms in enumerate(candidates):
        part = rows[i * n : (i + 1) * n]
        seen = {k: part[:, c.OBSERVABLES.index(v)].copy() for k, v in SIMULATED.items()}
        seen = dict(observed(mechanisms, situations, constants, seen))
        found.append(np.stack([seen[name] for name in OBSERVED], axis=1))
    return found


def _miss(predicted: Array, measured: Array) -> float:
    ratio = np.maximum(predicted, 1e-12) / measured
    return float(np.mean(np.abs(np.log(ratio))))


def table(found: Demonstration, *, most: int = 12) -> list[str]:
    """Return the demonstration as lines: the best explanations, the baseline, what remains."""
    head = "explanation (literature constants, nothing fitted)"
    out = [
        f"{head:58s} miss   "
        + "  ".join(f"{a:.0f} deg: d um, s um, e, ratio" for a in found.angles)
    ]

    def line(name: str, miss: str, values: Array) -> str:
        cells = "  ".join(
            f"{1e6 * v[0]:5.0f} {1e6 * v[1]:6.0f} {v[2]:5.2f} {v[3]:6.3f}" for v in values
        )
        return f"{name:58s} {miss:5s}  {cells}"

    out.append(line("measured (thesis)", "", found.measured))
    chosen = list(found.rows[:most])
    chosen += [r for r in found.rows[most:] if r.name == "baseline"]
    out += [line(r.name, f"{r.miss:.2f}", r.predicted) for r in chosen]
    best = found.rows[0]
    ratio = best.predicted / found.measured
    worst = np.unravel_index(int(np.argmax(np.abs(np.log(np.maximum(ratio, 1e-12))))), ratio.shape)
    same = sum(names[0] == best.name for names in found.permuted)
    base = next(r for r in found.rows if r.name == "baseline")
    out += [
        "",
        f"The best, {best.name}, misses by a factor of {math.exp(best.miss):.2f} on average; the "
        f"baseline by {math.exp(base.miss):.2f}.",
        f"What remains: {OBSERVED[worst[1]]} at {found.angles[worst[0]]:.0f} degrees is "
        f"{ratio[worst]:.2f} times the measured one.",
        f"With the measurements dealt out to the wrong angles, the same explanation still comes "
        f"first in {same} of {len(found.permuted)} orders.",
    ]
    return out


def draw(found: Demonstration, path: Path) -> None:
    """Draw measured and predicted values over the angle."""
    figure = Figure(figsize=(9.2, 6.0), layout="constrained")
    axes = figure.subplots(2, 2).ravel()
    titles = ("crater depth [um]", "sliding length [um]", "restitution [-]", "impulse ratio [-]")
    scale = (1e6, 1e6, 1.0, 1.0)
    base = next(r for r in found.rows if r.name == "baseline")
    shown = [
        (base, "#8a94a3"),
        *zip(found.rows[:3], ("#2b6cb0", "#c05621", "#2f855a"), strict=True),
    ]
    for k, axis in enumerate(axes):
        axis.plot(found.angles, scale[k] * found.measured[:, k], "ks", label="measured (thesis)")
        for row, colour in shown:
            axis.plot(
                found.angles, scale[k] * row.predicted[:, k], "o-", color=colour, ms=4, lw=1,
                label=row.name,
            )  # fmt: skip
        axis.set_title(titles[k], fontsize=10)
        axis.set_xlabel("angle of the rod [deg]", fontsize=9)
        axis.set_ylim(bottom=0.0)
    axes[0].legend(fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    FigureCanvasAgg(figure).print_png(str(path))
