"""The published data set: immutable parts below 10 MB, made from a complete run.

The parts' checksums lie beside them and are compared whenever they are read.
"""

from __future__ import annotations

import json
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
import numpy.typing as npt

from .. import fem
from ..core.errors import InputError
from ..core.provenance import file_digest
from .designs import Design, distinct_cases
from .manifest import write_manifest
from .parts import read_part, write_part
from .records import CaseRecord
from .run import status_of
from .store import Store

Floats = npt.NDArray[np.float64]

MOST_PARTS = 8
MOST_BYTES = 10_000_000
CHECKSUMS = "SHA256SUMS"
_ROOM = 0.93  # of the size of a part, when its cases are shared out by their mean size


@dataclass(frozen=True)
class Published:
    """One design of a published data set.

    Parameters
    ----------
    design
        Its name.
    parts
        How many files.
    done, failed
        Cases.
    numerics_version
        Of the solver that computed it.
    """

    design: str
    parts: int
    done: int
    failed: int
    numerics_version: int

    @property
    def stale(self) -> bool:
        """Whether the present solver gives other numbers."""
        return self.numerics_version != fem.NUMERICS_VERSION


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
        The run is not complete, cases of it are published already, or the parts become too many.
    """
    store = Store(source)
    status = status_of(design, store)
    if status.missing:
        raise InputError(
            f"{status.missing} of {status.designed} cases are missing",
            source=str(source),
            key=design.name,
            allowed="a complete run",
        )
    folder.mkdir(parents=True, exist_ok=True)
    wanted = distinct_cases(design)
    twice = wanted.keys() & _published_ids(folder)
    if twice:
        raise InputError(
            f"{len(twice)} of its {len(wanted)} cases are published already",
            source=str(folder),
            key=design.name,
        )
    stored = {record.id: record for record in store.read_all()}
    records = [stored[key] for key in wanted]
    with tempfile.TemporaryDirectory(dir=folder, prefix=".part-") as scratch:
        made = _write_parts(records, design.name, Path(scratch), most_bytes)
        if len(list(folder.glob("*.h5"))) + len(made) > MOST_PARTS:
            raise InputError(
                f"{len(made)} more parts", source=str(folder), allowed=f"{MOST_PARTS} in all"
            )
        parts = [folder / f"{design.name}-{k}.h5" for k in range(1, len(made) + 1)]
        for temporary, part in zip(made, parts, strict=True):
            temporary.rename(part)
    lines = [f"{file_digest(path)}  {path.name}\n" for path in sorted(folder.glob("*.h5"))]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8")
    write_manifest(folder)
    return parts


def read_published(folder: Path) -> list[CaseRecord]:
    """Read all completed cases of a published data set.

    Raises
    ------
    InputError
        A part is missing, or its checksum is not the published one.
    """
    records = (record for path in _checked_parts(folder) for record in read_part(path))
    return [record for record in records if record.status == "done"]


def published_designs(folder: Path) -> list[Published]:
    """Say which designs a data set holds, without reading its curves.

    Raises
    ------
    InputError
        A part is missing, or its checksum is not the published one.
    """
    found: dict[str, list[tuple[int, Counter[str]]]] = {}
    for path in _checked_parts(folder):
        with h5py.File(path, "r") as file:
            counts = Counter(text.decode() for text in file["cases/status"][()])
            version = int(file.attrs["numerics_version"])
            found.setdefault(str(file.attrs["design"]), []).append((version, counts))
    return [
        Published(
            design=name,
            parts=len(parts),
            done=sum(counts["done"] for _, counts in parts),
            failed=sum(counts["failed"] for _, counts in parts),
            numerics_version=parts[0][0],
        )
        for name, parts in found.items()
    ]


def _published_ids(folder: Path) -> set[str]:
    ids: set[str] = set()
    for path in _checked_parts(folder):
        with h5py.File(path, "r") as file:
            ids.update(text.decode() for text in file["cases/id"][()])
    return ids


def _checked_parts(folder: Path) -> list[Path]:
    sums = folder / CHECKSUMS
    if not sums.exists():
        return []
    paths = []
    for line in sums.read_text(encoding="utf-8").splitlines():
        digest, name = line.split()
        path = folder / name
        if not path.exists():
            raise InputError("no such file", source=str(path), allowed=f"a part of {sums}")
        if file_digest(path) != digest:
            raise InputError("its checksum is not the published one", source=str(path))
        paths.append(path)
    return paths


@dataclass(frozen=True)
class Difference:
    """Largest relative differences between runs of the same cases, at the same depths.

    Parameters
    ----------
    cases
        How many cases both have.
    same
        Whether they are cases of the same identity, or only of the same pair.
    force, radius, share
        Largest relative difference of F, a and delta_s*; 0 without common cases.
    """

    cases: int
    same: bool
    force: float
    radius: float
    share: float


def largest_difference(own: Sequence[CaseRecord], published: Sequence[CaseRecord]) -> Difference:
    """Compare the cases that two runs have in common.

    Cases of the same identity are compared depth by depth; where there are none, cases of the same
    pair at another resolution are, at the depths of the first within those of the second.
    """
    by_id = {record.id: record for record in published}
    common = [(record, by_id[record.id]) for record in own if record.id in by_id]
    same = bool(common)
    if not common:
        by_pair = {_groups(record): record for record in published}
        common = [(r, by_pair[_groups(r)]) for r in own if _groups(r) in by_pair]
    found = [_differences(a, b) for a, b in common]
    force, radius, share = np.max(found, axis=0) if found else (0.0, 0.0, 0.0)
    return Difference(len(common), same, float(force), float(radius), float(share))


def _groups(record: CaseRecord) -> str:
    return json.dumps(record.case.groups)


def _differences(a: CaseRecord, b: CaseRecord) -> tuple[float, float, float]:
    mine, theirs = _scaled(a), _scaled(b)
    x, y = np.log(mine[0]), np.log(theirs[0])
    within = (x >= y[0] - 1e-6) & (x <= y[-1] + 1e-6)
    force, radius, share = (
        float(np.abs(own[within] / np.exp(np.interp(x[within], y, np.log(other))) - 1.0).max())
        if within.any()
        else 0.0
        for own, other in zip(mine[1:], theirs[1:], strict=True)
    )
    return force, radius, share


def _scaled(record: CaseRecord) -> tuple[Floats, Floats, Floats, Floats]:
    """Delta/R, F/(E' R^2), a/R and delta_s*."""
    pair, c = record.case.pair, record.curve
    share = c["sphere"] / (c["sphere"] + c["flat"])
    force = c["force"] / (pair.E_reduced * pair.R**2)
    return c["delta"] / pair.R, force, c["radius"] / pair.R, share


def _write_parts(
    records: list[CaseRecord], design: str, scratch: Path, most_bytes: int
) -> list[Path]:
    """Write the cases, in order, as the fewest equal parts that stay below the size."""
    about = {"design": design, "numerics_version": str(fem.NUMERICS_VERSION)}
    whole = scratch / "whole.h5"
    write_part(whole, records, about=about)
    if whole.stat().st_size < most_bytes:
        return [whole]
    count = int(np.ceil(whole.stat().st_size / (_ROOM * most_bytes)))
    while count <= max(MOST_PARTS, len(records)):
        paths = []
        for k, share in enumerate(np.array_split(np.arange(len(records)), count)):
            path = scratch / f"{count}-{k}.h5"
            write_part(path, [records[i] for i in share], about=about)
            paths.append(path)
        if all(path.stat().st_size < most_bytes for path in paths):
            return paths
        count += 1
    raise InputError("one case is larger than a part may be", source=design)
