"""A blind test by others: sets of their own, and truths that only they know, fixed by seals."""

from __future__ import annotations

import json
import secrets
from pathlib import Path

from ...core.errors import InputError
from ...core.output import write_file
from ...recordings import read
from ..proof.rivals import ANOTHER_PAIR, BASELINE, OUTSIDE
from .answers import EXPLANATIONS, read_answers
from .archive import SEALS, seal_truths, sets_of


def seal(folder: Path, acts: Path, truths: Path) -> list[str]:
    """Fix what was done to each set before anybody says what he thinks; return the sets' names.

    - `folder`: has `sets`, a recording set a folder; receives the seals (the digests of each
      set's recordings and of its truth, salted) and `names.txt`.
    - `acts`: what acts, as an answer that is sure of it: set, name, 1. The name is `baseline`, a
      mechanism, two as `a+b`, or `outside-library` for what has no name.
    - `truths`: new file of the truths with their salts, to be published after the answers.

    Raises `InputErrors`: one line for each mistake; nothing is written then.
    """
    names = sets_of(folder)
    for path in (folder / SEALS, truths):
        if path.exists():
            raise InputError("there is one already", source=str(path), allowed="seal once")
    told = read_answers(acts, names)
    for name in names:
        if len(told[name]) > 1 or ANOTHER_PAIR in told[name]:
            raise InputError(
                " or ".join(told[name]), source=str(acts), key=name, allowed="one name that acts"
            )
        read(folder / "sets" / name)
    records = {name: _record(*told[name]) for name in names}
    write_file(truths, json.dumps(records, indent=1) + "\n")
    seal_truths(folder / SEALS, records, folder / "sets")
    write_file(folder / "names.txt", "\n".join(EXPLANATIONS) + "\n")
    return names


def _record(name: str) -> dict[str, object]:
    kind = {BASELINE: "null", OUTSIDE: "outside"}.get(name, "pair" if "+" in name else "single")
    acting = name.split("+") if kind in ("single", "pair") else []
    return {"kind": kind, "mechanisms": acting, "salt": secrets.token_hex(16)}
