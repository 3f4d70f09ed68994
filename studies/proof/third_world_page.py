"""What came of the third world: the file that is kept, and its part of the proof's page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .case import Case
from .rivals import (
    BASELINE,
    DIAGNOSIS,
    best_peer,
    best_rules,
    compare,
    less_rows,
    mark_of,
    score_rows,
    verdict_lines,
)

_DATA = Path(__file__).resolve().parents[2] / "data" / "proof"
FOUND = _DATA / "third-world.json"
"""Scores, paired differences, and a line for every set."""

REMARKS = _DATA / "third-world-remarks.md"
"""What was found when lost sets were looked into; goes into the page as it is."""

_INTRO = """## A third world

{done} sets of `studies/third_world`{ended}, {nulls} of them nulls and {outside} outside: another
law of contact, its mean metal 2 to 5 % rms from finite elements, each metal some per cent off that,
own bars, beams and time steps. The tool was chosen on other draws of it as well. The
[plan](../data/proof/third-world-plan.md), SHA-256 `{plan}`, came before the first set; every set
and rule is in `data/proof/third-world.json` (tree `{tree}`; `python -m
dentscope.studies.proof.third_world run`). Columns as above, the two best rules."""


def kept(
    cases: Sequence[Case], lines: Sequence[dict[str, Any]], *, plan: str, tree: str, total: int
) -> dict[str, Any]:
    """What is kept of a run: the comparison, and of every set its truth and what leads.

    `cases`: the opened sets; `lines`: what the peers said of them; `plan`, `tree`: SHA-256 of the
    plan and of the tool; `total`: sets of the list.
    """
    of = {c.name: c for c in cases}
    best = best_peer(compare(lines))["name"]
    sets = []
    for line in sorted(lines, key=lambda x: str(x["set"])):
        truth = of[line["set"]].truth
        said = line["said"][DIAGNOSIS]
        leading = sorted(said["odds"].items(), key=lambda item: -item[1])[:4]
        sets.append(
            {
                "set": line["set"], "bench": truth["bench"], "truth": _true(truth),
                "forms": [e["form"] for e in truth["effects"]],
                "sizes": [round(float(s), 1) for s in truth["sizes"]],
                "verdict": said["verdict"], "names": ["+".join(n) for n in said["names"]],
                "odds": {k: round(p, 3) for k, p in leading},
                "front": bool(mark_of(line, DIAGNOSIS).front),
                "peer_front": bool(mark_of(line, best).front),
            }
        )  # fmt: skip
    return {
        "plan": plan, "tree": tree, "total": total, "compared": compare(lines), "sets": sets
    }  # fmt: skip


def _true(truth: dict[str, Any]) -> str:
    names = [str(e["name"]) for e in truth["effects"]]
    joined = "+".join(names) or BASELINE
    return f"outside: {joined}" if truth["kind"] == "outside" else joined


def third_world_lines(path: Path = FOUND) -> list[str]:
    """The part of the page; none without a run."""
    if not path.exists():
        return []
    kept = json.loads(path.read_text(encoding="utf-8"))
    found = kept["compared"]
    best = best_peer(found)
    first = best_rules(found)
    own = [r for r in found["rows"] if r["name"] == DIAGNOSIS]
    done = found["sets"]
    intro = _INTRO.format(
        done=done, ended="" if done == kept["total"] else f" of {kept['total']}, in random order",
        nulls=found["nulls"], outside=found["outside"], plan=kept["plan"][:12],
        tree=kept["tree"][:12],
    )  # fmt: skip
    remarks = [REMARKS.read_text(encoding="utf-8").strip(), ""] if REMARKS.exists() else []
    return [
        intro, "", *score_rows(found | {"rows": [*own, *first]}), "",
        "The diagnosis less each:", "", *less_rows(found | {"rows": first}), "",
        *verdict_lines(best, own[0], done), "", *remarks,
    ]  # fmt: skip
