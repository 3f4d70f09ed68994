"""A verdict in words: the finding in one sentence, and what the terminal shows."""

from __future__ import annotations

import math

import numpy as np

from ...core.observables import OBSERVABLES
from ...core.tables import counted
from ..choice.decide import WRONG_INPUT
from ..choice.odds import OUTSIDE
from ..findings import Verdict, WrongInput
from ..rules import RULES
from . import wording
from .next_session import change_lines, next_lines
from .wording import explanation, interval, joined, parameter_name, percent, quantity, title_of

# limit: probability from which one has a line [-]; half a per cent is printed as one
STORY_LEAST = 0.005

# limit: explanations that the finding names where nothing is decided [-]: a line
_NAMED_LEADING = 3

# limit: probability from which the finding says what else may act beside what it names [-]
_BESIDE = 0.1

# limit: probability that a family has beyond a wrong number of it, from which it is told [-]
_APART = 0.05

# limit: places between which four fifths of a prior lie [-]
_MIDDLE = np.array([0.1, 0.9])
_UNTOLD = "not told by these data"


def headline(v: Verdict) -> str:
    """Return the finding in one sentence, with its probability.

    What comes before any physics is said first: numbers of the set that contradict each other, and
    a wrong one.
    """
    checks = [a["check"] for a in v.audit if a["message"].startswith("contradiction")]
    if not checks:
        return _finding(v)
    contradicted = f"The set's numbers contradict each other ({joined(checks)})"
    return f"{contradicted}: settle that first. {_finding(v)}"


def _finding(v: Verdict) -> str:
    part = v.inclusion
    if v.verdict == "adequate":
        p = v.probabilities.get("baseline", math.nan)
        return (
            "Nothing is missing: the simulation as described explains the recordings within their "
            f"noise and the stated uncertainties (probability {percent(p)})."
        )
    if v.verdict == WRONG_INPUT:
        beside = _beside(v) or " These data need nothing else then."
        return f"{' '.join(map(_wrong, v.wrong_inputs))}{beside}{_family(v)}"
    if v.verdict == "missing-physics":
        first = "".join(f"{_wrong(w)} " for w in v.wrong_inputs)
        what = joined([f"{title_of(m, v.titles)} ({m})" for m in v.mechanisms])
        sure = joined([percent(part.get(m, 0.0)) for m in v.mechanisms])
        each = " each" if len(v.mechanisms) > 1 else ""
        likely = "most likely " * (max(v.probabilities.values()) < RULES.cautious)
        return (
            f"{first}The simulation {likely}lacks this: {what}; probability that it takes part"
            f"{each}: {sure}.{_beside(v)}"
        )
    if v.verdict == "indistinguishable":
        shared = [f.name for f in v.choice.members]
        rival = joined(
            [f"{explanation(n, v.titles)} ({percent(v.probabilities[n])})" for n in shared], "or"
        )
        return f"Something is missing, and these share the probability: {rival}.{_family(v)}"
    if v.verdict == OUTSIDE and v.choice.alike:
        return (
            "The simulation as described fails, and no mechanism that dentscope has a name for "
            f"repairs it: it behaves as if {joined(v.choice.alike)}."
        )
    if v.verdict == OUTSIDE:
        return (
            "The simulation as described fails, and nothing that dentscope knows repairs it: the "
            f"cause is something else (probability {percent(v.probabilities[OUTSIDE])})."
        )
    missing = 1.0 - v.probabilities["baseline"]
    sure = f"Something is missing ({percent(missing)}), but " if missing > RULES.sure else ""
    if any(reason.startswith("too few") for reason in v.reasons):
        return f"{sure}too few data to say what." if sure else "Too few data to say."
    leads = list(v.probabilities.items())[:_NAMED_LEADING]
    likely = ", ".join(f"{explanation(name, v.titles)} {percent(p)}" for name, p in leads)
    unclear = "These data do not say whether something is missing, or what."
    if sure:
        unclear = f"{sure}these data do not say what."
    return f"{unclear} What leads, by probability: {likely}.{_family(v)}"


