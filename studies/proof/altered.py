"""What verdicts turn on: a table of what is halved and doubled, a picture of what is taken away.

The lines are those of `studies.sensitivity`; nothing here knows how they came about.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ...core.output import write_figure
from .ranks import RANKS
from .rivals import draws_of, mark_of, mean_with_interval

ALTERED = RANKS.with_name("altered.jsonl")
"""A line for each set and fit, made by `studies.sensitivity`."""

STAGES = "proof-stages.png"

AS_IT_IS = "as it is"
LAW_ERROR = "errors of the law and the metal"
WIDTHS = "widths of the priors"
WITHOUT = "without "
NO_LAW, NO_FORM = WITHOUT + "the error of the law", WITHOUT + "the error of forms"

RIGHT, AMONG, SILENT, WRONG = "named exactly", "right, among others", "silent", "wrong"
"""What a verdict is, best first; what is outside the library, or nothing, counts as a name."""


class Said(NamedTuple):
    """What was said of one set, by what was altered; no truth where nobody knows it."""

    truth: tuple[str, ...] | None
    said: dict[str, dict[str, Any]]


class Change(NamedTuple):
    """How many of `sets` change where one thing is altered.

    `leads`: another explanation is the most probable; `verdict`: the verdict or a name in it is
    another; `spoken`, `silenced`: from `undetermined` and to it; `spoilt`, `mended`: from right to
    wrong and back.
    """

    sets: int
    leads: int
    verdict: int
    spoken: int
    silenced: int
    spoilt: int
    mended: int


def label(row: str, times: float) -> str:
    """Return the name of a row with its number times so much."""
    return f"{row}, x {times:g}"


def by_set(lines: Sequence[dict[str, Any]]) -> dict[str, Said]:
    """Put the lines of each set together; probabilities that are not told are those as it is."""
    found: dict[str, Said] = {}
    for x in lines:
        truth = None if x["truth"] is None else tuple(x["truth"])
        found.setdefault(x["set"], Said(truth, {})).said.update(x["said"])
    for _, said in found.values():
        same = {"odds": said[AS_IT_IS]["odds"]}
        said.update({k: same | one for k, one in said.items()})
    return found


def outcome(one: Said, what: str) -> str:
    """Return which of `RIGHT`, `AMONG`, `SILENT`, `WRONG` is said of a set whose truth is known."""
    mark = _mark(one, what)
    if mark.exact:
        return RIGHT
    if mark.in_set:
        return AMONG
    return SILENT if one.said[what]["verdict"] == "undetermined" else WRONG


def _mark(one: Said, what: str) -> Any:
    line = {"truth": list(one.truth or ()), "acting": 0, "said": one.said}
    return mark_of(line, what)


def change(sets: Sequence[Said], what: str) -> Change:
    """Count what changes on the sets that have both."""
    both = [s for s in sets if what in s.said]
    before, after = ([s.said[k] for s in both] for k in (AS_IT_IS, what))
    pairs = list(zip(before, after, strict=True))
    known = [s for s in both if s.truth is not None]
    turns = [(outcome(s, AS_IT_IS), outcome(s, what)) for s in known]
    right = (RIGHT, AMONG)
    silent = [(a["verdict"] == "undetermined", b["verdict"] == "undetermined") for a, b in pairs]
    return Change(
        len(both),
        sum(_lead(a) != _lead(b) for a, b in pairs),
        sum(_told(a) != _told(b) for a, b in pairs),
        silent.count((True, False)), silent.count((False, True)),
        sum(a in right and b == WRONG for a, b in turns),
        sum(a == WRONG and b in right for a, b in turns),
    )  # fmt: skip


def _lead(said: dict[str, Any]) -> str:
    odds: dict[str, float] = said["odds"]
    return max(odds, key=lambda k: odds[k])


def _told(said: dict[str, Any]) -> tuple[str, tuple[str, ...]]:
    return said["verdict"], tuple(sorted("+".join(n) for n in said["names"]))


def altered_lines(lines: Sequence[dict[str, Any]]) -> list[str]:
    """The section of the page; empty where nothing was altered."""
    found = by_set(lines)
    if not found:
        return []
    drawn = [s for s in found.values() if s.truth is not None]
    real = [s for s in found.values() if s.truth is None]
    names = [k for s in found.values() for k in s.said]
    rows = list(dict.fromkeys(k.removesuffix(", x 0.5") for k in names if k.endswith(", x 0.5")))
    text = [
        "## What the verdicts turn on", "",
        f"{len(drawn)} open sets of the [challenge](challenge.md) and {len(real)} shipped "
        "recordings, told again with one thing halved or doubled (`python -m "
        "dentscope.studies.sensitivity`). Half as wide, a prior lies about the best place; twice "
        "as wide, nothing new explains the data. How many change, halved, doubled:", "",
        "| | open sets | lead | verdict | silent to told | told to silent | shipped: verdict |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]  # fmt: skip
    still, turns = [], [0]
    for row in rows:
        two = [change(drawn, label(row, t)) for t in (0.5, 2.0)]
        own = [change(real, label(row, t)).verdict for t in (0.5, 2.0)]
        turns += [c.spoilt + c.mended for c in two]
        if not any((*own, *two[0][1:], *two[1][1:])):
            still.append(row)
            continue
        columns = zip(*(c[1:5] for c in two), strict=True)
        cells = [str(two[0].sets), *(f"{a}, {b}" for a, b in (*columns, tuple(own)))]
        text.append(f"| {row} | {' | '.join(cells)} |")
    moved = [
        name
        for name, s in found.items()
        if s.truth is None and any(change([s], k).verdict for k in s.said if ", x " in k)
    ]
    return [
        *text, "",
        f"{f'At most {max(turns)} a row turn' if max(turns) else 'None turns'} from right to wrong "
        "or back. Nothing changes by: "
        f"{', '.join(still) or 'none'}. Of the shipped {', '.join(moved) or 'none'} changes. A "
        "stage taken away:",
        "", f"![a stage of the diagnosis taken away](pictures/{STAGES})", "",
    ]  # fmt: skip


def stages_picture(lines: Sequence[dict[str, Any]], path: Path) -> Path:
    """Draw what is said without each stage, and what that costs in ln p of the truth."""
    drawn = [s for s in by_set(lines).values() if s.truth is not None]
    stages = [k for k in dict.fromkeys(k for s in drawn for k in s.said) if k.startswith(WITHOUT)]
    own = {k: [s for s in drawn if k in s.said] for k in (AS_IT_IS, *stages)}
    # a stage that was fitted anew on fewer sets has those as they are beside it
    rows = [(k, k, own[k]) for k in own if len(own[k]) == len(own[AS_IT_IS])]
    few = [k for k in own if len(own[k]) < len(own[AS_IT_IS])]
    rows += [(AS_IT_IS, AS_IT_IS, own[few[0]])] if few else []
    rows += [(k, k, own[k]) for k in few]
    made = Figure(figsize=(9.0, 0.34 * len(rows) + 1.5), layout="constrained")
    left, right = made.subplots(1, 2, sharey=True, width_ratios=(1.35, 1.0))
    places = [-k for k in range(len(rows))]
    start = np.zeros(len(rows))
    for kind, colour in ((RIGHT, "C0"), (AMONG, "#9ec9e2"), (SILENT, "0.85"), (WRONG, "C3")):
        counts = np.array([sum(outcome(s, k) == kind for s in sets) for _, k, sets in rows])
        width = counts / np.array([len(sets) for *_, sets in rows])
        left.barh(places, width, left=start, color=colour, label=kind, height=0.72)
        for y, x, w, n in zip(places, start, width, counts, strict=True):
            if n:
                left.text(x + 0.5 * w, y, str(n), ha="center", va="center", fontsize=7,
                          color="white" if kind in (RIGHT, WRONG) else "black")  # fmt: skip
        start = start + width
    for y, (name, k, sets) in zip(places, rows, strict=True):
        if name == AS_IT_IS:
            continue
        less = np.array([_mark(s, k).ln_p - _mark(s, AS_IT_IS).ln_p for s in sets])
        mean, low, high = mean_with_interval(less, draws_of(len(sets)))
        right.errorbar([mean], [y], xerr=[[mean - low], [high - mean]], fmt="o", color="C0",
                       capsize=3, markersize=4)  # fmt: skip
    right.axvline(0.0, color="0.5", linewidth=0.8)
    left.set_yticks(places, [f"{name} ({len(sets)})" for name, _, sets in rows], fontsize=8)
    left.set(xlim=(0.0, 1.0), xlabel="share of the sets, and their number")
    right.set(xlabel="mean ln p of the truth, less as it is")
    right.set_title("below 0: worse without; 95 % intervals", fontsize=8)
    right.grid(alpha=0.3)
    made.legend(*left.get_legend_handles_labels(), loc="outside upper center", ncols=4, fontsize=8)
    return write_figure(made, path, dpi=110, metadata={"Software": None})
