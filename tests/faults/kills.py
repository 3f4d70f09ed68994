"""kill -9 of the coordinator and of workers at random moments, through the product's own pool.

`python tests/faults/kills.py --kills 200` runs a campaign of a solver that waits a third of a
second, and kills in turn in every phase of it: while the interpreter starts, the run is read, cases
are solved and handed over, the image of a case is made, its draft written and renamed, a case told
as stored. Each phase announces itself on a board; a kill waits for one and comes at a random moment
after that. Calls that change files are drawn out by random pauses, so that kills land before,
within and after them. After every kill what was told as stored must be there, and every number must
be that of a run that nobody disturbed, bit by bit.

Most coordinators and workers are forked from a process that has everything loaded; those that are
killed in their start are new interpreters, as the product starts them.
"""

import argparse
import multiprocessing
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from unittest import mock

import disk_faults
import numpy as np
from dentscope import fem
from dentscope.campaigns import Case, Design, Store, read_curves, run_design, standard_case
from dentscope.campaigns.executor import LocalExecutor
from dentscope.core import Material, Pair

PAUSE_S = 0.03
PATIENCE_S = 120.0
BOARD, LOG = "BOARD", "COMPUTED"
SPANS_S = {
    "starts": 4.0, "reads": 0.05, "waits": 0.5, "makes the image": 0.03, "writes the draft": 0.3,
    "renames the draft": 0.1, "tells": 0.01, "solves": 0.6, "hands over": 0.02,
}  # fmt: skip
"""Phases, and how long after their beginning a kill may come."""

SHARES = {
    ("coordinator", "starts"): 8, ("worker", "starts"): 4, ("coordinator", "reads"): 14,
    ("coordinator", "waits"): 28, ("coordinator", "makes the image"): 20,
    ("coordinator", "writes the draft"): 48, ("coordinator", "renames the draft"): 36,
    ("coordinator", "tells"): 8, ("worker", "solves"): 22, ("worker", "hands over"): 12,
}  # fmt: skip
"""How many of 200 kills wait for each phase."""


def made(n):
    return tuple(
        standard_case(
            f"c{i}", Pair(Material(E=2e11, nu=0.3, Sy=4e8 + 1e6 * i),
                          Material(E=1e11, nu=0.3, Sy=3e8), 1e-3),
            deepest=0.01, n_depths=48, accuracy=fem.Accuracy.smoke(),
        )
        for i in range(n)
    )  # fmt: skip


# --- what the killed processes do ---


class Board:
    """Where each process says what it does: a file a process, named by its kind and number."""

    def __init__(self, folder):
        self.folder, self.files = folder, {}

    def tell(self, kind, phase):
        pid = os.getpid()
        if pid not in self.files:
            flags = os.O_CREAT | os.O_WRONLY
            self.files = {pid: os.open(self.folder / f"{kind}-{pid}", flags)}
        os.pwrite(self.files[pid], f"{phase:<30}".encode(), 0)

    def phase(self, kind, pid):
        """What a process said last; it starts until it says something."""
        try:
            return (self.folder / f"{kind}-{pid}").read_text().strip() or "starts"
        except OSError:
            return "starts"


@cache
def board():
    return Board(Path(os.environ[BOARD]))


def stand_in(specification, time_limit_s):
    """A solver that waits, announced, with a line for each case that was begun."""
    board().tell("worker", "solves")
    case = Case.from_specification(specification)
    with open(os.environ[LOG], "a", encoding="utf-8") as log:  # one write: never torn
        log.write(f"{case.name}\n")
    time.sleep(random.uniform(0.1, 0.5))
    board().tell("worker", "hands over")
    return disk_faults.solved(case)


def _phase_of(name):
    return "renames the draft" if name in ("rename", "sync_folder") else "writes the draft"


def announced(draw):
    """Let every call that changes a file announce its phase and take a while."""

    def hook(name, call):
        def announced_call(disk, *arguments):
            board().tell("coordinator", _phase_of(name))
            time.sleep(draw.uniform(0.0, PAUSE_S))
            answer = call(disk, *arguments)
            time.sleep(draw.uniform(0.0, PAUSE_S))
            return answer

        return announced_call

    return disk_faults.patched(hook)


class Announced:
    """The executor of this machine, announced."""

    def __init__(self, executor):
        self.executor, self.workers = executor, executor.workers

    def run(self, cases, *, time_limit_s):
        board().tell("coordinator", "waits")
        yield from self.executor.run(cases, time_limit_s=time_limit_s)


