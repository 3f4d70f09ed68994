"""One raw file taken in twice under two names: not a repeat, but the same impact counted twice."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.inputs.json_input import read_json

# limit: largest record that is compared with others [bytes]: every record but a film
_COMPARED_BYTES = 10_000_000


def taken_twice(reduced: Path, trials: Sequence[str]) -> list[InputError]:
    """Return a mistake for each record whose raw file another one reduced in the same way.

    `reduced` is the folder of the records that reductions leave in a set, `trials` what it still
    holds.
    """
    first: dict[str, str] = {}
    mistakes = []
    for path in sorted(reduced.glob("*.json")) if reduced.is_dir() else ():
        try:
            record: Any = read_json(path, most=_COMPARED_BYTES, allowed="a record of a reduction")
            names = [name for name in record["trials"] if name in trials]
            what = json.dumps(
                [record.get("sha256") or record["files"], record["kind"], record["options"]]
            )
        except (ValueError, KeyError, TypeError):
            continue  # a record is for people: the set does not depend on it
        if names and what in first:
            mistakes.append(InputError(
                f"the raw file of {first[what]} again, reduced in the same way", source=str(path),
                key=f"trial {names[0]}", allowed="each raw file once: delete the trial or its twin",
            ))  # fmt: skip
        elif names:
            first[what] = f"trial {names[0]}"
    return mistakes
