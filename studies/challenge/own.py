"""Answers of the diagnosis, sealed or open: diagnosed set by set; goes on where it was stopped.

`python -m dentscope.studies.challenge.own challenge/sealed .`
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from pathlib import Path

from ...core.output import csv_text, write_file
from ...discrepancy import diagnose
from ...discrepancy.unknowns.wrong_number import WRONG
from ...recordings import read
from ..proof.rivals import ANOTHER_PAIR, OUTSIDE
from .answers import COLUMNS
from .archive import sets_of


def answer(folder: Path, out: Path) -> str:
    """Write `out`/diagnosis.csv of a part; return its SHA-256.

    What is diagnosed lies in `out`/diagnosis.jsonl, a line a set.
    """
    kept = out / "diagnosis.jsonl"
    lines = kept.read_text(encoding="utf-8").splitlines() if kept.exists() else []
    odds = {one["set"]: one["odds"] for one in map(json.loads, lines)}
    for name in sets_of(folder):
        if name not in odds:
            odds[name] = dict(diagnose(read(folder / "sets" / name)).probabilities)
            with kept.open("a", encoding="utf-8") as file:
                file.write(json.dumps({"set": name, "odds": odds[name]}) + "\n")
    rows = [
        (name, told, f"{p:.6g}")
        for name in sorted(odds)
        for told, p in _listed(odds[name]).items()
        if p >= 5e-7
    ]
    text = csv_text(rows, header=COLUMNS)
    write_file(out / "diagnosis.csv", text)
    return hashlib.sha256(text.encode()).hexdigest()


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
    sys.stdout.write(answer(given.folder, given.out) + "\n")


if __name__ == "__main__":
    main()
