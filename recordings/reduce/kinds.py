"""The kinds of raw file, in reading order, and what each of their folders offers.

The folder of a kind holds `kind.py` with two names: `Options`, the table of its options (an
`InputTable` whose fields have a description; field names end in their unit), and
`reduce(path, options) -> Reduced`; and `picture.py`, which draws the picture to check the numbers
by. The command line and the recipes make their options from `Options`, so that an option is
written once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError
from ...core.input_file import checked_file
from ...core.toml_input import InputTable, parse_model

if TYPE_CHECKING:
    from .reduced import Reduced

KINDS = {
    "video": "high-speed video: approach and rebound speed, lean, motion of the tip",
    "tip": "photograph of a tip: its radius",
    "mocap": "motion capture of markers: velocities, spin, friction",
    "scan": "scan of a crater: depth, rim, sliding length, profile",
    "sound": "sound of a bouncing ball: restitution of each bounce",
    "table": "table of force, acceleration, height, bounce times or trials",
}
"""Each kind, named as its folder, and what it gives."""


_MOST_BYTES = 20_000_000_000


@dataclass(frozen=True)
class Kind:
    """One way to reduce a file: its options and the function that takes them."""

    name: str
    options: type[InputTable]
    reduce: Callable[[Path, Any], Reduced]

    def run(self, path: Path, given: dict[str, Any], *, source: str) -> Reduced:
        """Reduce a file with options that are not checked yet; `source` names where they stand."""
        options = parse_model(given, self.options, source=source)
        if not path.exists():
            raise InputError("no such file", source=str(path), allowed="a raw recording")
        if not path.is_dir():
            checked_file(path, most=_MOST_BYTES, allowed="a raw recording")
        from numpy.linalg import LinAlgError

        try:
            return self.reduce(path, options)
        except (ArithmeticError, LinAlgError) as error:
            raise InputError(
                f"its numbers cannot be reduced ({error})", source=str(path),
                allowed="a recording of the kind that was named",
            ) from None  # fmt: skip


def load_kind(name: str) -> Kind:
    """Return a kind by its name.

    Raises
    ------
    InputError
        There is no such kind.
    """
    if name not in KINDS:
        raise InputError(f"no kind {name!r}", key="kind", allowed=", ".join(KINDS))
    module = import_module(f".{name}.kind", __package__)
    return Kind(name, module.Options, module.reduce)
