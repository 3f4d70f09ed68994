"""Fields of a solve as files and pictures: VTU through meshio, pictures through pyvista.

Where pyvista cannot render (see `core.rendering`) matplotlib draws the same picture, and the caller
is told which of the two it was.
"""

from __future__ import annotations

import io
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..core.output import write_figure, write_file
from ..core.rendering import offscreen_available
from .solution import Snapshot

Floats = npt.NDArray[np.float64]


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


def draw_section(snapshot: Snapshot, path: Path, *, Sy_min: float, extent: float) -> str:
    """Draw von Mises stress over the weaker body's strength on the full deformed section.

    Parameters
    ----------
    snapshot
        The fields.
    path
        PNG file.
    Sy_min
        Strength that the stress is shown over [Pa].
    extent
        Half width of the picture [m].

    Returns
    -------
    str
        What drew it, `"pyvista"` or `"matplotlib"`.
    """
    points = snapshot.points + snapshot.displacement
    near = np.hypot(*points[snapshot.quads].mean(axis=1).T) < 2.0 * extent
    quads, stress = snapshot.quads[near], snapshot.von_mises[near] / Sy_min
    if offscreen_available():
        _by_pyvista(points, quads, stress, path, extent)
        return "pyvista"
    _by_matplotlib(points, quads, stress, path, extent)
    return "matplotlib"


_LABEL = "von Mises stress / strength of the weaker body"


def _by_pyvista(
    points: Floats, quads: npt.NDArray[np.int64], stress: Floats, path: Path, extent: float
) -> None:
    import pyvista

    plotter: Any = pyvista.Plotter(off_screen=True, window_size=(1200, 1000))
    faces = np.column_stack([np.full(len(quads), 4), quads]).ravel()
    for side in (1.0, -1.0):
        xyz = np.column_stack([side * points[:, 0], points[:, 1], np.zeros(len(points))]) / extent
        section = pyvista.PolyData(xyz, faces)
        section.cell_data[_LABEL] = stress
        plotter.add_mesh(
            section,
            scalars=_LABEL,
            cmap="turbo",
            clim=(0.0, max(1.0, float(np.quantile(stress, 0.999)))),
            show_scalar_bar=side > 0.0,
            scalar_bar_args={
                "vertical": True,
                "position_x": 0.88,
                "position_y": 0.25,
                "height": 0.5,
                "color": "black",
                "title": "Mises/Sy",
            },
        )
    plotter.set_background("white")
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 1.0
    plotter.camera.focal_point = (0.0, 0.0, 0.0)
    plotter.camera.position = (0.0, 0.0, 5.0)
    stream = io.BytesIO()
    plotter.screenshot(stream)
    plotter.close()
    write_file(path, stream.getvalue())


def _by_matplotlib(
    points: Floats, quads: npt.NDArray[np.int64], stress: Floats, path: Path, extent: float
) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 7), layout="constrained")
    axis = figure.subplots()
    for side in (1.0, -1.0):
        corners = points[quads] * np.array([side, 1.0]) * 1e3
        collection = PolyCollection(list(corners), array=stress, cmap="turbo")
        collection.set_clim(0.0, max(1.0, float(np.quantile(stress, 0.999))))
        axis.add_collection(collection)
    figure.colorbar(collection, ax=axis, label=_LABEL)
    axis.set_xlim(-extent * 1e3, extent * 1e3)
    axis.set_ylim(-extent * 1e3, extent * 1e3)
    axis.set_aspect("equal")
    axis.set_xlabel("r [mm]")
    axis.set_ylabel("z [mm]")
    write_figure(figure, path, dpi=140)
