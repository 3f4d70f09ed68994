"""What the thesis's text says of a figure, sorted by whether it is so here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence


def judged(*claims: tuple[str, bool]) -> str:
    """Return how many claims hold here, and those that do not.

    Examples
    --------
    >>> judged(("a rises", True), ("b is largest", False))
    'Of 2 statements of the text 1 holds; not: b is largest.'
    >>> judged(("a rises", True))
    'As the text says: a rises.'
    """
    missed = [claim for claim, holds in claims if not holds]
    held = len(claims) - len(missed)
    if len(claims) == 1:
        return f"{'Not as' if missed else 'As'} the text says: {claims[0][0]}."
    if not missed:
        return f"{'Both' if held == 2 else f'All {held}'} statements of the text hold."
    if not held:
        return f"Not as the text says: {'; '.join(missed)}."
    verb = "holds" if held == 1 else "hold"
    return f"Of {len(claims)} statements of the text {held} {verb}; not: {'; '.join(missed)}."


def ranked(
    values: Mapping[str, float],
    law: str,
    *,
    first: str,
    form: str = ".3g",
    without: Sequence[str] = (),
) -> tuple[str, bool]:
    """Return the claim that `law` is the "largest" or "smallest", and whether it is.

    `values`: by law; `law`: of which it is said; `first`: "largest" or "smallest"; `form`: format
    of the values; `without`: laws that the text leaves out of the comparison.

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
