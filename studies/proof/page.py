"""docs/proof.md: what the proof is, every run made, and the last full one in numbers."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...core.output import write_file
from .calibrated import calibration, coverage_by_class, inclusion
from .case import Case, interval
from .follow import brought
from .score import confusion, scores

_DATA = Path(__file__).resolve().parents[2] / "data" / "proof"
RUNS = _DATA / "runs.json"
"""Every run that was scored, oldest first."""

REMARKS = _DATA / "remarks.md"
"""What was found when single failures were looked into; goes into the page as it is."""

_HEAD = """# Proof

Can the diagnosis be believed? `make proof` draws impacts with concealed truths, lets the
diagnosis name what is missing, and only then looks. The generators are `studies/proof`; they
import nothing of the diagnosis, of the contact laws, of the impact or of the recordings.

* **Families.** Two fast ones with base laws of their own, an expanding-cavity dent and a row of
  yielding springs, each fitted pair by pair to quasi-static finite elements: force and elastic
  energy within 2 % rms, residual depth within 3 % (12 % in one pair whose shallowest dent keeps a
  fiftieth of its depth). A third is dynamic finite elements: bar, block and support meshed,
  explicit in time, {impacts} impacts in `data/proof/explicit_impacts.h5`.
* **Metals.** In half of the sets of the fast families, nulls included, the metal is 3 to 8 % off
  elastic-perfect plasticity (rms of the restitution, or of the dent where that is more): by the
  unloading of Etsion, Kligerman and Kadin, by a modulus of unloading that falls with plastic
  strain (Yoshida), or by a flow curve of the shape of 6061-T6's in tension. None of that is
  missing physics.
* **Truths.** The constitutive form differs from the textbook's in more than half of them:
  overstress with relaxation, Zerilli and Armstrong, Voce, a chain of beam elements in place of
  modes. What a rate and hardening make of an impact there stands beside finite elements with the
  same flow law in [verification](verification.md#what-hardening-and-rate-make-of-an-impact): the
  rate 0.5 to 0.9 of their effect, hardening 1.3 to 1.5. Half of all sets
  have strength, moduli, radius, mass, friction, speed and angle off within what the sheet states.
  Noise is Gaussian, skewed or heavy-tailed, with up to 2 % outliers and 3 % empty cells.
* **Seed.** SHA-256 of the source tree without the proof: any change of the tool draws new truths.
* **Seals.** Truth and recordings are hashed into a chained ledger before the diagnosis runs in a
  process that is given the recordings only; verdicts are hashed before a truth is opened. The
  scorer checks the whole chain first.
* **Size** of an effect: norm of the change of all readings over their noise, after what the
  nuisances within their tolerance and a metal that is 5 % off elastic-perfect plasticity can
  imitate is taken out, from the generator itself. Of an effect outside the library also what the
  nearest of the generator's own library effects imitates (draws of each, the best improved by a
  simplex search): a layer that crushes may look like asperities to every instrument of a set, and
  then no name is wrong. Of one of a pair also what the other one's numbers imitate, each known to a
  factor of e. Both are drawn until 10 is left, if eight draws give it. Three of the six kinds
  outside (a layer that crushes, softening by strain, a strength that falls with the rate) are
  physics that the tool knows in other forms, without a name; it knows nothing of the other three.
* **First place**: observable and condition along which the truth's effect is largest over what
  noise, nuisances and metal move there, dents, times and forces as ratios; within a fifth of it
  counts, and an observable that the effect leaves alone never does. **Next experiment**: a trial
  within the rig's speeds, angles and bodies, or one that says what to build.
* **Marks.** `met` or `missed` only if the whole 95 % interval (Clopper and Pearson) is on one
  side; else `not shown`.
