"""Figures 2.2-2.4 of the thesis redrawn, and what its text says of them measured."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..... import fem
from .....campaigns.cases.pairs import pair_of
from .....core.arrays import Array, Integers, Mask
from ...bench import Bench, Effort
from ...result import Measurement, Result

_RATIOS = (0.1, 1.0, 10.0)
_FIGURES = {0.1: "2.2", 1.0: "2.3", 10.0: "2.4"}
_DEPTHS = (0.001, 0.01)
_THESIS = "thesis, section 2.3, text to figure"


@dataclass(frozen=True)
class Drawn:
    """One state and its contact radius [m]."""

    ratio: float
    snapshot: fem.Snapshot
    radius: float


def run(bench: Bench) -> Result:
    """Solve the three pairs of the figures, draw them and look where they yield."""
    accuracy = fem.Accuracy.smoke() if bench.effort is Effort.QUICK else fem.Accuracy.quick()
    states: list[Drawn] = []
    for ratio in _RATIOS:
        pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=ratio)
        bench.say(f"  solving Sy* = {ratio:g} at level {accuracy.level}")
        problem = fem.ContactProblem(pair, _DEPTHS, snapshots=_DEPTHS)
        solution = fem.solve(problem, accuracy=accuracy)
        states += [
            Drawn(ratio, snapshot, float(radius))
            for snapshot, radius in zip(solution.snapshots, solution.loading.radius, strict=True)
        ]
    bench.pictures.mkdir(parents=True, exist_ok=True)
    name = "plastic-zones.png"
    _draw(states, bench.pictures / name)
    last = {s.ratio: s for s in states if s.snapshot.depth == _DEPTHS[-1]}
    return Result(
        name="plastic-zones",
        title="Plastic zones: figures 2.2 to 2.4",
        about=(
            "E = 200 GPa, nu = 0.3, weaker body 503 MPa, Sy* = 0.1, 1, 10, level "
            f"`{accuracy.level}`. Each sentence of the thesis on the zones is measured at Delta/R "
            f"= {_DEPTHS[-1]:g}."
        ),
        measurements=_as_described(last),
        pictures=(
            (
                name,
                "Von Mises stress over the weaker body's strength, both bodies deformed, mirrored; "
                "white line: edge of the plastic zone. Columns: Sy* = 0.1, 1, 10 (figures 2.2, "
                "2.3, 2.4); rows: Delta/R = 0.001 and 0.01. Lengths in contact radii.",
            ),
        ),
        notes=(
            "At Delta/R = 0.001, seven times the depth of first yield, the zones have reached the "
            "surface near the edge of the contact and leave an elastic core at the surface in the "
            "middle. At Delta/R = 0.01 and Sy* = 1 both bodies are at their strength over the "
            "whole contact, which is the "
            "thesis's statement to figure 2.3. At Sy* = 10 the flat yields beside the contact and "
            "piles up; at Sy* = 0.1 the flat stays elastic and its largest stress on the surface "
            "sits at the last point of contact.",
        ),
    )


def _as_described(last: dict[float, Drawn]) -> tuple[Measurement, ...]:
    flattened, equal, indented = (last[ratio] for ratio in _RATIOS)
    r_flat, mises_flat, _ = _surface(flattened, sphere=False)
    shares = [_plastic_share(equal, sphere=sphere) for sphere in (True, False)]
    r, _, strain = _surface(indented, sphere=False)
    reach = float(r[strain > 0.0].max() / indented.radius)
    peak = float(r_flat[np.argmax(mises_flat)] / flattened.radius)
    return (
        Measurement("2.2: largest plastic strain of the flat", _strain(flattened, sphere=False), "",
                    None, 0.0, f"{_THESIS} 2.2: flat elastic"),
        Measurement("2.2: where the flat's surface is stressed most, r/a", peak, "", 0.85, 1.15,
                    f"{_THESIS} 2.2: at the last point of contact"),
        Measurement("2.3: plastic part of the contact, sphere", shares[0], "", 0.95, None,
                    f"{_THESIS} 2.3: over the whole contact area"),
        Measurement("2.3: plastic part of the contact, flat", shares[1], "", 0.95, None,
                    f"{_THESIS} 2.3: over the whole contact area"),
        Measurement("2.4: largest plastic strain of the sphere", _strain(indented, sphere=True), "",
                    None, 0.0, f"{_THESIS} 2.4: sphere below yield"),
        Measurement("2.4: how far the flat's surface has yielded, r/a", reach, "", 1.0, None,
                    f"{_THESIS} 2.4: yield outside of the contact"),
    )  # fmt: skip


def _body(drawn: Drawn, *, sphere: bool) -> Integers:
    n = drawn.snapshot.n_sphere_quads
    return np.arange(n) if sphere else np.arange(n, len(drawn.snapshot.quads))


def _strain(drawn: Drawn, *, sphere: bool) -> float:
    return float(drawn.snapshot.plastic_strain[_body(drawn, sphere=sphere)].max())


def _surface(drawn: Drawn, *, sphere: bool) -> tuple[Array, Array, Array]:
    """Current radius, von Mises stress and plastic strain of the elements along a surface."""
    s = drawn.snapshot
    x = s.points[s.quads]
    scale = float(s.points[:, 1].max())
    if sphere:
        on = np.abs(np.hypot(x[..., 0], x[..., 1] - scale) - scale) < 1e-9 * scale
    else:
        on = np.abs(x[..., 1]) < 1e-12 * scale
    body = np.zeros(len(s.quads), dtype=bool)
    body[_body(drawn, sphere=sphere)] = True
    r = (s.points + s.displacement)[s.quads][..., 0].mean(axis=1)
    chosen = np.flatnonzero(body & (on.sum(axis=1) == 2) & (r < 3.0 * drawn.radius))
    return r[chosen], s.von_mises[chosen], s.plastic_strain[chosen]


def _plastic_share(drawn: Drawn, *, sphere: bool) -> float:
    """Part of the contact area under which the first element has yielded."""
    r, _, strain = _surface(drawn, sphere=sphere)
    inside = r < drawn.radius
    order = np.argsort(r[inside])
    area = np.gradient(r[inside][order] ** 2)
    return float(area[strain[inside][order] > 0.0].sum() / area.sum())


def _draw(states: list[Drawn], path: Path) -> None:
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.figure import Figure
    from PIL import Image

    figure = Figure(figsize=(12, 7.5), layout="constrained")
    axes = figure.subplots(len(_DEPTHS), len(_RATIOS))
    for drawn in states:
        s = drawn.snapshot
        axis = axes[_DEPTHS.index(s.depth), _RATIOS.index(drawn.ratio)]
        extent = 2.6
        points = (s.points + s.displacement) / drawn.radius
        points[:, 1] -= points[np.argmin(np.hypot(*s.points.T)), 1]
        near = np.hypot(*points[s.quads].mean(axis=1).T) < 1.6 * extent
        strength = 503e6
        for side in (1.0, -1.0):
            corners = points[s.quads[near]] * np.array([side, 1.0])
            cells = PolyCollection(list(corners), array=s.von_mises[near] / strength, cmap="turbo",
                                   edgecolors="face", linewidths=0.2)  # fmt: skip
            cells.set_clim(0.0, 1.5)
            axis.add_collection(cells)
            lines = LineCollection(_edge(s, points, near, side), colors="white", linewidths=1.2)
            axis.add_collection(lines)
        axis.set_xlim(-extent, extent)
        axis.set_ylim(-extent, extent)
        axis.set_aspect("equal")
        axis.set(xlabel="r/a [-]", ylabel="z/a [-]")
        axis.label_outer()
        axis.set_title(
            rf"figure {_FIGURES[drawn.ratio]}: $S_y^*$ = {drawn.ratio:g}, "
            rf"$\Delta/R$ = {s.depth:g}, $a/R$ = {drawn.radius * 1e3:.3f}",
            fontsize=9,
        )
    figure.colorbar(
        cells,
        ax=axes,
        label="von Mises stress over 503 MPa [-]; white: edge of the plastic zone",
        shrink=0.8,
    )
    figure.savefig(path, dpi=90)
    Image.open(path).convert("RGB").quantize(96).save(path, optimize=True)


def _edge(s: fem.Snapshot, points: Array, near: Mask, side: float) -> list[Array]:
    """Element edges between plastic and elastic elements."""
    quads, plastic = s.quads[near], s.plastic_strain[near] > 0.0
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(plastic, 4)
    keys, index, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    n_plastic = np.bincount(index.ravel(), weights=owner)
    chosen = (n_plastic == 1) & (count == 2)
    return [points[key] * np.array([side, 1.0]) for key in keys[chosen]]
