"""docs/proof.md: the proof and its last full run; proof-details.md: what it is made of."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...core.output import write_file
from .calibrated import coverage_by_class, inclusion
from .case import Case, interval
from .power import PICTURE, Shown, picture, power_lines, shown
from .ranks import AT_DATA, at_data_lines, rank_lines, read_ranks
from .rivals import compare, rival_lines
from .score import confusion, scores
from .third_world_page import third_world_lines

_DATA = Path(__file__).resolve().parents[2] / "data" / "proof"
RUNS = _DATA / "runs.json"
"""Every run that was scored, oldest first."""

REMARKS = _DATA / "remarks.md"
"""What was found when single failures were looked into; goes into the page as it is."""

_MANY = 500
"""Sets of a run from which it stands in the table of all runs."""

_HEAD = """# Proof

`make proof` makes up recordings in which a known effect is concealed, lets the diagnosis say what
is missing, and only then looks at the truth. The generators, `studies/proof`, share nothing with
what is tested but the finite elements.

* **Simulators.** An expanding cavity, and a row of yielding springs, fitted pair by pair to
  quasi-static finite elements (force and elastic energy within 2 % rms, residual depth 3 %).
* **Effects** mostly follow other equations than the diagnosis has: overstress with relaxation,
  Zerilli and Armstrong, Voce, a chain of beam elements in place of modes
  ([beside finite elements](verification.md#what-hardening-and-rate-make-of-an-impact)).
* **Nulls**: nothing is missing. In half of all sets the metal is 3 to 8 % off elastic-perfect
  plasticity, in half the stated numbers are off within what the sheet says. Noise is Gaussian,
  skewed or heavy-tailed, with outliers and empty cells.
* **Sheets** state liquids, thin plates, blocks and heights whether they act or not: a learner that
  sees all but the readings, trained on 848 other sets, had 0.25 in front on 259, the commonest
  answer of each kind of rig 0.32.
* **Outside** are six effects without a name in the library; it knows other forms of three.
* **Seals.** The seed is the digest of the source tree. Truths and recordings are hashed into a
  chained ledger before the diagnosis runs, verdicts before a truth is opened.
* **Size**: change of all readings over their noise, less what stated tolerances, a metal 5 % off
  and, of a pair, the other effect can imitate. **First place**: where it is largest, or within a
  fifth.
* **Marks** were set before; `met` and `missed`: the whole 95 % interval (Clopper and Pearson) lies
  on one side, else `not shown`.

Known effects of real recordings, concealed: [interventions](interventions.md); recordings whose
truth nobody knows: [verdicts](verdicts-real.md). By effect and size, other
methods: [details](proof-details.md).
"""

_DETAILS = """# Proof, in detail

Of the last full run of the [proof](proof.md), unless said otherwise.
"""

_OTHERS = """## Other methods

Not run here: LISDD (Wang, arXiv:2606.23215) finds a missing term where residuals are not quiet,
ours act in all conditions and a formula is no name; mist (Anau Montel and others, Phys. Rev. D
111 (2025) 083013) learns likelihood ratios of distortions, ours are known; posterior predictive p
values (Meng, Ann. Stat. 22 (1994) 1142) and emdcmp (René, Longtin, Nature Communications 2025)
say whether a model fits, not what it lacks. Whoever has one can [try it](challenge.md) on
concealed sets."""


def summary(
    cases: list[Case], *, which: str, tree: str, date: str, total: int, commit: str = "",
    peers: Sequence[dict[str, Any]] = (), plan: str = "",
) -> dict[str, Any]:  # fmt: skip
    """What is kept of a run.

    - `cases`: the opened cases.
    - `which`, `tree`, `date`: list, tree hash and day of the run.
    - `total`: number of sets on the list.
    - `commit`: of the tool that was judged, if known.
    - `peers`: what simple rules said of the same sets, from `rivals.read_lines`.
    - `plan`: SHA-256 of the plan that was sealed before the first set.
    """
    wrong = [c for c in cases if _wrong(c)]
    return {
        "list": which, "tree": tree, "commit": commit, "date": date, "plan": plan,
        "sets": len(cases), "total": total,
        "failed": sum(not c.verdict for c in cases),
        "cpu_s": round(sum(float(c.event["cpu_s"]) for c in cases) / max(len(cases), 1), 1),
        "scores": [asdict(s) for s in scores(cases)],
        "confusion": confusion(cases), "inclusion": inclusion(cases),
        "coverage": coverage_by_class(cases),
        "by_mechanism": _by_mechanism(cases),
        "power": shown(cases), "peers": compare(peers) if peers else {},
        "failures": [_told(c) for c in wrong],
    }  # fmt: skip


def keep(entry: dict[str, Any], path: Path = RUNS) -> list[dict[str, Any]]:
    """Add a run to the list of all runs, in place of an earlier state of the same run."""
    runs: list[dict[str, Any]] = json.loads(path.read_text()) if path.exists() else []
    same = (entry["list"], entry["tree"])
    runs = [r for r in runs if (r["list"], r["tree"]) != same] + [entry]
    text = json.dumps(runs, indent=1, default=str)
    write_file(path, text.replace("NaN", "null") + "\n")
    return runs


def page(runs: list[dict[str, Any]]) -> str:
    """The whole page as Markdown."""
    lines = [_HEAD]
    last = _shown(runs)
    if last is None:
        return "\n".join([*lines, "No run has been made yet.", ""])
    lines += _run_text(last)
    lines += _history(runs)
    lines += third_world_lines()
    if REMARKS.exists():
        lines += ["## Failures looked into", "", REMARKS.read_text().strip(), ""]
    return "\n".join(lines)


def details(runs: list[dict[str, Any]]) -> str:
    """The page of what a run's scores are made of, and of what was looked into beside it."""
    lines = [_DETAILS]
    run = _shown(runs)
    if run is not None:
        lines += ["## By effect", "", "| truth | sets | detected | named right | median size |",
                  "| --- | --- | --- | --- | --- |"]  # fmt: skip
        lines += [
            f"| {name} | {n} | {seen} | {right} | {_text(size)} |"
            for name, (n, seen, right, size) in sorted(run["by_mechanism"].items())
        ]
        lines += power_lines([Shown(*row) for row in run.get("power", [])])
        lines += [*_inclusion_rows(run.get("inclusion", [])), ""]
    lines += rank_lines(read_ranks())
    lines += at_data_lines(read_ranks(AT_DATA))
    return "\n".join([*lines, _OTHERS, ""])


def publish(runs: list[dict[str, Any]], docs: Path) -> None:
    """Write the pages and their pictures."""
    write_file(docs / "proof.md", page(runs))
    write_file(docs / "proof-details.md", details(runs))
    power = (_shown(runs) or {}).get("power")
    if power:
        picture([Shown(*row) for row in power], docs / "pictures" / PICTURE)


def _shown(runs: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The run that the page shows: the last full one, else the last."""
    full = [r for r in runs if r["list"] == "full"]
    return full[-1] if full else (runs[-1] if runs else None)


def _run_text(run: dict[str, Any]) -> list[str]:
    lines = [
        f"## The last {'full ' if run['list'] == 'full' else ''}run", "",
        f"Tree `{run['tree'][:12]}`{_commit(run)}, {run['date']}: "
        f"{run['sets']} of {run['total']} sets, "
        f"{run['failed']} without a verdict, {run['cpu_s']} s processor time a diagnosis. Every "
        "wrong verdict, what was said of each truth, and all earlier runs: `data/proof/runs.json`."
        f"{_plan(run)}",
        "",
        "| score | value | 95 % interval | mark | |", "| --- | --- | --- | --- | --- |",
    ]  # fmt: skip
    lines += [_score_row(s) for s in run["scores"]]
    return [*lines, *rival_lines(run.get("peers", {})), ""]


def _commit(run: dict[str, Any]) -> str:
    if not run.get("commit"):
        return ""
    commit, *dirty = str(run["commit"]).split("-dirty")
    return f" (commit {commit[:7]}{', and changes that were in no commit' * len(dirty)})"


def _plan(run: dict[str, Any]) -> str:
    if not run.get("plan"):
        return ""
    sealed = f"SHA-256 `{run['plan'][:12]}`, was sealed before the first set"
    return f" The [plan](proof-plan.md), {sealed}."


def _history(runs: list[dict[str, Any]]) -> list[str]:
    """What was traded for what, run after run; what counts is named as in the table of scores."""
    asked = ("false alarms on nulls", "detected, size above 10", "undetermined or failed",
             "both of a pair named")  # fmt: skip
    lines = ["## All runs", "",
             f"Of {_MANY} sets or more, and the last; none shares a set with another.", "",
             f"| run | sets | {' | '.join(asked)} |", "| --- |" + " --- |" * 5]  # fmt: skip
    for run in (r for r in runs if r["sets"] >= _MANY or r is _shown(runs)):
        cells = []
        for name in asked:
            found = [s for s in run["scores"] if s["name"].startswith(name) and s["of"]]
            hits, of = (sum(s[k] for s in found) for k in ("hits", "of"))
            cells.append(f"{100.0 * hits / of:.1f} % of {of}" if of else "-")
        lines.append(
            f"| `{run['tree'][:7]}`, {run['date']} | {run['sets']} | {' | '.join(cells)} |"
        )
    return [*lines, ""]


def _inclusion_rows(rows: list[tuple[float, float, float, int, int]]) -> list[str]:
    if not rows:
        return []
    lines = ["", "### Does a mechanism take part as often as is said?", "",
             "| stated | mean | takes part | 95 % interval |",
             "| --- | --- | --- | --- |"]  # fmt: skip
    for low, high, mean, hits, n in rows:
        below, above = interval(hits, n)
        lines.append(
            f"| {low:g} to {high:g} | {mean:.3f} | {hits / n:.3f} ({hits} of {n}) | "
            f"{below:.3f} to {above:.3f} |"
        )
    return lines


def _score_row(s: dict[str, Any]) -> str:
    value = _text(s["value"])
    between = ""
    if s["of"]:
        value = f"{100.0 * s['value']:.1f} % ({s['hits']} of {s['of']})"
        between = f"{100.0 * s['low']:.1f} to {100.0 * s['high']:.1f} %"
    return f"| {s['name']} | {value} | {between} | {s['mark']} | {s['state']} |"


def _text(value: float | None) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.3g}"


def _by_mechanism(cases: list[Case]) -> dict[str, tuple[int, int, int, float]]:
    found: dict[str, tuple[int, int, int, float]] = {}
    groups: dict[str, list[Case]] = {}
    for case in cases:
        if case.truth["kind"] == "single":
            groups.setdefault(next(iter(case.true)), []).append(case)
        elif case.truth["kind"] == "outside":
            name = "outside: " + ", ".join(e["name"] for e in case.truth["effects"])
            groups.setdefault(name, []).append(case)
    for name, group in groups.items():
        seen = sum(c.said not in ("adequate", "undetermined") for c in group)
        right = sum(c.best == c.true if c.true else c.said == "outside-library" for c in group)
        sizes = sorted(c.size for c in group if math.isfinite(c.size))
        median = sizes[len(sizes) // 2] if sizes else math.nan
        found[name] = (len(group), seen, right, median)
    return found


def _wrong(case: Case) -> bool:
    kind = case.truth["kind"]
    if kind == "null":
        return case.said != "adequate"
    if kind == "outside":
        return case.said != "outside-library"
    if kind in ("single", "pair"):
        return case.best != case.true
    return False


def _told(case: Case) -> dict[str, Any]:
    effects = ", ".join(f"{e['name']} ({e['form']})" for e in case.truth["effects"]) or "nothing"
    rest = [" + ".join(sorted(r)) for r in case.reported]
    said = case.said + (": " + " or ".join(rest) if rest else "")
    return {
        "set": case.name, "size": case.size,
        "truth": f"{effects}; {case.truth['bench']}, {case.truth['family']}",
        "said": said or str(case.event["message"]),
    }  # fmt: skip
