"""Profilometer files: heights on a grid, in metres."""

from __future__ import annotations

import math
import warnings
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from io import StringIO
from itertools import takewhile
from pathlib import Path

import meshio
import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator
from scipy.spatial import cKDTree

from ...core.arrays import Array
from ...core.errors import InputError, first_line, optional
from ...core.inputs.csv_table import number, shown
from ..shared.units import LARGEST_NUMBER, LENGTH, metres
from ..table.cells import UNSEEN
from ..table.file import is_data, numbered_lines, text_rows
from ..table.heading import unit_in

# limit: distance of neighbouring points at most [m]; one reader's format gives 0.3 m for 0.3 um
_SCAN_STEP = 1e-3

# limit: points of a scan at least [-]
_SCAN_POINTS = 100

# limit: points a byte of a packed file at most [-]: what compression gives of a level plane
_PACKED_POINTS = 50

# limit: gap between a filling and all heights at least, in their range [-]; -9999 beside um
_FILLING = 3.0

# limit: distance of a grid point from the next point of a cloud, in steps [-]; a gap is wider
_OPEN = 1.5

# limit: part of such a grid that is seen at least [-]; a round piece fills three quarters
_COVERED = 0.5

# limit: points of a scan at most [-]: memory of a small machine
_SCAN_MOST = 100_000_000


@dataclass(frozen=True)
class Scan:
    """Heights on a grid: `z` (nx, ny) with NaN where nothing was seen [m], `step` (2,) [m]."""

    z: Array
    step: Array
    source: str


def read_scan(
    path: Path, *, unit: str | None = None, height_unit: str | None = None,
    step: float | None = None,
) -> Scan:  # fmt: skip
    """Read any file that SurfaceTopography knows, a mesh's points, or comma-separated numbers.

    Units of length along the surface and of the heights (by default the same), of `units.LENGTH`,
    and the distance of neighbouring points [m] are for files that name none or a wrong one. A line,
    and a file that does not say them, are refused.
    """
    found = _READERS.get(path.suffix.lower(), _known_format)(path)
    heights = _without_filling(np.where(np.abs(found.z) < LARGEST_NUMBER, found.z, np.nan))
    if heights.size < _SCAN_POINTS or np.isfinite(heights).sum() < 0.05 * heights.size:
        raise InputError(
            f"{int(np.isfinite(heights).sum())} heights in it", source=str(path),
            allowed=f"{_SCAN_POINTS} or more, seen in a twentieth of the points or more",
        )  # fmt: skip
    heights = heights * _factor(height_unit or unit or found.z_unit or found.unit, path)
    steps = np.full(2, step or np.nan)
    if step is None and found.step is not None:
        steps = found.step * _factor(unit or found.unit, path)
    if not np.all(np.isfinite(steps) & (steps > 0.0)):
        raise InputError(
            "the file does not say the distance of its points", source=str(path), key="step_m",
            allowed="a distance above 0",
        )  # fmt: skip
    if step is None:
        _refuse_far(float(steps.max()), path)
    return Scan(heights, steps, str(path))


@dataclass(frozen=True)
class _Raw:
    """What a file says, in its own unit; `z_unit` is that of the heights, if said for itself."""

    z: Array
    step: Array | None = None
    unit: str | None = None
    z_unit: str | None = None


def _without_filling(z: Array) -> Array:
    """Heights without the number that fills points not seen: one, far from all others."""
    for end in (np.min, np.max):
        seen = z[np.isfinite(z)]
        others = seen[seen != end(seen)] if seen.size else seen
        if seen.size > others.size + 1 and others.size:
            away = float(np.abs(others - end(seen)).min())
            if away > _FILLING * float(np.ptp(others)) > 0.0:
                z = np.where(z == end(seen), np.nan, z)
    return z


def _refuse_far(step: float, path: Path) -> None:
    """Refuse points so far apart that the unit must be wrong."""
    if step > _SCAN_STEP:
        raise InputError(
            f"its points are {step:.3g} m apart, {step / _SCAN_STEP:.0f} times as far as in a scan",
            source=str(path),
            allowed=f"--unit or --step-m, where neighbours are {_SCAN_STEP:g} m apart or less",
        )  # fmt: skip


