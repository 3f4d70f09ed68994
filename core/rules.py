"""Registers of tuned numbers: one a stage, in its `rules.py`, made of `rule`.

A tuned number is one that somebody chose and that a result hangs on: a threshold, a tolerance, the
size of a grid, a weight. A limit is one that somebody chose and that no result hangs on: of memory,
of waiting, of what is shown, a guard against round-off or a loop without end; it stands in the same
registers, made of `limit`. Constants of nature, coefficients that a paper printed, units and the
layout of arrays are neither.
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


def limit(value: Number, meaning: str, source: str) -> Number:
    """Return a field of a register that no result hangs on; parameters as of `rule`."""
    told = {"meaning": meaning, "source": source, "limit": True}
    found: Number = field(default=value, metadata=told)
    return found


@dataclass(frozen=True)
class CoreRules:
    """What is read, waited for and told, and what is taken of a metal that is half described."""

    cache_names: int = limit(
        20, "names that are tried for a folder of one's own [-]",
        "more are an attack",
    )  # fmt: skip
    table_bytes: int = limit(
        100_000_000, "largest table that is read [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    table_columns: int = limit(
        2000, "most columns of a table [-]",
        "a logger has hundreds",
    )  # fmt: skip
    problems_kept: int = limit(
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
        "a twentieth of the proof strain",
    )  # fmt: skip
    name_bytes: int = limit(
        200, "longest name that becomes a file's [bytes]",
        "file systems take 255; what is written beside a trial gets up to 55 more",
    )  # fmt: skip
    toml_bytes: int = limit(
        4_000_000, "largest TOML file that is read [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    value_shown: int = limit(
        80, "characters of a value in an error [-]",
        "a line of a terminal",
    )  # fmt: skip
    toml_depth: int = limit(
        20, "tables and lists within each other [-]",
        "files of this package have four",
    )  # fmt: skip
    folder_wait_s: float = limit(
        300.0, "wait for another process that changes the same folder [s]",
        "a large set is written in less",
    )  # fmt: skip
    pending_bytes: int = limit(
        500_000_000, "largest unfinished file that is read again [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    parent_look_s: float = limit(
        0.5, "between two looks whether the parent is still there [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    child_bytes: int = limit(
        1_000_000_000, "memory of a confined child [bytes]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    child_s: float = limit(
        60.0, "processor time of a confined child [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    stop_again_s: float = limit(
        0.5, "after how long an interruption that nobody has heard comes again [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    render_s: float = limit(
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
    least_known: float = rule(
        100.0, "largest standard deviation over a value that is stated [-]",
        "what is known within e^100 either way is not known: leave it out",
    )  # fmt: skip
    mistakes_told: int = limit(
        20, "mistakes that are told one by one [-]",
        "a screen",
    )  # fmt: skip
    speeds_exported: int = limit(
        7, "speeds of a range that is exported [-]",
        "chosen: both ends, the middle and between",
    )  # fmt: skip
    narrowest: int = limit(
        40, "columns that a table takes to be there [-]",
        "half a terminal",
    )  # fmt: skip
    flow_first: float = rule(
        1e-6, "first plastic strain of a written law's table [-]",
        "a hundredth of what a test shows",
    )  # fmt: skip
    flow_last: float = rule(
        10.0, "its last plastic strain [-]",
        "beyond every strain in a contact",
    )  # fmt: skip
    flow_rows: int = rule(
        200, "its rows [-]",
        "28 a decade",
    )  # fmt: skip


RULES = CoreRules()
"""Every tuned number of the stage."""
