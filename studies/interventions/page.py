"""The page docs/interventions.md: the plan's pairs beside what was said of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from .plan import ROOT, Pair
from .scoring import NAMING, points, right_with, said

PAGE = ROOT / "docs" / "interventions.md"
REMARKS = ROOT / "data" / "interventions" / "remarks.md"
_HEAD = """# Interventions on real recordings

A known effect of each recording was concealed; what a fair verdict would be stood in
`data/interventions/plan.toml` before the diagnosis was asked. `dentscope proof interventions` makes
all again, from shipped sets and `dentscope recordings fetch`. A star: published before.

"""
_TABLE = """
| concealed (with / without) | said with it | | said without it | |
| --- | --- | --- | --- | --- |
"""
_SCORES = """
A point for a name that is fair, none for silence, one off for any other name, with the effect or
without it, and for *outside the library* where that is not fair. What an audit contradicts goes
with every answer and has no point.

| answer | fair with the effect | points |
| --- | --- | --- |
"""
_CONSTANT = ("undetermined", "adequate", "outside-library")
_MARK = {True: "right", False: "missed"}


def page(pairs: Sequence[Pair], told: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page as Markdown.

    `pairs`: the plan; `told`: what was said, by pair and side.
    """
    rows = [_row(pair, told.get(pair.name, {})) for pair in pairs]
    after = REMARKS.read_text(encoding="utf-8").strip() + "\n" if REMARKS.exists() else ""
    table = _TABLE + "\n".join(rows) + "\n"
    scores = _SCORES + "\n".join(scored(pairs, told)) + "\n"
    return _HEAD + counted(pairs, told) + "\n" + scores + table + ("\n" + after if after else "")


def scored(pairs: Sequence[Pair], told: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return a row for the diagnosis, and one for each answer that is always the same."""
    asked = [p for p in pairs if {"with", "without"} <= set(told.get(p.name, {}))]
    rows = []
    for answer in ("", *_CONSTANT):
        always = {"verdict": answer, "mechanisms": [], "alternatives": []} if answer else {}
        fair = sum(right_with(p, {**told[p.name]["with"], **always}) for p in asked)
        total = sum(points(p, side, {**told[p.name][side], **always})
                    for p in asked for side in ("with", "without"))  # fmt: skip
        name = f"always `{answer}`" if answer else "the diagnosis"
        rows.append(f"| {name} | {fair} of {len(asked)} | {total} |")
    return rows


def counted(pairs: Sequence[Pair], told: Mapping[str, Mapping[str, Any]]) -> str:
    """Return how many sides of each kind are right, and by what, in a sentence."""
    asked = [p for p in pairs if {"with", "without"} <= set(told.get(p.name, {}))]
    fair = [p for p in asked if told[p.name]["with"]["right"]]
    named = sum(told[p.name]["with"]["verdict"] in NAMING for p in fair if not p.audit)
    audited = sum(bool(p.audit) for p in fair)
    fresh = [p for p in asked if not p.known]
    clean = [told[p.name]["without"] for p in asked]
    return (
        f"With the effect {len(fair)} of {len(asked)} verdicts are fair: {named} name the cause, "
        f"{audited} audits contradict, {len(fair) - named - audited} rightly name nothing; of "
        f"those without a star {sum(p in fair for p in fresh)} of {len(fresh)}. Without it "
        f"{sum(entry['right'] for entry in clean)} of {len(clean)} are "
        f"({len({entry['set'] for entry in clean})} different sets)."
    )


def _row(pair: Pair, told: Mapping[str, Any]) -> str:
    star = "*" if pair.known else ""
    cells = [f"{pair.recordings}: {pair.concealed}{star}"]
    for side in ("with", "without"):
        entry = told.get(side)
        cells += [said(entry), _MARK[entry["right"]]] if entry else ["not asked", ""]
    return "| " + " | ".join(cells) + " |"
