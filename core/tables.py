"""Rows as a data frame, and as tables of text."""

from __future__ import annotations

import html
import io
from collections.abc import Iterable, Mapping, Sequence
from importlib.util import find_spec
from typing import Any

from .errors import missing_extra


def counted(number: int, noun: str) -> str:
    """Return a number of things.

    Examples
    --------
    >>> counted(1, "trial"), counted(2, "trial")
    ('1 trial', '2 trials')
    """
    return f"{number} {noun}{'' if number == 1 else 's'}"


def frame(table: Iterable[dict[str, Any]] | Mapping[str, Any]) -> Any:
    """Return rows, or columns by name, as a pandas data frame; refused without pandas."""
    if find_spec("pandas") is None:
        raise missing_extra("a data frame", "tables")
    import pandas

    return pandas.DataFrame(dict(table) if isinstance(table, Mapping) else list(table))


def parquet(table: Mapping[str, Any]) -> bytes:
    """Return columns by name as the content of a Parquet file; refused without pyarrow.

    A cell without a number is null, as pandas writes it.
    """
    if find_spec("pyarrow") is None:
        raise missing_extra("a Parquet file", "tables")
    import pyarrow
    from pyarrow.parquet import write_table

    columns = {k: pyarrow.array(v, from_pandas=True) for k, v in table.items()}
    content = io.BytesIO()
    write_table(pyarrow.table(columns), content)
    return content.getvalue()


def thinned(count: int, most: int = 13) -> list[int]:
    """Return the rows of a long table that are shown: the first, the last, evenly between."""
    shown = min(count, most)
    return [round(k * (count - 1) / max(shown - 1, 1)) for k in range(shown)]


def text_table(rows: Sequence[Sequence[str]], *, numbers: bool = False) -> str:
    """Return rows as text in columns, those after the first on the right if they are numbers."""
    first, *others = (max(map(len, column)) for column in zip(*rows, strict=True))
    return "\n".join(
        "  ".join(
            [row[0].ljust(first), *(
                cell.rjust(w) if numbers else cell.ljust(w)
                for cell, w in zip(row[1:], others, strict=True)
            )]
        ).rstrip()
        for row in rows
    )  # fmt: skip


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """Return rows, the head first, as a table in Markdown."""
    head, *rest = rows
    lines = [head, ["---"] * len(head), *rest]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def html_table(head: Sequence[str], rows: Iterable[Sequence[str]], *, title: str = "") -> str:
    """Return a table for a notebook."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    above = f"<caption>{html.escape(title)}</caption>" if title else ""
    return f"<table>{above}<thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>"
