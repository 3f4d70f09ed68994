"""What other packages add: laws, mechanisms and readers, found by their entry points.

A package names what it adds in its pyproject.toml:

    [project.entry-points."dentscope.laws"]
    my-law = "my_package:LAW"

Nothing is loaded until a name is asked for that is not ours, or all of a group are.
"""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import Any

from ..errors import InputError

LAWS, MECHANISMS, READERS = "dentscope.laws", "dentscope.mechanisms", "dentscope.readers"
"""Groups: a `ContactLaw`, a `Mechanism`, a module with `ABOUT`, `Options` and `reduce`."""


def names_added(group: str) -> tuple[str, ...]:
    """Return the names that other packages add to a group, in order, without loading them."""
    return tuple(sorted(entry_points(group=group).names))


def added(group: str, name: str) -> Any:
    """Load what a package adds to a group under a name, or refuse a name that none has."""
    found = tuple(entry_points(group=group, name=name))
    if not found:
        raise InputError(f"no {name!r}", key=group, allowed=", ".join(names_added(group)))
    try:
        return found[0].load()
    except Exception as error:  # the package of somebody else raises what it likes
        reason = (str(error).splitlines() or [""])[0]
        package = found[0].dist.name if found[0].dist else found[0].value
        raise InputError(
            f"{name!r} of {package} cannot be loaded ({type(error).__name__}: {reason})",
            key=group, allowed="a package that works: mend it, or uninstall it",
        ) from None  # fmt: skip
