"""What a diagnosis says: the content of verdict.json, and what the report draws."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .. import __version__
from .correction import Correction
from .inference.fit import Fit
from .locate import Located
from .next_experiment import Proposal
from .problem import Problem
from .rank import Ranking


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a diagnosis says; the fields are those of verdict.json, and what the report draws.

    Parameters
    ----------
    verdict
        `adequate`, `missing-physics`, `indistinguishable`, `outside-library`, `undetermined`.
    mechanisms
        Names of the best explanation's mechanisms.
    alternatives
        Other explanations that the data cannot tell from the best.
    best
        Its fit; the baseline's when none is named.
    """

    name: str
    seed: int
    verdict: str
    mechanisms: tuple[str, ...]
    alternatives: tuple[tuple[str, ...], ...]
    audit: tuple[dict[str, Any], ...]
    probabilities: dict[str, float]
    scores: dict[str, dict[str, float]]
    located: Located
    parameters: dict[str, dict[str, Any]]
    nuisance_pulls: dict[str, float]
    excluded: dict[str, str]
    limits: dict[str, float]
    improvement: dict[str, float]
    corrections: tuple[Correction, ...]
    proposals: tuple[Proposal, ...]
    notes: tuple[str, ...]
    reasons: tuple[str, ...]
    ranking: Ranking
    best: Fit
    impacts: int

    @property
    def problem(self) -> Problem:
        """What was compared."""
        return self.ranking.problem

    def to_dict(self) -> dict[str, Any]:
        """Return the content of verdict.json."""
        return {
            "format": "verdict/1",
            "set": self.name,
            "seed": self.seed,
            "version": __version__,
            "audit": list(self.audit),
            "verdict": self.verdict,
            "mechanisms": list(self.mechanisms),
            "alternatives": [list(names) for names in self.alternatives],
            "probabilities": self.probabilities,
            "scores": self.scores,
            "located": [
                {
                    "observable": m.observable, "phase": m.phase, "covariate": m.covariate,
                    "trend": m.trend, "z": round(m.z, 3),
                }
                for m in self.located.misses
            ],
            "parameters": self.parameters,
            "nuisance_pulls": self.nuisance_pulls,
            "excluded": [{"mechanism": k, "reason": v} for k, v in self.excluded.items()],
            "limits": self.limits,
            "improvement": self.improvement,
            "correction": [
                {
                    "phase": c.phase, "indentation_over_R": c.depth_over_R.tolist(),
                    "factor": c.factor.tolist(), "low": c.low.tolist(), "high": c.high.tolist(),
                }
                for c in self.corrections
            ],
            "next_experiment": {
                "change": self.proposals[0].change if self.proposals else "",
                "expected_discrimination": (
                    self.proposals[0].expected_discrimination if self.proposals else 0.0
                ),
            },
            "notes": [*self.reasons, *self.notes],
        }  # fmt: skip
