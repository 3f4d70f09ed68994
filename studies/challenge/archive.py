"""The sets that ship, open and sealed ones, and what their truths are held to."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.inputs.json_input import read_json
from ...core.output import folder_for_output, write_file
from ..proof.rivals import names_of
from ..proof.seal import Ledger, SealBroken, digest_of, digest_of_record
from .answers import EXPLANATIONS

DATA = Path(__file__).resolve().parents[2] / "data" / "blind-sets"
"""Where those of the present edition lie, and in `FIRST` those of the one before."""

FIRST = "first"

PARTS = ("open", "sealed")
"""An archive each: with truths beside the sets, and without."""

SEALS, TRUTHS, SUMS = "seals.jsonl", "truths.enc", "SHA256SUMS"

_TRUTHS = "the file of truths as published"
_MOST = 20_000_000  # bytes


@cache
def seals() -> dict[str, dict[str, Any]]:
    """Name of each set that ships to the digests of its truth and its recordings."""
    before = DATA / FIRST / SEALS
    return (Ledger(before).of("truth") if before.exists() else {}) | Ledger(DATA / SEALS).of(
        "truth"
    )


def get(folder: Path, *, first: bool = False) -> dict[str, int]:
    """Write the sets that ship below a folder; return how many each part has.

    `folder`: made if missing; receives `open/sets`, `open/truths`, `sealed/sets`, the seals and the
    names that an answer may have; `first`: those of the first edition.

    Raises `InputError`: a part is there already, or an archive is not what was published.
    """
    data = DATA / FIRST if first else DATA
    for part in PARTS:
        if (folder / part).exists():
            raise InputError(
                "there is one already", source=str(folder / part), allowed="a new folder"
            )
    for line in (data / SUMS).read_text(encoding="utf-8").splitlines():
        digest, name = line.split()
        if digest_of(data / name) != digest:
            raise InputError("not what was published", source=str(data / name), allowed=digest)
    folder_for_output(folder)
    (folder / SEALS).write_bytes((data / SEALS).read_bytes())
    write_file(folder / "names.txt", "\n".join(EXPLANATIONS) + "\n")
    counts = {}
    for part in PARTS:
        with (
            tempfile.TemporaryDirectory(dir=folder) as place,
            zipfile.ZipFile(data / f"{part}.zip") as archive,
        ):
            archive.extractall(place)
            written = Path(place) / part
            sets = sorted((written / "sets").iterdir())
            for path in sets:
                if digest_of(path) != seals()[path.name]["recordings"]:
                    raise InputError(
                        "not the recordings that were sealed", source=str(data), key=path.name
                    )
            written.rename(folder / part)
        counts[part] = len(sets)
    return counts


def seal_truths(path: Path, truths: Mapping[str, dict[str, Any]], sets: Path) -> None:
    """Write the seals of truths by set, and of their recordings, which lie in `sets`."""
    ledger = Ledger(path)
    for name, record in truths.items():
        digests = {"truth": digest_of_record(record), "recordings": digest_of(sets / name)}
        ledger.add(event="truth", set=name, **digests)


def sets_of(folder: Path) -> list[str]:
    """Return the names of the sets of a part.

    Raises `InputError`: there are none.
    """
    sets = folder / "sets"
    names = sorted(p.name for p in sets.iterdir() if p.is_dir()) if sets.is_dir() else []
    if not names:
        raise InputError("no sets", source=str(folder), allowed="a folder with sets/, as of `get`")
    return names


def truths_of(
    folder: Path, sets: list[str], opened: Path | None = None
) -> dict[str, tuple[str, ...]]:
    """Return the true names of each set; nothing where the truths are sealed.

    `folder`: a part; truths may lie in `folder/truths`, a file each; `sets`: names of the sets;
    `opened`: file of the truths of sealed sets: a record by name.

    Raises `InputError`: a truth is missing, or is not the one that was sealed.
    """
    if opened is not None:
        records = read_json(opened, most=_MOST, allowed=_TRUTHS)
        source = opened
    elif (folder / "truths").is_dir():
        source = folder / "truths"
        paths = [source / f"{name}.json" for name in sets]
        records = {p.stem: read_json(p, most=_MOST, allowed="a truth") for p in paths}
    else:
        return {}
    if not isinstance(records, dict) or any(name not in records for name in sets):
        raise InputError("not the truths of these sets", source=str(source), allowed=_TRUTHS)
    theirs = (folder / SEALS).exists()
    try:
        known = Ledger(folder / SEALS).of("truth") if theirs else seals()
    except SealBroken as broken:
        place = folder if theirs else DATA
        raise InputError(str(broken), source=str(place), allowed="unbroken seals") from broken
    for name in sets:
        if opened is not None and name not in known:
            raise InputError("was never sealed", source=str(folder), key=name, allowed="its truths")
        if theirs and digest_of(folder / "sets" / name) != known[name]["recordings"]:
            raise InputError("not the recordings that were sealed", source=str(folder), key=name)
        if name in known and digest_of_record(records[name]) != known[name]["truth"]:
            raise InputError(
                "not the truth that was sealed", source=str(source), key=name, allowed=_TRUTHS
            )
    try:
        return {name: names_of(records[name]) for name in sets}
    except (KeyError, TypeError):
        raise InputError("no truths", source=str(source), allowed=_TRUTHS) from None
