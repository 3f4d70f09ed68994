"""The published data set: immutable parts below 10 MB, made from a complete run.

A part is a campaign file like any other, so that the same reader and schema serve both; the parts'
checksums lie beside them.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import h5py
import numpy as np

from ..core.errors import InputError
from ..core.provenance import file_digest
from .designs import Design, distinct_cases
from .run import status_of
from .schema import FORMAT
from .store import CaseRecord, Store, read_curves

MOST_PARTS = 8
MOST_BYTES = 10_000_000
CHECKSUMS = "SHA256SUMS"


def publish(
    design: Design, source: Path, folder: Path, *, most_bytes: int = MOST_BYTES
) -> list[Path]:
    """Write a complete design as parts into `folder`; parts that exist are never touched.

    Parameters
    ----------
    design
        What is published; every one of its cases has ended in `source`.
    source
        Campaign file of the run.
    folder
        Where the data set lies.
    most_bytes
        Size that no part exceeds.

    Returns
    -------
    list of Path
        The parts written.

    Raises
    ------
    InputError
        The run is not complete, the design is published already, or the parts become too many.
    """
    status = status_of(design, Store(source))
    if status.missing:
        raise InputError(
            f"{status.missing} of {status.designed} cases are missing",
            source=str(source),
            key=design.name,
            allowed="a complete run",
        )
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.glob(f"{design.name}-*.h5")):
        raise InputError("is published already", source=str(folder), key=design.name)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".part-") as scratch:
        made = _write_parts(source, list(distinct_cases(design)), Path(scratch), most_bytes)
        if len(list(folder.glob("*.h5"))) + len(made) > MOST_PARTS:
            raise InputError(
                f"{len(made)} more parts", source=str(folder), allowed=f"{MOST_PARTS} in all"
            )
        parts = [folder / f"{design.name}-{k}.h5" for k in range(1, len(made) + 1)]
        for temporary, part in zip(made, parts, strict=True):
            temporary.rename(part)
    lines = [f"{file_digest(path)}  {path.name}\n" for path in sorted(folder.glob("*.h5"))]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8")
    return parts


def read_published(folder: Path) -> list[CaseRecord]:
    """Read all completed cases of a published data set.

    Raises
    ------
    InputError
        A part is missing, or its checksum is not the published one.
    """
    sums = folder / CHECKSUMS
    if not sums.exists():
        return []
    records = []
    for line in sums.read_text(encoding="utf-8").splitlines():
        digest, name = line.split()
        path = folder / name
        if not path.exists():
            raise InputError("no such file", source=str(path), allowed=f"a part of {sums}")
        if file_digest(path) != digest:
            raise InputError("its checksum is not the published one", source=str(path))
        records += read_curves(path)
    return records


def largest_difference(own: list[CaseRecord], published: list[CaseRecord]) -> tuple[int, float]:
    """Return the number of common cases and the largest relative difference of their force."""
    reference = {record.id: record for record in published}
    common = [(record, reference[record.id]) for record in own if record.id in reference]
    differences = [
        float(np.max(np.abs(a.curve["force"][:n] / b.curve["force"][:n] - 1.0)))
        for a, b in common
        if (n := min(len(a.curve["force"]), len(b.curve["force"])))
    ]
    return len(common), max(differences, default=0.0)


def _write_parts(source: Path, keys: list[str], scratch: Path, most_bytes: int) -> list[Path]:
    """Copy the cases in order; a part is closed before the next case would make it too large."""
    parts: list[Path] = []
    with h5py.File(source, "r") as whole:
        sizes = _sizes(whole, keys, scratch)
        start = 0
        while start < len(keys):
            end, total = start, 0
            while end < len(keys) and (end == start or total + sizes[end] < 0.95 * most_bytes):
                total += sizes[end]
                end += 1
            path = scratch / f"{len(parts) + 1}.h5"
            with _new_part(path) as part:
                for key in keys[start:end]:
                    whole.copy(f"cases/{key}", part["cases"])
            if path.stat().st_size >= most_bytes:
                raise InputError("one case is larger than a part may be", source=str(source))
            parts.append(path)
            start = end
    return parts


def _sizes(whole: h5py.File, keys: list[str], scratch: Path) -> list[int]:
    """Bytes that each case takes in a part, measured by writing it."""
    path, sizes, before = scratch / "measure.h5", [], 0
    with _new_part(path) as part:
        for key in keys:
            whole.copy(f"cases/{key}", part["cases"])
            part.flush()
            after = path.stat().st_size
            sizes.append(after - before)
            before = after
    path.unlink()
    return sizes


def _new_part(path: Path) -> h5py.File:
    file = h5py.File(path, "w")
    file.attrs["format"] = FORMAT
    file.create_group("cases")
    return file
