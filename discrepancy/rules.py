"""Tuned numbers of the decision: what each means, and which measurement chose it."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class DiagnosisRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    penalty: float = rule(
        1.5, "taken off the ln evidence of every alternative to the baseline [nat]",
        "0 to 3 tried on 55 sets of another make and 18 of the generators of the proof: between 1 "
        "and 2 the probabilities hold and no `adequate` is false (docs/diagnose-method.md)",
    )  # fmt: skip
    misfit: float = rule(
        0.01, "share by chi2, the law's error apart, below which a leader does not fit [-]",
        "the usual level; of the textbook rule that the diagnosis is compared with",
    )  # fmt: skip
    kept: float = rule(
        0.2, "part of its probability that such a leader keeps, the rest goes outside [-]",
        "0.1 to 0.6 tried on the same sets: no name from outside the library up to 0.2",
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
    derived: float = rule(
        0.2, "rms of a column less what others give, in its noise, below which it is derived [-]",
        "two instruments differ by their noise: of four trials one in a thousand agrees so well",
    )  # fmt: skip
    derived_trials: int = rule(
        3, "trials from which a column may be called derived [-]",
        "by chance one in a hundred of three agrees so well",
    )  # fmt: skip
    scaled: float = rule(
        0.3, "standard deviation of a factor on all readings of one observable (logarithm) [-]",
        "a depth from another plane, a diameter at the rim, a charge amplifier's range",
    )  # fmt: skip
    scaled_cells: int = rule(
        3, "numbers of an observable from which it may have a factor of its own [-]",
        "two are a slope",
    )  # fmt: skip


RULES = DiagnosisRules()
