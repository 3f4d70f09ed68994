"""The kinds of raw file, in reading order, and what each module offers.

A kind is one module with two names: `Options`, the table of its options (an `InputTable` whose
fields have a description; field names end in their unit), and `reduce(path, options) -> Reduced`.
The command line and the recipes make their options from `Options`, so that an option is written
once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.toml_input import InputTable, parse_model
from .reduced import Reduced

KINDS = {
    "video": "high-speed video: approach and rebound speed, lean, motion of the tip",
    "tip": "photograph of a tip: its radius",
    "mocap": "motion capture of markers: velocities, spin, friction",
    "scan": "scan of a crater: depth, rim, sliding length, profile",
    "sound": "sound of a bouncing ball: restitution of each bounce",
    "table": "table of force, acceleration, height, bounce times or trials",
}
"""Each kind, reduced by the module `NAME/kind.py`, and what it gives."""


@dataclass(frozen=True)
class Kind:
    """The two names that the module of a kind offers."""

    name: str
    options: type[InputTable]
    reduce: Callable[[Path, Any], Reduced]

    def run(self, path: Path, given: dict[str, Any], *, source: str) -> Reduced:
        """Reduce a file with options that are not checked yet; `source` names where they stand."""
        options = parse_model(given, self.options, source=source)
        if not path.exists():
            raise InputError("no such file", source=str(path), allowed="a raw recording")
        return self.reduce(path, options)


def offered() -> tuple[str, ...]:
    """Return the kinds whose module is there."""
    return tuple(k for k in KINDS if find_spec(f".{k}.kind", __package__))


def load_kind(name: str) -> Kind:
    """Return a kind by its name.

    Raises
    ------
    InputError
        There is no such kind.
    """
    if name not in offered():
        raise InputError(f"no kind {name!r}", key="kind", allowed=", ".join(offered()))
    module = import_module(f".{name}.kind", __package__)
    return Kind(name, module.Options, module.reduce)