def _wrong(w: WrongInput) -> str:
    """One wrong number: what it would have to be, the usual slip, and what settles it."""
    n = w.number
    found = f"A number of the sheet is wrong: {n.title} (probability {percent(w.probability)})."
    if w.would_be is not None:
        value, low, high = w.would_be
        found += (
            f" {n.key} would have to be {quantity(value, n.unit)} ({interval(low, high, n.unit)}) "
            f"in place of {quantity(w.stated or 0.0, n.unit)}"
        )
    else:
        unit = n.parameters[0].unit
        found += f" {n.told.format(f'{quantity(w.off, unit)} ({interval(w.low, w.high, unit)})')}"
    slip = n.slip(w.low, w.high)
    return f"{found}{f'; usual slip: {slip}' if slip else ''}. It would settle it: {w.settled_by}."


def _beside(v: Verdict) -> str:
    """What may act beside all that is named, with its probability; or ""."""
    named = {*v.mechanisms, *(w.number.name for w in v.wrong_inputs)}
    found: dict[str, float] = {}
    for label, p in v.probabilities.items():
        parts = set(label.split("+"))
        for name in parts - named if named < parts else ():
            found[name] = found.get(name, 0.0) + p
    likely = sorted((n for n, p in found.items() if p >= _BESIDE), key=lambda n: -found[n])
    told = [f"{explanation(n, v.titles)} ({percent(found[n])})" for n in likely[:_NAMED_LEADING]]
    return f" Beside it perhaps: {joined(told, 'or')}." if told else ""


def _family(v: Verdict) -> str:
    """What the members of the leading family agree on, where one that leads says less; or ""."""
    family, named = v.choice.family, max((w.probability for w in v.wrong_inputs), default=0.0)
    open_ones = ("undetermined", "indistinguishable", WRONG_INPUT)
    if not family or v.verdict not in open_ones or family.probability < named + _APART:
        return ""
    members = joined([f"{title_of(m, v.titles)} {percent(p)}" for m, p in family.members.items()])
    return f" What they agree on ({percent(family.probability)}): {family.title}; by {members}."


def why(v: Verdict) -> str:
    """Return why, in three sentences: where it misses, what leads and how clearly, its rivals."""
    where = "No observable by itself is off by more than chance gives."
    if v.located.misses:
        worst = v.located.misses[0]
        label = OBSERVABLES[worst.observable].label
        where = f"The simulation misses most in {label}: {worst.trend}."
    (lead, p), *others = v.probabilities.items()
    best = f"Most probable: {explanation(lead, v.titles)} ({percent(p)})"
    if lead in v.scores and lead != "baseline":
        times = _times(v.scores[lead]["evidence"])
        best += f", with which the readings are {times} as probable as with nothing missing"
        own, nothing = (v.scores[name]["chi2"] for name in (lead, "baseline"))
        best += f" (chi2 {own:.3g} in place of {nothing:.3g}, moved inputs counted)"
    rivals = [f"{explanation(k, v.titles)} ({percent(q)})" for k, q in others if q >= STORY_LEAST]
    beside = "Nothing else has a share."
    if rivals:
        beside = f"Beside it: {joined(rivals[:_NAMED_LEADING])}."
    return f"{where} {best}. {beside}"


def _times(nats: float) -> str:
    """Return a ratio of probabilities in words."""
    if nats > math.log(1e6):
        return "more than a million times"
    return f"{float(f'{math.exp(nats):.2g}'):,.7g} times"


def nowhere(v: Verdict) -> str:
    """Return how places and verdict go together; "" where both say that something is missing."""
    nothing = v.probabilities.get("baseline", 0.0)
    told = percent(nothing)
    if v.located.beyond_chance:
        if nothing < 0.5:
            return ""
        return (
            f"All numbers together still leave a probability of {told} that nothing is missing: "
            "one set of twenty in which nothing is missing shows such a place somewhere."
        )
    if nothing >= 0.5:
        return "Nowhere beyond what chance gives over all observables and conditions."
    if v.misfit["as_stated"] > v.misfit["numbers"] and v.misfit["rest"] < 0.5:
        cause = "as stated the numbers do not fit, but moved they do"
    else:
        cause = "each place by itself misses too little"
    none = "No single observable or condition is off by more than chance gives"
    if nothing >= max(v.probabilities.values()):
        return f"{none}; that nothing is missing leads with a probability of {told} only."
    return (
        f"{none}, and yet nothing is missing with a probability of {told} only: {cause}, and the "
        "explanation that leads fits all numbers together better than they can."
    )


