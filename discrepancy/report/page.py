"""report.html: one file for people that needs no network, and its numbers as JSON and CSV."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from ... import __version__
from ...core.observables import OBSERVABLES
from ...core.output import csv_text, write_file
from ..findings import Verdict
from .figures import comparison, correction, path, paths_of
from .series import SeriesPoint
from .story import Story, story_of
from .wording import explanation

_TEMPLATE = Path(__file__).parent / "template"
_SHAPES = ("●", "■", "▲", "◆", "▼", "✚", "✖", "★")


class Panel(NamedTuple):
    """One figure of the page: an observable against something that varies."""

    observable: str
    label: str
    against: str
    svg: str


def write_report(verdict: Verdict, path: Path) -> tuple[Path, ...]:
    """Write the report, and what its figures show as JSON and CSV beside it; return the files."""
    story = story_of(verdict)
    numbers = json.dumps(_finite(story.to_dict()), indent=1, allow_nan=False)
    contents = {
        path: page(verdict, story),
        path.with_suffix(".json"): f"{numbers}\n",
        path.with_suffix(".csv"): table(story.points),
    }
    for file, text in contents.items():
        write_file(file, text)
    return tuple(contents)


def page(v: Verdict, story: Story) -> str:
    """Return the report as one HTML page."""
    environment = Environment(
        loader=FileSystemLoader(_TEMPLATE), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    panels = panels_of(story)
    words = [explanation(name, v.titles) for name in paths_of(v.history)]
    return environment.get_template("report.html").render(
        s=story, seed=v.seed, impacts=v.impacts, version=__version__,
        style=(_TEMPLATE / "report.css").read_text(encoding="utf-8"),
        script=(_TEMPLATE / "report.js").read_text(encoding="utf-8"),
        panels=panels, observables={p.observable: p.label for p in panels},
        corrected=correction(v.corrections) if v.corrections else "",
        path=path(v.history) if v.history else "",
        paths=list(zip(_SHAPES, words, strict=False)),
        equations=[(m.title, m.equations) for m in v.best.mechanisms],
        shapes=list(zip(story.strikers, _SHAPES * len(story.strikers), strict=False)),
        weightless=any(not p.weight for p in story.points),
        csv=_link("text/csv", table(story.points)),
        json=_link("application/json", json.dumps(_finite(story.to_dict()))),
    )  # fmt: skip


def panels_of(story: Story) -> tuple[Panel, ...]:
    """Return a figure for every observable and everything that varies among its numbers."""
    found = []
    for k, name in enumerate(dict.fromkeys(p.observable for p in story.points)):
        points = [p for p in story.points if p.observable == name]
        for n, against in enumerate(story.against):
            if n and len({p.x[against.key] for p in points}) < 2:
                continue
            svg = comparison(points, against, story.strikers, key=f"f{k}x{n}")
            found.append(Panel(name, OBSERVABLES[name].label, against.key, svg))
    return tuple(found)


def table(points: tuple[SeriesPoint, ...]) -> str:
    """Return every number of the figures as CSV."""
    rows = [p.row() for p in points]
    return csv_text((row.values() for row in rows), header=rows[0])


def _link(kind: str, text: str) -> str:
    """Return a text as the address of a link, for a page that stands alone."""
    return f"data:{kind};base64,{base64.b64encode(text.encode()).decode('ascii')}"


def _finite(content: object) -> object:
    """Return the content as JSON holds it: null where there is no number."""
    if isinstance(content, dict):
        return {k: _finite(x) for k, x in content.items()}
    if isinstance(content, list):
        return [_finite(x) for x in content]
    return None if isinstance(content, float) and content != content else content
