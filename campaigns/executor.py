"""Where cases are computed: processes of this machine, or a dask cluster, behind one seam.

An executor takes specifications and gives back (case id, solution or reason) in the order in which
they end. A worker that dies costs its case one more try, never the run.
"""

from __future__ import annotations

import multiprocessing
import os
import threading
import time
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import FIRST_COMPLETED, CancelledError, wait
from dataclasses import dataclass
from typing import Any, Protocol

from ..core.errors import InputError
from ..core.threads import one_thread_each
from ..fem import Solution, solve
from .case import Case

_MOST_POOLS = 20  # that a run makes when workers die between cases
_TRIES = 3
_WINDOW = 4  # cases sent ahead to each dask worker


@dataclass(frozen=True)
class Ended:
    """One case that ended: its solution, or why there is none."""

    id: str
    solution: Solution | None
    message: str = ""


class Executor(Protocol):
    """What the campaign needs of a place to compute."""

    workers: int

    def run(self, cases: Mapping[str, Case], *, time_limit_s: float) -> Generator[Ended]:
        """Compute the cases; give each as it ends."""


def solve_specification(spec: dict[str, Any], time_limit_s: float) -> Solution:
    """Solve one case from its specification; the function that workers run."""
    case = Case.from_specification(spec)
    return solve(case.problem, accuracy=case.accuracy, time_limit_s=time_limit_s)


Work = Callable[[dict[str, Any], float], Solution]
"""What a worker does with a case's specification and its time limit [s]."""


@dataclass(frozen=True)
class LocalExecutor:
    """Worker processes on this machine, one thread each.

    Parameters
    ----------
    workers
        How many.
    work
        What they do with a case.
    """

    workers: int
    work: Work = solve_specification

    def run(self, cases: Mapping[str, Case], *, time_limit_s: float) -> Generator[Ended]:
        """Compute the cases; give each as it ends."""
        from pebble import ProcessPool

        # workers are spawned: the variables act before their numpy loads
        one_thread_each()

        def new_pool() -> Any:
            return ProcessPool(
                max_workers=self.workers,
                context=multiprocessing.get_context("spawn"),
                initializer=_die_with,
                initargs=[os.getpid()],
            )

        pools = [new_pool()]

        def submit(key: str) -> None:
            try:
                future = self._submit(pools[-1], cases[key], time_limit_s)
            except RuntimeError:  # the pool broke a moment ago
                pools.append(new_pool())
                future = self._submit(pools[-1], cases[key], time_limit_s)
            waiting[future] = (key, len(pools))

        try:
            tries = dict.fromkeys(cases, 0)
            waiting: dict[Any, tuple[str, int]] = {}
            for key in cases:
                submit(key)
            while waiting:
                ended, _ = wait(waiting, return_when=FIRST_COMPLETED)
                for future in ended:
                    key, number = waiting.pop(future)
                    if _pool_broke(future) and len(pools) < _MOST_POOLS:
                        # a worker that dies between two cases takes pebble's whole pool with it,
                        # which is no fault of the cases that waited there
                        if number == len(pools):
                            pools.append(new_pool())
                        submit(key)
                        continue
                    answer = _answer(key, future)
                    tries[key] += 1
                    if answer is None and tries[key] < _TRIES:
                        submit(key)
                        continue
                    yield answer or Ended(key, None, f"the worker died {_TRIES} times")
        finally:
            for pool in pools:
                pool.stop()
                pool.join()

    def _submit(self, pool: Any, case: Case, time_limit_s: float) -> Any:
        # the solver keeps the limit itself; the pool's is for one that hangs
        return pool.schedule(
            self.work,
            args=[case.specification(), time_limit_s],
            timeout=1.5 * time_limit_s + 60.0,
        )


@dataclass(frozen=True)
class DaskExecutor:
    """Workers of a dask cluster.

    Parameters
    ----------
    address
        The scheduler's address, `tcp://HOST:PORT`.
    workers
        Workers known when the connection was made.
    client
        The connection.
    work
        What the workers do with a case.
    """

    address: str
    workers: int
    client: Any
    work: Work = solve_specification

    @classmethod
    def connect(cls, address: str, *, timeout_s: float = 10.0) -> DaskExecutor:
        """Connect to a scheduler.

        Raises
        ------
        InputError
            dask is not installed, or nobody answers at the address.
        """
        try:
            from distributed import Client
        except ImportError:
            raise InputError(
                "dask.distributed is not installed",
                key="scheduler",
                allowed="pip install 'dentscope[cluster]'",
            ) from None
        try:
            client = Client(address, timeout=timeout_s)
        except (OSError, ValueError, TimeoutError) as error:
            raise InputError(
                f"no dask scheduler at {address} ({error})",
                key="scheduler",
                allowed="tcp://HOST:PORT",
            ) from None
        return cls(address, max(1, len(client.scheduler_info()["workers"])), client)

    def run(self, cases: Mapping[str, Case], *, time_limit_s: float) -> Generator[Ended]:
        """Compute the cases in a sliding window of a few a worker; give each as it ends.

        Workers may come and go, as under a batch system: the window follows their number, and dask
        sends the cases of a worker that died to another.

        Raises
        ------
        InputError
            The scheduler went away.
        """
        from distributed import as_completed

        todo = iter(cases.items())
        running = as_completed()
        keys: dict[str, str] = {}

        def fill() -> None:
            while len(keys) < _WINDOW * max(1, self._worker_count()):
                key, case = next(todo, ("", None))
                if case is None:
                    return
                future = self.client.submit(
                    self.work, case.specification(), time_limit_s, key=f"case-{key}"
                )
                keys[future.key] = key
                running.add(future)

        fill()
        for future in running:
            key = keys.pop(future.key)
            error = None if future.cancelled() else future.exception()
            if future.cancelled() or isinstance(error, CancelledError):
                raise self._went_away()
            if error is None:
                yield Ended(key, future.result())
            else:
                yield Ended(key, None, f"{type(error).__name__}: {error}")
            fill()

    def _worker_count(self) -> int:
        # a client that has given up on its scheduler knows of no workers, not of none
        workers = self.client.scheduler_info().get("workers")
        if workers is None:
            raise self._went_away()
        return len(workers)

    def _went_away(self) -> InputError:
        return InputError(
            "the dask scheduler went away; all completed cases are kept",
            source=self.address,
            allowed="a running scheduler; the same command goes on from here",
        )


def _die_with(coordinator: int) -> None:
    """End this worker when its coordinator is gone, so that a killed run leaves nothing behind."""

    def watch() -> None:
        while os.getppid() == coordinator:
            time.sleep(1.0)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _pool_broke(future: Any) -> bool:
    from concurrent.futures.process import BrokenProcessPool

    return not future.cancelled() and isinstance(future.exception(), BrokenProcessPool)


def _answer(key: str, future: Any) -> Ended | None:
    """Return the outcome of a pool's future; none when its worker died."""
    from pebble import ProcessExpired

    try:
        return Ended(key, future.result())
    except ProcessExpired:
        return None
    except TimeoutError:
        return Ended(key, None, "the case hung beyond its time limit")
    except Exception as error:  # a bug in one case must not take the campaign with it
        return Ended(key, None, f"{type(error).__name__}: {error}")