def lines(v: Verdict) -> list[str]:
    """Return the finding as lines for a terminal."""
    part = [(x, f"{k}: {title_of(k, v.titles)}") for k, x in v.inclusion.items() if x >= 0.01][:5]
    unknown = v.probabilities.get(OUTSIDE, 0.0)
    part += [(unknown, "something that dentscope has no name for")] * (unknown >= 0.01)
    part += [(v.probabilities.get("baseline", 0.0), "nothing is missing")]
    changes = []
    for c in v.corrections:
        k = max(range(len(c.factor)), key=lambda i: abs(math.log(c.factor[i])))
        changes.append(
            f"{c.phase}: times {c.factor[k]:.2f} ({c.low[k]:.2f} to {c.high[k]:.2f}) at a "
            f"depth of {c.depth_over_R[k]:.2g} R"
        )
    explained = [
        f"{name}{':' if value == _UNTOLD else ' ='} {value} (90 %: {between})"
        for name, value, between in (own_parameters(v) if v.best.mechanisms else ())
    ]
    seen = limit_rows(v) if v.limits and v.verdict == "adequate" else ()
    sections = {
        "Inputs": [a["message"] for a in v.audit],
        "Where the simulation misses": [*wording.miss_sentences(v.located, most=4), nowhere(v)],
        "What explains it": [*explained, predicted(v)] if v.best.mechanisms else [],
        "Probability that it takes part": [f"{percent(x):>14}  {what}" for x, what in part],
        "Where the force law would have to change": changes,
        "Next experiment": [*change_lines(v), *next_lines(v)],
        "What would have been seen": [f"{what}: {x} from {size} on" for what, x, size in seen],
        "How it was decided": v.reasons,
        "Notes": v.notes,
    }
    out = [f"{v.name}: {held(v)}", "", headline(v)]
    for title, told in sections.items():
        if rows := [f"  {row}" for row in told if row]:
            out += ["", title, *rows]
    return out


def held(v: Verdict) -> str:
    """Return what was compared."""
    p = v.problem
    trials = sum(len(c.trials) for c in p.conditions)
    seen = ", ".join(OBSERVABLES[o].label for o in dict.fromkeys(p.cells.observable))
    return (
        f"{counted(trials, 'trial')}, {counted(len(p.conditions), 'condition')}, "
        f"{counted(len(p.cells), 'number')} ({seen})"
    )


def predicted(v: Verdict) -> str:
    """Return how the trials left out of the fit are predicted by what is named."""
    i = v.improvement
    if math.isnan(i["held_out_extended"]):
        return "no condition could be left out of the fit to try the prediction on"
    return (
        f"on conditions left out of the fit the miss goes from {i['held_out_baseline']:.1f} to "
        f"{i['held_out_extended']:.1f} standard errors, where noise alone leaves 1: "
        f"{wording.compared(i)}"
    )


def limit_rows(v: Verdict) -> tuple[tuple[str, str, str], ...]:
    """Return what would have been seen, by which number, and from which value of it on."""
    of = {s.mechanism.name: s.mechanism.parameters[0] for s in v.ranking.screened}
    return tuple(
        (title_of(k, v.titles), parameter_name(of[k].name, of[k].unit), quantity(x, of[k].unit))
        for k, x in v.limits.items() if k in of
    )  # fmt: skip


def own_parameters(v: Verdict) -> list[tuple[str, str, str]]:
    """Return name, value and 90 % interval of the parameters of the best explanation only.

    Of one whose interval is wider than four fifths of what was thought before, no value.
    """
    found = []
    for name, axis in zip(v.best.grid.labels, v.best.grid.axes, strict=True):
        q, (least, most) = v.parameters[name], axis.parameter.value(_MIDDLE)
        value = quantity(q["value"], q["unit"])
        if q["low"] <= least and q["high"] >= most:
            value = _UNTOLD
        told = parameter_name(name, q["unit"])
        found.append((told, value, interval(q["low"], q["high"], q["unit"])))
    return found
