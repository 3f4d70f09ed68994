"""What a report says, as plain values: the page, its tables and its files are made from it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...dynamics.files.second import second_of
from ..estimates import PULLED
from ..findings import Verdict
from ..inference.fit import Fit
from . import sentences as say
from .next_session import change_lines, next_lines
from .series import STATED, WITH, WITHOUT, Against, SeriesPoint, againsts, points_of, series_of
from .wording import explanation, interval, miss_sentences, number_name, percent, quantity, title_of

# limit: explanations of a picture [-]: a screen
_STORY_ROWS = 8

FORM = "the textbook form of the mechanism"  # its own error

# limit: numbers that moved, of a legend [-]: a line
_STORY_MOVED = 3


class Bar(NamedTuple):
    """A part of a whole, with its name in words."""

    name: str
    share: float

    @property
    def told(self) -> str:
        """The share in words."""
        return percent(self.share)


class ToldCells(NamedTuple):
    """A table: names of the columns, and rows of texts."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Story:
    """Everything that a report says, in sentences, bars and tables."""

    name: str  # of the set
    finding: str  # in one sentence
    why: str  # in three
    summary: str  # what was compared
    points: tuple[SeriesPoint, ...]  # what is drawn
    against: tuple[Against, ...]
    strikers: tuple[str, ...]
    series: tuple[str, str, str]  # the simulations that are drawn, each with what its fit took
    misses: tuple[str, ...]  # where the simulation misses
    nowhere: str  # what to think of it where places and verdict seem to contradict each other
    audit: tuple[str, ...]  # contradictions of the inputs
    reasons: tuple[str, ...]  # how the verdict came about
    notes: tuple[str, ...]  # what was assumed
    parts: tuple[Bar, ...]  # probability of each mechanism to take part
    explanations: tuple[Bar, ...]
    found: ToldCells  # numbers of the mechanisms that are named, with intervals
    prediction: str  # how the trials left out of the fit are predicted
    doubt: tuple[Bar, ...]  # what the uncertainty of the comparison is made of
    numbers: ToldCells
    scores: ToldCells
    excluded: ToldCells
    limits: ToldCells
    next_step: str  # whether to go on
    further: tuple[str, ...]  # steps of the next session, and what its outcome would mean
    changed: tuple[str, ...]  # by the last session

    def to_dict(self) -> dict[str, Any]:
        """Return what the figures show, for programs."""
        return {
            "format": "report/1", "set": self.name, "finding": self.finding,
            "axes": {a.key: a.label for a in self.against},
            "points": [p.row() for p in self.points],
        }  # fmt: skip


def story_of(v: Verdict) -> Story:
    """Return what there is to say of a verdict."""
    step, *further = [*next_lines(v), ""]
    return Story(
        name=v.name, finding=say.headline(v), why=say.why(v), summary=_summary(v),
        points=points_of(v), against=againsts(v),
        strikers=tuple(dict.fromkeys(series_of(c) for c in v.problem.conditions)),
        series=(STATED, f"{WITHOUT}: {_took(v, v.ranking.base)}", f"{WITH}: {_took(v, v.best)}"),
        misses=miss_sentences(v.located, most=_STORY_ROWS),
        nowhere=say.nowhere(v), reasons=v.reasons, notes=tuple(filter(None, v.notes)),
        audit=tuple(str(a["message"]) for a in v.audit),
        parts=tuple(
            Bar(f"{title_of(k, v.titles)} ({k})", p)
            for k, p in v.inclusion.items() if p >= say.STORY_LEAST
        ),
        explanations=tuple(
            Bar(explanation(k, v.titles), p)
            for k, p in v.probabilities.items() if p >= say.STORY_LEAST
        ),
        prediction=f"{say.predicted(v).capitalize()}." if v.best.mechanisms else "",
        found=_found(v), doubt=_doubt(v), numbers=_numbers(v), scores=_scores(v),
        excluded=ToldCells(
            ("what", "why not"), tuple((title_of(k, v.titles), x) for k, x in v.excluded.items())
        ),
        limits=ToldCells(("what", "number", "would have been seen from"), say.limit_rows(v)),
        next_step=step, further=tuple(filter(None, further)), changed=tuple(change_lines(v)),
    )  # fmt: skip


