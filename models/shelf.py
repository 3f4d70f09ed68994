"""The laws by name, which show themselves as a table."""

from __future__ import annotations

from ..core.tables import html_table
from .base import ContactLaw

_HEAD = ("law", "authors", "made for", "equations")


class Shelf(dict[str, ContactLaw]):
    """Contact laws by name, in reading order."""

    def rows(self) -> list[tuple[str, str, str, str]]:
        """Return name, authors, the bodies it is made for, and where its equations were read."""
        return [(law.name, law.title, law.regime, law.standing.told) for law in self.values()]

    def __repr__(self) -> str:
        rows = [_HEAD, *self.rows()]
        width = [max(map(len, column)) for column in zip(*rows, strict=True)]
        return "\n".join(
            "  ".join(cell.ljust(w) for cell, w in zip(row, width, strict=True)).rstrip()
            for row in rows
        )

    def _repr_html_(self) -> str:
        return html_table(_HEAD, self.rows())
