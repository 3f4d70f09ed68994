"""What a diagnosis says: the content of verdict.json, and what the report draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .. import __version__
from ..core.arrays import Array
from ..core.errors import InputError
from ..core.rig import TABOR
from ..core.tables import text_table
from .choice.decide import Choice
from .comparison.problem import Problem
from .correction import Correction
from .estimates import finite
from .experiments.session import Proposal, Session
from .inference.fit import Fit
from .locate import Located
from .rank import Ranking
from .samples import Samples, drawn
from .unknowns.wrong_number import WrongNumber, is_wrong

# limit: explanations that are shown [-]: a screen
_SHOWN = 12


class After(NamedTuple):
    """What was known after a session: its number, trials so far, explanation to probability."""

    batch: float
    trials: int
    probabilities: dict[str, float]


class WrongInput(NamedTuple):
    """A number of the sheet that is wrong.

    - `probability`: that it takes part.
    - `stated`: as it stands [`number.unit`]; none where it is not one number.
    - `off`, `low`, `high`: factor on it, or what is added to all heights [m], with the 90 %
      interval.
    - `hardness`: of a strength, the hardness that stands beside it [Pa].
    """

    number: WrongNumber
    probability: float
    stated: float | None
    off: float
    low: float
    high: float
    hardness: float | None = None

    @property
    def settled_by(self) -> str:
        """What would settle it: the hardness, where it was tested."""
        if self.hardness is None:
            return self.number.settled_by
        strength = self.hardness / TABOR / 1e6
        return (
            f"the stated hardness, if it is right: over {TABOR:g}, as of most metals, it is a "
            f"strength of {strength:.3g} MPa"
        )

    @property
    def would_be(self) -> tuple[float, float, float] | None:
        """What it would have to be, with the 90 % interval; none where it is not one number."""
        if self.stated is None:
            return None
        return self.stated * self.off, self.stated * self.low, self.stated * self.high

    @property
    def told(self) -> dict[str, Any]:
        """As in verdict.json; without a value the interval is that of factor or offset."""
        value, low, high = self.would_be or (None, self.low, self.high)
        n = self.number
        return {
            "key": n.key, "probability": self.probability, "stated": self.stated,
            "value": value, "low": low, "high": high, "level": 0.9, "unit": n.unit,
            n.measure: self.off, "settled_by": self.settled_by,
        }  # fmt: skip


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a diagnosis says; the fields are those of verdict.json, and what the report draws.

    - `choice`: the verdict, the explanations that it holds, and why.
    - `audit`: contradictions and cautions of the inputs.
    - `probabilities`, `scores`: by explanation.
    - `inclusion`: mechanism to the probability that it takes part, alone or with others.
    - `parameters`, `nuisance_pulls`, `surprise`: by the number's name, of the best explanation.
    - `excluded`, `limits`: by mechanism: why it was not fitted; the smallest value that would have
      been seen.
    - `misfit`: how much of the baseline's misfit the data sheet, the law and the metal took.
    - `stated`: (m,) predictions of the cells with every input as stated.
    - `proposals`, `session`: what could be done next, one by one, and in one session together.
    - `history`: probabilities after each session, where the set has had several.
    - `ranking`: all fits, and the problem that they were fitted to.
    - `best`: fit of the best explanation; the baseline's when none is named.
    - `impacts`: impacts that were simulated.
    - `titles`: what each mechanism that was tried means, as a clause; one's own too.
    """

    name: str
    seed: int
    choice: Choice
    audit: tuple[dict[str, Any], ...]
    probabilities: dict[str, float]
    inclusion: dict[str, float]
    scores: dict[str, dict[str, float]]
    located: Located
    parameters: dict[str, dict[str, Any]]
    nuisance_pulls: dict[str, float]
    surprise: dict[str, float]
    excluded: dict[str, str]
    limits: dict[str, float]
    improvement: dict[str, float]
    misfit: dict[str, float]
    stated: Array
    corrections: tuple[Correction, ...]
    proposals: tuple[Proposal, ...]
    session: Session
    history: tuple[After, ...]
    notes: tuple[str, ...]
    ranking: Ranking
    best: Fit
    impacts: int
    titles: Mapping[str, str]

    def __repr__(self) -> str:
        rows = [(f"{self.name}: {self.verdict}", "probability")]
        rows += [(name, f"{p:.2g}") for name, p in list(self.probabilities.items())[:_SHOWN]]
        return text_table(rows, numbers=True)

    @property
    def verdict(self) -> str:
        """The answer.

        `adequate`, `wrong-input`, `missing-physics`, `indistinguishable`, `outside-library` or
        `undetermined`.
        """
        return self.choice.verdict

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names of the best explanation's mechanisms."""
        return tuple(m.name for m in self.best.mechanisms if not is_wrong(m))

    @property
    def wrong_inputs(self) -> tuple[WrongInput, ...]:
        """Numbers of the sheet that are wrong by the best explanation."""
        return tuple(self._wrong(m) for m in self.best.mechanisms if is_wrong(m))

    def _wrong(self, m: WrongNumber) -> WrongInput:
        found = self.parameters[m.parameters[0].name]
        off, low, high = (float(found[k]) for k in ("value", "low", "high"))
        of, name = self.problem.rig.of, m.key.replace(".Sy_Pa", ".hardness_Pa")
        tested = of.get(name) if m.kind == "strength" else None
        part = self.inclusion.get(m.name, 0.0)
        return WrongInput(m, part, of.get(m.key), off, low, high, tested)

    @property
    def alternatives(self) -> tuple[tuple[str, ...], ...]:
        """Other explanations that the data cannot tell from the best."""
        return tuple(f.names for f in self.choice.members[1:])

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why, in sentences."""
        return self.choice.reasons

    @property
    def problem(self) -> Problem:
        """What was compared."""
        return self.ranking.problem

    def samples(self, draws: int = 1000, *, explanation: str = "") -> Samples:
        """Return equally probable draws: parameters, stated numbers and what is read again.

        `explanation`: a key of `scores`, as "baseline"; left out: the best explanation.

        Raises `InputError`: an explanation that was not fitted; no draw.
        """
        if not (isinstance(draws, int) and draws > 0):
            raise InputError(repr(draws), key="draws", allowed="a whole number above 0")
        fits = {f.name: f for f in self.ranking.fits}
        name = explanation or self.best.name
        if name not in fits:
            raise InputError(repr(name), key="explanation", allowed=", ".join(fits))
        return drawn(self.problem, fits[name], draws, np.random.default_rng(self.seed))

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
            "wrong_inputs": [one.told for one in self.wrong_inputs],
            "family": self.choice.family._asdict() if self.choice.family else None,
            "alternatives": [list(names) for names in self.alternatives],
            "inclusion": self.inclusion,
            "probabilities": self.probabilities,
            "scores": {name: _stated(found) for name, found in self.scores.items()},
            "located": [
                {
                    "observable": m.observable, "phase": m.phase, "covariate": m.covariate,
                    "trend": m.trend, "z": round(m.z, 3),
                }
                for m in self.located.misses
            ],
            "parameters": self.parameters,
            "nuisance_pulls": self.nuisance_pulls,
            "surprise": self.surprise,
            "excluded": [{"mechanism": k, "reason": v} for k, v in self.excluded.items()],
            "limits": self.limits,
            "improvement": _stated(self.improvement),
            "misfit": self.misfit,
            "correction": [
                {
                    "phase": c.phase, "indentation_over_R": c.depth_over_R.tolist(),
                    "factor": c.factor.tolist(), "low": c.low.tolist(), "high": c.high.tolist(),
                }
                for c in self.corrections
            ],
            "next_experiment": self._next(),
            "history": [one._asdict() for one in self.history],
            "notes": [*self.reasons, *self.notes],
        }  # fmt: skip

    def _next(self) -> dict[str, Any]:
        """The best proposal, and the others beside it."""
        if not self.proposals:
            return {"change": "", "expected_discrimination": 0.0, "others": []}
        first, *others = (_proposed(p) for p in self.proposals)
        s = self.session
        session = {
            "go_on": s.goes_on, "information_nats": s.information, "entropy_nats": s.entropy,
            "minutes": s.minutes, "steps": [_proposed(p) for p in s.steps],
            "outcomes": [one._asdict() for one in s.outcomes],
            "elsewhere": [_proposed(p) for p in s.elsewhere],
        }  # fmt: skip
        return {**first, "others": others, "session": session}


def _proposed(p: Proposal) -> dict[str, Any]:
    return {
        "change": p.change, "expected_discrimination": p.expected_discrimination,
        "information_nats": p.information, "kind": p.kind, "interval": finite(p.interval),
        "trial": dict(p.trial), "minutes": finite(p.minutes),
    }  # fmt: skip


def _stated(found: dict[str, float]) -> dict[str, float | None]:
    """Numbers as JSON holds them: null where no condition could be left out."""
    return {name: finite(value) for name, value in found.items()}
