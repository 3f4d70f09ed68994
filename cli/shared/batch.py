"""Several raw files in one call: which, with which options each, and their pictures on one page."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ...core.errors import InputError, InputErrors
from ...core.inputs.csv_table import Problems, read_text_table
from ...core.inputs.names import trial_name
from ...reduce.images.picture_file import PICTURES, natural_order
from ...reduce.kinds import Kind
from .places import misused

_FILE = "file"


class Job(NamedTuple):
    """A raw file, its options, and where they stand."""

    file: Path
    options: dict[str, Any]
    source: str


def jobs_of(
    kind: Kind, files: Sequence[Path], listed: Path | None, given: Mapping[str, Any]
) -> list[Job]:
    """Return what is to be reduced: raw files, folders of them, and files of a list.

    `listed` has the column `file`, from its own folder, and columns named as options, which count
    for that file alone; `given` are options of all. Refused where there is nothing to reduce, a
    list cannot be read, or two files would name one trial.
    """
    jobs = [Job(f, dict(given), "command line") for path in files for f in _within(path, kind)]
    if listed is not None:
        jobs += _listed(kind, listed, given)
    if not jobs:
        needed = "files, folders of them, or --list with a table of them"
        raise misused("no raw file", key="FILE", allowed=needed)
    names = [trial_name(job.file, **job.options) for job in jobs]
    twice = next((name for name in names if names.count(name) > 1), "")
    if twice:
        needed = "files of different names: they name the trials"
        raise misused(f"two files are named {twice}", key="FILE", allowed=needed)
    return jobs


def _within(path: Path, kind: Kind) -> list[Path]:
    """The files of a folder, in the natural order of their names; pictures of one are a clip."""
    if not path.is_dir():
        return [path]
    found = [f for f in path.iterdir() if f.is_file() and not f.name.startswith(".")]
    if kind.takes_folders and any(f.suffix.lower() in PICTURES for f in found):
        return [path]
    return sorted(found, key=lambda f: natural_order(f.name))


def _listed(kind: Kind, listed: Path, given: Mapping[str, Any]) -> list[Job]:
    """The rows of a list; an empty cell leaves the option as it is for all."""
    problems = Problems(str(listed))
    table = read_text_table(listed, (_FILE, *kind.options.model_fields), problems)
    if table is None or problems.found:
        raise InputErrors(tuple(problems.found))
    if _FILE not in table.columns:
        raise InputError(
            "no such column", source=str(listed), key=_FILE, allowed="the name of each raw file"
        )
    jobs = []
    for place, number in enumerate(table.rows):
        row = {c: table.cells[c][place].strip() for c in table.columns}
        own = {c: _number_or_text(v) for c, v in row.items() if v and c != _FILE}
        file = listed.parent / row[_FILE]
        jobs.append(Job(file, {**given, **own}, f"{listed}, row {number}"))
    return jobs


def _number_or_text(cell: str) -> int | float | str:
    if re.fullmatch(r"[+-]?\d+", cell):
        return int(cell)
    try:
        return float(cell)
    except ValueError:
        return cell


def draw_page(pictures: Mapping[str, Path], path: Path) -> None:
    """Draw small copies of all pictures on one page, named, for a look at all of them."""
    from matplotlib.image import imread

    from ...core.output import figure
    from ...reduce.pictures import save

    columns = min(4, len(pictures))
    rows = math.ceil(len(pictures) / columns)
    made, grid = figure(rows, columns, size=(4.0 * columns, 2.6 * rows))
    for axes in grid.ravel():
        axes.axis("off")
    for axes, (name, picture) in zip(grid.ravel(), pictures.items(), strict=False):
        axes.imshow(imread(picture))
        axes.set_title(name, fontsize=8)
    save(made, path)
