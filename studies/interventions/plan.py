"""The pairs: what is concealed in which recordings, and which verdicts are fair."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from ...core.inputs.toml_input import InputTable, Listed, read_model

ROOT = Path(__file__).resolve().parents[2]
PLAN = ROOT / "data" / "interventions" / "plan.toml"
"""Written before the diagnosis was asked."""

Said = Literal["adequate", "outside-library", "undetermined"]


class Side(InputTable):
    """One set of a pair: a base, and what is done to it."""

    base: str = Field(min_length=1)
    """A shipped set, or a name of `bases.MADE`."""
    given: dict[str, float] = Field(default_factory=dict)
    """Options of a base that is made."""
    rows: tuple[str, ...] = Field((), strict=False)
    """Patterns of the names of trials that are kept; all without it."""
    stated: dict[str, Any] = Field(default_factory=dict)
    """Keys of set.toml, joined by dots, and what they say here."""
    left_out: tuple[str, ...] = Field((), strict=False)
    """Keys of set.toml that are taken away."""
    columns_left_out: tuple[str, ...] = Field((), strict=False)
    """Columns of trials.csv that are taken away."""
    scaled: dict[str, float] = Field(default_factory=dict)
    """Columns, and the factor on all their readings."""
    turned_deg: float = 0.0
    """Added to every stated angle, the total speed kept."""


class Pair(InputTable):
    """A known effect, with it and without it, and the verdicts that would be fair with it."""

    name: str = Field(min_length=1)
    recordings: str
    concealed: str
    fair: str
    named: tuple[str, ...] = Field(strict=False)
    """Mechanisms and wrong numbers of which one must lead, or be an answer, where any is named."""
    verdicts: tuple[Said, ...] = Field(strict=False)
    """Verdicts without a name that are fair."""
    audit: str = ""
    """Check that must contradict."""
    known: Literal["", "with", "both"] = ""
    """Whose verdict was published before the plan."""
    concealing: Side = Field(alias="with")
    plain: Side = Field(alias="without")

    @property
    def sides(self) -> dict[str, Side]:
        """Both sets by the words of the plan."""
        return {"with": self.concealing, "without": self.plain}


class Plan(InputTable):
    """The whole plan."""

    pair: tuple[Pair, ...] = Listed


def read_plan(path: Path = PLAN) -> tuple[Pair, ...]:
    """Read the pairs.

    Raises `InputErrors`: one line for each mistake.
    """
    return read_model(path, Plan).pair
