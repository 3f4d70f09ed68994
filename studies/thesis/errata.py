"""docs/thesis/errata.md: misprints and contradictions of the thesis, from what shows them.

Nothing in that file is written by hand.
"""

from __future__ import annotations

import textwrap
from pathlib import Path

from ...core.output import write_file
from .contradictions import CONTRADICTIONS
from .misprints import MISPRINTS, Erratum

_HEAD = """# Errata of the thesis

Written by `python -m dentscope.studies.thesis.errata`; every number is computed there. Each entry
says what is printed → what is used here. The corrected equations are in the functions that
docs/theory.md names, the printed ones in `studies.thesis.as_printed`.
"""


def text() -> str:
    """Return the content of docs/thesis/errata.md."""
    parts = [_HEAD, "## Misprints\n", *map(_entry, MISPRINTS)]
    return "\n".join([*parts, "## Contradictions\n", *map(_entry, CONTRADICTIONS)])


def _entry(one: Erratum) -> str:
    lines = textwrap.wrap(one.show(), 98)
    head = f"- **{one.where}** {one.printed} → {one.meant}."
    return "\n".join([head, *(f"  {line}" for line in lines)]) + "\n"


def write(path: Path) -> Path:
    """Write the errata to `path`."""
    return write_file(path, text())


if __name__ == "__main__":
    write(Path(__file__).resolve().parents[2] / "docs" / "thesis" / "errata.md")
