"""Profilometer files: heights on a grid, in metres."""

from __future__ import annotations

import math
import warnings
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from io import StringIO
from itertools import takewhile
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError, first_line, missing_extra
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

# limit: points of a scan at most [-]: memory of a small machine
_SCAN_MOST = 100_000_000


@dataclass(frozen=True)
class Scan:
    """Heights on a grid: `z` (nx, ny) with NaN where nothing was seen [m], `step` (2,) [m]."""

    z: Array
    step: Array
    source: str


def read_scan(
    path: Path,
    *,
    unit: str | None = None,
    height_unit: str | None = None,
    step: float | None = None,
) -> Scan:
    """Read any file that SurfaceTopography knows, or comma-separated numbers.

    Units of length along the surface and of the heights (by default the same), of `units.LENGTH`,
    and the distance of neighbouring points [m] are for files that name none or a wrong one. A line,
    and a file that does not say them, are refused.
    """
    found = _text(path) if path.suffix.lower() == ".csv" else _known_format(path)
    heights = np.where(np.abs(found.z) < LARGEST_NUMBER, found.z, np.nan)
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
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from SurfaceTopography import open_topography
    except ImportError:
        raise missing_extra("reading profilometer files", "surface") from None
    try:
        with warnings.catch_warnings(), redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            warnings.simplefilter("ignore")  # its readers print what they stumble over, in turn
            channel = open_topography(str(path)).default_channel
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
        told = "" if isinstance(error, LookupError) or why.endswith(": )") else f" ({why})"
        raise InputError(
            f"cannot be read as a surface scan{told}", source=str(path),
            allowed="a whole file of a format of SurfaceTopography (x3p, sur, al3d, plu, opd, vk, "
            "mnt, xyz ...), or a grid as CSV",
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
        raise InputError(
            "the points x, y do not lie on a regular grid", source=str(path),
            allowed="equal distances along x and along y",
        )  # fmt: skip
    z = np.full([a.size for a in axes], np.nan)
    index = tuple(np.searchsorted(a, points[:, k]) for k, a in enumerate(axes))
    z[index] = points[:, 2]
    return _Raw(z, step=np.array([s.mean() for s in steps]))


def _factor(unit: str | None, path: Path) -> float:
    return metres(unit or "", source=str(path), allowed=LENGTH if unit else ("m", "mm", "um", "nm"))


def _a_line(path: Path) -> InputError:
    return InputError(
        "heights along a line", source=str(path),
        allowed="a map; a line, as x_m and z_m, belongs into profiles/ of a set, which levels it",
    )  # fmt: skip
