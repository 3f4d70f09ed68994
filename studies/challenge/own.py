"""Answers of the diagnosis and of the plainest rule, from what `dentscope proof peers` kept.

`python -m dentscope.studies.challenge.own challenge/open data/blind-sets`
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.output import csv_text, write_file
from ...discrepancy.unknowns.wrong_number import WRONG
from ..proof.rivals import ANOTHER_PAIR, DIAGNOSIS, OUTSIDE, read_lines
from .answers import COLUMNS

ANSWERED = {DIAGNOSIS: "diagnosis.csv", "BIC, 3 % floor": "bic.csv"}
"""Who answers, and the file of the answers."""


def write_own(folder: Path, out: Path) -> None:
    """Write a file of answers for each of `ANSWERED`.

    `folder`: a part of the challenge with its peers.jsonl; `out`: for the files.
    """
    lines = sorted(read_lines(folder), key=lambda line: str(line["set"]))
    for who, name in ANSWERED.items():
        rows = [
            (line["set"], told, f"{p:.6g}")
            for line in lines
            for told, p in _listed(line["said"][who]["odds"]).items()
            if p >= 5e-7
        ]
        write_file(out / name, csv_text(rows, header=COLUMNS))


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
    given = parser.parse_args()
    write_own(given.folder, given.out)


if __name__ == "__main__":
    main()
