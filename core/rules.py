"""Registers of tuned numbers: one a stage, in its `rules.py`, made of `rule`.

A tuned number is one that somebody chose and that a result hangs on: a threshold, a tolerance, the
size of a grid, a weight. Constants of nature, coefficients that a paper printed, units and the
layout of arrays are none.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

Number = TypeVar("Number")


def rule(value: Number, meaning: str, source: str) -> Number:
    """Return a field of a register: a number with what is said of it.

    Parameters
    ----------
    value
        The number, or several that belong together.
    meaning
        What it is, its unit at the end.
    source
        Where it is from: a standard, a paper, a reason, or the benchmark that chose it.
    """
    found: Number = field(default=value, metadata={"meaning": meaning, "source": source})
    return found


@dataclass(frozen=True)
class CoreRules:
    """Limits of what is read and waited for; no number of a result hangs on one of them."""

    cache_names: int = rule(
        20, "names that are tried for a folder of one's own [-]",
        "more are an attack",
    )  # fmt: skip
    table_bytes: int = rule(
        100_000_000, "largest table that is read [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    table_columns: int = rule(
        2000, "most columns of a table [-]",
        "a logger has hundreds",
    )  # fmt: skip
    problems_kept: int = rule(
        1000, "mistakes of a table that are kept one by one [-]",
        "nobody reads more",
    )  # fmt: skip
    specimens: float = rule(
        0.07, "standard deviation between specimens of one metal, of the stress at 0.2 % [-]",
        "15 and more bars of two steels (the docstring beside it)",
    )  # fmt: skip
    rows_a_decade: int = rule(
        8, "rows of a flow curve in a decade of strain [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    strain_seen: float = rule(
        1e-4, "plastic strain below which a tension test shows none [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    name_bytes: int = rule(
        200, "longest name that becomes a file's [bytes]",
        "file systems take 255; what is written beside a trial gets up to 55 more",
    )  # fmt: skip
    toml_bytes: int = rule(
        4_000_000, "largest TOML file that is read [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    value_shown: int = rule(
        80, "characters of a value in an error [-]",
        "a line of a terminal",
    )  # fmt: skip
    toml_depth: int = rule(
        20, "tables and lists within each other [-]",
        "files of this package have four",
    )  # fmt: skip
    folder_wait_s: float = rule(
        300.0, "wait for another process that changes the same folder [s]",
        "a large set is written in less",
    )  # fmt: skip
    pending_bytes: int = rule(
        500_000_000, "largest unfinished file that is read again [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    output_name_bytes: int = rule(
        200, "longest name of a file that is written [bytes]",
        "file systems take 255",
    )  # fmt: skip
    parent_look_s: float = rule(
        0.5, "between two looks whether the parent is still there [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    child_bytes: int = rule(
        1_000_000_000, "memory of a confined child [bytes]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    child_s: float = rule(
        60.0, "processor time of a confined child [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    stop_again_s: float = rule(
        0.5, "after how long an interruption that nobody has heard comes again [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    render_s: float = rule(
        120.0, "time of a trial picture off screen [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    tabor_spread: float = rule(
        0.10, "relative standard deviation of hardness over strength [-]",
        "metals are found between 2.5 and 3.2 (Johnson, Contact Mechanics, 1985, 6.3)",
    )  # fmt: skip
    hardness_spread: float = rule(
        0.11, "relative standard deviation of a hardness stated without one [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip


RULES = CoreRules()
"""Every tuned number of the stage."""
