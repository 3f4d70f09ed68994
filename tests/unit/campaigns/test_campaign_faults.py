"""Faults that a long run meets: a full disk, readers beside a writer."""

import os
import shutil
import subprocess
import sys

import made_cases
import pytest
from dentscope.campaigns import Store, read_curves

MADE = os.path.dirname(made_cases.__file__)

# the product's store and main path with a solver that takes no time: writing is what is tested
WRITER = """
import resource, signal, sys, time
from pathlib import Path
import numpy as np
from dentscope.campaigns import Design, run_design
from dentscope.campaigns.executor import Ended
sys.path.append(sys.argv.pop(1))
from made_cases import case_of, solution_of

if len(sys.argv) > 4:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[4]), resource.RLIM_INFINITY))

def made():
    return tuple(case_of(f"c{i}", Sy=4e8 + 1e5 * i) for i in range(int(sys.argv[2])))

class Quick:
    workers = 1
    def run(self, cases, *, time_limit_s):
        for key, case in cases.items():
            line = np.random.default_rng(0).random(int(sys.argv[3]))
            yield Ended(key, solution_of(case, line=line))

try:
    run_design(Design("d", "", made), Path(sys.argv[1]), executor=Quick(), time_limit_s=1.0,
               report=lambda step: print("STORED", step.case.name, flush=True))
except Exception as error:
    print(type(error).__name__, error, flush=True)
    sys.exit(2)
"""


def start(path, n=200, values=48, limit=()):
    return subprocess.Popen(
        [sys.executable, "-c", WRITER, MADE, *map(str, (path, n, values, *limit))],
        stdout=subprocess.PIPE,
        text=True,
    )


def test_readers_and_the_writer_wait_for_each_other(tmp_path):
    path = tmp_path / "run"
    process = start(path, n=40)
    seen = [0]
    while process.poll() is None:
        if path.exists():
            seen.append(len(Store(path).statuses()))
    process.stdout.close()
    assert process.returncode == 0
    assert seen == sorted(seen)
    assert len(Store(path).statuses()) == 40


@pytest.mark.skipif(
    os.geteuid() != 0 or shutil.which("mount") is None, reason="a small disk needs root"
)
def test_a_full_disk_keeps_what_is_there(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=6m", "none", str(disk)]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("mounting is not allowed here")
    try:
        process = start(disk / "run", n=200, values=5000)
        *lines, last = process.communicate()[0].splitlines()
        assert process.returncode == 2
        assert last.startswith("InputError")
        assert "the disk is full" in last
        assert len(lines) > 1
        assert len(read_curves(disk / "run")) == len(lines)
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_a_file_that_may_not_grow_keeps_what_is_there(tmp_path):
    path = tmp_path / "run"
    start(path, n=3).communicate()
    process = start(path, n=5, values=5000, limit=(100_000,))
    *lines, last = process.communicate()[0].splitlines()
    assert process.returncode == 2
    assert "a file may not be larger here; all completed cases are kept" in last
    assert lines == []
    assert len(read_curves(path)) == 3
