"""Tuned numbers of a first look: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class StartRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    kept_out: float = rule(
        0.9, "part of the largest speed from which conditions are kept out [-]",
        "chosen: they judge what the rest inferred",
    )  # fmt: skip
    least_dent: float = rule(
        0.1, "part of the depth below which a dent says nothing about a law [-]"
    )
    press_deeper: float = rule(
        1.25, "depth of the solve over the deepest press [-]",
        "room for a stated number that is off",
    )  # fmt: skip
    clock_end: float = rule(
        0.1, "part of the approach speed at which the clock of a press ends [-]",
        "a half-sine's slow end",
    )  # fmt: skip
    ball_keeps: float = rule(
        0.05, "part of the permanent approach that the ball may keep [-]",
        "beyond it the dent is not that of a ball",
    )  # fmt: skip


RULES = StartRules()
"""Every tuned number of the stage."""
