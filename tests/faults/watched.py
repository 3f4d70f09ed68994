"""Children that read one input after the other, each ended where one takes too long or too much.

A child says a line of JSON before each input, its `number` and `reader`, and one after it: what
was `told` of it, a fault in capitals, `where`, and the `seconds` and `MB` that it took.
"""

import json
import os
import resource
import select
import subprocess
import sys
import time
from collections import Counter, defaultdict
from functools import partial
from pathlib import Path

SLOW_S = 20.0
MEMORY_MB = 1000.0
_STUCK_S = 300.0  # of the clock: one that waits takes no time of its processor


def teller():
    """Return what tells a line to who watches; what a library prints is not among it."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    told_to = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    return partial(_tell, told_to)


def _tell(to, line):
    to.write(json.dumps(line) + "\n")
    to.flush()


def forget_peak():
    """Let the largest memory be that of the next input alone."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        pass  # where that cannot be, it is the largest of all inputs so far


def peak_mb(pid="self"):
    """Largest memory of a process alone: ru_maxrss keeps what the parent held when it forked."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3 if pid == "self" else 0.0
    return next((float(x.split()[1]) / 1e3 for x in lines if x.startswith("VmHWM")), 0.0)


def cpu_s(pid):
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Watched:
    """A child that reads inputs; it is ended when one takes too long or too much."""

    def __init__(self, command, *, slow_s, memory_mb):
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE)
        self.slow_s, self.memory_mb = slow_s, memory_mb
        self.why = ""

    def lines(self):
        rest, reading = b"", False
        begun = cpu, clock = 0.0, time.monotonic()
        out = self.process.stdout
        while True:
            if reading:
                cpu, clock = begun
                if (
                    cpu_s(self.process.pid) - cpu > self.slow_s
                    or time.monotonic() - clock > _STUCK_S
                ):
                    self._end("HANG")
                elif peak_mb(self.process.pid) > self.memory_mb:
                    self._end("MEMORY")
            if not select.select([out], [], [], 0.5)[0]:
                continue
            got = os.read(out.fileno(), 65536)
            if not got:
                break
            *whole, rest = (rest + got).split(b"\n")
            for line in whole:
                said = json.loads(line)
                reading = "number" in said
                begun = cpu_s(self.process.pid), time.monotonic()
                yield said
        self.process.wait()
        out.close()

    def _end(self, why):
        self.why = self.why or why
        self.process.kill()


def run(
    count, seed, *, script, more=(), first=0, slow_s=SLOW_S, memory_mb=MEMORY_MB,
    say=lambda line: None, every=500,
):  # fmt: skip
    """Read inputs by `script --child FIRST --inputs COUNT --seed SEED` and `more`, from `first` on.

    Returns counts by reader, faults, the largest memory [MB] and the longest times [s].
    """
    counts, longest = defaultdict(Counter), defaultdict(float)
    faults, most = [], 0.0
    while first < count:
        command = [sys.executable, script, "--child", first, "--inputs", count, "--seed", seed]
        watched = Watched([*map(str, command), *more], slow_s=slow_s, memory_mb=memory_mb)
        last, reader = first - 1, ""
        for said in watched.lines():
            if "number" in said:
                last, reader = said["number"], said["reader"]
                continue
            most = max(most, said["MB"])
            longest[reader] = max(longest[reader], said["seconds"])
            told = said["told"] if said["seconds"] < slow_s else "SLOW"
            told = told if said["MB"] < memory_mb else "MEMORY"
            counts[reader][told] += 1
            if told[0].isupper():
                faults.append({"number": last, "reader": reader, **said, "told": told})
                say(f"{last} {reader}: {told} {said['where']}")
            reader = ""
            if last % every == every - 1:
                say(f"{last + 1} of {count}")
        if reader:
            told = watched.why or "PROCESS ENDED"
            counts[reader][told] += 1
            faults.append({"number": last, "reader": reader, "told": told})
            say(f"{last} {reader}: {told} {watched.process.returncode}")
        elif last + 1 < count:
            raise RuntimeError(f"the child ended with {watched.process.returncode} after {last}")
        first = last + 1
    return counts, faults, most, longest
