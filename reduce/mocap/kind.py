"""Marker tracks, read, fitted and drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.inputs.toml_input import read_model
from ..measured import Measured, labelled, labels
from ..pictures import drawn_if_refused
from ..reduced import Reduced
from .body import BodyFile, make_body
from .file import Markers, read_markers
from .options import MocapOptions
from .picture import draw_mocap, draw_point
from .point import PointBounce, reduce_point
from .reduction import Hit, MocapScene, reduce_mocap
from .rigid import rigid_poses


def reduce(path: Path, options: MocapOptions) -> Reduced:
    """Fit a rigid body to the markers and read its motion before and after each impact."""
    places = read_model(Path(options.body), BodyFile).markers if options.body else {}
    markers = read_markers(
        path, unit=None if options.unit == "file" else options.unit, rate=options.frame_rate_hz,
        select=options.select, points=places,
    )  # fmt: skip
    markers = markers.part(options.first_frame, options.last_frame)
    if options.markers:
        markers = markers.only(tuple(n.strip() for n in options.markers.split(",")))
    up = np.zeros(3)
    up["xyz".index(options.up[-1])] = -1.0 if options.up.startswith("-") else 1.0
    scene = MocapScene(up, options.gravity_m_s2, options.length_scale_std)
    if options.shape == "sphere" and len(markers.names) == 1:
        return _point(path, markers, scene, options)
    poses = rigid_poses(markers)
    body, remarks = make_body(
        poses, markers, shape=options.shape, tip_radius=options.tip_radius_m or 0.0,
        length=(options.length_m or 0.0) if options.shape == "rod" else 0.0,
        radius=options.radius_m, file=Path(options.body) if options.body else None,
        axis=options.two_ends,
    )  # fmt: skip
    heights = markers.position @ up
    seen = np.isfinite(heights).any(axis=1)
    height = np.full(seen.size, np.nan)
    height[seen] = np.nanmean(heights[seen], axis=1)
    axes = ("time [s]", "mean height of the markers [m]")
    with drawn_if_refused(markers.time, height, axes=axes):
        found = reduce_mocap(poses, body, scene, source=str(path))
    missing = f"{100.0 * markers.missing:.2g} % of the marker positions are missing"
    noise = {"frame_rate_hz": found.rate, "tip_height_m": found.flights.sigma}
    return Reduced(
        source=path, values=_values("marker", found.flights.sigma, found.fall, found.hits),
        trials=found.trials(), notes=(missing, *remarks, *found.notes), noise=noise,
        draw=lambda picture: draw_mocap(found, picture),
    )  # fmt: skip


def _point(path: Path, markers: Markers, scene: MocapScene, options: MocapOptions) -> Reduced:
    axes, height = ("time [s]", "height of the marker [m]"), markers.position[:, 0] @ scene.up
    with drawn_if_refused(markers.time, height, axes=axes):
        found = reduce_point(markers, scene, spin=options.spin)
    return Reduced(
        source=path, values=_values("position", found.noise, found.fall, found.bounces),
        trials=found.trials(), notes=found.notes,
        draw=lambda picture: draw_point(found, picture), noise={"frame_rate_hz": markers.rate},
    )  # fmt: skip


def _values(
    of: str, noise: float, fall: Measured, found: Sequence[Hit | PointBounce]
) -> dict[str, Measured]:
    each = labelled(zip(labels(len(found)), (one.measured for one in found), strict=True))
    return {f"{of}_noise_m": Measured(noise, math.nan), "fall_acceleration_m_s2": fall, **each}
