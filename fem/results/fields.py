"""Fields of a solve as files and pictures: VTU through meshio, for ParaView, and PNG."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.arrays import Array, Integers
from ...core.output import figure, write_file
from ..solution import Snapshot

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def write_vtu(snapshot: Snapshot, path: Path) -> Path:
    """Write the deformed meridian section of both bodies with its fields.

    Cell data: `body` (0 sphere, 1 flat), `von_mises_Pa`, `plastic_strain`, `mean_stress_Pa` and the
    stress components; point data: `displacement_m`.
    """
    import meshio

    current = snapshot.points + snapshot.displacement
    n = len(snapshot.quads)
    body = (np.arange(n) >= snapshot.n_sphere_quads).astype(float)
    mesh = meshio.Mesh(
        points=np.column_stack([current, np.zeros(len(current))]),
        cells=[("quad", snapshot.quads)],
        point_data={
            "displacement_m": np.column_stack([snapshot.displacement, np.zeros(len(current))])
        },
        cell_data={
            "body": [body],
            "von_mises_Pa": [snapshot.von_mises],
            "plastic_strain": [snapshot.plastic_strain],
            "mean_stress_Pa": [snapshot.mean_stress],
            **{
                f"stress_{name}_Pa": [snapshot.stress[:, i]]
                for i, name in enumerate(("rr", "zz", "rz", "tt"))
            },
        },
    )
    with tempfile.TemporaryDirectory() as folder:  # its writer takes names of files only
        mesh.write(made := Path(folder) / "fields.vtu")
        return write_file(path, made.read_bytes())


def section(snapshot: Snapshot, *, Sy_min: float, extent: float) -> Figure:
    """Return the deformed section: von Mises stress to the left, plastic strain to the right.

    Where nothing flows the stress, over Sy_min [Pa], is on both sides; `extent` is half the width
    of the picture [m].
    """
    unit, scale = ("mm", 1e3) if extent >= 1e-3 else ("um", 1e6)
    points = scale * (snapshot.points + snapshot.displacement)
    made, ((axis,),) = figure(1, 1, size=(8.4, 6.4))
    stress, strain = snapshot.von_mises / Sy_min, 100.0 * snapshot.plastic_strain
    flows = bool((strain > 0.0).any())
    sides = [(-1.0, stress, "turbo", "von Mises stress over the weaker strength [-]")]
    sides += [(1.0, strain, "magma_r", "equivalent plastic strain [%]") if flows
              else (1.0, *sides[0][1:])]  # fmt: skip
    near = np.hypot(*points[snapshot.quads].mean(axis=1).T) < 2.0 * scale * extent
    first = np.arange(len(snapshot.quads)) < snapshot.n_sphere_quads
    for side, values, colours, label in sides:
        seen = values[near & (values > 0.0)]
        most = float(np.quantile(seen, 0.995)) if len(seen) else 1.0
        for body in (near & first, near & ~first):
            drawn = _shaded(axis, points * [side, 1.0], snapshot.quads[body], values[body])
            drawn.set(cmap=colours, clim=(0.0, most))
        if side < 0.0 or flows:
            place = "left" if flows and side < 0.0 else "right"
            bar = made.colorbar(drawn, ax=axis, extend="max", location=place, shrink=0.85)
            bar.set_label(label, fontsize=10)
    for name, mine in (("sphere", True), ("flat", False)):
        _outline(axis, snapshot, points, sphere=mine)
        axis.text(-0.97, 0.95 if mine else -0.97, name, transform=_in_halves(axis), fontsize=11,
                  bbox={"facecolor": "w", "alpha": 0.7, "edgecolor": "none"})  # fmt: skip
    half = scale * extent
    axis.axvline(0.0, color="w", lw=0.8)
    axis.set(
        xlim=(-half, half), ylim=(-half, half), aspect="equal", xlabel=f"radius r [{unit}]",
        ylabel=f"height z [{unit}]",
        title=f"approach {snapshot.depth:.3g} of the sphere's radius, deformed, to scale",
    )  # fmt: skip
    return made


def _shaded(axis: Any, points: Array, quads: Integers, values: Array) -> Any:
    """Draw one body's values, means at the nodes, without steps from element to element."""
    nodes, corners = np.unique(quads, return_inverse=True)
    corners = corners.reshape(quads.shape)
    total, count = (
        np.bincount(corners.ravel(), weights=np.repeat(w, 4))
        for w in (values, np.ones_like(values))
    )
    triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    return axis.tripcolor(*points[nodes].T, triangles, total / count, shading="gouraud")


def _in_halves(axis: Any) -> Any:
    """Coordinates from -1 to 1 across the axes."""
    from matplotlib.transforms import Affine2D

    return Affine2D().translate(1.0, 1.0).scale(0.5) + axis.transAxes


def _outline(axis: Any, snapshot: Snapshot, points: Array, *, sphere: bool) -> None:
    """Draw the edges that belong to one element only: a body's surface."""
    n = snapshot.n_sphere_quads
    quads = snapshot.quads[:n] if sphere else snapshot.quads[n:]
    edges = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    alone, count = np.unique(edges, axis=0, return_counts=True)
    for a, b in alone[count == 1]:
        if max(abs(snapshot.points[a, 0]), abs(snapshot.points[b, 0])) == 0.0:
            continue  # the axis of symmetry is no surface
        for side in (1.0, -1.0):
            axis.plot(side * points[[a, b], 0], points[[a, b], 1], "k", lw=0.7)
