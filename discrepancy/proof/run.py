"""A run: draw and seal, diagnose in a process of its own, seal the verdict. It may be stopped.

Folder of a run: `ledger.jsonl`, `sets/NAME/`, `truths/NAME.json`, `verdicts/NAME.json`. The
diagnosing process is given the path of a copy of the recordings and nothing else.
"""

from __future__ import annotations

import json
import os
import resource
import secrets
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .explicit_library import SERIES
from .explicit_sets import draw_explicit, write_explicit
from .folder import write_set
from .lists import LISTS, Entry, seed_of, shuffled
from .seal import Ledger, digest_of, tree_hash
from .truth import Truth, draw

_PASSED = (
    "PATH", "HOME", "LANG", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "TMPDIR", "PYTHONPATH",
)  # fmt: skip

ROOT = Path(__file__).resolve().parents[2]


def run_folder(base: Path, which: str) -> Path:
    """Folder of the run of this list on the present source tree."""
    return base / f"{which}-{tree_hash(ROOT)[:12]}"


def draw_entry(tree: str, entry: Entry) -> Truth:
    """The concealed case of one entry."""
    rng = seed_of(tree, entry)
    if entry.series:
        series = next(s for s in SERIES if s.name == entry.series)
        return draw_explicit(rng, series)
    return draw(rng, entry.kind, name=entry.effect)


def prepare(run: Path, ledger: Ledger, tree: str, entry: Entry) -> None:
    """Draw one case, write its recordings and its salted truth, and seal both."""
    truth = draw_entry(tree, entry)
    for place in ("sets", "truths", "verdicts"):
        (run / place).mkdir(parents=True, exist_ok=True)
    folder = run / "sets" / entry.name
    shutil.rmtree(folder, ignore_errors=True)
    write = write_explicit if entry.series else write_set
    write(truth, folder, name=entry.name)
    record = truth.record() | {"salt": secrets.token_hex(16), "tree": tree}
    path = run / "truths" / f"{entry.name}.json"
    path.write_text(json.dumps(record, indent=1) + "\n")
    ledger.add(event="truth", set=entry.name, truth=digest_of(path), recordings=digest_of(folder))


def diagnose(run: Path, ledger: Ledger, name: str, *, limit_s: float) -> dict[str, Any]:
    """Diagnose one set in a process that sees only its recordings; seal what it says.

    Returns
    -------
    dict
        The event: `verdict` (hash, empty if there is none), `exit`, `cpu_s`, `wall_s`, `message`.
    """
    start, before = time.monotonic(), _children_cpu()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / name
        shutil.copytree(run / "sets" / name, folder)
        out = Path(place) / "out"
        command = [sys.executable, "-m", "dentscope", "diagnose", str(folder), "--out", str(out)]
        code, message = _call(command, place, limit_s)
        found = out / "verdict.json"
        digest = ""
        if code == 0 and found.exists():
            kept = run / "verdicts" / f"{name}.json"
            shutil.copyfile(found, kept)
            digest = digest_of(kept)
    event = {
        "event": "verdict", "set": name, "verdict": digest, "exit": code,
        "cpu_s": round(_children_cpu() - before, 2),
        "wall_s": round(time.monotonic() - start, 2), "message": message,
    }  # fmt: skip
    ledger.add(**event)
    return event


def _call(command: list[str], place: str, limit_s: float) -> tuple[int, str]:
    plain = {
        key: value
        for key, value in os.environ.items()
        if key in _PASSED or key.endswith("_NUM_THREADS")
    }
    try:
        answer = subprocess.run(
            command, cwd=place, capture_output=True, text=True, timeout=limit_s, env=plain,
            check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return 124, f"not done after {limit_s:g} s"
    return answer.returncode, answer.stderr[-400:] if answer.returncode else ""


def _children_cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def carry_on(
    run: Path, which: str, *, hours: float = float("inf"), most: int = 10**9, limit_s: float = 900.0
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Go on with a run where it stopped; yield each set's name and its verdict event.

    Parameters
    ----------
    run
        Folder of the run.
    which
        Name of the list: `full` or `small`.
    hours, most
        When to stop: time [h], number of sets diagnosed now.
    limit_s
        Longest time of one diagnosis [s].

    Raises
    ------
    ValueError
        The source tree changed since the run began; a new run draws new truths.
    """
    tree = tree_hash(ROOT)
    run.mkdir(parents=True, exist_ok=True)
    ledger = Ledger(run / "ledger.jsonl")
    events = ledger.events()
    if not events:
        ledger.add(event="begin", set="", tree=tree, list=which)
    elif events[0]["tree"] != tree:
        raise ValueError("the source tree is not the one of this run")
    sealed, done = set(ledger.of("truth")), set(ledger.of("verdict"))
    end = time.monotonic() + 3600.0 * hours
    count = 0
    for entry in shuffled(LISTS[which](), tree):
        if count >= most or time.monotonic() > end:
            return
        if entry.name in done:
            continue
        if entry.name not in sealed:
            prepare(run, ledger, tree, entry)
        count += 1
        yield entry.name, diagnose(run, ledger, entry.name, limit_s=limit_s)
