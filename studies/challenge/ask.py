"""Sealed sets that answer: a method buys trials of them, one by one or in batches.

What a set conceals is drawn anew from a secret at every answer and lies nowhere as text. The secret
is in the judge's folder; who is asked about the sets gets theirs alone. A secret is one whose first
draw is kept, so that no answer takes longer than another by what was tried before.
"""

from __future__ import annotations

import json
import math
import secrets
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.errors import InputError, InputErrors
from ...core.inputs.csv_table import Problems, TextTable, numbers, read_text_table, shown
from ...core.inputs.json_input import read_json
from ...core.output import csv_text, folder_for_output, locked, write_file
from ...recordings import read
from ...recordings.adding import add_trials
from ...recordings.bench import SETTING
from ...recordings.trials import NORMAL
from ..proof.rivals import draws_of, mean_with_interval
from ..third_world.asked import Asked, answer, begun, possible
from ..third_world.draw import NULLS, PAIRS, SEEN, Truth, draw
from ..third_world.effects import EFFECTS
from ..third_world.sheet import write
from .answers import EXPLANATIONS, Odds
from .score import Row

BOUGHT = 10
"""Trials that may be bought of a set."""

SECRET = "secret.json"
COLUMNS = ("striker", "impact_speed_m_s", "angle_deg", "temperature_K", "load_N")
"""Of what is asked."""

FIRST = 24
"""Trials that a set begins with: two hours of five minutes."""


def deal(folder: Path, judge: Path, count: int, *, seed: int | None = None) -> list[str]:
    """Write sets that answer; return their names.

    - `folder`: new; receives `sets` and `names.txt`.
    - `judge`: new; receives the secret, and later what was bought.
    - `count`: how many sets.
    - `seed`: for the same sets again; a secret one of 128 bits if left out.
    """
    for place in (folder, judge):
        if place.exists():
            raise InputError("there is one already", source=str(place), allowed="a new folder")
    rng = np.random.default_rng(secrets.randbits(128) if seed is None else seed)
    kept: dict[str, dict[str, str]] = {}
    for k in range(count):
        name = f"asked-{k + 1:03d}"
        while True:
            one = {"kind": "null", "effect": str(rng.choice(NULLS)),
                   "seed": f"{rng.integers(2**62):x}"}  # fmt: skip
            what = float(rng.random())
            if what < 0.6:
                one |= {"kind": "single", "effect": str(rng.choice([*EFFECTS]))}
            elif what < 0.75:
                one |= {
                    "kind": "pair",
                    "effect": "+".join(PAIRS[int(rng.integers(len(PAIRS)))][1:]),
                }
            truth, settled = _drawn(one)
            if settled:
                break
        write(truth, folder / "sets" / name, name=name)
        with (folder / "sets" / name / "set.toml").open("a", encoding="utf-8") as stream:
            stream.write(_rig(truth))
        kept[name] = one
    write_file(folder / "names.txt", "\n".join(EXPLANATIONS) + "\n")
    write_file(folder_for_output(judge) / SECRET, json.dumps(kept, indent=1) + "\n")
    return list(kept)


def _drawn(one: Mapping[str, str]) -> tuple[Truth, bool]:
    """A set's truth with its first session, and whether the first draw is of a size to be seen."""
    rng = np.random.default_rng(int(one["seed"], 16))
    whole = draw(rng, one["kind"], one["effect"], tries=1)
    seen = all(SEEN[0] <= x <= SEEN[1] for x in whole.sizes)
    return replace(whole, rig=begun(rng, whole.rig, most=FIRST)), seen


def _rig(truth: Truth) -> str:
    keys = {"speed": "speeds_m_s", "angle": "angles_deg", "load": "loads_N"}
    spans = possible(truth.rig)
    lines = [
        f"{keys[k]} = [{low:.4g}, {high:.4g}]" for k, (low, high) in spans.items() if low < high
    ]
    return "\n".join(["\n[rig]", *lines, ""])


def ask(folder: Path, judge: Path, name: str, rows: Path) -> tuple[list[list[str]], int]:
    """Add what trials show to a set; return their rows with a header, and how many are left.

    - `folder`, `judge`: as dealt.
    - `name`: of the set.
    - `rows`: table with the columns `striker` and `impact_speed_m_s`, or `load_N` for a press;
      `angle_deg` (90) and `temperature_K` (293) may stand beside them.

    Raises `InputErrors`: rows that do not fit, or too many; nothing is bought then.
    """
    kept = _kept(judge)
    if name not in kept:
        raise InputError(shown(name), source=str(folder), key="SET", allowed=", ".join(kept))
    place = folder / "sets" / name
    with locked(judge):
        bought = _bought(judge, name)
        asked = _read(rows, place, left=BOUGHT - len(bought))
        table = answer(_drawn(kept[name])[0], asked, before=bought)
        new = judge / f"{name}.csv"
        write_file(new, csv_text(table[1:], header=table[0]))
        try:
            add_trials(place, new)
        except InputErrors as found:
            told = (InputError(x.message, source=str(rows), key=x.key, allowed=x.allowed)
                    for x in found.errors)  # fmt: skip
            raise InputErrors(tuple(told)) from None
        write_file(judge / f"{name}.json", json.dumps([list(x) for x in (*bought, *asked)]) + "\n")
    return table, BOUGHT - len(bought) - len(asked)


