"""Tuned numbers of the decision: what each means, and which measurement chose it."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class DiagnosisRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    penalty: float = rule(
        3.0, "taken off the ln evidence of every alternative to the baseline [nat]",
        "Bayes factors up to 20 are what nulls may show; 0 to 4 tried on sets of another make "
        "(docs/diagnose-method.md, what each stage wins)",
    )  # fmt: skip
    refuted: float = rule(
        0.05, "share of a single's own sets that fit no better, below which pairs are tried [-]",
        "a second mechanism where the first does not fit; 0.02 to 0.5 tried on the same sets",
    )  # fmt: skip
    supported: float = rule(
        0.002, "probability below which, or nearer to 1 than which, none is printed [-]",
        "one of the 500 sets with nothing missing that are drawn",
    )  # fmt: skip
    adequate: float = rule(
        0.7, "probability of the baseline from which `adequate` is said [-]",
        "readers take the word for an all-clear",
    )  # fmt: skip


RULES = DiagnosisRules()
