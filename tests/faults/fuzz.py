"""Malformed input to every reader: nothing but one line may come of it, soon and in little memory.

`python tests/faults/fuzz.py --inputs 5000` makes that many files from sound ones by a seed, reads
them one after the other in a child that stays, and prints for each reader how many were refused
with a line, how many were read, and what else happened: another exception, a line that is several,
a file outside the folder, words on the terminal, the end of the process, more than 20 s of it, more
than 1 GB. Where a number of a TOML file is replaced by what is none (`true`, "0.01", a date, a
list), reading it is a fault as well. `--raw` takes raw recordings of every kind instead and reduces
them to numbers and a picture.
"""

import argparse
import contextlib
import json
import os
import random
import resource
import select
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter, defaultdict
from functools import partial
from pathlib import Path

from dentscope.core import InputError
from readers import RAW, READERS, lay_out

SLOW_S = 20.0
MEMORY_MB = 1000.0
_STUCK_S = 300.0  # of the clock: one that waits takes no time of its processor


def made_input(number, seed, readers, sound={}):  # noqa: B006 - sound files are made once
    """Return the reader, content and whether it must be refused; the same for the same seed."""
    draw = random.Random(f"{seed}-{number}")
    name = list(readers)[number % len(readers)]
    if name not in sound:
        sound[name] = readers[name].make()
    content, refuse = readers[name].change(sound[name], draw)
    return name, content, refuse and readers[name].name.endswith(".toml")


def read_sound_files(readers):
    """Read what is not damaged; what is imported or compiled once is then no input's time."""
    for reader in readers.values():
        with tempfile.TemporaryDirectory() as folder:
            reader.read(lay_out(reader, reader.make(), Path(folder) / "set"))


def child(seed, first, last, readers):
    """Read inputs first to last; a line of JSON before and after each."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    told_to = os.fdopen(os.dup(1), "w")  # what a library prints is not among what is told
    os.dup2(2, 1)
    tell = partial(_tell, told_to)
    read_sound_files(readers)
    for number in range(first, last):
        name, content, refuse = made_input(number, seed, readers)
        with tempfile.TemporaryDirectory() as folder:
            path = lay_out(readers[name], content, Path(folder) / "set")
            tell({"number": number, "reader": name})
            forget_peak()
            started, where, printed = time.process_time(), "", []
            try:
                with screened(printed):
                    readers[name].read(path)
                told = "NONSENSE READ" if refuse else "read"
            except InputError as error:
                lines = str(error).splitlines()
                each = getattr(error, "errors", (error,))
                told = "refused with a line" if len(lines) == len(each) else "SEVERAL LINES"
                where = str(error)[:500]
            except BaseException as error:
                told = f"EXCEPTION {type(error).__name__}"
                where = "".join(traceback.format_exception(error)[-3:])
            seconds = time.process_time() - started
            if os.listdir(folder) != ["set"]:
                told = "WROTE OUTSIDE"
            if printed:
                told, where = "PRINTED", "".join(printed)[:500]
        shown = content[:300].decode("latin-1") if told[0].isupper() else ""
        tell({"told": told, "where": where, "seconds": seconds, "MB": peak_mb(), "content": shown})


@contextlib.contextmanager
def screened(printed):
    """Keep words on the terminal, those too that compiled libraries write past `sys.stdout`."""
    sys.stdout.flush()
    kept = [os.dup(stream) for stream in (1, 2)]
    with tempfile.TemporaryFile() as screen:
        for stream in (1, 2):
            os.dup2(screen.fileno(), stream)
        try:
            yield
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for stream, was in zip((1, 2), kept, strict=True):
                os.dup2(was, stream)
                os.close(was)
            screen.seek(0)
            printed += filter(None, [screen.read().decode("latin-1")])


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
    """Seconds of the processor that a process has taken."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Watched:
    """A child that reads inputs; it is ended when one takes too long or too much."""

    def __init__(self, seed, first, last, *, raw, script):
        command = [sys.executable, script, "--child", str(first), "--inputs", str(last)]
        command += ["--raw"] if raw else []
        self.process = subprocess.Popen([*command, "--seed", str(seed)], stdout=subprocess.PIPE)
        self.why = ""

    def lines(self):
        """Yield what it says, until its end."""
        rest, reading = b"", False
        begun = cpu, clock = 0.0, time.monotonic()
        out = self.process.stdout
        while True:
            if reading:
                cpu, clock = begun
                if cpu_s(self.process.pid) - cpu > SLOW_S or time.monotonic() - clock > _STUCK_S:
                    self._end("HANG")
                elif peak_mb(self.process.pid) > MEMORY_MB:
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


def run(count, seed, *, first=0, raw=False, script=__file__, say=lambda line: None):
    """Read all inputs; return counts by reader, what went wrong, and the largest memory [MB].

    `script` is what is run with `--child`: this one, or another that calls `child`.
    """
    counts = defaultdict(Counter)
    faults, most = [], 0.0
    while first < count:
        watched, last, reader = Watched(seed, first, count, raw=raw, script=script), first - 1, ""
        for said in watched.lines():
            if "number" in said:
                last, reader = said["number"], said["reader"]
                continue
            most = max(most, said["MB"])
            told = said["told"] if said["seconds"] < SLOW_S else "SLOW"
            told = told if said["MB"] < MEMORY_MB else "MEMORY"
            counts[reader][told] += 1
            if told[0].isupper():
                faults.append({"number": last, "reader": reader, **said, "told": told})
                say(f"{last} {reader}: {told} {said['where']}")
            reader = ""
            if last % 500 == 499:
                say(f"{last + 1} of {count}")
        if reader:
            told = watched.why or "PROCESS ENDED"
            counts[reader][told] += 1
            faults.append({"number": last, "reader": reader, "told": told})
            say(f"{last} {reader}: {told} {watched.process.returncode}")
        elif last + 1 < count:
            raise RuntimeError(f"the child ended with {watched.process.returncode} after {last}")
        first = last + 1
    return counts, faults, most


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, default=5000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--raw", action="store_true", help="raw recordings instead")
    parser.add_argument("--child", type=int)
    chosen = parser.parse_args()
    if chosen.child is not None:
        readers = RAW if chosen.raw else READERS
        child(chosen.seed, chosen.child, chosen.inputs, readers)
        return
    begun = time.monotonic()

    def say(line):
        sys.stdout.write(f"{time.monotonic() - begun:.0f} s: {line}\n")
        sys.stdout.flush()

    counts, faults, most = run(
        chosen.inputs, chosen.seed, first=chosen.first, raw=chosen.raw, say=say
    )
    for name, found in counts.items():
        say(f"{name}: {dict(found)}")
    say(f"{len(faults)} faults; most memory {most:.0f} MB")


if __name__ == "__main__":
    main()
