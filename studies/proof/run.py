"""A run: draw and seal, diagnose in a process of its own, seal the verdict. It may be stopped.

Folder of a run: `ledger.jsonl`, `sets/NAME/`, `truths/NAME.json`, `verdicts/NAME.json`. The
ledger begins with the SHA-256 of the plan, docs/proof-plan.md. The diagnosing process is given the
path of a copy of the recordings and nothing else.
"""

from __future__ import annotations

import json
import os
import secrets
import shutil
import signal
import tempfile
import time
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from itertools import islice, takewhile
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.output import in_use
from ...core.processes.children import die_with, keep_current_folder_out
from .apart import answer
from .generators.folder import write_set
from .generators.truth import draw
from .lists import LISTS, Entry, seed_of, shuffled
from .seal import Ledger, digest_of, tree_hash

ROOT = Path(__file__).resolve().parents[2]
PLAN = ROOT / "docs" / "proof-plan.md"
"""What is drawn, what counts as right and how it is analysed, written before the run."""


def run_folder(base: Path, which: str) -> Path:
    """Folder of the run of this list on the present source tree."""
    return base / f"{which}-{tree_hash(ROOT)[:12]}"


def verdicts_of(run: Path) -> int:
    """How many sets of a run have a sealed verdict."""
    return len(Ledger(run / "ledger.jsonl").of("verdict"))


def prepare(run: Path, tree: str, entry: Entry) -> dict[str, Any]:
    """Draw one case and conceal it; return the event that seals it."""
    truth = draw(seed_of(tree, entry), entry.kind, name=entry.effect)
    return conceal(run, entry.name, truth.record() | {"tree": tree}, partial(write_set, truth))


def conceal(
    run: Path, name: str, record: dict[str, Any], write: Callable[..., object]
) -> dict[str, Any]:
    """Write recordings (`write` takes folder and name) and salted truth.

    Returned: the event that seals both.
    """
    for place in ("sets", "truths", "verdicts"):
        (run / place).mkdir(parents=True, exist_ok=True)
    folder = run / "sets" / name
    shutil.rmtree(folder, ignore_errors=True)
    write(folder, name=name)
    path = run / "truths" / f"{name}.json"
    path.write_text(json.dumps(record | {"salt": secrets.token_hex(16)}, indent=1) + "\n")
    return {
        "event": "truth", "set": name, "truth": digest_of(path), "recordings": digest_of(folder)
    }  # fmt: skip


def diagnose(run: Path, name: str, limit_s: float) -> dict[str, Any]:
    """Diagnose one set in a process that sees only its recordings.

    Returned: the event that seals what was said: `verdict` (hash, empty if there is none), `exit`,
    `cpu_s`, `wall_s`, `message`.
    """
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / name
        shutil.copytree(run / "sets" / name, folder)
        out = Path(place) / "out"
        told = answer(folder, out, limit_s)
        found = out / "verdict.json"
        digest = ""
        if told.code == 0 and found.exists():
            kept = run / "verdicts" / f"{name}.json"
            shutil.copyfile(found, kept)
            digest = digest_of(kept)
    return {
        "event": "verdict", "set": name, "verdict": digest, "exit": told.code,
        "cpu_s": round(told.cpu_s, 2), "wall_s": round(time.monotonic() - start, 2),
        "message": told.message,
    }  # fmt: skip


def local_workers(count: int) -> Executor:
    """Processes of this machine that draw and diagnose; Ctrl-C is for their parent alone."""
    keep_current_folder_out()
    return ProcessPoolExecutor(
        count, get_context("spawn"), initializer=_begin_worker, initargs=(os.getpid(),)
    )