def _known_format(path: Path) -> _Raw:
    """Read a file with SurfaceTopography."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        library = optional("SurfaceTopography", "reading profilometer files", "surface")
    try:
        with warnings.catch_warnings(), redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            warnings.simplefilter("ignore")  # its readers print what they stumble over, in turn
            channel = library.open_topography(str(path)).default_channel
            silent = channel.physical_sizes is None
            sizes = {"physical_sizes": tuple(map(float, channel.nb_grid_pts))} if silent else {}
            _check_claim(channel.nb_grid_pts, path)
            found = channel.topography(**sizes)
            if found.dim == 1:
                raise _a_line(path)
            z = np.ma.filled(np.ma.asarray(found.heights(), dtype=np.float64), np.nan)
            if min(z.shape) < 4:  # x, y and z of points, some of the grid left out
                return _text(path)
            step = None if silent else np.array(found.physical_sizes) / z.shape
            return _Raw(z, step=step, unit=found.unit)
    except InputError:
        raise
    except Exception as error:  # each of its readers raises its own kind
        if path.suffix.lower() == ".xyz":
            return _text(path)
        why = first_line(error)
        told = "" if isinstance(error, LookupError) or why.endswith((":", ": )")) else f" ({why})"
        raise InputError(
            f"cannot be read as a surface scan{told}", source=str(path),
            allowed="a whole file of a format of SurfaceTopography (x3p, sur, al3d, plu, opd, vk, "
            "mnt, xyz ...), points as STL or PLY, or a grid as CSV",
        ) from None  # fmt: skip


def _check_claim(points: tuple[int, ...], path: Path) -> None:
    """Refuse a header that claims more points than the file can hold, before room is made."""
    count, size = math.prod(int(n) for n in points), path.stat().st_size
    if count > min(_SCAN_MOST, _PACKED_POINTS * size):
        raise InputError(
            f"{count} points claimed in {size} bytes", source=str(path),
            allowed=f"up to {_SCAN_MOST:g}, and {_PACKED_POINTS} a byte",
        )  # fmt: skip


def _text(path: Path) -> _Raw:
    """Read a table of numbers: a grid, or three columns of a regular one."""
    lines = numbered_lines(path.read_bytes(), str(path))
    table = text_rows([line for _, line in lines], str(path))
    while all(len(row) > 1 and not row[-1] for row in table):
        table = [row[:-1] for row in table]  # a separator at the end of every line
    rows = [(k, row) for (k, _), row in zip(lines, table, strict=True)]
    # names of the columns, below what an instrument says of itself
    above = list(takewhile(_is_heading, table))
    names, rows = above[-1] if above else [], rows[len(above) :]
    if not rows:
        raise InputError("empty", source=str(path), allowed="heights, one row a line")
    width = len(rows[0][1])
    for n, cells in rows:
        if len(cells) != width:
            raise InputError(
                f"{len(cells)} cells, the first row has {width}", source=str(path),
                key=f"row {n}", allowed="as many cells in each row",
            )  # fmt: skip
        for cell in cells:
            if _is_word(cell):
                raise InputError(
                    shown(cell), source=str(path), key=f"row {n}",
                    allowed="a number, or an empty cell for a point that was not seen",
                )  # fmt: skip
    grid = np.array([[number(c) for c in cells] for _, cells in rows])
    said = [unit_in(name) for name in names] if len(names) == width else [""]
    units = [said[k] if said[k] in LENGTH else None for k in (0, -1)]
    if width == 2:
        raise _a_line(path)
    if width == 3:
        return replace(_regular(grid, path), unit=units[0], z_unit=units[1])
    if min(grid.shape) < 4:
        raise InputError(
            f"{grid.shape[0]} rows of {grid.shape[1]} numbers", source=str(path),
            allowed="a grid of heights, or columns x, y, z",
        )  # fmt: skip
    return _Raw(grid.T)


def _is_heading(row: list[str]) -> bool:
    return row == [""] or (not is_data(row) and any(map(_is_word, row)))


def _is_word(cell: str) -> bool:
    return math.isnan(number(cell)) and cell.strip().lower() not in UNSEEN


def _regular(points: Array, path: Path) -> _Raw:
    """Put columns x, y, z on the grid that they come from."""
    axes = [np.unique(points[:, k]) for k in (0, 1)]
    steps = [np.diff(a) for a in axes]
    even = all(s.size and np.ptp(s) < 0.02 * s.mean() for s in steps)
    if not np.isfinite(points[:, :2]).all() or not even:
        return _scattered(points[np.isfinite(points).all(axis=1)], path)
    z = np.full([a.size for a in axes], np.nan)
    index = tuple(np.searchsorted(a, points[:, k]) for k, a in enumerate(axes))
    z[index] = points[:, 2]
    return _Raw(z, step=np.array([s.mean() for s in steps]))


def _scattered(points: Array, path: Path) -> _Raw:
    """Put points anywhere, of a mesh or a cloud, on a grid as fine as they are: cubic between."""
    size = np.ptp(points[:, :2], axis=0) if len(points) > 3 else np.zeros(2)
    step = math.sqrt(float(np.prod(size)) / max(len(points), 1))
    z = np.full((1, 1), np.nan)
    if 0.0 < step < 0.25 * size.min():
        low = points[:, :2].min(axis=0)
        axes = [np.arange(0.0, s, step) for s in size]
        at = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        between = CloughTocher2DInterpolator(points[:, :2] - low, points[:, 2])(at)
        away = cKDTree(points[:, :2] - low).query(at)[0]
        z = np.where(away < _OPEN * step, between, np.nan)
    if np.isfinite(z).mean() < _COVERED:
        raise InputError(
            f"{len(points)} points x, y that lie on a line, or cover no area", source=str(path),
            allowed="a map: points all over a surface",
        )  # fmt: skip
    return _Raw(z, step=np.full(2, step))


def _mesh(path: Path) -> _Raw:
    """Read the corners of a mesh, heights along its z."""
    with warnings.catch_warnings(), redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        warnings.simplefilter("ignore")
        try:
            x, y, z = np.asarray(meshio.read(path).points, dtype=np.float64).T
        except (Exception, SystemExit):  # its readers raise what they like, and say little
            raise InputError(
                "cannot be read as a mesh", source=str(path), allowed="a whole STL or PLY file"
            ) from None
    return _regular(np.unique(np.stack([x, y, z], axis=1), axis=0), path)


def _factor(unit: str | None, path: Path) -> float:
    return metres(unit or "", source=str(path), allowed=LENGTH if unit else ("m", "mm", "um", "nm"))


def _a_line(path: Path) -> InputError:
    return InputError(
        "heights along a line", source=str(path),
        allowed="a map; a line, as x_m and z_m, belongs into profiles/ of a set, which levels it",
    )  # fmt: skip


_READERS = {".csv": _text, ".stl": _mesh, ".ply": _mesh}
"""By the end of a file's name; all others are what SurfaceTopography makes of them."""
