"""What a metal's marks say, in lines."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..correction import LEVEL
from ..rules import RULES
from .estimate import Metal
from .next_mark import TOLD


def lines(metal: Metal) -> Iterator[str]:
    """Yield the finding: stresses, rate, what is not identified, the next mark."""
    of = "the flat" if metal.body == "target" else metal.body.removeprefix("strikers.")
    counted = (("presses", metal.pressed), ("impacts", metal.struck))
    numbers = [f"{n} number{'s' * (n != 1)} of {marks}" for marks, n in counted if n]
    strains = " to ".join(dict.fromkeys(f"{100.0 * x:.2g}" for x in metal.covered))
    yield (
        f"{metal.name}: flow curve of {of} from {' and '.join(numbers)}, at representative strains "
        f"of {strains} %"
    )
    yield ""
    for x in TOLD:
        value, least, most = (1e-6 * s for s in metal.stress_at(x))
        yield (
            f"  at {100.0 * x:.3g} %: {value:.4g} MPa ({LEVEL:.0%}: {least:.4g} to {most:.4g})"
            f"{_doubt(metal, x)}"
        )
    yield from _rate(metal)
    if metal.next is not None:
        n = metal.next
        told = ", ".join(
            f"{100.0 * b:.2g} to {100.0 * a:.2g} % at {100.0 * x:.3g} %"
            for x, b, a in zip(TOLD, n.before, n.after, strict=True)
        )
        yield ""
        yield (
            f"Next mark: press {n.striker} to {float(f'{n.load:.2g}'):g} N and read depth and "
            f"diameter: the standard error of the stress goes from {told}"
        )
    yield ""
    for note in metal.notes:
        yield f"note: {note}"


def _doubt(metal: Metal, strain: float) -> str:
    low, high = metal.covered
    if metal.spread_at(strain) > RULES.vague:
        return ": not identified by these marks"
    if not low <= strain <= high:
        return ": beyond the marks, by how metals harden"
    return ""


def _rate(metal: Metal) -> Iterator[str]:
    if not metal.rated:
        yield "  rate: not identified, no impact left a mark that was read"
        return
    value, low, high = (100.0 * x for x in metal.rise)
    text = f"  rise at 1000 1/s: {value:.3g} % ({LEVEL:.0%}: {low:.3g} to {high:.3g})"
    if math.log((100.0 + high) / (100.0 + low)) > 3.3 * RULES.vague:
        more = "" if metal.pressed else "; quasi-static presses of the same ball would tell it"
        text += f": not identified{more}"
    yield text
