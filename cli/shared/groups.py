"""Groups of commands: what they print for help, and what they do when asked for nothing.

Help is plain text: it keeps units in square brackets, wraps at any width and cuts nothing.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

import typer
from typer.core import TyperGroup

from ..studies import COMMANDS as _WORKSHOP
from .places import misused

SECTIONS = (
    ("Your own", (
        "impact", "diagnose", "metal", "recordings", "reduce", "case", "laws", "export", "inverse",
    )),
    ("Behind the law", ("campaign", "fit")),
    ("To begin", ("examples", "materials", "keys", "doctor", "version")),
    ("Workshop, in a checkout only", tuple(name for name in _WORKSHOP if " " not in name)),
)  # fmt: skip
"""Commands as the first help shows them; what stands in none comes last."""


class Commands(TyperGroup):
    """A group that shows its commands whole, and runs `alone` where none is given."""

    alone: tuple[str, ...] = ("--help",)
    sections: tuple[tuple[str, tuple[str, ...]], ...] = ()  # titles, and the commands under each

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Take `alone` for an empty command line."""
        return super().parse_args(ctx, args or list(self.alone))

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write each command with its first sentence, in sections where there are some."""
        told = self.abouts(ctx)
        left = list(told)
        for title, names in (*self.sections, ("Commands", ())):
            here = [n for n in names if n in left] if names else left
            left = [n for n in left if n not in here]
            if here:
                with formatter.section(title):
                    formatter.write_dl([(name, told[name]) for name in here])

    def abouts(self, ctx: Any) -> dict[str, str]:
        """Commands that are shown, and what each is for."""
        known = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        helps = {n: c.help or "" for n, c in known.items() if c is not None and not c.hidden}
        return {n: " ".join(text.split("\n\n")[0].split()) for n, text in helps.items()}

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command; for an unknown one say which there are."""
        name = args[0]
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            known = list(self.abouts(ctx))
            near = get_close_matches(name, known, n=1)
            meant = f"; did you mean {near[0]!r}?" if near else ""
            raise misused(f"no command {name!r}{meant}", allowed=", ".join(known))
        return super().resolve_command(ctx, args)


class Sections(Commands):
    """The first group, in sections."""

    sections = SECTIONS


def group(about: str, *, cls: type[Commands] = Commands) -> typer.Typer:
    """Return a group of commands that says `about` itself."""
    return typer.Typer(
        help=about, cls=cls, rich_markup_mode=None, add_completion=False,
        pretty_exceptions_enable=False,
    )  # fmt: skip
