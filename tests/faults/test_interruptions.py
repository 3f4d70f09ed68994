"""Ctrl-C and SIGTERM end a command at once, whatever it is doing, and leave no process behind."""

import os
import random
import signal
import subprocess
import sys
import time
import weakref
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from dentscope.core.processes.stopping import AGAIN_S, Stopped, heard, listening
from dentscope.fem.mesh.bodies import _session

# A worker that computes for ever, told of by its number.
ENDLESS = """
import os, sys, time
from dentscope.campaigns.workers import answers
if __name__ == "__main__":
    orders = {str(k): (1000.0,) for k in range(2)}
    list(answers(time.sleep, orders, workers=2, timeout_s=1000.0))
"""


@pytest.fixture(autouse=True)
def _interruptible() -> Iterator[None]:
    """Take Ctrl-C as at a terminal: a shell starts what runs in the background with it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


class Thing:
    pass


def _lost() -> None:
    """Take the interruption in a callback of a weak reference, where Python only prints it."""
    thing = Thing()
    kept = weakref.ref(thing, lambda _: os.kill(os.getpid(), signal.SIGINT))
    del thing
    assert kept() is None


def broken():
    raise RuntimeError("no compiled object yet")


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("then", [partial(time.sleep, 20.0), broken], ids=["lost", "an error"])
def test_an_interruption_that_a_callback_swallows_comes_again(then):
    def work() -> None:
        with listening():
            _lost()
            then()

    before = signal.getsignal(signal.SIGINT)
    start = time.monotonic()
    with pytest.raises(Stopped):
        work()
    assert time.monotonic() - start < 10.0
    assert signal.getsignal(signal.SIGINT) is before


def test_a_mesh_leaves_signals_as_they_were() -> None:
    """The library of meshes lets SIGTERM end the process without a word."""
    told = []
    before = signal.signal(signal.SIGTERM, lambda *_: told.append(True))
    try:
        with _session():
            os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)
    assert told == [True, True]


def test_what_is_tidied_up_is_left_in_peace() -> None:
    tidied = []

    def work() -> None:
        with listening():
            try:
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(5.0)
            finally:
                heard()
                time.sleep(2.0 * AGAIN_S)
                tidied.append(True)

    with pytest.raises(Stopped):
        work()
    assert tidied


def _group(pid: int) -> list[int]:
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(fields[3]) == pid and fields[0] != "Z":
                found.append(int(entry.name))
    return found


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_worker_is_left_behind(tmp_path: Path, sent: signal.Signals) -> None:
    script = tmp_path / "endless.py"
    script.write_text(ENDLESS)
    child = subprocess.Popen(
        [sys.executable, str(script)], start_new_session=True, stderr=subprocess.DEVNULL
    )
    try:
        end = time.monotonic() + 60.0
        # the resource tracker is one of them
        while len(_group(child.pid)) < 3 and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(random.Random(int(sent)).uniform(0.0, 0.5))
        child.send_signal(sent)
        child.wait(timeout=60.0)
        end = time.monotonic() + 60.0
        while _group(child.pid) and time.monotonic() < end:
            time.sleep(0.05)
        assert _group(child.pid) == []
    finally:
        for pid in _group(child.pid):
            os.kill(pid, signal.SIGKILL)
