"""kill -9 of the coordinator and of workers at random moments, through the product's own pool.

`python tests/faults/kills.py --kills 20` prints what was killed and what was
lost. The solver is a stand-in that takes a third of a second and gives curves that follow from the
case, so that every stored number can be checked; all else is the product's. With `--solver` it is
the product's own too, at its lowest accuracy; what is stored is then compared with a run that
nobody disturbed, bit by bit.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

import numpy as np
from dentscope import fem
from dentscope.campaigns import Case, Design, read_curves, run_design, standard_case
from dentscope.campaigns.executor import LocalExecutor, solve_specification
from dentscope.core import COMPLETED, Material, Pair
from dentscope.fem import Counters, Curve, Solution, Unloading


def real(n):
    """Cases that the solver itself takes about a second for."""
    flat = Material(E=200e9, nu=0.3, Sy=3e8)
    pairs = [Pair(Material(E=200e9, nu=0.3, Sy=4e8 + 1e7 * i), flat, 1e-3) for i in range(n)]
    return tuple(
        standard_case(f"c{i}", pair, deepest=3e-4, n_depths=4, accuracy=fem.Accuracy.smoke())
        for i, pair in enumerate(pairs)
    )


def made(n):
    flat = Material(E=1e11, nu=0.3, Sy=3e8)
    pairs = [Pair(Material(E=2e11, nu=0.3, Sy=4e8 + 1e6 * i), flat, 1e-3) for i in range(n)]
    return tuple(
        standard_case(f"c{i}", pair, deepest=0.01, n_depths=48, accuracy=fem.Accuracy.smoke())
        for i, pair in enumerate(pairs)
    )


def expected(case):
    """Force of the stand-in: a number that only this case has."""
    return case.pair.sphere.Sy * np.array(case.depths)


def stand_in(specification, time_limit_s):
    case = Case.from_specification(specification)
    with open(os.environ["COMPUTED"], "a", encoding="utf-8") as log:  # one write: never torn
        log.write(f"{case.name}\n")
    time.sleep(random.uniform(0.1, 0.5))
    depth = np.array(case.depths)
    curve = Curve(**{**dict.fromkeys(Curve.__dataclass_fields__, depth), "force": expected(case)})
    shape = np.linspace(0.0, 1.0, 200)
    unloading = Unloading(0.01, curve, 1e-6, 1e-6, *(shape,) * 4, steps=9, outcome=COMPLETED)
    counters = Counters(**dict.fromkeys(Counters.__dataclass_fields__, 1))
    return Solution(
        case.problem, case.accuracy, COMPLETED, curve, (unloading,) * 5, (), counters, "mesh"
    )


def tell(line):
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def logged(specification, time_limit_s):
    """The product's own work, and a line for each case that was begun."""
    with open(os.environ["COMPUTED"], "a", encoding="utf-8") as log:
        log.write(f"{specification['name']}\n")
    return solve_specification(specification, time_limit_s)


def coordinate(path, n, *, solver):
    cases = real(n) if solver else made(n)
    run_design(
        Design("faults", "", lambda: cases),
        path,
        executor=LocalExecutor(workers=2, work=logged if solver else stand_in),
        time_limit_s=600.0 if solver else 60.0,
        report=lambda step: tell(f"STORED {step.case.name}"),
    )


class Run:
    """A coordinator in a process of its own, and what it told of stored cases."""

    def __init__(self, path, n, told, options=()):
        self.process = subprocess.Popen(
            [sys.executable, __file__, "--coordinate", str(path), "--cases", str(n), *options],
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "COMPUTED": str(path.with_suffix(".log"))},
        )
        self.told = told
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            if line.endswith("\n"):
                self.told.append(line.split()[1])

    def workers(self):
        pid = self.process.pid
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        names = {int(c): Path(f"/proc/{c}/cmdline").read_bytes() for c in children}
        return [child for child, name in names.items() if b"spawn_main" in name]

    def ended(self):
        self.process.wait()
        self.reader.join()
        self.process.stdout.close()


def still_there(workers, *, patience_s=30.0):
    """How many processes do not end; on a free machine they see in a second that they are alone."""
    until = time.monotonic() + patience_s
    left = workers
    while left and time.monotonic() < until:
        time.sleep(0.1)
        left = [pid for pid in left if Path(f"/proc/{pid}").exists()]
    return len(left)


def inject(folder, *, kills, cases, seed, say=tell, reference=None):
    """Kill until `kills` are done, then let it finish; return what happened.

    Returns
    -------
    dict
        Counts of kills, of cases told as stored, found, computed more than once after being told,
        and wrong.
    """
    draw, path, told = random.Random(seed), folder / "c.h5", []
    count, lost, left_over = Counter(), 0, 0
    options = ["--solver"] if reference else []
    run = Run(path, cases, told, options)
    while sum(count.values()) < kills and run.process.poll() is None:
        # a third of the kills meet the start, the others the work
        busy = time.monotonic() + draw.choice((0.0, 20.0 if reference else 60.0, 60.0))
        before = len(told)
        while len(told) == before and time.monotonic() < busy and run.process.poll() is None:
            time.sleep(0.01)
        time.sleep(draw.uniform(0.0, 3.0))
        if run.process.poll() is not None:
            break
        workers = run.workers()
        if workers and draw.random() < 0.5:
            os.kill(draw.choice(workers), signal.SIGKILL)
            count["worker"] += 1
            continue
        run.process.send_signal(signal.SIGKILL)
        count["coordinator"] += 1
        run.ended()
        if path.exists():
            lost += len(set(told) - {record.case.name for record in read_curves(path)})
        left_over += still_there(workers)
        say(f"kill {sum(count.values())}: {len(told)} told as stored, {lost} of them lost")
        run = Run(path, cases, told, options)
    run.ended()
    computed = Counter(path.with_suffix(".log").read_text().split())
    found = {record.case.name: record for record in read_curves(path)}
    right = reference or {name: expected(r.case) for name, r in found.items()}
    wrong = [n for n, r in found.items() if not np.array_equal(r.curve["force"], right[n])]
    return {
        **count,
        "stored": len(found),
        "lost": lost,
        "told twice": len(told) - len(set(told)),
        "wrong": len(wrong),
        "workers left over": left_over,
        "computed in all": sum(computed.values()),
    }


def undisturbed(path, cases):
    """Forces of every case from a run of the solver that nobody kills."""
    run = Run(path, cases, [], ["--solver"])
    run.ended()
    return {record.case.name: record.curve["force"] for record in read_curves(path)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--coordinate", type=Path)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--solver", action="store_true")
    parser.add_argument("--reference", type=Path, help="keep the undisturbed run here")
    chosen = parser.parse_args()
    if chosen.coordinate:
        coordinate(chosen.coordinate, chosen.cases, solver=chosen.solver)
        return
    with tempfile.TemporaryDirectory() as folder:
        reference = None
        if chosen.solver:
            reference = undisturbed(chosen.reference or Path(folder) / "reference.h5", chosen.cases)
        total = Counter()
        while total["coordinator"] + total["worker"] < chosen.kills:
            place = Path(folder) / str(total["rounds"])
            place.mkdir()
            left = chosen.kills - total["coordinator"] - total["worker"]
            found = inject(
                place, kills=left, cases=chosen.cases, seed=chosen.seed + total["rounds"],
                reference=reference,
            )  # fmt: skip
            total += Counter(found) + Counter(rounds=1)
            tell(dict(total))


if __name__ == "__main__":
    main()
