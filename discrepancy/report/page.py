"""report.html: one file for people, with figures inside, that needs no network."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from ...core.observables import OBSERVABLES
from ...core.output import write_file
from ..findings import Verdict
from .pictures import figure_correction, figure_misfit, image
from .text import headline, number, own_parameters

_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #1c2430; max-width: 60rem;
  margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.5rem; line-height: 1.25 }
h2 { font-size: 1.15rem; margin-top: 2.2rem; border-bottom: 1px solid #d5dbe3 }
table { border-collapse: collapse; margin: .6rem 0; font-size: .92rem }
td, th { padding: .25rem .7rem; text-align: left; border-bottom: 1px solid #e4e8ee;
  vertical-align: top }
th { font-weight: 600; background: #f4f6f9 }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums }
img { max-width: 100% }
.finding { background: #eef3fa; border-left: 4px solid #2b6cb0; padding: .8rem 1rem;
  font-size: 1.1rem }
.small { color: #5a6675; font-size: .88rem }
"""


def write_report(verdict: Verdict, path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    verdict
        From `diagnose`.
    path
        Of the HTML file.
    """
    write_file(path, report(verdict))


def report(v: Verdict) -> str:
    """Return the report as one HTML page."""
    parts = [
        f"<h1>{_e(v.name)}: what the recordings say about the simulation</h1>",
        f'<p class="finding">{_e(headline(v))}</p>',
        _list(v.reasons),
        *_compared(v),
        *_misses(v),
        *_explanation(v),
        *_outside(v),
        *_ranking(v),
        *_next(v),
        *_numbers(v),
        f'<p class="small">dentscope, seed {v.seed}, {v.impacts} simulated impacts.</p>',
    ]
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{_e(v.name)}</title>'
        f"<style>{_STYLE}</style></head><body>{''.join(parts)}</body></html>\n"
    )


def _compared(v: Verdict) -> Iterable[str]:
    p = v.problem
    yield "<h2>What was compared</h2>"
    trials = sum(len(c.trials) for c in p.conditions)
    metal = " without yield" if p.law.name == "hertz" else " of a metal that knows no rate"
    yield (
        f"<p>{trials} trials at {len(p.conditions)} conditions, {len(p.cells)} numbers, against a "
        f"rigid striker on a rigid base{metal} (contact law "
        f"<b>{_e(p.law.name)}</b>, its own error kept as an unknown inside the law).</p>"
    )
    if v.audit:
        yield "<p>The inputs, checked against each other before any fit:</p>"
        yield _list([str(a["message"]) for a in v.audit])


def _misses(v: Verdict) -> Iterable[str]:
    yield "<h2>Where the baseline misses</h2>"
    if v.located.misses:
        rows = [
            (OBSERVABLES[m.observable].label, m.phase, m.trend, f"{m.z:+.1f}")
            for m in v.located.misses[:8]
        ]
        yield _table(("observable", "phase", "recording against simulation", "score"), rows)
        yield (
            f'<p class="small">Scores beyond &plusmn;{v.located.threshold:.1f} come up in fewer '
            "than one of twenty sets with nothing missing, over all rows together.</p>"
        )
    else:
        yield "<p>Nowhere beyond what chance gives over all observables and conditions.</p>"
    yield image(figure_misfit(v), "Recording over simulation for each observable")


def _explanation(v: Verdict) -> Iterable[str]:
    if not v.mechanisms:
        return
    yield "<h2>What explains it</h2>"
    for m in v.best.mechanisms:
        yield f"<p><b>{_e(m.name)}</b>: {_e(m.title)}. <code>{_e(m.equations)}</code></p>"
    rows = [
        (n, number(q), f"{q['low']:.3g} to {q['high']:.3g}", axis.parameter.source)
        for (n, q), axis in zip(own_parameters(v).items(), v.best.grid.axes, strict=True)
    ]
    yield _table(("parameter", "value", "90 % interval", "where its range comes from"), rows)
    i = v.improvement
    if math.isnan(i["held_out_extended"]):
        yield "<p>No condition could be left out of the fit to try the prediction on.</p>"
        return
    yield (
        "<p>Conditions that were left out of the fit, whole speeds, strikers and angles at a time, "
        f"are predicted with a miss of <b>{i['held_out_extended']:.2f}</b> standard errors instead "
        f"of <b>{i['held_out_baseline']:.2f}</b> ({i['trials']:.0f} predictions). A better "
        "prediction is not proof of the name: a wrong mechanism can improve it too.</p>"
    )


def _outside(v: Verdict) -> Iterable[str]:
    if not v.corrections:
        return
    yield "<h2>Where the force law would have to change</h2>"
    yield (
        "<p>No mechanism of the library repairs the baseline. Freed from its known error, the "
        "force law would change as drawn: a correction without physics in it, as a lead.</p>"
    )
    yield image(figure_correction(v), "Factor on the force law over the depth")


def _miss(score: float) -> str:
    return "none left out" if math.isnan(score) else f"{score:.2f}"


def _ranking(v: Verdict) -> Iterable[str]:
    yield "<h2>How sure</h2>"
    rows = [
        (
            name.replace("+", " + "), f"{s['evidence']:+.1f}", f"{s['p_value']:.3f}",
            _miss(s["held_out"]), f"{v.probabilities.get(name, 0.0):.3f}",
        )
        for name, s in sorted(v.scores.items(), key=lambda item: -item[1]["evidence"])
    ]  # fmt: skip
    yield _table(
        ("explanation", "ln evidence", "p of fit", "held-out miss", "probability"), rows, right=1
    )
    yield (
        '<p class="small">ln evidence is counted from the baseline. p of fit: how many sets that '
        "the explanation itself would make fit it no better; below 0.01 it is rejected. Held-out "
        "miss: rms distance of conditions left out of the fit, in standard errors.</p>"
    )
    if v.excluded:
        yield "<p>Excluded by arithmetic, before fitting:</p>"
        yield _table(("mechanism", "reason"), list(v.excluded.items()))
    if v.limits:
        yield "<p>The smallest value that would have been seen in this set:</p>"
        yield _table(
            ("mechanism", "smallest value"), [(k, f"{x:.3g}") for k, x in v.limits.items()]
        )


def _next(v: Verdict) -> Iterable[str]:
    if not v.proposals:
        return
    yield "<h2>The next experiment</h2>"
    yield "<p>Trials that would separate the leading explanations best:</p>"
    rows = [(q.change, f"{q.expected_discrimination:.3g}") for q in v.proposals]
    yield _table(("trial", "discrimination"), rows)


def _numbers(v: Verdict) -> Iterable[str]:
    yield "<h2>The stated numbers, after the comparison</h2>"
    rows = [
        (
            n.name, f"{n.value:.4g} {n.unit}", f"{v.parameters[n.name]['value']:.4g}",
            f"{v.nuisance_pulls[n.name]:+.1f}", f"{v.surprise[n.name]:+.1f}",
            "" if n.stated else "assumed",
        )
        for n in v.problem.nuisances
    ]  # fmt: skip
    yield _table(("number", "stated", "found", "pull", "surprise", ""), rows)
    yield (
        '<p class="small">Pull: shift in stated standard deviations. Surprise: shift over what '
        "chance would give; beyond 2 the sheet is doubted.</p>"
    )
    if v.notes:
        yield "<h2>Notes</h2>"
        yield _list(v.notes)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], *, right: int | None = None) -> str:
    """Return a table; columns from `right` on are numbers."""

    def cell(tag: str, k: int, text: str) -> str:
        side = ' class="n"' if right is not None and k >= right else ""
        return f"<{tag}{side}>{_e(text)}</{tag}>"

    top = "".join(cell("th", k, text) for k, text in enumerate(head))
    body = "".join(
        "<tr>" + "".join(cell("td", k, str(text)) for k, text in enumerate(row)) + "</tr>"
        for row in rows
    )
    return f"<table><tr>{top}</tr>{body}</table>"


def _list(items: Iterable[str]) -> str:
    return "<ul>" + "".join(f"<li>{_e(item)}</li>" for item in items) + "</ul>"


def _e(text: str) -> str:
    return html.escape(text)


__all__ = ["figure_correction", "figure_misfit", "report", "write_report"]
