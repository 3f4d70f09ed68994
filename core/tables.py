"""Rows as a data frame, and as a table of a notebook."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from typing import Any

from .errors import missing_extra


def frame(rows: Iterable[dict[str, Any]]) -> Any:
    """Return rows as a pandas data frame.

    Raises
    ------
    InputError
        pandas is not installed.
    """
    if find_spec("pandas") is None:
        raise missing_extra("a data frame", "tables")
    import pandas

    return pandas.DataFrame(list(rows))


def html_table(head: Sequence[str], rows: Iterable[Sequence[str]], *, title: str = "") -> str:
    """Return a table for a notebook."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    above = f"<caption>{html.escape(title)}</caption>" if title else ""
    return f"<table>{above}<thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>"