def _begin_worker(parent: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with(parent)


def carry_on(
    run: Path, which: str, workers: Executor, *, at_once: int = 1, hours: float = float("inf"),
    most: int = 10**9, limit_s: float = 900.0,
) -> Generator[tuple[str, dict[str, Any]]]:  # fmt: skip
    """Go on with a run where it stopped; yield each set's name and its verdict event.

    Only this process writes the ledger; a truth is sealed before its diagnosis is handed out.

    - `run`: folder of the run.
    - `which`: name of the list: `full` or `small`.
    - `workers`: draw and diagnose.
    - `at_once`: how many sets are under way at a time.
    - `hours`, `most`: when to stop: time [h], number of sets diagnosed now.
    - `limit_s`: longest time of one diagnosis [s].

    Raises `ValueError`: the source tree changed since the run began; a new run draws new truths.
    `InputError`: the plan is not the one that the run began with; or another process goes on with
    it.
    """
    tree = tree_hash(ROOT)
    with alone(run):
        ledger = _ledger_of(run, which, tree)
        todo = islice(entries_to_do(ledger, which, tree), most)
        end = time.monotonic() + 3600.0 * hours
        yield from _carry_on(run, tree, ledger, todo, workers, at_once, end, limit_s)


@contextmanager
def alone(run: Path) -> Iterator[None]:
    """Keep a run for oneself: two processes would seal a set twice.

    Raises `InputError`: another process goes on with it.
    """
    with in_use(run) as before:
        if before:
            raise InputError("another process goes on with this run", source=str(run),
                             allowed="one at a time")  # fmt: skip
        yield


def _carry_on(
    run: Path, tree: str, ledger: Ledger, todo: Iterator[Entry], workers: Executor, at_once: int,
    end: float, limit_s: float,
) -> Generator[tuple[str, dict[str, Any]]]:  # fmt: skip
    sealed = set(ledger.of("truth"))
    waiting: set[Future[dict[str, Any]]] = set()
    while True:
        while len(waiting) < at_once and time.monotonic() < end and (entry := next(todo, None)):
            if entry.name in sealed:
                waiting.add(workers.submit(diagnose, run, entry.name, limit_s))
            else:
                waiting.add(workers.submit(prepare, run, tree, entry))
        if not waiting:
            return
        ended, waiting = wait(waiting, return_when=FIRST_COMPLETED)
        for event in (future.result() for future in ended):
            ledger.add(**event)
            if event["event"] == "truth":
                waiting.add(workers.submit(diagnose, run, event["set"], limit_s))
            else:
                yield event["set"], event


def entries_to_do(ledger: Ledger, which: str, tree: str) -> Generator[Entry]:
    """Entries of a list that have no verdict yet, in the order of this tree's run."""
    done = set(ledger.of("verdict"))
    return (entry for entry in shuffled(LISTS[which](), tree) if entry.name not in done)


def _ledger_of(run: Path, which: str, tree: str) -> Ledger:
    run.mkdir(parents=True, exist_ok=True)
    ledger = Ledger(run / "ledger.jsonl")
    begun = ledger.of("begin").get("")
    if begun is None or not ledger.of("truth"):
        _seal_plan(ledger)
    if begun is None:
        ledger.add(event="begin", set="", tree=tree, list=which)
        return ledger
    if begun["tree"] != tree:
        raise ValueError("the source tree is not the one of this run")
    sealed = plan_of(ledger)
    if sealed and sealed != digest_of(PLAN):
        raise InputError(
            "the plan changed after the first set was drawn", source=str(PLAN), key="SHA-256",
            allowed=f"the plan that the run began with, {sealed}",
        )  # fmt: skip
    return ledger


def plan_of(ledger: Ledger) -> str:
    """SHA-256 of the plan that lay before a run's first truth; empty where there was none."""
    before = takewhile(lambda e: e["event"] != "truth", ledger.events())
    return next((str(e["plan"]) for e in reversed(list(before)) if e["event"] == "plan"), "")


def _seal_plan(ledger: Ledger) -> None:
    """Put the plan into the ledger, unless the same one is there."""
    now = digest_of(PLAN)
    if plan_of(ledger) != now:
        ledger.add(event="plan", set="", plan=now)
