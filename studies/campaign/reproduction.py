"""docs/thesis/claims.md: the trends of chapter 2, claim by claim."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ...campaigns import CaseRecord, read_curves
from ...core.output import write_file
from .sweep import sweeps
from .trends import Trend, trends

_HEAD = """# Chapter 2 of the thesis, claim by claim

What the text says of its finite elements, checked on ours at Delta/R = 0.04, the depth of its
figures. **agrees**: all computed cases hold the claim within the tolerance that stands in it;
**partly**: some do, and those that do not are shown; **contradicts**: none does. Of several cases
alike the first is shown. Made by `dentscope campaign reproduction`.

{rests} {counts}.

| section | claim | verdict | found |
| --- | --- | --- | --- |
"""


def write(source: Path, to: Path) -> list[Trend]:
    """Test the claims on a run or a data set and write the report.

    Raises `InputError`: the file is missing or damaged.
    """
    records = [r for r in read_curves(source) if r.case.pair.perfectly_plastic]
    found = trends(records)
    write_file(to, report(records, found))
    return found


def report(records: Sequence[CaseRecord], found: Sequence[Trend]) -> str:
    """Return the report as Markdown."""
    counts = Counter(trend.verdict for trend in found)
    told = ", ".join(f"{n} {word}" for word, n in counts.items())
    text = _HEAD.format(rests=_rests(records), counts=f"Of {len(found)} claims: {told}")
    return text + "".join(
        f"| {trend.section} | {trend.claim} | **{trend.verdict}** | {_cells(trend)} |\n"
        for trend in found
    )


def _cells(trend: Trend) -> str:
    """What was found: the cases against a claim that some hold, else the first of those alike."""
    against = {name: note for name, (good, note) in trend.findings.items() if not good}
    if trend.verdict == "partly":
        return "; ".join(f"{name}: {note}" for name, note in against.items())
    found = [f"{name}: {note}" for name, (_, note) in trend.findings.items()]
    return found[0] if found else "the cases are not computed yet"


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
    rough = " Verdicts at less than production resolution are provisional: F and a ripple there."
    return (
        f"It rests on {sum(levels.values())} cases of Table 2.1 ({resolution}) among "
        f"{len(records)} stored ones."
        f"{'' if set(levels) == {'production'} else rough}"
    )
