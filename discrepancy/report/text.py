"""A verdict in words: what the terminal shows and the report begins with."""

from __future__ import annotations

import math
from typing import Any

from ...core.observables import OBSERVABLES
from ..decide import OUTSIDE
from ..findings import Verdict


def headline(v: Verdict) -> str:
    """Return the finding in one sentence."""
    names = " with ".join(v.mechanisms)
    if v.verdict == "adequate":
        return (
            "Nothing is missing: the baseline explains the recordings within their noise and the "
            "stated uncertainties."
        )
    if v.verdict == "missing-physics":
        title = v.best.mechanisms[0].title if len(v.best.mechanisms) == 1 else "both act"
        return f"Missing physics: {names} ({title})."
    if v.verdict == "indistinguishable":
        rest = "; ".join(" with ".join(a) for a in v.alternatives)
        return f"Something is missing, and these explain it equally well: {names}; {rest}."
    if v.verdict == OUTSIDE:
        return (
            "The baseline fails, and nothing in the library repairs it: the cause is something "
            "else."
        )
    return "Too few data to say."


def lines(v: Verdict) -> list[str]:
    """Return the finding as lines for a terminal."""
    p = v.problem
    trials = sum(len(c.trials) for c in p.conditions)
    seen = ", ".join(OBSERVABLES[o].label for o in dict.fromkeys(p.cells.observable))
    out = [
        f"{v.name}: {trials} trials, {len(p.conditions)} conditions, {len(p.cells)} numbers "
        f"({seen})",
        "",
        headline(v),
        "",
        *(f"  {r}" for r in v.reasons),
    ]
    flagged = [a["message"] for a in v.audit]
    if flagged:
        out += ["", "Inputs", *(f"  {m}" for m in flagged)]
    out += ["", "Where the baseline misses"]
    if v.located.misses:
        for m in v.located.misses[:4]:
            out.append(f"  {OBSERVABLES[m.observable].label} ({m.phase}): {m.trend}, z = {m.z:.1f}")
    else:
        out.append("  nowhere beyond what chance gives over all observables and conditions")
    if v.mechanisms:
        out += ["", "What explains it"]
        for name, q in own_parameters(v).items():
            out.append(f"  {name} = {number(q)} ({q['low']:.3g} to {q['high']:.3g})")
        i = v.improvement
        out.append(
            "  no condition could be left out of the fit to try the prediction on"
            if math.isnan(i["held_out_extended"])
            else f"  on conditions left out of the fit the miss falls from "
            f"{i['held_out_baseline']:.2f} to {i['held_out_extended']:.2f} standard errors"
        )
    out += ["", "Probabilities"]
    out += [f"  {k:55s} {x:6.3f}" for k, x in list(v.probabilities.items())[:5]]
    if v.corrections:
        out += ["", "Where the force law would have to change"]
        for c in v.corrections:
            k = max(range(len(c.factor)), key=lambda i: abs(math.log(c.factor[i])))
            out.append(
                f"  {c.phase}: times {c.factor[k]:.2f} ({c.low[k]:.2f} to {c.high[k]:.2f}) at a "
                f"depth of {c.depth_over_R[k]:.2g} R"
            )
    if v.proposals:
        best = v.proposals[0]
        out += [
            "", "Next experiment",
            f"  {best.change} (discrimination {best.expected_discrimination:.3g})",
        ]  # fmt: skip
    if v.limits and v.verdict == "adequate":
        out += ["", "What would have been seen"]
        out += [f"  {k}: {x:.3g} or more" for k, x in v.limits.items()]
    notes = [n for n in v.notes if n]
    if notes:
        out += ["", "Notes", *(f"  {n}" for n in notes)]
    return out


def own_parameters(v: Verdict) -> dict[str, dict[str, Any]]:
    """Return the parameters of the best explanation's mechanisms only."""
    return {label: v.parameters[label] for label in v.best.grid.labels}


def number(q: dict[str, Any]) -> str:
    """Return a value with its unit."""
    unit = "" if q["unit"] == "-" else f" {q['unit']}"
    return f"{q['value']:.3g}{unit}"


__all__ = ["headline", "lines", "number", "own_parameters"]
