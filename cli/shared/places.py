"""Where commands write: an option that is checked before anything is computed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

from ...core.errors import InputError


def misused(told: str, *, key: str = "", allowed: str = "") -> InputError:
    """Return what is wrong with an option or an argument, `key`."""
    return InputError(told, source="command line", key=key, allowed=allowed)


def folder_option(about: str, *, name: str = "--out") -> Any:
    """Return the option of a folder that is made and written into, but not beside `--new`."""

    def check(context: typer.Context, path: Path | None) -> Path | None:
        if path is None or context.params.get("new"):
            return path
        return writable_folder(path, key=name)

    return typer.Option(name, help=about, callback=check)


def file_option(about: str, *, name: str = "--to") -> Any:
    """Return the option of a file that is written."""

    def check(path: Path) -> Path:
        if path.is_dir():
            raise misused(f"{path} is a folder", key=name, allowed="a file's name")
        writable_folder(path.parent, key=name)
        return path

    return typer.Option(name, help=about, callback=check)


def writable_folder(path: Path, *, key: str) -> Path:
    """Return the folder, which need not exist yet.

    Refused where it is a file, lies below one, or may not be written.
    """
    there = path.absolute()
    while not there.exists() and not there.is_symlink() and there != there.parent:
        there = there.parent
    if not there.is_dir():
        raise misused(f"{there} is no folder", key=key, allowed="a folder, new or existing")
    if not os.access(there, os.W_OK | os.X_OK):
        raise misused(f"{there} may not be written", key=key, allowed="a folder of your own")
    return path


def one_of(asked: str, allowed: Sequence[str], *, key: str) -> str:
    """Return a word that an option takes, or refuse it."""
    if asked not in allowed:
        raise misused(repr(asked), key=key, allowed=", ".join(filter(None, allowed)))
    return asked


def refuse_beside(context: typer.Context, option: str, *names: str) -> None:
    """Refuse options and arguments of a command, by their `names`, that do nothing beside another.

    `option` is what rules them out, as it is told: "beside --new".
    """
    for parameter in context.command.params:
        source = context.get_parameter_source(parameter.name or "")
        if parameter.name in names and source is not None and source.name == "COMMANDLINE":
            key = parameter.opts[0] if parameter.opts[0].startswith("-") else parameter.name.upper()
            raise misused(f"does nothing {option}", key=key, allowed="left out")