def coordinate(path, cases, *, forked):
    """Run the campaign to its end; tell each stored case in a file beside it."""
    told = os.open(path.with_suffix(".told"), os.O_CREAT | os.O_APPEND | os.O_WRONLY)
    put, pause = Store.put, random.Random(os.getpid())

    def announced_put(store, *arguments, **options):
        board().tell("coordinator", "makes the image")
        put(store, *arguments, **options)
        board().tell("coordinator", "tells")
        time.sleep(pause.uniform(0.0, PAUSE_S))  # what follows is too short to be met

    def tell(step):
        os.write(told, f"{step.case.name}\n".encode())
        board().tell("coordinator", "waits")

    with ExitStack() as changes:
        board().tell("coordinator", "reads")
        changes.enter_context(announced(random.Random(os.getpid())))
        changes.enter_context(mock.patch.object(Store, "put", announced_put))
        if forked:
            context = multiprocessing.get_context("fork")
            changes.enter_context(
                mock.patch.object(multiprocessing, "get_context", return_value=context)
            )
        run_design(
            Design("faults", "", lambda: cases), path,
            executor=Announced(LocalExecutor(workers=2, work=stand_in)),
            time_limit_s=600.0, report=tell,
        )  # fmt: skip


# --- who kills them ---


def announce_at(folder):
    """Let processes that start from here on announce their phases and cases in a folder."""
    (folder / "board").mkdir(exist_ok=True)
    (folder / "computed").touch()
    os.environ |= {BOARD: str(folder / "board"), LOG: str(folder / "computed")}


@dataclass
class Run:
    """A coordinator, and the folder of its campaign."""

    path: Path
    count: int
    pid: int = 0
    forked: bool = False
    code: int | None = None

    def begin(self, *, forked):
        self.forked, self.code = forked, None
        announce_at(self.path.parent)
        if not forked:
            command = [sys.executable, __file__, "--coordinate", str(self.path)]
            self.process = subprocess.Popen([*command, "--cases", str(self.count)])
            self.pid = self.process.pid
            return
        self.pid = os.fork()
        if not self.pid:
            try:
                board.cache_clear()
                coordinate(self.path, made(self.count), forked=True)
            except BaseException:
                traceback.print_exc()
                os._exit(1)
            os._exit(0)

    def ended(self):
        """Whether the coordinator is gone; its exit code is kept."""
        if self.code is None:
            if self.forked:
                pid, status = os.waitpid(self.pid, os.WNOHANG)
                self.code = os.waitstatus_to_exitcode(status) if pid else None
            else:
                self.code = self.process.poll()
        return self.code is not None

    def workers(self):
        """Numbers of its worker processes."""
        found = []
        for task in Path(f"/proc/{self.pid}/task").glob("*/children"):
            with suppress(OSError):
                found += map(int, task.read_text().split())
        if self.forked:
            return [pid for pid in found if b"resource_tracker" not in _command(pid)]
        # a new interpreter asks git for its commit too: that child is no worker that starts
        return [pid for pid in found if b"spawn_main" in _command(pid)]

    def told(self):
        file = self.path.with_suffix(".told")
        return file.read_text().split() if file.exists() else []

    def stored(self):
        """Curves of the stored cases, by name."""
        if not self.path.exists():
            return {}
        return {record.case.name: record.curve for record in read_curves(self.path)}


def _command(pid):
    with suppress(OSError):
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    return b"resource_tracker"


