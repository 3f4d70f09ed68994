"""The workshop, `studies/`: it lies in a checkout and is not installed with the package.

The one place that knows whether it is there. A command that needs it appears in a checkout;
elsewhere it is hidden, and answers in one line where to get the workshop, with exit code 2.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

import typer

from ..core.errors import InputError

WHERE = "not installed: get a checkout or the source archive of dentscope, `make install` there"

COMMANDS = ("figures", "verify", "proof", "challenge", "campaign reproduction")
"""What the user types after `dentscope`; the first word is the module that holds it."""

_ANYTHING = {"allow_extra_args": True, "ignore_unknown_options": True}


def present() -> bool:
    """Whether this installation is a checkout that holds the workshop."""
    return find_spec("..studies", package=__package__) is not None


def needed_for(what: str) -> None:
    """Refuse the command `what` where the workshop is not present, and say where to get it."""
    if not present():
        raise InputError(f"{what} belongs to the workshop (studies/), which is {WHERE}")


def add(group: typer.Typer, name: str) -> None:
    """Add one of `COMMANDS` of the workshop to a group of the command line."""
    last = name.rsplit(" ", 1)[-1]
    if not present():
        hidden = group.command(last, hidden=True, add_help_option=False, context_settings=_ANYTHING)
        hidden(lambda: needed_for(f"`dentscope {name}`"))
        return
    part = import_module(f"..studies.commands.{name.split()[0]}", __package__)
    if hasattr(part, "app"):
        group.add_typer(part.app, name=last)
    else:
        group.command(last)(getattr(part, last))
