"""The published data set: immutable parts below 10 MB, made from a complete run.

The parts' checksums lie beside them and are compared whenever they are read.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import h5py
import numpy as np

from .. import fem
from ..core.errors import InputError
from ..core.output import finish, finish_pending, locked, write_files
from ..core.provenance import file_digest
from .designs import Design, distinct_cases
from .manifest import MANIFEST, manifest
from .parts import CHECKSUMS, checksums, opened_part, part_of, read_part, texts_of
from .records import CaseRecord, scaled
from .run import status_of
from .store import Store

# limit: of the size of a part, when cases are shared out by their mean size [-]: where a part
# becomes too large all the same there is one more
_PART_FILL = 0.93

# limit: published parts in all [-]: 160 MB of a repository
_PARTS = 16

# limit: size that no published part exceeds [bytes]: a repository's files stay below 10 MB
_PART_BYTES = 10_000_000


@dataclass(frozen=True)
class Published:
    """One design of a published data set: how many files, cases, and of which solver."""

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
    design: Design, source: Path, folder: Path, *, most_bytes: int = _PART_BYTES
) -> list[Path]:
    """Write a complete design as parts into `folder`; parts that exist are never touched.

    Every one of its cases has ended in the run at `source`. Returns the parts written, none larger
    than `most_bytes`. Refused where the run is not complete, cases of it are published already, or
    the parts become too many.
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
    with locked(folder):
        finish_pending(folder)
        wanted = distinct_cases(design)
        twice = wanted.keys() & {key for file in _opened(folder) for key in texts_of(file, "id")}
        if twice:
            raise InputError(
                f"{len(twice)} of its {len(wanted)} cases are published already",
                source=str(folder),
                key=design.name,
            )
        stored = {record.id: record for record in store.read_all()}
        made = _made_parts([stored[key] for key in wanted], design.name, most_bytes)
        if len(list(folder.glob("*.h5"))) + len(made) > _PARTS:
            raise InputError(
                f"{len(made)} more parts", source=str(folder), allowed=f"{_PARTS} in all"
            )
        parts = {f"{design.name}-{k}.h5": part for k, part in enumerate(made, start=1)}
        sums = checksums(folder) | {k: sha256(v).hexdigest() for k, v in parts.items()}
        lines = [f"{digest}  {name}\n" for name, digest in sorted(sums.items())]
        everything: dict[str, bytes | str] = {**parts, CHECKSUMS: "".join(lines)}
        everything[MANIFEST] = manifest(folder, tuple(sums), parts)
        write_files(folder, everything)
    return [folder / name for name in parts]


def read_published(folder: Path) -> list[CaseRecord]:
    """Read a data set's completed cases; a part missing, or of another checksum, is refused."""
    records = (record for path in _checked_parts(folder) for record in read_part(path))
    return [record for record in records if record.status == "done"]


def published_designs(folder: Path) -> list[Published]:
    """Say which designs a data set holds, its curves unread; refused as `read_published`."""
    found: dict[str, list[tuple[int, Counter[str]]]] = {}
    for file in _opened(folder):
        counts = Counter(texts_of(file, "status"))
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


def _opened(folder: Path) -> Iterator[h5py.File]:
    for path in _checked_parts(folder):
        with opened_part(path) as file:
            yield file


def _checked_parts(folder: Path) -> list[Path]:
    finish(folder)
    paths = []
    for name, digest in checksums(folder).items():
        path = folder / name
        if not path.exists():
            raise InputError("no such file", source=str(path), allowed=f"a part of {CHECKSUMS}")
        if file_digest(path) != digest:
            raise InputError("its checksum is not the published one", source=str(path))
        paths.append(path)
    return paths


@dataclass(frozen=True)
class Difference:
    """Largest relative differences of F, a and delta_s* of the cases that two runs share.

    `same` says whether they are cases of the same identity, or only of the same pair.
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
    (mine, *ours), (theirs, *others) = scaled(a), scaled(b)
    x, y = np.log(mine), np.log(theirs)
    within = (x >= y[0] - 1e-6) & (x <= y[-1] + 1e-6)
    force, radius, share = (
        float(np.abs(own[within] / np.exp(np.interp(x[within], y, np.log(other))) - 1.0).max())
        if within.any()
        else 0.0
        for own, other in zip(ours, others, strict=True)
    )
    return force, radius, share


def _made_parts(records: list[CaseRecord], design: str, most_bytes: int) -> list[bytes]:
    """Return the cases, in order, as the fewest equal parts that stay below the size."""
    about = {"design": design, "numerics_version": str(fem.NUMERICS_VERSION)}
    whole = part_of(records, about=about)
    if len(whole) < most_bytes:
        return [whole]
    count = int(np.ceil(len(whole) / (_PART_FILL * most_bytes)))
    while count <= max(_PARTS, len(records)):
        shares = np.array_split(np.arange(len(records)), count)
        parts = [part_of([records[i] for i in share], about=about) for share in shares]
        if all(len(part) < most_bytes for part in parts):
            return parts
        count += 1
    raise InputError("one case is larger than a part may be", source=design)
