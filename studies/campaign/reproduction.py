"""docs/reproduction.md: the trends of chapter 2, claim by claim."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ...campaigns import CaseRecord, read_curves
from ...core.output import write_file
from .sweep import sweeps
from .trends import Trend, trends

_HEAD = """# Chapter 2 of the thesis, claim by claim

Made by `dentscope campaign reproduction`. The depth is Delta/R = 0.04 as in the thesis's figures;
the cases are those of its Table 2.1. A verdict is for the tolerance that stands in the claim:
**agrees** where all computed cases hold it, **partly** where some do, **contradicts** where none
does.

{rests}

| | |
| --- | --- |
{counts}
"""


def write(source: Path, to: Path) -> list[Trend]:
    """Test the claims on a campaign file or data set and write the report.

    Raises
    ------
    InputError
        The file is missing or damaged.
    """
    records = [r for r in read_curves(source) if r.case.pair.perfectly_plastic]
    found = trends(records)
    write_file(to, report(records, found))
    return found


def report(records: Sequence[CaseRecord], found: Sequence[Trend]) -> str:
    """Return the report as Markdown."""
    counts = Counter(trend.verdict for trend in found)
    words = ("agrees", "partly", "contradicts", "not computed")
    rows = "\n".join(f"| {word} | {counts[word]} |" for word in words)
    text = _HEAD.format(rests=_rests(records), counts=rows)
    section = ""
    for trend in found:
        if trend.section != section:
            section = trend.section
            text += f"\n## Section {section}\n\n"
            text += "| claim | verdict | found |\n| --- | --- | --- |\n"
        text += f"| {trend.claim} | **{trend.verdict}** | {_cells(trend)} |\n"
    return text


def _cells(trend: Trend) -> str:
    holds = {good for good, _ in trend.findings.values()}
    told = []
    for name, (good, note) in trend.findings.items():
        mark = "" if len(holds) < 2 else ("yes, " if good else "no, ")
        told.append(f"{name}: {mark}{note}")
    return "; ".join(told) if told else "the cases are not computed yet"


def _rests(records: Sequence[CaseRecord]) -> str:
    found = sweeps(records)
    levels = Counter(
        str(record.accuracy.get("level", record.case.accuracy.level))
        for sweep in found.values()
        for record in sweep.records
    )
    if not levels:
        return f"Of {len(records)} stored cases none is of Table 2.1."
    resolution = ", ".join(f"{count} at {level} resolution" for level, count in levels.items())
    ratios = ", ".join(f"case {n}: {len(sweep.ratio)}" for n, sweep in found.items())
    rough = " Verdicts at less than production resolution are provisional: F and a ripple there."
    return (
        f"It rests on {sum(levels.values())} cases of Table 2.1 ({resolution}; values of Sy* "
        f"computed: {ratios}) among {len(records)} stored ones."
        f"{'' if set(levels) == {'production'} else rough}"
    )