def there(pid):
    """Whether a process runs: one that ended and that nobody asked for does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def still_there(workers, *, patience_s=60.0):
    """How many processes do not end; on a free machine they see in a second that they are alone."""
    until = time.monotonic() + patience_s
    while (left := [pid for pid in workers if there(pid)]) and time.monotonic() < until:
        time.sleep(0.05)
    return len(left)


@dataclass
class Found:
    """What happened: kills by victim and phase, and what must be none."""

    kills: Counter = field(default_factory=Counter)
    lost: int = 0
    wrong: int = 0
    told_twice: int = 0
    left_over: int = 0
    unended: int = 0
    stored: int = 0
    failed: int = 0
    computed: int = 0
    rounds: int = 0

    @property
    def faults(self):
        return self.lost + self.wrong + self.told_twice + self.left_over + self.unended


def schedule(kills, seed):
    """Victims and phases that kills wait for, in a random order."""
    whole = sum(SHARES.values())
    wanted = [key for key, share in SHARES.items() for _ in range(round(kills * share / whole))]
    draw = random.Random(seed)
    # an interpreter's start is dear: few of them are enough
    rest = [key for key in SHARES if key[1] != "starts"]
    wanted += draw.choices(rest, k=max(0, kills - len(wanted)))
    draw.shuffle(wanted)
    return wanted[:kills]


def kill(run, who, phase, draw):
    """Wait for a phase, and kill a little later.

    Returns
    -------
    tuple
        Phase of the one that died, nothing when the campaign ended before; workers at that moment.
    """
    until = time.monotonic() + PATIENCE_S
    place = board()
    while not run.ended():
        pids = [run.pid] if who == "coordinator" else run.workers()
        met = [pid for pid in pids if place.phase(who, pid) == phase]
        if met or time.monotonic() > until:
            break
        time.sleep(0.002)
    else:
        return "", []
    time.sleep(draw.uniform(0.0, SPANS_S[phase]))
    pids = [pid for pid in (met or pids) if there(pid)]
    if not pids or run.ended():
        return "", []
    workers = run.workers()
    victim = draw.choice(pids)
    with suppress(ProcessLookupError):
        os.kill(victim, signal.SIGKILL)
    return place.phase(who, victim), workers


def inject(folder, wanted, *, count, seed, say):
    """Do the kills that are wanted, over as many campaigns as that takes; return what happened.

    `wanted` are victim and phase of each kill; those that are done are taken away.
    """
    draw, found = random.Random(seed), Found()
    while wanted:
        found.rounds += 1
        place = folder / str(found.rounds)
        place.mkdir()
        _one_campaign(Run(place / "run", count), wanted, draw, found, say)
    return found


def _one_campaign(run, wanted, draw, found, say):
    def check():
        stored, told = run.stored(), run.told()
        found.lost += len(set(told) - stored.keys() - _failed(run))
        found.told_twice += len(told) - len(set(told))
        found.wrong += sum(
            not (curve.keys() == right.keys() and all(
                np.array_equal(curve[k], right[k]) for k in right
            ))
            for name, curve in stored.items()
            for right in [_expected(run.count)[name]]
        )  # fmt: skip

    run.begin(forked=not (wanted and wanted[0][1] == "starts"))
    board.cache_clear()
    while wanted and not run.ended():
        who, phase = wanted[0]
        died_in, workers = kill(run, who, phase, draw)
        if not died_in:
            break
        wanted.pop(0)
        found.kills[f"{who} {died_in}"] += 1
        if who == "coordinator":
            while not run.ended():
                time.sleep(0.005)
            found.left_over += still_there(workers)
            check()
            run.begin(forked=not (wanted and wanted[0][1] == "starts"))
        say(f"kill {found.kills.total()}: {who} {died_in} (for {phase}), {found}")
    until = time.monotonic() + 10.0 * PATIENCE_S
    while not run.ended():
        if time.monotonic() > until:
            found.unended += 1
            os.kill(run.pid, signal.SIGKILL)
        time.sleep(0.05)
    if run.code:
        found.unended += 1
        say(f"the coordinator ended with {run.code}")
    check()
    found.stored += len(run.stored())
    found.failed += len(_failed(run))
    found.lost += run.count - len(run.stored()) - len(_failed(run))
    found.computed += len(Path(os.environ[LOG]).read_text().split())


def _failed(run):
    """Names of the cases that are stored as failed, with the reason."""
    if not run.path.exists():
        return set()
    records = Store(run.path).read_all()
    return {r.case.name for r in records if r.status == "failed" and r.message}


@cache
def _expected(count):
    """What the stand-in gives, as it is read."""
    with tempfile.TemporaryDirectory() as folder:
        store = Store(Path(folder))
        for case in made(count):
            store.put(case, disk_faults.solved(case))
        return {record.case.name: record.curve for record in store.read_all()}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--coordinate", type=Path)
    parser.add_argument("--cases", type=int, default=8)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    if chosen.coordinate:
        coordinate(chosen.coordinate, made(chosen.cases), forked=False)
        return
    begun = time.monotonic()

    def say(line):
        sys.stdout.write(f"{time.monotonic() - begun:.0f} s: {line}\n")
        sys.stdout.flush()

    with tempfile.TemporaryDirectory() as folder:
        wanted = schedule(chosen.kills, chosen.seed)
        found = inject(Path(folder), wanted, count=chosen.cases, seed=chosen.seed, say=say)
    for words, number in sorted(found.kills.items()):
        say(f"{number:4} {words}")
    say(f"{found.kills.total()} kills, {found.faults} faults: {found}")
    sys.exit(found.faults > 0)


if __name__ == "__main__":
    main()
