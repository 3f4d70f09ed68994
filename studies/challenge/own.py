"""Answers of the diagnosis and of the plainest rule, from what `dentscope proof peers` kept.

`python -m dentscope.studies.challenge.own challenge/open .`

Of sealed sets, which no rule is compared on, the diagnosis alone answers; it goes on where it was
stopped: `python -m dentscope.studies.challenge.own challenge/sealed . --sealed`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Mapping
from pathlib import Path

from ...core.output import csv_text, write_file
from ...discrepancy import diagnose
from ...discrepancy.unknowns.wrong_number import WRONG
from ...recordings import read
from ..proof.rivals import ANOTHER_PAIR, DIAGNOSIS, OUTSIDE, read_lines
from .answers import COLUMNS
from .archive import sets_of

ANSWERED = {DIAGNOSIS: "diagnosis.csv", "BIC, 3 % floor": "bic.csv"}
"""Who answers, and the file of the answers."""


def write_own(folder: Path, out: Path) -> None:
    """Write a file of answers for each of `ANSWERED`.

    `folder`: a part of the challenge with its peers.jsonl; `out`: for the files.
    """
    lines = sorted(read_lines(folder), key=lambda line: str(line["set"]))
    for who, name in ANSWERED.items():
        odds = {str(line["set"]): line["said"][who]["odds"] for line in lines}
        write_file(out / name, _answers(odds))


def answer_sealed(folder: Path, out: Path) -> str:
    """Diagnose each set of a part and write the answers; return their SHA-256.

    What is answered lies in `out`/sealed.jsonl, a line a set.
    """
    kept = out / "sealed.jsonl"
    lines = kept.read_text(encoding="utf-8").splitlines() if kept.exists() else []
    odds = {one["set"]: one["odds"] for one in map(json.loads, lines)}
    for name in sets_of(folder):
        if name not in odds:
            odds[name] = dict(diagnose(read(folder / "sets" / name)).probabilities)
            with kept.open("a", encoding="utf-8") as file:
                file.write(json.dumps({"set": name, "odds": odds[name]}) + "\n")
    text = _answers(odds)
    write_file(out / ANSWERED[DIAGNOSIS], text)
    return hashlib.sha256(text.encode()).hexdigest()


def _answers(odds: Mapping[str, dict[str, float]]) -> str:
    """The table of answers, by set."""
    rows = [
        (name, told, f"{p:.6g}")
        for name in sorted(odds)
        for told, p in _listed(odds[name]).items()
        if p >= 5e-7
    ]
    return csv_text(rows, header=COLUMNS)


def _listed(odds: dict[str, float]) -> dict[str, float]:
    """Probabilities by the names of an answer, which has none for a wrong number of the sheet."""
    found: dict[str, float] = {}
    for told, p in odds.items():
        name = told
        if WRONG in told:
            name = ANOTHER_PAIR if "+" in told else OUTSIDE
        found[name] = found.get(name, 0.0) + p
    return found


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--sealed", action="store_true", help="diagnose anew, compare nothing")
    given = parser.parse_args()
    if given.sealed:
        sys.stdout.write(answer_sealed(given.folder, given.out) + "\n")
    else:
        write_own(given.folder, given.out)


if __name__ == "__main__":
    main()
