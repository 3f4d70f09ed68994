"""What is said of each set, judged by the plan: each set is diagnosed once, and kept.

A set that two pairs share is asked about once. What was said before stays, until the plan of the
pair or the tool changes; `data/interventions/outcomes.json` tells the tree that was asked.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ...core.errors import InputError
from ...core.output import write_file
from ..proof.apart import answer
from ..proof.seal import digest_of, tree_hash
from .bases import base
from .edits import write_side
from .plan import ROOT, Pair

OUTCOMES = ROOT / "data" / "interventions" / "outcomes.json"
NAMING = ("missing-physics", "indistinguishable", "wrong-input")
_SHORT = 12


class Told(NamedTuple):
    """One side of a pair: whether it is right, and what was said; None where it was not asked."""

    pair: str
    side: str
    right: bool | None
    said: str


def right_with(pair: Pair, told: Mapping[str, Any]) -> bool:
    """Whether what is said of the set with the effect is fair, by the plan.

    Examples
    --------
    >>> from dentscope.studies.interventions.plan import read_plan
    >>> tilt = next(p for p in read_plan() if p.name == "tilt")
    >>> said = {"verdict": "missing-physics", "alternatives": [], "audit": []}
    >>> [right_with(tilt, {**said, "mechanisms": m}) for m in (["tilt"], ["tilt", "adhesion"])]
    [True, False]
    """
    if pair.audit and pair.audit not in " ".join(told["audit"]):
        return False
    if told["verdict"] not in NAMING:
        return told["verdict"] in pair.verdicts
    reported = [told["mechanisms"], *told["alternatives"]]
    return any(names and set(names) <= set(pair.named) for names in reported)


def points(pair: Pair, side: str, told: Mapping[str, Any]) -> int:
    """Return 1 where the cause is named, -1 where anything else is, 0 for silence.

    Examples
    --------
    >>> from dentscope.studies.interventions.plan import read_plan
    >>> tilt = next(p for p in read_plan() if p.name == "tilt")
    >>> said = {"verdict": "missing-physics", "mechanisms": ["tilt"], "alternatives": []}
    >>> points(tilt, "with", said), points(tilt, "without", said)
    (1, -1)
    """
    concealed = side == "with"
    if told["verdict"] in NAMING:
        return 1 if concealed and right_with(pair, {**told, "audit": [pair.audit]}) else -1
    unfair = told["verdict"] == "outside-library" and not (
        concealed and "outside-library" in pair.verdicts
    )
    return -1 if unfair else 0


def right_without(told: Mapping[str, Any]) -> bool:
    """Whether nothing is named, nothing called outside the library, and nothing contradicted."""
    return told["verdict"] in ("adequate", "undetermined") and not told["audit"]


def ask(
    pairs: Sequence[Pair], *, raw: Path, out: Path, record: Path = OUTCOMES, limit_s: float = 600.0
) -> Iterator[Told]:
    """Make both sets of each pair, and diagnose those that this tool was not asked about yet.

    - `pairs`: the plan.
    - `raw`: folder of the fetched recordings; pairs whose raw files are not there are left out.
    - `out`: folder of the sets and verdicts.
    - `record`: file of what was said, brought up to date after every set.
    - `limit_s`: longest time of one diagnosis [s].
    """
    tree = tree_hash(ROOT)[:_SHORT]
    kept = outcomes(record)
    for pair in pairs:
        for side, what in pair.sides.items():
            try:
                folder = _written(pair, side, raw, out)
            except FileNotFoundError as missing:
                place = missing.filename or missing.args[0]
                yield Told(pair.name, side, None, f"no {place}: dentscope recordings fetch")
                continue
            found = _asked(folder, out / "verdicts" / tree, limit_s)
            right = right_with(pair, found) if side == "with" else right_without(found)
            entry = {"tree": tree, "right": right, "base": what.base, **found}
            kept.setdefault(pair.name, {})[side] = entry
            write_file(record, json.dumps(kept, indent=1) + "\n")
            yield Told(pair.name, side, right, said(entry))


def outcomes(record: Path = OUTCOMES) -> dict[str, dict[str, Any]]:
    """Return what was said so far, by pair and side."""
    return json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}


def _written(pair: Pair, side: str, raw: Path, out: Path) -> Path:
    what = pair.sides[side]
    options = "".join(f",{name}={value:g}" for name, value in what.given.items())
    made = out / "bases" / (what.base + options)
    if not made.exists():
        begun = made.with_name(f".{made.name}")
        shutil.rmtree(begun, ignore_errors=True)
        begun.parent.mkdir(parents=True, exist_ok=True)
        base(what.base, what.given, raw=raw, folder=begun)
        begun.rename(made)  # what is half made is never taken for the whole
    folder = out / "sets" / f"{pair.name}-{side}"
    shutil.rmtree(folder, ignore_errors=True)
    write_side(what, made, folder)
    return folder


def _asked(folder: Path, out: Path, limit_s: float) -> dict[str, Any]:
    """Diagnose a set, unless one of the same content was diagnosed before."""
    digest = digest_of(folder)[:_SHORT]
    path = out / f"{digest}.json"
    if not path.exists():
        place = out / "running"
        shutil.rmtree(place, ignore_errors=True)
        told = answer(folder.resolve(), place.resolve(), limit_s)
        if told.code:
            raise InputError(told.message, source=str(folder), allowed="a verdict")
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(place / "verdict.json", path)
    verdict = json.loads(path.read_text(encoding="utf-8"))
    audit = [found["message"] for found in verdict["audit"]]
    wrong = [f"wrong-input:{one['key']}" for one in verdict.get("wrong_inputs", ())]
    return {
        "set": digest,
        "verdict": verdict["verdict"],
        # and the numbers of the sheet that it takes for wrong, by the names of its explanations
        "mechanisms": [*verdict["mechanisms"], *wrong],
        "alternatives": verdict["alternatives"],
        "audit": [line for line in audit if line.startswith("contradiction")],
        "probabilities": dict(
            sorted(verdict["probabilities"].items(), key=lambda item: -item[1])[:4]
        ),
    }


def said(told: Mapping[str, Any]) -> str:
    """What was said, in few words."""
    text = str(told["verdict"])
    if text in NAMING:
        reported = [told["mechanisms"], *told["alternatives"]]
        text = " or ".join("+".join(names) or "nothing" for names in reported)
    if told["audit"]:
        checks = (line.split(": ")[1].split(" of ")[0] for line in told["audit"])
        text += "; audit: " + ", ".join(dict.fromkeys(checks))
    return text
