"""How large an effect must be to be found and rightly named: tables and a picture."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from matplotlib.figure import Figure

from ...core.output import write_figure
from .case import Case, interval

SIZES = (0.0, 5.0, 10.0, 20.0, 40.0, math.inf)
"""Edges of the classes of size."""

_TICKS = (2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0)
_FAR = 500.0  # beyond it a size tells no more

PICTURE = "proof-power.png"


class Shown(NamedTuple):
    """One concealed effect: its mechanism, its size, whether it was found and rightly named."""

    mechanism: str
    size: float
    detected: bool
    right: bool


def shown(cases: Iterable[Case]) -> list[Shown]:
    """Every set with one mechanism whose size is known."""
    return [
        Shown(
            next(iter(c.true)), c.size, c.said not in ("adequate", "undetermined"), c.best == c.true
        )
        for c in cases
        if c.truth["kind"] == "single" and math.isfinite(c.size)
    ]  # fmt: skip


def by_size(rows: Sequence[Shown]) -> list[tuple[float, float, int, int, int]]:
    """(low, high, detected, right, sets) of each class of size with sets."""
    found = []
    for low, high in itertools.pairwise(SIZES):
        here = [r for r in rows if low <= r.size < high]
        if here:
            counts = sum(r.detected for r in here), sum(r.right for r in here)
            found.append((low, high, *counts, len(here)))
    return found


def power_lines(rows: Sequence[Shown]) -> list[str]:
    """The section of the page: found and rightly named by size."""
    if not rows:
        return []
    lines = [
        "", "### Power", "",
        f"![found and rightly named against size](pictures/{PICTURE})", "",
        "| size | sets | found, 95 % interval | rightly named, 95 % interval |",
        "| --- | --- | --- | --- |",
    ]  # fmt: skip
    for low, high, seen, right, n in by_size(rows):
        sizes = f"above {low:g}" if math.isinf(high) else f"{low:g} to {high:g}"
        lines.append(f"| {sizes} | {n} | {_share(seen, n)} | {_share(right, n)} |")
    return lines


def picture(rows: Sequence[Shown], path: Path) -> Path:
    """Draw both shares against size, and every set beside its mechanism."""
    made = Figure(figsize=(9.0, 4.6), layout="constrained")
    left, right = made.subplots(1, 2, width_ratios=(1.0, 1.3))
    for which, look in ((2, {"fmt": "o-", "color": "0.4", "label": "found"}),
                        (3, {"fmt": "s-", "color": "C0", "label": "rightly named"})):  # fmt: skip
        places, shares, errors = [], [], []
        for found in by_size(rows):
            here = [r.size for r in rows if found[0] <= r.size < found[1]]
            share, (low, high) = found[which] / found[4], interval(int(found[which]), found[4])
            places.append(math.exp(sum(map(math.log, here)) / len(here)))
            shares.append(share)
            errors.append((share - low, high - share))
        left.errorbar(places, shares, yerr=list(zip(*errors, strict=True)), capsize=3, **look)
    left.set(xscale="log", ylim=(0.0, 1.02), xlabel="size of the effect",
             ylabel="share of the sets, 95 % interval")  # fmt: skip
    left.legend(loc="lower right", fontsize=8)
    names = sorted({r.mechanism for r in rows}, reverse=True)
    for label, colour, marker, own in (
        ("rightly named", "C0", "o", [r for r in rows if r.right]),
        ("found", "0.55", "o", [r for r in rows if r.detected and not r.right]),
        ("not found", "C3", "x", [r for r in rows if not r.detected]),
    ):
        right.scatter([min(r.size, _FAR) for r in own], [names.index(r.mechanism) for r in own],
                      s=18, c=colour, marker=marker, label=label, alpha=0.8,
                      linewidths=1.0)  # fmt: skip
    right.set(xscale="log", xlabel=f"size of the effect, or {_FAR:g} and more")
    right.set_yticks(range(len(names)), names, fontsize=7)
    right.legend(fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    for axis in (left, right):
        axis.set_xticks(_TICKS, [f"{x:g}" for x in _TICKS])
        axis.xaxis.minorticks_off()
        axis.grid(alpha=0.3)
    return write_figure(made, path, dpi=110, metadata={"Software": None})


def _share(hits: int, of: int) -> str:
    low, high = interval(hits, of)
    return f"{hits / of:.2f} ({low:.2f} to {high:.2f})"
