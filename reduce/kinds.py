"""The kinds of raw file, in reading order, and what each of their folders offers.

The folder of a kind holds `options.py` with `Options`, the table of its options (an `InputTable`
whose fields have a description; field names end in their unit, standard deviations in `_std` behind
it); `kind.py` with `reduce(path, options) -> Reduced`, loaded when a file is reduced; and
`picture.py`, which draws the picture to check the numbers by. The command line and the recipes make
their options from `Options`, so that an option is written once. Another package adds a kind as one
module with `ABOUT` (what it gives), `Options` and `reduce` (`core.inputs.added`); where it fails,
the others still work.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ..core.errors import InputError, first_line
from ..core.inputs.added import READERS, added, names_added
from ..core.inputs.input_file import checked_file
from ..core.inputs.toml_input import InputTable, parse_model
from ..core.processes.threads import in_one_thread

if TYPE_CHECKING:
    from .reduced import Reduced

# limit: largest raw file [bytes]: the longest clips of the cameras that are read
_RAW_BYTES = 20_000_000_000

KINDS = {
    "video": "high-speed video: approach and rebound speed, lean, motion of the tip",
    "tip": "photograph of a tip: its radius",
    "mocap": "motion capture of markers: velocities, spin, friction",
    "scan": "scan of a crater: depth, rim, sliding length, profile",
    "sound": "sound of a bouncing ball: restitution of each bounce",
    "press": "load against depth of a testing machine or an indenter: depths, stiffness",
    "table": "table of force, acceleration, height, bounce times or trials",
}
"""Each kind, named as its folder, and what it gives."""


@dataclass(frozen=True)
class Kind:
    """One way to reduce a file: its name, its options, and its module where another package's."""

    name: str
    options: type[InputTable]
    module: ModuleType | None = None

    @property
    def takes_folders(self) -> bool:
        """Whether a folder may be one recording."""
        return self.name == "video"

    def run(self, path: Path, given: dict[str, Any], *, source: str) -> Reduced:
        """Reduce a file with options that are not checked yet; `source` names where they stand."""
        options = parse_model(given, self.options, source=source)
        if not (self.takes_folders and path.is_dir()):
            checked_file(path, most=_RAW_BYTES, allowed="a raw recording")
        kind = self.module or import_module(f".{self.name}.kind", __package__)
        # the reader of somebody else raises what it likes
        expected = Exception if self.module else (ArithmeticError, LookupError, ValueError)
        try:
            # threads of many small solutions wait for each other most of the time
            reduced: Reduced = in_one_thread(kind.reduce)(path, options)
            return reduced.known()
        except InputError:
            raise
        except expected as error:
            raise InputError(
                f"its numbers cannot be reduced ({first_line(error)})", source=str(path),
                allowed="a recording of the kind that was named",
            ) from error  # fmt: skip


def kind_names() -> tuple[str, ...]:
    """The kinds, those of other packages too, without loading any."""
    return (*KINDS, *(name for name in names_added(READERS) if name not in KINDS))


def all_kinds() -> dict[str, str]:
    """Each kind and what it gives, or why it cannot be loaded."""
    return {name: KINDS[name] if name in KINDS else _about(name) for name in kind_names()}


def load_kind(name: str) -> Kind:
    """Return a kind by its name; refuse one that there is not, or whose package fails."""
    if name in KINDS:
        return Kind(name, import_module(f".{name}.options", __package__).Options)
    if name in kind_names():
        module = _reader(name)
        return Kind(name, module.Options, module)
    raise InputError(f"no kind {name!r}", key="kind", allowed=", ".join(kind_names()))


def _reader(name: str) -> ModuleType:
    module: ModuleType = added(READERS, name)
    missing = [part for part in ("ABOUT", "Options", "reduce") if not hasattr(module, part)]
    if missing:
        raise InputError(
            f"{name!r} has no {missing[0]}", key=READERS,
            allowed="a module with ABOUT, Options and reduce",
        )  # fmt: skip
    return module


def _about(name: str) -> str:
    try:
        return str(_reader(name).ABOUT)
    except InputError as error:
        return error.message
