"""One diagnosis in a process of its own, which is given recordings and a place for its verdict.

The processes are forked from a server that has loaded the diagnosis and nothing of the proof; it
draws nothing and is told of no truth.
"""

from __future__ import annotations

import os
import signal
import time
import traceback
from contextlib import suppress
from functools import cache
from importlib import import_module
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext
from pathlib import Path
from typing import NamedTuple

from ...core.processes.children import die_with, keep_current_folder_out

_PASSED = ("PATH", "HOME", "LANG", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "TMPDIR", "PYTHONPATH",
           "PYTHONSAFEPATH")  # fmt: skip
_LOADED = ["dentscope.cli.app", "dentscope.discrepancy", "dentscope.discrepancy.report"]


class Answer(NamedTuple):
    """How a diagnosis ended: exit code, what it said if it failed, processor time [s]."""

    code: int
    message: str
    cpu_s: float


def answer(folder: Path, out: Path, limit_s: float) -> Answer:
    """Run `dentscope diagnose FOLDER --out OUT` in a process of its own.

    `folder`: recording set; `out`: for verdict.json and the report; `limit_s`: longest time [s].
    """
    theirs, ours = _server().Pipe(duplex=False)
    process = _server().Process(target=_diagnose, args=(folder, out, ours))
    process.start()
    ours.close()
    told = None
    if theirs.poll(limit_s):
        try:
            told = Answer(*theirs.recv())
        except EOFError:
            process.join()
            told = Answer(process.exitcode or 1, "the process ended without a word", 0.0)
    if told is None:
        process.kill()
        told = Answer(124, f"not done after {limit_s:g} s", limit_s)
    process.join()
    return told


@cache
def _server() -> ForkServerContext:
    keep_current_folder_out()
    context = get_context("forkserver")
    context.set_forkserver_preload(_LOADED)
    return context


def _diagnose(folder: Path, out: Path, ours: Connection) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the run, not for a verdict
    die_with(os.getppid())
    # by its name, as a shell reaches it: the proof imports nothing of the tool
    run = import_module("dentscope.cli.app").run
    for key in list(os.environ):
        if key not in _PASSED and not key.endswith("_NUM_THREADS"):
            del os.environ[key]
    os.chdir(folder.parent)
    with Path(os.devnull).open("w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        code = run(["diagnose", str(folder), "--out", str(out), "--quiet", "--no-report"])
        message = f"exit code {code}" if code else ""
    except BaseException:
        code, message = 1, traceback.format_exc()[-400:]
    with suppress(BrokenPipeError):  # the run was stopped
        ours.send((code, message, time.process_time()))
    ours.close()