def _kept(judge: Path) -> dict[str, dict[str, str]]:
    path = judge / SECRET
    if not path.is_file():
        raise InputError("no judge", source=str(judge), allowed=f"a folder with {SECRET}, as dealt")
    found: dict[str, dict[str, str]] = read_json(path, most=10_000_000, allowed="as dealt")
    return found


def _bought(judge: Path, name: str) -> list[Asked]:
    path = judge / f"{name}.json"
    return [Asked(*x) for x in json.loads(path.read_text("utf-8"))] if path.exists() else []


def _read(path: Path, place: Path, *, left: int) -> list[Asked]:
    """What is asked; every mistake by row and column."""
    problems = Problems(str(path))
    table = read_text_table(path, COLUMNS, problems)
    found: list[Asked] = []
    if table is not None and not problems.found:
        found = _rows(table, place, problems)
        if len(table.rows) > left:
            problems.add(f"{len(table.rows)} trials", allowed=f"{left} more of this set")
        if not table.rows:
            problems.add("no trial", allowed="at least one row below the header")
    if problems.found:
        raise InputErrors(tuple(problems.found))
    return found


def _rows(table: TextTable, place: Path, problems: Problems) -> list[Asked]:
    setup = read(place).setup
    empty = np.full(len(table.rows), np.nan)
    given = {k: numbers(table, k, problems) if k in table.columns else empty for k in COLUMNS[1:]}
    strikers = table.cells.get("striker", ("",) * len(table.rows))
    rig = setup.rig
    spans = {"impact_speed_m_s": rig.speeds_m_s, "angle_deg": rig.angles_deg or (NORMAL, NORMAL),
             "load_N": rig.loads_N}  # fmt: skip
    found = []
    for i, (row, striker) in enumerate(zip(table.rows, strikers, strict=True)):
        speed, angle, warm, load = (float(given[k][i]) for k in COLUMNS[1:])
        if striker not in setup.strikers:
            problems.add(f"no striker {shown(striker)}", row=row, column="striker",
                         allowed=", ".join(sorted(setup.strikers)))  # fmt: skip
        if math.isnan(speed) == math.isnan(load):
            problems.add("a speed or a load", row=row, allowed="one of the two")
        pressed = not math.isnan(load)
        angle = NORMAL if math.isnan(angle) or pressed else angle
        asked = {"impact_speed_m_s": speed, "load_N": load}
        asked |= {} if pressed else {"angle_deg": angle}
        for column, value in asked.items():
            low, high = spans[column] or (math.inf, -math.inf)
            if not (math.isnan(value) or low / SETTING <= value <= high * SETTING):
                told = f"{low:g} to {high:g}, [rig] of set.toml" if spans[column] else "no press"
                problems.add(f"{value:g}", row=row, column=column, allowed=told)
        if not (math.isnan(warm) or 200.0 <= warm <= 600.0):
            problems.add(f"{warm:g}", row=row, column="temperature_K", allowed="200 to 600")
        warm = 293.0 if math.isnan(warm) else warm
        found.append(
            Asked(striker, float(np.nan_to_num(speed)), angle, warm, float(np.nan_to_num(load)))
        )
    return found


def truths(judge: Path) -> dict[str, tuple[str, ...]]:
    """Return what each set conceals."""
    return {
        name: tuple(sorted(one["effect"].split("+"))) if one["kind"] != "null" else ()
        for name, one in _kept(judge).items()
    }


def bought_scores(
    judge: Path, answers: Mapping[str, Odds], before: Mapping[str, Odds] | None
) -> list[Row]:
    """Return how many trials were bought of a set, and what one brought in ln p of the truth [nat].

    Before them all names are alike, unless `before` says otherwise.
    """
    gain, count = [], []
    for name, truth in truths(judge).items():
        label = "+".join(truth) or "baseline"
        even = 1.0 / (len(EXPLANATIONS) - 1)
        first = even if before is None else before[name].get(label, 0.0)
        now = answers[name].get(label, 0.0)
        gain.append(math.log(max(now, 0.002)) - math.log(max(first, 0.002)))
        count.append(float(len(_bought(judge, name))))
    draws = draws_of(len(count))
    told = [Row("trials bought", *mean_with_interval(np.array(count), draws))]
    if sum(count) > 0.0:
        each = np.array(gain) / np.mean(count)
        told.append(Row("nats a trial", *mean_with_interval(each, draws)))
    return told
