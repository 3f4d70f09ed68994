"""Tables within other files: a packed export of phyphox, the tracks of a Tracker project."""

from __future__ import annotations

import cmath
import math
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError, reading

# limit: largest table of numbers [bytes]; memory of a small machine
TABLE_BYTES = 500_000_000

_TABLES = (".csv", ".txt", ".tsv")


def packed_table(path: Path, member: str) -> tuple[bytes, str]:
    """Return the text of one table of a packed export, as phyphox writes them, and its name.

    `member` names it with or without its ending; the only one if empty. Refuses what is no ZIP
    file, has no such table, or several without a name.
    """
    allowed = "a whole ZIP file without password"
    raised = (zipfile.BadZipFile, zlib.error, RuntimeError, OSError, EOFError)
    with (
        reading(path, allowed, "cannot be unpacked", raised=raised),
        zipfile.ZipFile(path) as archive,
    ):
        tables = [
            i for i in archive.infolist()
            # the folder meta holds the device, not the measurement
            if i.filename.lower().endswith(_TABLES) and "meta/" not in i.filename
        ]  # fmt: skip
        known = {PurePosixPath(i.filename).stem: i for i in tables}
        wanted = PurePosixPath(member).stem if member else ""
        if (wanted and wanted not in known) or (not wanted and len(known) != 1):
            raise InputError(
                f"no table {member!r}" if member else f"{len(known)} tables", source=str(path),
                key="sheet", allowed=", ".join(known) or " ".join(_TABLES),
            )  # fmt: skip
        chosen = known[wanted] if wanted else next(iter(known.values()))
        if chosen.file_size > TABLE_BYTES:
            raise InputError(
                f"{chosen.file_size / 1e6:.0f} MB unpacked", source=str(path),
                allowed=f"up to {TABLE_BYTES // 10**6} MB",
            )  # fmt: skip
        return archive.read(chosen), f"{path}/{chosen.filename}"


def tracker_rows(path: Path, track: str) -> tuple[tuple[str, ...], Array]:
    """Return names and rows (n, 3) of a point mass of a Tracker project: time, x, y; refuse none.

    The places are those in the picture turned into the project's axes and scale; without a
    calibration the scale is 1 and the unit the pixel. Without `delta_t`, the milliseconds of a
    frame, the first column counts frames.
    """
    raw = path.read_bytes()
    if b"<!ENTITY" in raw or len(raw) > TABLE_BYTES:
        raise InputError("not a plain project", source=str(path), allowed="a TRK file of Tracker")
    raised = (ElementTree.ParseError, ValueError, LookupError)
    with reading(path, "a TRK file of Tracker", raised=raised):
        root = ElementTree.fromstring(raw)
    masses = {
        _text(o, "name"): o for o in root.iter("object")
        if o.get("class", "").endswith("tracker.PointMass")
    }  # fmt: skip
    if (track and track not in masses) or (not track and len(masses) != 1):
        raise InputError(
            f"no track {track!r}" if track else f"{len(masses)} tracks", source=str(path),
            key="sheet", allowed=", ".join(masses) or "a project with a point mass",
        )  # fmt: skip
    mass = masses[track] if track else next(iter(masses.values()))
    frames = [
        (int(p.get("name", "")[1:-1]), _number(p, "x"), _number(p, "y"))
        for p in _property(mass, "framedata").findall("property")
        if p.get("name", "")[1:-1].isdigit()
    ]
    axes, step = _axes(root), max(_number(root, "delta_t", 0.0) / 1e3, 0.0)
    turn = cmath.rect(1.0, math.radians(axes["angle"]))
    frame, x, y = np.array(sorted(frames), dtype=float).reshape(-1, 3).T
    # rows of a picture grow downwards
    place = (x - axes["xorigin"] + 1j * (axes["yorigin"] - y)) / turn
    with np.errstate(over="ignore"):
        at = (frame * (step or 1.0), place.real / axes["xscale"], place.imag / axes["yscale"])
    rows = np.stack(at, axis=1)[np.isfinite(at).all(axis=0)]
    if not len(rows):
        raise InputError("no position", source=str(path), allowed="a track with positions")
    unit = _text(root, "length_unit") or "m"
    unit = "px" if axes["xscale"] == 1.0 == axes["yscale"] else unit
    return ("t [s]" if step else "frame", f"x [{unit}]", f"y [{unit}]"), rows


def _property(parent: Any, name: str) -> Any:
    found = next((p for p in parent.iter("property") if p.get("name") == name), None)
    return ElementTree.Element("property") if found is None else found


def _text(parent: Any, name: str) -> str:
    return _property(parent, name).text or ""


def _number(parent: Any, name: str, otherwise: float = np.nan) -> float:
    try:
        value = float(_text(parent, name))
    except ValueError:
        return otherwise
    return value if math.isfinite(value) else otherwise


def _axes(root: Any) -> dict[str, float]:
    usual = {"xorigin": 0.0, "yorigin": 0.0, "angle": 0.0, "xscale": 1.0, "yscale": 1.0}
    first = next(
        (o for o in root.iter("object") if "ImageCoordSystem$FrameData" in o.get("class", "")), root
    )
    found = {name: _number(first, name, value) for name, value in usual.items()}
    return found if found["xscale"] and found["yscale"] else {**found, "xscale": 1.0, "yscale": 1.0}
