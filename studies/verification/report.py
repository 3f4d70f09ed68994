"""docs/verification.md from what has been measured, and every number of it in one file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ... import fem
from ...core.output import write_file
from ...core.provenance import environment
from ...core.tables import markdown
from .bench import Effort
from .checks import CHECKS
from .result import Cell, Measurement, Result
from .runner import best_result, publish


def write_report(path: Path, *, folder: Path) -> Path:
    """Write the report from the measurements kept in `folder`; return its path.

    What is not measured there is taken from the results beside the report, where all that it shows
    is kept; so a report can be renewed check by check. Every number goes to `rows.md` in `folder`.
    """
    beside = path.parent / path.stem
    known = {check.name: best_result(check, folders=(folder, beside)) for check in CHECKS}
    found = [result for result in known.values() if result is not None]
    for result in found:
        publish(result, folder=beside)
    absent = [name for name, r in known.items() if r is None]
    missed = (part for result in found if result.missed for part in _section(result))
    rows = (part for result in found for part in _rows(result))
    every = ["# What the solver was checked against: every number", *rows]
    write_file(folder / "rows.md", "\n\n".join(every) + "\n")
    parts = [*_head(found), *_summary(found, absent), *missed]
    return write_file(path, "\n\n".join(parts) + "\n")


def _head(results: list[Result]) -> Iterator[str]:
    versions = environment()
    packages = ", ".join(f"{k} {v}" for k, v in versions.items() if k != "commit")
    yield "# What the solver was checked against"
    yield (
        "Made by `dentscope verify`; `--list` names the checks, `--only NAME` runs one, all take "
        f"{sum(r.cpu_s for r in results) / 3600.0:.1f} processor hours. Marks were set before "
        "measuring. Of each check the number nearest to its mark is shown, at the level "
        "`production` unless a row says otherwise. How each was done, and every number, any run "
        "writes to `build/verification/rows.md`; as data they lie in `docs/verification/results`."
    )
    yield f"Numerics version of the solver {fem.NUMERICS_VERSION}; {packages}."


def _summary(results: list[Result], absent: list[str]) -> Iterator[str]:
    rows = [("check", "marks met", "number nearest to its mark")]
    for r in results:
        title = f"[{r.title}](#{_anchor(r.title)})" if r.missed else r.title
        rows.append((title, _met(r), _nearest(r)))
    yield markdown(rows).rstrip()
    if absent:
        yield f"Not measured yet: {', '.join(absent)}."


def _nearest(result: Result) -> str:
    """The number of a check that is nearest to its mark and meets it."""
    kept = [m for m in result.measurements if m.met is not False]
    if not kept:
        return ""
    m = max(kept, key=lambda m: m.used)
    told = "; ".join(filter(None, (m.mark, m.source)))
    return _cell(f"{m.what}: {_value(m)}" + (f" ({told})" if told else ""))


def _met(result: Result) -> str:
    marked = sum(m.met is not None for m in result.measurements)
    told = f"{marked - len(result.missed)} of {marked}" if marked else "none set"
    if result.effort != Effort.PRODUCTION.value:
        told += f", {result.effort}"
    if result.numerics_version != fem.NUMERICS_VERSION:
        told += f", **numerics {result.numerics_version}: stale**"
    return told


def _section(result: Result) -> Iterator[str]:
    """The marks that a check missed, and why, a block after the other."""
    yield f"## {result.title}"
    yield "Missed:"
    yield "\n".join(f"- {m.what}: {_value(m)} ({m.mark})" for m in result.missed)
    yield from (check.missed for check in CHECKS if check.name == result.name and check.missed)


def _rows(result: Result) -> Iterator[str]:
    """Everything that a check measured."""
    yield f"## {result.title}"
    yield result.about
    if result.measurements:
        head = ["| measured | value | mark | | reference |", "| --- | --- | --- | --- | --- |"]
        yield "\n".join([*head, *map(_measurement, result.measurements)])
    for table in result.tables:
        yield f"{table.title}:"
        yield markdown([table.columns, *([_shown(x) for x in row] for row in table.rows)]).rstrip()
    yield from result.notes


def _value(m: Measurement) -> str:
    return f"{m.value:.3g} {m.unit}".rstrip()


def _measurement(m: Measurement) -> str:
    state = {True: "met", False: "**missed**", None: ""}[m.met]
    return f"| {_cell(m.what)} | {_value(m)} | {m.mark} | {state} | {_cell(m.source)} |"


def _shown(value: Cell) -> str:
    return f"{value:.4g}" if isinstance(value, float) else _cell(str(value))


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _anchor(title: str) -> str:
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")
