"""Registers of tuned numbers: one a stage, in its `rules.py`, made of `rule`.

A tuned number is one that somebody chose and that a result hangs on: a threshold, a tolerance, the
size of a grid, a weight. A limit is one that somebody chose and that no result hangs on: of memory,
of waiting, of what is shown, a guard against round-off or a loop without end; it stands beside its
use, under a comment that begins with `limit:`. Constants of nature, numbers that a paper or a
standard printed, units and the layout of arrays are neither.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

Number = TypeVar("Number")


def rule(value: Number, meaning: str, source: str = "chosen; no measurement is kept") -> Number:
    """Return a field of a register: a number, or several that belong together, and what it is.

    `meaning` ends with its unit; `source` is a standard, a paper, a reason, or the benchmark that
    chose it.
    """
    found: Number = field(default=value, metadata={"meaning": meaning, "source": source})
    return found


@dataclass(frozen=True)
class CoreRules:
    """What is read, waited for and told, and what is taken of a metal that is half described."""

    specimens: float = rule(
        0.07, "standard deviation between specimens of one metal, of the stress at 0.2 % [-]",
        "15 and more bars of two steels (the docstring beside it)",
    )  # fmt: skip
    rows_a_decade: int = rule(8, "rows of a flow curve in a decade of strain [-]")
    strain_seen: float = rule(
        1e-4, "plastic strain below which a tension test shows none [-]",
        "a twentieth of the proof strain",
    )  # fmt: skip
    tabor_spread: float = rule(
        0.10, "relative standard deviation of hardness over strength [-]",
        "metals are found between 2.5 and 3.2 (Johnson, Contact Mechanics, 1985, 6.3)",
    )  # fmt: skip
    hardness_spread: float = rule(
        0.11, "relative standard deviation of a hardness stated without one [-]"
    )
    guessed: float = rule(
        0.5, "standard deviation over a value that is stated as a guess [-]",
        "within a factor of 2 nineteen times in twenty, as a strength by the class of metal",
    )  # fmt: skip
    flow_first: float = rule(
        1e-6, "first plastic strain of a written law's table [-]",
        "a hundredth of what a test shows",
    )  # fmt: skip
    flow_rows: int = rule(200, "its rows [-]", "28 a decade")
    deepest: float = rule(0.5, "largest approach that is solved or kept in a table [R]")


RULES = CoreRules()
"""Every tuned number of the stage."""
