"""Answers of any method: a table of probabilities by set and name."""

from __future__ import annotations

import math
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

from ...core.errors import InputErrors
from ...core.inputs.csv_table import Problems, TextTable, numbers, read_text_table, shown
from ...dynamics import mechanisms
from ..proof.rivals import ANOTHER_PAIR, BASELINE, OUTSIDE

COLUMNS = ("set", "name", "probability")

MECHANISMS = tuple(m.name for m in mechanisms.MECHANISMS)
"""Names of single mechanisms: those of the diagnosis, which may be concealed or not."""

EXPLANATIONS = (BASELINE, *MECHANISMS, OUTSIDE, ANOTHER_PAIR)
"""Names that an answer may have; beside them `a+b` of two mechanisms."""

_ROUNDING = 1e-3  # by so much a set's probabilities may miss 1

Odds = dict[str, float]


def read_answers(path: Path, sets: Sequence[str]) -> dict[str, Odds]:
    """Return the probabilities of every set by name, their sum 1.

    `path`: table with the columns set, name, probability; a pair of mechanisms is `a+b`; `sets`:
    names of the sets that have to be answered.

    Raises `InputErrors`: one line for each mistake.
    """
    problems = Problems(str(path))
    table = read_text_table(path, COLUMNS, problems)
    found: dict[str, Odds] = {}
    if table is not None:
        missing = [name for name in COLUMNS if name not in table.columns]
        for name in missing:
            problems.add("missing", column=name, allowed=",".join(COLUMNS))
        if not missing:
            found = _odds(table, sets, problems)
            _check_whole(found, sets, problems)
    if problems.found:
        raise InputErrors(tuple(problems.found))
    return {name: {k: p / sum(odds.values()) for k, p in odds.items()}
            for name, odds in found.items()}  # fmt: skip


def _odds(table: TextTable, sets: Sequence[str], problems: Problems) -> dict[str, Odds]:
    known, found = set(sets), dict[str, Odds]()
    values = numbers(table, "probability", problems)
    unknown: dict[str, int] = {}
    for i, row in enumerate(table.rows):
        name, told, p = table.cells["set"][i], table.cells["name"][i], float(values[i])
        if name not in known:
            unknown.setdefault(name, row)
            continue
        whole = _label(told)
        odds = found.setdefault(name, {})
        if not whole:
            near = get_close_matches(told, EXPLANATIONS, n=1)
            allowed = f"did you mean {near[0]}?" if near else ", ".join(EXPLANATIONS) + ", or a+b"
            problems.add(f"unknown name {shown(told)}", row=row, column="name", allowed=allowed)
        elif whole in odds:
            problems.add(f"{whole} twice for {name}", row=row, column="name", allowed="once")
        elif math.isnan(p) and table.cells["probability"][i]:
            continue  # no number: told already
        elif not 0.0 <= p <= 1.0 + _ROUNDING:
            problems.add(
                shown(table.cells["probability"][i]), row=row, column="probability",
                allowed="a number from 0 to 1",
            )  # fmt: skip
        else:
            odds[whole] = p
    if unknown:
        name, row = next(iter(unknown.items()))
        problems.add(
            f"{len(unknown)} sets that are not there, the first {shown(name)}", row=row,
            column="set", allowed=f"these {len(sets)}: {sets[0]}, ..., {sets[-1]}",
        )  # fmt: skip
    return found


def _label(told: str) -> str:
    """Return a name as it is compared, a pair's parts in order; empty for what is none."""
    parts = sorted(part.strip() for part in told.split("+"))
    if len(parts) == 1:
        return told if told in EXPLANATIONS else ""
    return "+".join(parts) if len(set(parts)) == 2 and set(parts) <= set(MECHANISMS) else ""


def _check_whole(found: dict[str, Odds], sets: Sequence[str], problems: Problems) -> None:
    """Note sets without an answer, in one line, and those whose probabilities do not add to 1."""
    absent = [name for name in sets if name not in found]
    if absent and not problems.found:
        told = ", ".join(absent[:3]) + (", ..." if len(absent) > 3 else "")
        problems.add(f"{len(absent)} sets without an answer: {told}", allowed="every set answered")
    if problems.found:
        return  # a sum means nothing where a row was left out
    for name, odds in found.items():
        total = sum(odds.values())
        if abs(total - 1.0) > _ROUNDING:
            problems.add(
                f"probabilities of {name} add to {total:.4g}", column="probability", allowed="1"
            )
