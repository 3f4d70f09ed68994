"""Recording sets that come with the package, by name."""

from __future__ import annotations

from pathlib import Path

from ..core.errors import InputError

FOLDER = Path(__file__).resolve().parents[1] / "data" / "recordings"
"""Where they lie."""


def shipped_sets() -> tuple[str, ...]:
    """Names of the sets that come with the package."""
    return tuple(sorted(path.parent.name for path in FOLDER.glob("*/set.toml")))


def set_folder(given: Path) -> Path:
    """Return the folder of a set: the one given, or the shipped set of that name.

    A folder of the user's goes before a shipped set of the same name, but for one of its results.

    Raises `InputError`: a plain name that is neither; the names of the shipped sets are told.

    Examples
    --------
    >>> set_folder(Path("kharaz-2001-oblique")).parts[-3:]
    ('data', 'recordings', 'kharaz-2001-oblique')
    """
    results = (given / "verdict.json").exists() and not (given / "set.toml").exists()
    if len(given.parts) != 1 or (given.exists() and not (results and given.name in shipped_sets())):
        return given
    if given.name not in shipped_sets():
        raise InputError(
            "no such folder, and no shipped set of this name", source=str(given),
            allowed=f"a folder with set.toml, or one of {', '.join(shipped_sets())}",
        )  # fmt: skip
    return FOLDER / given
