"""Run the rules over a folder of sets: a line of JSON for each, in the folder's peers.jsonl.

Sets lie at sets/NAME, truths at truths/NAME.json or truths/NAME.toml, whose key `mechanisms` is
empty where nothing is missing. A folder with a ledger is a sealed run: its seals are checked, its
sealed verdicts stand for the diagnosis, and nothing is diagnosed again.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Generator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import InputError
from ...core.inputs.toml_input import read_toml
from ...discrepancy import diagnose
from ...recordings import read
from ..proof.case import open_run
from ..proof.generators.truth import PLANTED
from ..proof.rivals import DIAGNOSIS, PEERS, names_of, read_lines
from ..proof.seal import Ledger, SealBroken
from .fitted import Fitted, fitted_of
from .rules import RULES, LeftOut, Rule


class Asked(NamedTuple):
    """One set: its folder, its truth, and the verdict with its seconds where one is sealed."""

    place: Path
    truth: tuple[str, ...]
    verdict: dict[str, Any] | None = None
    seconds: float = 0.0


def asked_of(folder: Path) -> list[Asked]:
    """Return the sets of a folder; of a run those with a sealed verdict, in the run's order.

    The order of a run is random. Sets with a wrong mass or strength are left out.

    Raises `InputError`: a seal of a run does not hold, or the folder holds no sets.
    """
    ledger = Ledger(folder / "ledger.jsonl")
    if not ledger.path.exists():
        if not (folder / "sets").is_dir():
            raise InputError(
                "no sets", source=str(folder), allowed="a folder with sets/ and truths/"
            )
        places = sorted(p for p in (folder / "sets").iterdir() if p.is_dir())
        return [Asked(p, _truth(folder / "truths", p.name)) for p in places]
    try:
        cases = {c.name: c for c in open_run(folder)}
        order = [name for name in ledger.of("verdict") if name in cases]
    except SealBroken as broken:
        raise InputError(str(broken), source=str(folder), allowed="unbroken seals") from broken
    return [
        Asked(
            folder / "sets" / name, names_of(cases[name].truth), cases[name].verdict,
            float(cases[name].event["cpu_s"]),
        )
        for name in order
        if cases[name].truth["kind"] not in PLANTED
    ]  # fmt: skip


def _truth(folder: Path, name: str) -> tuple[str, ...]:
    written = folder / f"{name}.json"
    if written.exists():
        return names_of(json.loads(written.read_text(encoding="utf-8")))
    return tuple(sorted(read_toml(folder / f"{name}.toml")["mechanisms"]))


def compared(
    folder: Path, workers: Executor, *, at_once: int = 1, most: int = 10**9
) -> Generator[tuple[dict[str, Any], int, int]]:
    """Go on with a folder where it stopped; yield each set's line, how many are done, of how many.

    - `folder`: with sets/ and truths/, or a run.
    - `workers`: fit and diagnose.
    - `at_once`: how many sets are under way at a time.
    - `most`: number of sets, in the folder's order, those of earlier calls among them.
    """
    asked = asked_of(folder)[:most]
    source = _source()
    known = {x["set"] for x in read_lines(folder) if x["source"] == source}
    todo = iter([a for a in asked if a.place.name not in known])
    done = sum(a.place.name in known for a in asked)
    waiting: set[Future[dict[str, Any]]] = set()
    with (folder / PEERS).open("a", encoding="utf-8") as stream:
        stream.write(_ended(folder / PEERS))
        while True:
            more = islice(todo, at_once - len(waiting))
            waiting |= {workers.submit(line_of, a, source) for a in more}
            if not waiting:
                return
            ended, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for line in (future.result() for future in ended):
                stream.write(json.dumps(line) + "\n")
                stream.flush()
                done += 1
                yield line, done, len(asked)


def _ended(path: Path) -> str:
    """What ends a line that was cut short."""
    text = path.read_bytes()
    return "" if text[-1:] in (b"", b"\n") else "\n"


def line_of(asked: Asked, source: str) -> dict[str, Any]:
    """Return what the diagnosis and each rule say of a set, beside its truth.

    Where the fits fail, every rule is undetermined, as a diagnosis without a verdict is.
    """
    begun = time.process_time()
    verdict, seconds = asked.verdict, asked.seconds
    if verdict is None:
        verdict = diagnose(read(asked.place)).to_dict()
        seconds = time.process_time() - begun
    between = time.process_time()
    said = {DIAGNOSIS: _of_verdict(verdict)} | dict.fromkeys(RULES, _of_verdict({}))
    acting, failed = 0, ""
    try:
        fitted = fitted_of(read(asked.place))
    except (InputError, np.linalg.LinAlgError) as error:
        failed = str(error)
    else:
        acting = fitted.acting
        said |= {name: _of_rule(rule, fitted) for name, rule in RULES.items()}
    return {
        "set": asked.place.name, "truth": list(asked.truth), "source": source,
        "acting": acting, "said": said, "failed": failed,
        "seconds": {
            DIAGNOSIS: round(seconds, 2), "rules": round(time.process_time() - between, 2)
        },
    }  # fmt: skip


def _of_rule(rule: Rule | LeftOut, fitted: Fitted) -> dict[str, Any]:
    one = rule.says(fitted)
    names = [one.name.split("+")] if one.name else []
    odds = {k: round(p, 6) for k, p in rule.odds(fitted).items()}
    return {"verdict": one.verdict, "names": names, "odds": odds}


def _of_verdict(verdict: dict[str, Any]) -> dict[str, Any]:
    wrong = (str(one["key"]) for one in verdict.get("wrong_inputs", ()))
    best = [*verdict.get("mechanisms", ()), *wrong]
    rest = [list(x) for x in verdict.get("alternatives", ()) if sorted(x) != sorted(best)]
    said = str(verdict.get("verdict", "undetermined"))
    named = said in ("missing-physics", "indistinguishable")
    return {
        "verdict": said, "names": [x for x in (best, *rest) if x] if named else [],
        "odds": dict(verdict.get("probabilities", {})),
    }  # fmt: skip


def _source() -> str:
    """Digest of the fits and the rules: a line that others made is made again."""
    text = hashlib.sha256()
    for name in ("fitted.py", "rules.py"):
        text.update((Path(__file__).parent / name).read_bytes())
    return text.hexdigest()[:12]
