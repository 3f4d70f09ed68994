"""Worker processes of this machine, each with a pipe of its own.

They share no queue and no lock: one that is killed, at whatever moment, costs its own order another
try and nobody else anything.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from collections import deque
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

from ..core.processes.children import die_with, keep_current_folder_out
from ..core.processes.stopping import heard
from ..core.processes.threads import one_thread_each

# limit: how long a process may take to end before it is killed [s]
_END_S = 5.0

# limit: how often a case is given to a worker [-]: dask's own limit
_TRIES = 3

Order = tuple[Any, ...]


@dataclass(frozen=True)
class Answer:
    """What became of an order: what the work gave, or why it gave nothing."""

    value: Any = None
    message: str = ""


def answers(
    work: Callable[..., Any], orders: Mapping[str, Order], *, workers: int, timeout_s: float
) -> Generator[tuple[str, Answer]]:
    """Let processes do the work for each order; give each answer as it comes.

    `work` is a function at the top of a module; one that takes longer than `timeout_s` is taken for
    one that hangs, and ended.
    """
    # workers are spawned: the variables act before their numpy loads
    one_thread_each()
    keep_current_folder_out()
    todo, tries = deque(orders), dict.fromkeys(orders, 0)
    crew: list[_Worker] = []

    def employ() -> None:
        """Give the next order to a worker that is free, or to a new one."""
        worker = next((w for w in crew if not w.key), None)
        if worker is None:
            worker = _Worker(work)
            crew.append(worker)
        key = todo.popleft()
        tries[key] += 1
        worker.give(key, orders[key], timeout_s)

    def again(worker: _Worker) -> bool:
        """Dismiss a worker that ended; whether its order gets another try."""
        crew.remove(worker)
        worker.stop()
        if tries[worker.key] >= _TRIES:
            return False
        todo.appendleft(worker.key)
        return True

    try:
        while todo or any(w.key for w in crew):
            while todo and sum(bool(w.key) for w in crew) < workers:
                employ()
            busy = [w for w in crew if w.key]
            left = min(w.until for w in busy) - time.monotonic()
            ready = wait([w.pipe for w in busy], timeout=max(0.0, left))
            for worker in busy:
                key = worker.key
                if worker.pipe in ready:
                    answer = worker.answer()
                    if answer is None and again(worker):
                        continue
                    answer = answer or Answer(message=f"the worker died {_TRIES} times")
                elif time.monotonic() > worker.until:
                    crew.remove(worker)
                    worker.stop()
                    answer = Answer(message="the case hung beyond its time limit")
                else:
                    continue
                if todo:  # it computes while the answer is stored
                    employ()
                yield key, answer
    finally:
        heard()  # workers are ended in peace
        for worker in crew:
            worker.stop()


class _Worker:
    """A process that does one order at a time; `key` names the order while it does."""

    def __init__(self, work: Callable[..., Any]) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, work, os.getpid()))
        self.process.start()
        theirs.close()  # so that the pipe ends when the process does
        self.key, self.until = "", 0.0

    def give(self, key: str, order: Order, timeout_s: float) -> None:
        self.key, self.until = key, time.monotonic() + timeout_s
        try:
            self.pipe.send(order)
        except OSError:
            pass  # it died since: its pipe says so when it is asked

    def answer(self) -> Answer | None:
        """Return the answer that waits; none when the process died."""
        try:
            found: Answer = self.pipe.recv()
        except (EOFError, OSError):
            return None
        self.key = ""
        return found

    def stop(self) -> None:
        self.pipe.close()
        if self.key:
            self.process.terminate()
        self.process.join(_END_S)
        self.process.kill()
        self.process.join()
        self.process.close()


def _serve(pipe: Connection, work: Callable[..., Any], coordinator: int) -> None:
    """Do the orders that come through a pipe, until it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the coordinator's
    die_with(coordinator)
    while True:
        try:
            order = pipe.recv()
        except (EOFError, OSError):
            return
        try:
            pipe.send(Answer(work(*order)))
        except OSError:
            return
        except Exception as error:  # a bug in one order must not take the others with it
            pipe.send(Answer(message=f"{type(error).__name__}: {error}"))
