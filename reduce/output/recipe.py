"""A recipe of many raw files, run as a program."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from ...core.errors import EXIT_INPUT_ERROR, InputError


def run_recipe(recipe: Callable[..., tuple[int, list[str]]], about: str) -> NoReturn:
    """Carry out a recipe on what the command line names, say what came of it, and leave.

    `recipe` takes the raw file or folder, the set's folder and whole numbers; it gives the number
    of trials and a line for each file left out. `about` is its docstring, the second paragraph the
    call.
    """
    usage = about.split("\n\n")[1].strip()
    raw, target, *rest = sys.argv[1:] if len(sys.argv) > 2 else ("", "", "no number")
    if len(rest) > usage.count("[") or not all(number.isdecimal() for number in rest):
        sys.stderr.write(f"usage: {usage}\n")
        sys.exit(EXIT_INPUT_ERROR)
    try:
        if not Path(raw).exists():
            raise InputError("no such file or folder", source=raw, allowed=usage)
        trials, left_out = recipe(Path(raw), Path(target), *map(int, rest))
    except (InputError, OSError) as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(EXIT_INPUT_ERROR)
    sys.stdout.write(f"{trials} trials in {target}\n" + "".join(f"{line}\n" for line in left_out))
    sys.exit(0 if trials else EXIT_INPUT_ERROR)