def _summary(v: Verdict) -> str:
    p = v.problem
    rate = "" if p.law_name == "hertz" else ", or rate of the metal"
    return (
        f"{say.held(v)}, compared with a simulation without vibration{rate} "
        f"(contact law: {p.law_name})."
    )


def _took(v: Verdict, fitted: Fit) -> str:
    """How well a simulation fits, and which numbers it moved further than chance would."""
    p, struck = v.problem, _struck(v)
    names = [number_name(n.name, struck=struck) for n in p.nuisances]
    names += ["the contact law"] * (len(fitted.z) - len(names)) + [FORM] * len(fitted.form)
    far: dict[str, float] = {}
    moved = zip(names, [*fitted.z, *fitted.form], strict=True)
    for name, z in sorted(moved, key=lambda item: -abs(item[1])):
        if abs(z) > PULLED:
            far.setdefault(name, float(z))
    told = ", ".join(f"{name} {z:+.1f}" for name, z in list(far.items())[:_STORY_MOVED])
    told = f"off by so many times their uncertainty: {told}" if told else (
        f"no input off by more than {PULLED:g} times its uncertainty"
    )  # fmt: skip
    return f"chi2 {fitted.chi2:.3g}, {told}"


def _found(v: Verdict) -> ToldCells:
    parameters = zip(say.own_parameters(v), v.best.grid.axes, strict=True)
    rows = tuple((*told, axis.parameter.source) for told, axis in parameters)
    return ToldCells(("number", "value", "90 % interval", "where its range comes from"), rows)


def _doubt(v: Verdict) -> tuple[Bar, ...]:
    """Mean share of each source in the variance between recording and simulation."""
    p, linear = v.problem, v.best.linear
    counts = [i for i in range(len(p.cells)) if i not in p.weightless]
    total = np.diag(linear.total)
    sources = {"scatter and noise of the readings": np.diag(linear.noise)}
    struck = _struck(v)
    for k, n in enumerate(p.nuisances):
        name = number_name(n.name, struck=struck)
        sources[name] = sources.get(name, 0.0) + linear.scaled[:, k] ** 2
    sources["the contact law's own error"] = np.sum(linear.scaled[:, p.n_nuisances :] ** 2, axis=1)
    sources[FORM] = np.sum(linear.form**2, axis=1)
    bars = [Bar(k, float(np.mean((x / total)[counts]))) for k, x in sources.items()]
    bars = sorted((b for b in bars if b.share >= 0.01), key=lambda b: -b.share)
    rest = 1.0 - sum(b.share for b in bars)
    return (*bars, *[Bar("all else", rest)] * (rest >= 0.005))


def _numbers(v: Verdict) -> ToldCells:
    struck = _struck(v)
    rows = tuple(
        (
            number_name(n.name, struck=struck) + ("" if n.stated else " (not stated)"),
            quantity(n.value, n.unit), quantity(q["value"], q["unit"]),
            interval(q["low"], q["high"], q["unit"]),
            f"{v.nuisance_pulls[n.name]:+.1f}", f"{v.surprise[n.name]:+.1f}",
        )
        for n in v.problem.nuisances for q in [v.parameters[n.name]]
    )  # fmt: skip
    head = ("number of set.toml", "stated", "found", "90 % interval", "shift", "surprise")
    return ToldCells(head, rows)


def _struck(v: Verdict) -> str:
    return "the flat" if second_of(v.problem.rig) is None else "the second sphere"


def _scores(v: Verdict) -> ToldCells:
    rows = tuple(
        (
            explanation(name, v.titles), f"{s['evidence']:+.1f}", f"{s['p_value']:.3f}",
            f"{s['chi2']:.3g}", "-" if math.isnan(s["held_out"]) else f"{s['held_out']:.2f}",
            percent(v.probabilities.get(name, 0.0)),
        )
        for name, s in sorted(v.scores.items(), key=lambda item: -item[1]["evidence"])
    )  # fmt: skip
    head = (
        "explanation", "weight of evidence over 'nothing missing' [nat]",
        "probability of a fit no better, were it the truth", "chi2, moved inputs counted",
        "miss on trials kept out [standard errors]",
        "probability",
    )  # fmt: skip
    return ToldCells(head, rows)
