"""A published part: many cases as a few long columns, which compress and which any tool can read.

A run keeps each case in a file of its own; most of its bytes are headers. A part holds the same
cases as tables: `cases` (one row a case), `loading` (one row a depth, all cases below each other),
`unloadings` (one row an unloading), `unloading_curves`, `craters`, `tips`, `profiles` (one row a
depth), `profile_sphere` and `profile_flat`. A table's first column counts the rows of the table
above it that its rows belong to: `case` counts rows of `cases`, `unloading` of `unloadings`,
`profile` of `profiles`. Columns of floating-point numbers of the curves and shapes are in single
precision (relative error below 6e-8); scalars are in double precision.

A part is sealed as a case's file is, and holds a digest of each case as it is read.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from ..core.arrays import Array
from ..core.errors import InputError
from ..core.inputs.input_file import read_bytes
from ..core.provenance import canonical_json
from .case import Case
from .contents import DIGEST, Tree, new_image, opened, read_array
from .records import CaseRecord, UnloadingRecord
from .schema import CURVE, PROFILES, UNLOADING_PROFILES, Dataset

# limit: largest published part that is read [bytes]: ten times what is published
_READ_PART_BYTES = 100_000_000

Columns = dict[str, npt.NDArray[Any]]

PART_FORMAT = "dentscope-campaign-part/2"
_DIGEST, _NAME = re.compile(r"[0-9a-f]{64}"), re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,127}")
CHECKSUMS = "SHA256SUMS"
"""Checksums of the parts of a folder."""

_ROW = Dataset("1", ("row",), "row of the table above that this row belongs to")
SCALARS: dict[str, Dataset] = {
    "E_s": Dataset("Pa", ("case",), "Young's modulus of the sphere"),
    "nu_s": Dataset("1", ("case",), "Poisson ratio of the sphere"),
    "Sy_s": Dataset("Pa", ("case",), "yield strength of the sphere"),
    "E_f": Dataset("Pa", ("case",), "Young's modulus of the flat"),
    "nu_f": Dataset("1", ("case",), "Poisson ratio of the flat"),
    "Sy_f": Dataset("Pa", ("case",), "yield strength of the flat"),
    "R": Dataset("m", ("case",), "radius of the sphere"),
    "E_reduced": Dataset("Pa", ("case",), "reduced modulus E'"),
    "Sy_min": Dataset("Pa", ("case",), "strength of the weaker body"),
    "Sy_ratio": Dataset("1", ("case",), "Sy* = Sy_s/Sy_f"),
    "critical_depth": Dataset("1", ("case",), "delta_c/R, first yield"),
    "energy_defect": Dataset("1", ("case",), "largest |work - stored - dissipated|/work"),
    "force_step": Dataset("1", ("case",), "largest step of F along the case, over F"),
    "radius_step": Dataset("1", ("case",), "largest step of a along the case, over a"),
    "share_step": Dataset("1", ("case",), "largest step of delta_s* along the case, over it"),
    "depth_reached": Dataset("1", ("case",), "largest Delta/R"),
    "radius_reached": Dataset("1", ("case",), "largest a/R"),
}
TEXTS: dict[str, str] = {
    "id": "SHA-256 of groups, depths, settings and numerics version",
    "name": "name within the design",
    "status": "done or failed",
    "message": "why it failed",
    "specification": "what was asked, JSON",
    "accuracy": "settings it was solved with, JSON",
    "environment": "versions and commit that computed it, JSON",
    "counters": "work that the solve took, JSON",
    "mesh": "digest of the mesh",
}
_JSON = ("specification", "accuracy", "environment", "counters")
_UNLOADING: dict[str, Dataset] = {
    "depth": Dataset("1", ("row",), "Delta/R from which it unloads"),
    "residual_sphere": Dataset("m", ("row",), "permanent displacement of the sphere's pole"),
    "residual_flat": Dataset("m", ("row",), "permanent displacement of the flat below it"),
}
_CRATER = {n: d for n, d in UNLOADING_PROFILES.items() if n.startswith("crater")}
_TIP = {n: d for n, d in UNLOADING_PROFILES.items() if n.startswith("tip")}
_ON_SPHERE = {n: PROFILES[n] for n in ("sphere_r", "sphere_z", "pressure")}
_ON_FLAT = {n: PROFILES[n] for n in ("flat_r", "flat_z")}


PUBLISHED = Path(__file__).resolve().parents[1] / "data" / "campaign"
"""The parts of a release."""
_COARSE = "smoke"


def published_parts(wanted: Callable[[str], bool] = bool) -> list[Path]:
    """Return the parts of the release whose names are wanted, but for the coarse ones."""
    names = sorted(path.name for path in PUBLISHED.glob("*.h5"))
    found = [PUBLISHED / name for name in names if wanted(name) and not name.startswith(_COARSE)]
    if not found:
        raise InputError(
            "no published cases", source=str(PUBLISHED), allowed="the parts of a release"
        )
    return found


def part_of(records: Sequence[CaseRecord], *, about: dict[str, str]) -> bytes:
    """Return cases as the bytes of one part, and `about`: design, numerics version."""
    with new_image() as made:
        file = made.file
        file.attrs["format"] = PART_FORMAT
        for name, value in about.items():
            file.attrs[name] = value
        _put_cases(file.create_group("cases"), records)
        rows = list(enumerate(records))
        _put_table(file, "loading", "case", [(k, r.curve) for k, r in rows], CURVE)
        unloadings = [(k, u) for k, r in rows for u in r.unloadings]
        scalars = [
            (k, {name: np.array([getattr(u, name)]) for name in _UNLOADING}) for k, u in unloadings
        ]
        _put_table(file, "unloadings", "case", scalars, _UNLOADING, precision="f8")
        flat = list(enumerate(u for _, u in unloadings))
        _put_table(file, "unloading_curves", "unloading", [(k, u.curve) for k, u in flat], CURVE)
        shapes = [(k, u.profiles) for k, u in flat]
        _put_table(file, "craters", "unloading", shapes, _CRATER)
        _put_table(file, "tips", "unloading", shapes, _TIP)
        depths = [(k, {"depth": r.profiles["depth"]}) for k, r in rows if r.profiles]
        _put_table(file, "profiles", "case", depths, {"depth": PROFILES["depth"]}, precision="f8")
        states = list(enumerate(p for _, r in rows if r.profiles for p in _states(r.profiles)))
        for table, columns in (("profile_sphere", _ON_SPHERE), ("profile_flat", _ON_FLAT)):
            nodes = [(k, _nodes(state, columns)) for k, state in states]
            _put_table(file, table, "profile", nodes, columns)
        # of what a reader will get: single precision has rounded it
        digests = [digest_of(record).encode() for record in _read_records(file)]
        data = _put(file["cases"], DIGEST, np.array(digests, dtype="S64"))
        data.attrs["meaning"] = "SHA-256 of the case as it is read"
    return made.sealed


@contextmanager
def opened_part(path: Path) -> Iterator[h5py.File]:
    """Open a part, or refuse one of which a byte has changed."""
    with opened(path, most=_READ_PART_BYTES, kind="a published part") as file:
        if (found := file.attrs.get("format")) != PART_FORMAT:
            raise InputError(f"format {found!r}", source=str(path), allowed=PART_FORMAT)
        yield file


def read_part(path: Path) -> list[CaseRecord]:
    """Read all cases of a part, or refuse one that is damaged."""
    with opened_part(path) as file:
        records = _read_records(file)
        for record, digest in zip(records, texts_of(file, DIGEST), strict=True):
            if digest != digest_of(record):
                raise InputError(
                    "its digest is another: damaged", source=str(path), key=record.case.name
                )
        return records


def is_part(path: Path) -> bool:
    """Whether a file is a published part, and as it was written."""
    try:
        with opened_part(path):
            return True
    except InputError:
        return False


def checksums(folder: Path) -> dict[str, str]:
    """Checksum of each part of a folder by its name; empty where there is no list."""
    place = folder / CHECKSUMS
    if not place.exists():
        return {}
    raw = read_bytes(place, most=10_000_000, allowed="lines of a digest and a name")
    lines = [line.split() for line in raw.decode(errors="replace").splitlines()]
    for number, line in enumerate(lines, start=1):
        # a name of this folder, and one that every file system takes
        if len(line) != 2 or not _DIGEST.fullmatch(line[0]) or not _NAME.fullmatch(line[1]):
            raise InputError(
                "damaged", source=str(place), key=f"line {number}", allowed="a digest and a name"
            )
    return {name: digest for digest, name in lines}


def digest_of(record: CaseRecord) -> str:
    """SHA-256 of all that a record holds, as 64 hexadecimal digits."""
    arrays = {
        "loading": record.curve,
        "profiles": record.profiles,
        **{f"unload-{k}": u.curve | u.profiles for k, u in enumerate(record.unloadings)},
    }
    about = {
        "specification": record.case.specification(),
        "unloadings": [(u.depth, u.residual_sphere, u.residual_flat) for u in record.unloadings],
        **{name: value for name, value in vars(record).items() if name in TEXTS},
    }
    groups = {
        name: Tree(arrays=dict(columns), units=dict.fromkeys(columns, ""))
        for name, columns in arrays.items()
    }
    return Tree(attributes={"about": canonical_json(about)}, groups=groups).digest()


def texts_of(file: h5py.File, name: str) -> list[str]:
    """Return a column of texts of the table `cases`."""
    return [text.decode() for text in read_array(file["cases"][name]).tolist()]


def _put_cases(group: h5py.Group, records: Sequence[CaseRecord]) -> None:
    told = [
        {**vars(r), "name": r.case.name, "specification": r.case.specification()} for r in records
    ]
    for name, meaning in TEXTS.items():
        texts = [json.dumps(one[name]) if name in _JSON else one[name] for one in told]
        values = np.array([text.encode() for text in texts])
        if values.dtype.itemsize == 0:  # all empty: HDF5 has no strings of length nought
            values = values.astype("S1")
        data = _put(group, name, values)
        data.attrs["meaning"] = meaning
    scalars = [_scalars(record) for record in records]
    for name, about in SCALARS.items():
        _describe(_put(group, name, np.array([row[name] for row in scalars])), about)


def _scalars(record: CaseRecord) -> dict[str, float]:
    pair = record.case.pair
    bodies = {
        f"{name}_{end}": getattr(body, name)
        for end, body in (("s", pair.sphere), ("f", pair.flat))
        for name in ("E", "nu", "Sy")
    }
    both = {name: getattr(pair, name) for name in ("R", "E_reduced", "Sy_min", "Sy_ratio")}
    return bodies | both | {"critical_depth": pair.first_yield} | asdict(record.quality)


def _states(profiles: Columns) -> list[Columns]:
    return [
        {name: profiles[name][k] for name in PROFILES if name != "depth"}
        for k in range(len(profiles["depth"]))
    ]


def _nodes(state: Columns, columns: dict[str, Dataset]) -> Columns:
    """The nodes of one surface, without the NaN that fill its row up to the longest."""
    there = np.isfinite(state[next(iter(columns))])
    return {name: state[name][there] for name in columns}


def _put_table(
    file: h5py.File,
    name: str,
    parent: str,
    parts: Sequence[tuple[int, Columns]],
    columns: dict[str, Dataset],
    *,
    precision: str = "f4",
) -> None:
    group = file.create_group(name)
    first = next(iter(columns))
    lengths = [len(part[first]) if part else 0 for _, part in parts]
    owner = np.repeat([row for row, _ in parts], lengths).astype(np.int32)
    _describe(_put(group, parent, owner), _ROW)
    for column, about in columns.items():
        found = [part[column] for _, part in parts if part]
        values = np.concatenate(found) if found else np.zeros(0)
        _describe(_put(group, column, values.astype(precision)), about)


def _put(group: h5py.Group, name: str, values: npt.NDArray[Any]) -> h5py.Dataset:
    if values.size == 0:
        return group.create_dataset(name, data=values)
    return group.create_dataset(
        name, data=values, compression="gzip", compression_opts=9, shuffle=True, fletcher32=True
    )


def _describe(data: h5py.Dataset, about: Dataset) -> None:
    data.attrs["unit"] = about.unit
    data.attrs["meaning"] = about.meaning


def _read_records(file: h5py.File) -> list[CaseRecord]:
    texts: dict[str, list[Any]] = {
        name: list(map(json.loads, texts_of(file, name))) if name in _JSON else texts_of(file, name)
        for name in TEXTS
    }
    n = len(texts["id"])
    curves = _split(file["loading"], "case", n, CURVE)
    unloadings = _read_unloadings(file, n)
    profiles = _read_profiles(file, n)
    return [
        CaseRecord(
            case=Case.from_specification(texts["specification"][k]),
            curve=curves[k],
            unloadings=tuple(unloadings[k]),
            profiles=profiles[k],
            **{name: texts[name][k] for name in CaseRecord.__annotations__ if name in TEXTS},
        )
        for k in range(n)
    ]


def _read_unloadings(file: h5py.File, n: int) -> list[list[UnloadingRecord]]:
    table = file["unloadings"]
    owner = read_array(table["case"])
    count = len(owner)
    curves = _split(file["unloading_curves"], "unloading", count, CURVE)
    craters = _split(file["craters"], "unloading", count, _CRATER)
    tips = _split(file["tips"], "unloading", count, _TIP)
    scalars = {name: read_array(table[name]) for name in _UNLOADING}
    out: list[list[UnloadingRecord]] = [[] for _ in range(n)]
    for k in range(count):
        numbers = {name: float(values[k]) for name, values in scalars.items()}
        shapes = craters[k] | tips[k]
        out[owner[k]].append(UnloadingRecord(curve=curves[k], profiles=shapes, **numbers))
    return out


def _read_profiles(file: h5py.File, n: int) -> list[dict[str, Array]]:
    owner, depth = (read_array(file["profiles"][name]) for name in ("case", "depth"))
    spheres = _split(file["profile_sphere"], "profile", len(owner), _ON_SPHERE)
    flats = _split(file["profile_flat"], "profile", len(owner), _ON_FLAT)
    out: list[dict[str, Array]] = []
    for k in range(n):
        rows = np.flatnonzero(owner == k)
        states = [{**spheres[row], **flats[row]} for row in rows]
        found = {
            name: filled([state[name] for state in states])
            for name in (*_ON_SPHERE, *_ON_FLAT)
            if states
        }
        out.append({"depth": depth[rows], **found} if states else {})
    return out


def filled(rows: Sequence[Array]) -> Array:
    """Return rows of uneven length as one array, filled up with NaN."""
    out = np.full((len(rows), max(map(len, rows))), np.nan)
    for row, values in zip(out, rows, strict=True):
        row[: len(values)] = values
    return out


def _split(
    group: h5py.Group, parent: str, n: int, columns: dict[str, Dataset]
) -> list[dict[str, Array]]:
    """Cut a table's columns into the pieces of its `n` owners, whose rows lie together."""
    ends = np.searchsorted(read_array(group[parent]), np.arange(n), side="right")
    starts = np.concatenate([[0], ends[:-1]]) if n else ends
    whole = {name: read_array(group[name]).astype(float) for name in columns}
    return [
        {name: values[a:b] for name, values in whole.items()} if b > a else {}
        for a, b in zip(starts, ends, strict=True)
    ]
