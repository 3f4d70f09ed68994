"""The laws by name, which show themselves as a table."""

from __future__ import annotations

from difflib import get_close_matches

from ..core.errors import InputError
from ..core.inputs.added import LAWS as GROUP
from ..core.inputs.added import added, names_added
from ..core.tables import html_table, text_table
from .base import ContactLaw

_HEAD = ("law", "authors", "made for", "equations")


class UnknownLaw(KeyError):
    """No law has this name; the message says which come near."""

    def __str__(self) -> str:
        return str(self.args[0])


class Shelf(dict[str, ContactLaw]):
    """Contact laws by name, in reading order; those of other packages when they are asked for."""

    def __missing__(self, name: str) -> ContactLaw:
        if name in names_added(GROUP):
            law = added(GROUP, name)
            if not isinstance(law, ContactLaw):
                raise InputError(f"{name!r} of {GROUP} is no ContactLaw", key="law")
            return law
        near = get_close_matches(str(name), self, n=1)
        meant = f"did you mean {near[0]!r}? " if near else ""
        raise UnknownLaw(f"no law {name!r}; {meant}known are {', '.join(self)}")

    def rows(self) -> list[tuple[str, str, str, str]]:
        """Return name, authors, the bodies it is made for, and where its equations were read."""
        return [(law.name, law.title, law.regime, law.standing.told) for law in self.values()]

    def __repr__(self) -> str:
        return text_table([_HEAD, *self.rows()])

    def _repr_html_(self) -> str:
        return html_table(_HEAD, self.rows())
