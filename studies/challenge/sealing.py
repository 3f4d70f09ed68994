"""A blind test by others: sets of their own, and truths that only they know, fixed by seals."""

from __future__ import annotations

import json
import secrets
from pathlib import Path

from ...core.errors import InputError, InputErrors
from ...core.inputs.csv_table import Problems, read_text_table, shown
from ...core.output import write_file
from ...recordings import read
from ..proof.rivals import ANOTHER_PAIR, BASELINE, OUTSIDE
from ..proof.seal import Ledger, digest_of, digest_of_record
from .answers import EXPLANATIONS, label
from .archive import SEALS, sets_of

COLUMNS = ("set", "name")
"""Of the table of what was done."""


def seal(folder: Path, acts: Path, truths: Path) -> list[str]:
    """Fix what was done to each set before anybody says what he thinks; return the sets' names.

    - `folder`: has `sets`, a recording set a folder; receives the seals (the digests of each
      set's recordings and of its truth, salted) and `names.txt`.
    - `acts`: table of set and name of what acts: `baseline`, a mechanism, two as `a+b`, or
      `outside-library` for what has no name.
    - `truths`: new file of the truths with their salts, to be published after the answers.

    Raises `InputErrors`: one line for each mistake; nothing is written then.
    """
    names = sets_of(folder)
    for path in (folder / SEALS, truths):
        if path.exists():
            raise InputError("there is one already", source=str(path), allowed="seal once")
    told = _acts(acts, names)
    for name in names:
        read(folder / "sets" / name)
    records = {name: _record(told[name]) for name in names}
    write_file(truths, json.dumps(records, indent=1) + "\n")
    ledger = Ledger(folder / SEALS)
    for name, record in records.items():
        ledger.add(
            event="truth", set=name, truth=digest_of_record(record),
            recordings=digest_of(folder / "sets" / name),
        )  # fmt: skip
    write_file(folder / "names.txt", "\n".join(EXPLANATIONS) + "\n")
    return names


def _record(name: str) -> dict[str, object]:
    kind = {BASELINE: "null", OUTSIDE: "outside"}.get(name, "pair" if "+" in name else "single")
    acting = name.split("+") if kind in ("single", "pair") else []
    return {"kind": kind, "mechanisms": acting, "salt": secrets.token_hex(16)}


def _acts(path: Path, sets: list[str]) -> dict[str, str]:
    problems = Problems(str(path))
    table = read_text_table(path, COLUMNS, problems)
    found: dict[str, str] = {}
    missing = [c for c in COLUMNS if table is not None and c not in table.columns]
    for column in missing:
        problems.add("missing", column=column, allowed=",".join(COLUMNS))
    if table is None or missing:
        raise InputErrors(tuple(problems.found))
    for row, name, act in zip(table.rows, table.cells["set"], table.cells["name"], strict=True):
        if name not in sets or name in found:
            problems.add(
                f"{shown(name)} {'twice' if name in found else 'is not there'}", row=row,
                column="set", allowed=f"each of these {len(sets)} once: {sets[0]}, ..., {sets[-1]}",
            )  # fmt: skip
        elif act == ANOTHER_PAIR or not label(act):
            allowed = ", ".join(EXPLANATIONS[:-1]) + ", or a+b"
            problems.add(f"unknown name {shown(act)}", row=row, column="name", allowed=allowed)
        else:
            found[name] = label(act)
    if not problems.found and len(found) < len(sets):
        missing = [name for name in sets if name not in found]
        problems.add(f"no row of {', '.join(missing[:3])}", column="set", allowed="every set")
    if problems.found:
        raise InputErrors(tuple(problems.found))
    return found
