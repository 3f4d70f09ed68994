"""What the thesis's text says of a figure, sorted by whether it is so here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence


def judged(*claims: tuple[str, bool]) -> str:
    """Return the claims that hold here, then those that do not.

    Examples
    --------
    >>> judged(("a rises", True), ("b is largest", False))
    'As the text says: a rises. Not as it says: b is largest.'
    """
    parts = [
        f"{opening}: {'; '.join(said)}."
        for opening, wanted in (("As the text says", True), ("Not as it says", False))
        if (said := [claim for claim, holds in claims if bool(holds) is wanted])
    ]
    return " ".join(parts)


def ranked(
    values: Mapping[str, float],
    law: str,
    *,
    first: str,
    form: str = ".3g",
    without: Sequence[str] = (),
) -> tuple[str, bool]:
    """Return the claim that `law` is the "largest" or "smallest", and whether it is.

    Parameters
    ----------
    values
        By law.
    law
        Of which it is said.
    first
        "largest" or "smallest".
    form
        Format of the values.
    without
        Laws that the text leaves out of the comparison.

    Examples
    --------
    >>> ranked({"a": 1.0, "b": 2.0}, "a", first="largest")
    ('a is largest (here b, 2, and a 1)', False)
    """
    left = {name: value for name, value in values.items() if name not in without}
    found = (max if first == "largest" else min)(left, key=lambda name: left[name])
    besides = f" beside {' and '.join(without)}" if without else ""
    if found == law:
        return f"{law} is {first}{besides} ({left[law]:{form}})", True
    here = f"here {found}, {left[found]:{form}}, and {law} {left[law]:{form}}"
    return f"{law} is {first}{besides} ({here})", False


def apart(values: Mapping[str, float], names: Sequence[str], reference: float) -> str:
    """Deviations of laws from a reference, for a note."""
    return ", ".join(f"{name} {values[name] / reference - 1.0:+.1%}" for name in names)
