"""The two bodies in space, a quarter cut away, with the stresses on the cut: by pyvista."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array, Integers
from ...core.output import write_file
from ...core.rendering import offscreen_available, offscreen_plotter
from ..solution import Snapshot

# limit: steps of the turn [-]: three degrees: no eye sees corners
_TURN_STEPS = 90

# limit: what a picture leaves of the bodies [degrees]: a quarter is cut out
_TURN_LEFT = 270.0

_LABEL = "von Mises stress over the weaker body's strength"


def draw_cutaway(snapshot: Snapshot, path: Path, *, Sy_min: float, extent: float) -> Path | None:
    """Draw von Mises stress over Sy_min [Pa] on a cut through the deformed bodies.

    `extent` is half the width of the picture [m]. None where nothing can be rendered without a
    screen.
    """
    if not offscreen_available():
        return None
    import pyvista

    points = (snapshot.points + snapshot.displacement) / extent
    stress = snapshot.von_mises / Sy_min
    near = np.hypot(*points[snapshot.quads].mean(axis=1).T) < 1.0
    first = np.arange(len(snapshot.quads)) < snapshot.n_sphere_quads
    limits = (0.0, max(1.0, float(np.quantile(stress[near], 0.999))))
    plotter = offscreen_plotter(1200, 1000)
    for body in (near & first, near & ~first):
        section = _section(pyvista, points, snapshot.quads[body], stress[body])
        for face in (section, section.rotate_z(_TURN_LEFT)):
            plotter.add_mesh(
                face, scalars=_LABEL, cmap="turbo", clim=limits, lighting=False,
                scalar_bar_args={
                    # a blank line, or its words stand on the numbers
                    "title": f"{_LABEL}\n", "color": "black", "n_labels": 5, "fmt": "%.2f",
                    "width": 0.6, "position_x": 0.2, "position_y": 0.03, "title_font_size": 20,
                    "label_font_size": 18,
                },
            )  # fmt: skip
        skin = section.extract_feature_edges(feature_edges=False, manifold_edges=False)
        turned = skin.extrude_rotate(resolution=_TURN_STEPS, angle=_TURN_LEFT, capping=False)
        plotter.add_mesh(turned, color="lightgrey", smooth_shading=True)
    plotter.set_background("white")
    plotter.camera_position = [(3.9, -2.5, 2.0), (0.0, 0.0, -0.2), (0.0, 0.0, 1.0)]
    stream = io.BytesIO()
    plotter.screenshot(stream)
    plotter.close()
    return write_file(path, stream.getvalue())


def _section(pyvista: Any, points: Array, quads: Integers, stress: Array) -> Any:
    """One half of a meridian section, in the plane y = 0."""
    used, place = np.unique(quads, return_inverse=True)
    corners = place.reshape(quads.shape)
    xyz = np.column_stack([points[used, 0], np.zeros(len(used)), points[used, 1]])
    section = pyvista.PolyData(xyz, np.column_stack([np.full(len(quads), 4), corners]).ravel())
    section.cell_data[_LABEL] = stress
    return section