"""


def summary(
    cases: list[Case], *, which: str, tree: str, date: str, total: int, commit: str = "",
    followed: Sequence[dict[str, Any]] = (),
) -> dict[str, Any]:  # fmt: skip
    """What is kept of a run.

    Parameters
    ----------
    cases
        The opened cases.
    which, tree, date
        List, tree hash and day of the run.
    total
        Number of sets on the list.
    commit
        Of the tool that was judged, if known.
    followed
        What proposed and random trials brought, from `follow`.
    """
    wrong = [c for c in cases if _wrong(c)]
    return {
        "list": which, "tree": tree, "commit": commit, "date": date,
        "sets": len(cases), "total": total,
        "failed": sum(not c.verdict for c in cases),
        "cpu_s": round(sum(float(c.event["cpu_s"]) for c in cases) / max(len(cases), 1), 1),
        "scores": [asdict(s) for s in scores(cases)],
        "confusion": confusion(cases), "calibration": calibration(cases),
        "inclusion": inclusion(cases), "coverage": coverage_by_class(cases),
        "by_mechanism": _by_mechanism(cases), "brought": brought(list(followed)),
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


def page(runs: list[dict[str, Any]], *, impacts: int) -> str:
    """The whole page as Markdown."""
    lines = [_HEAD.format(impacts=impacts)]
    full = [r for r in runs if r["list"] == "full"]
    shown = full[-1] if full else (runs[-1] if runs else None)
    if shown is None:
        return "\n".join([*lines, "No run has been made yet.", ""])
    lines += _run_text(shown)
    lines += ["## Every run", ""]
    lines.append("| date | list | tree | sets | failed | met | missed | not shown |")
    lines.append("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for run in runs:
        states = [s["state"] for s in run["scores"]]
        lines.append(
            f"| {run['date']} | {run['list']} | `{run['tree'][:12]}` | {run['sets']} of "
            f"{run['total']} | {run['failed']} | {states.count('met')} | {states.count('missed')} "
            f"| {states.count('not shown')} |"
        )
    if REMARKS.exists():
        lines += ["", "## Failures looked into", "", REMARKS.read_text().strip()]
    return "\n".join([*lines, ""])


def _run_text(run: dict[str, Any]) -> list[str]:
    lines = [
        f"## The last {'full ' if run['list'] == 'full' else ''}run", "",
        f"Tree `{run['tree'][:12]}`{_commit(run)}, {run['date']}: "
        f"{run['sets']} of {run['total']} sets, "
        f"{run['failed']} without a verdict, {run['cpu_s']} s processor time a diagnosis.", "",
        "| score | value | 95 % interval | mark | |", "| --- | --- | --- | --- | --- |",
    ]  # fmt: skip
    lines += [_score_row(s) for s in run["scores"]]
    lines += ["", "### Truth against what was said", "", *_confusion_rows(run["confusion"])]
    lines += ["", "### By mechanism", "",
              "| truth | sets | detected | named right | median size |",
              "| --- | --- | --- | --- | --- |"]  # fmt: skip
    lines += [
        f"| {name} | {n} | {seen} | {right} | {_text(size)} |"
        for name, (n, seen, right, size) in sorted(run["by_mechanism"].items())
    ]
    lines += [
        "",
        "### Calibration",
        "",
        "| stated probability | right | of |",
        "| --- | --- | --- |",
    ]
    lines += [f"| {low:g} to {high:g} | {r} | {n} |" for low, high, r, n in run["calibration"]]
    lines += _inclusion_rows(run.get("inclusion", []))
    lines += _brought_lines(run.get("brought", {}))
    lines += _coverage_rows(run.get("coverage", {}))
    lines += [
        "",
        "### Wrong or missed",
        "",
        "| set | truth | size | said |",
        "| --- | --- | --- | --- |",
    ]
    lines += [
        f"| {f['set']} | {f['truth']} | {_text(f['size'])} | {f['said']} |" for f in run["failures"]
    ]
    return [*lines, ""]


def _commit(run: dict[str, Any]) -> str:
    return f" (commit {run['commit'][:7]})" if run.get("commit") else ""


def _brought_lines(found: dict[str, float]) -> list[str]:
    if not found.get("sets"):
        return []
    return [
        "", "### What a proposed trial brings", "",
        f"Three more trials of {found['sets']:.0f} sets with something to tell apart: the entropy "
        f"of the probabilities falls by {found['proposed']:.2f} nats where they are proposed, by "
        f"{found['random']:.2f} at random places of the same rig"
        + ("." if math.isnan(found["ratio"] or math.nan) else f": {found['ratio']:.1f} times."),
    ]  # fmt: skip


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


def _coverage_rows(table: dict[str, tuple[int, int]]) -> list[str]:
    if not table:
        return []
    lines = ["", "### 90 % intervals by mechanism", "", "| truth | cover | of |",
             "| --- | --- | --- |"]  # fmt: skip
    return [*lines, *(f"| {name} | {hits} | {of} |" for name, (hits, of) in table.items())]


def _score_row(s: dict[str, Any]) -> str:
    value = _text(s["value"])
    between = ""
    if s["of"]:
        value = f"{100.0 * s['value']:.1f} % ({s['hits']} of {s['of']})"
        between = f"{100.0 * s['low']:.1f} to {100.0 * s['high']:.1f} %"
    return f"| {s['name']} | {value} | {between} | {s['mark']} | {s['state']} |"


def _text(value: float | None) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.3g}"


def _confusion_rows(table: dict[str, dict[str, int]]) -> list[str]:
    lines = ["| truth | said |", "| --- | --- |"]
    for row in sorted(table):
        cells = sorted(table[row].items(), key=lambda item: -item[1])
        lines.append(f"| {row} | " + ", ".join(f"{name} {n}" for name, n in cells) + " |")
    return lines


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
