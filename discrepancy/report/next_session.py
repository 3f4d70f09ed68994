"""What to do next, and what the last session changed, in the words of an instruction."""

from __future__ import annotations

import math

from ...core.observables import OBSERVABLES
from ...core.tables import counted
from ..choice.odds import OUTSIDE
from ..experiments.session import Proposal, Session, Telling
from ..findings import Verdict
from ..rules import RULES
from .wording import explanation, joined, number_name, percent, quantity

# limit: deviation of a logarithm beyond which both ends are told [-]: ± would reach below zero
_WIDE = 0.3

# limit: the same beyond which nothing is foreseen [-]: a factor of 150 either way
_ENDLESS = 5.0

# limit: explanations whose change is told [-]: a line
_CHANGED = 3


def next_lines(v: Verdict) -> list[str]:
    """Return whether to go on and with what, a line a step, then what the outcome would mean."""
    s = v.session
    if not s.steps and not v.proposals:
        return []
    told = f"remove {_of_doubt(s.information, s)}"
    steps = [f"{k}. {_step(step)}" for k, step in enumerate(s.steps, start=1)]
    meaning = [_meaning(v, one) for one in s.outcomes]
    if s.goes_on:
        head = f"In one session ({_time(s.minutes)} of {_time(s.length)}), which is expected to "
        return [f"{head}{told}:", *steps, *meaning]
    leads = max(v.probabilities, key=lambda name: v.probabilities[name])
    head = "Stop: this rig offers no trial."
    if s.steps:
        head = (
            f"Stop: a session of {_time(s.length)} would {told}, which is but {s.entropy:.2g} nat."
        )
    if s.entropy < RULES.worth:
        head = f"Stop: nothing is left to tell apart ({s.entropy:.2g} nat)."
    if leads == OUTSIDE:
        head += " What leads has no name, and a trial tells named explanations apart."
    others = [p for p in v.proposals if p.kind in ("noise", "none")][:1] if not s.elsewhere else []
    others += s.elsewhere
    found = [head, *(f"What would help: {p.change} ({_worth(p, s)})." for p in others)]
    if steps:
        found += ["To test what leads all the same:", *steps, *meaning]
    return found


def _time(minutes: float) -> str:
    return f"{minutes:.0f} min" if minutes < 90.0 else f"{minutes / 60.0:.2g} h"


def _step(p: Proposal) -> str:
    often = int(p.trial.get("repeats", 1))
    times = f"{often} times: " if often > 1 else ""
    text = f"strike {times}{p.change}" if p.kind == "trial" else p.change
    return f"{text[0].upper()}{text[1:]} ({_time(p.minutes)})."


def _worth(p: Proposal, s: Session) -> str:
    if math.isfinite(p.interval):
        return f"the interval would be {p.interval:.2g} times as wide as now"
    return f"removes {_of_doubt(p.information, s)}"


def _of_doubt(information: float, s: Session) -> str:
    return f"{percent(information / max(s.entropy, 1e-9))} of the doubt"


def _meaning(v: Verdict, one: Telling) -> str:
    """What the most telling reading is under each explanation."""
    row = OBSERVABLES.get(one.read)
    logarithm = row is None or row.log
    # a strength that is not stated is infinite in the rig, and assumed among the nuisances
    assumed = {n.name: n.value for n in v.problem.nuisances}
    stated = assumed.get(one.read, v.problem.rig.of.get(one.read, 1.0))
    unit = one.read.rpartition("_")[2] if row is None else _si(one.read)
    cases = []
    for name, (mean, std) in one.expected.items():
        value = stated * math.exp(mean) if row is None else math.exp(mean) if logarithm else mean
        wide = abs(value) * std if logarithm else std
        told = f"{quantity(value, unit)} ± {quantity(wide, unit)}"
        if logarithm and std > _WIDE:
            ends = (value * math.exp(-std), value * math.exp(std))
            told = f"{quantity(ends[0], unit)} to {quantity(ends[1], unit)}"
            told = "anything" if std > _ENDLESS else told
        cases.append(f"{told} if {explanation(name, v.titles)}")
    what = number_name(one.read) if row is None else row.label
    return f"Most telling is step {one.step + 1}, {what}: {'; '.join(cases)}."


def _si(column: str) -> str:
    ends = {"_m_s": "m/s", "_rad_s": "rad/s", "_Ns": "N s", "_m": "m", "_s": "s", "_N": "N"}
    return next((unit for end, unit in ends.items() if column.endswith(end)), "-")


def change_lines(v: Verdict) -> list[str]:
    """Return what the last session changed; nothing where there was but one."""
    if len(v.history) < 2:
        return []
    before, after = v.history[-2:]
    # that it takes part, as the finding says it
    was, now = (
        {k: sum(p for label, p in some.items() if k in label.split("+"))
         for k in dict.fromkeys("+".join(after.probabilities | before.probabilities).split("+"))}
        for some in (before.probabilities, after.probabilities)
    )  # fmt: skip
    most = sorted(now, key=lambda k: -abs(now[k] - was[k]))[:_CHANGED]
    told = [
        f"{explanation(k, v.titles)} {percent(was[k])}, now {percent(now[k])}"
        for k in most if abs(now[k] - was[k]) >= 0.01
    ]  # fmt: skip
    new = counted(after.trials - before.trials, "trial")
    if not told:
        return [f"Session {after.batch:g} ({new}) changed no probability by a per cent."]
    return [f"What session {after.batch:g} ({new}) changed in what takes part: {joined(told)}."]
