"""Where cases are computed: processes of this machine, or a dask cluster, behind one seam.

An executor takes specifications and gives back (case id, solution or reason) in the order in which
they end. A worker that dies costs its case one more try, never the run.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import CancelledError
from contextlib import closing
from dataclasses import dataclass, replace
from typing import Any, Protocol

from ..core.errors import InputError, first_line
from ..core.provenance import differences, environment
from ..fem import Solution, solve
from .case import Case
from .workers import answers

# limit: how long a run on a cluster goes on without any worker [s]: a worker's restart takes less
_PATIENCE_S = 60.0

# limit: between two looks at which dask workers are there [s]: tools/benchmarks/bench_scale.py
_LOOK_S = 1.0

# limit: cases sent ahead to each dask worker [-]: none waits while one is on its way
# (tools/benchmarks/bench_scale.py)
_AHEAD = 4


@dataclass(frozen=True)
class Ended:
    """One case that ended: its solution, or why there is none, and by which versions."""

    id: str
    solution: Solution | None
    message: str = ""
    computed_by: Mapping[str, str] | None = None

    @property
    def done(self) -> bool:
        """Whether its solution is complete."""
        return self.solution is not None and self.solution.outcome.completed


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

Signed = tuple[Solution, dict[str, str]]


def signed(work: Work, spec: dict[str, Any], time_limit_s: float) -> Signed:
    """Do the work and say by which versions and source; what is sent to workers."""
    return work(spec, time_limit_s), environment()


def _ended(key: str, answer: Signed, *, where: str) -> Ended:
    solution, computed_by = answer
    _check_same(computed_by, where=where)
    return Ended(key, solution, computed_by=computed_by)


def _check_same(computed_by: Mapping[str, str], *, where: str) -> None:
    """Refuse a worker whose numbers need not be those of this process."""
    found = differences(environment(), computed_by)
    if found:
        raise InputError(
            f"other versions: {'; '.join(found)}", source=where,
            allowed="the same packages and source on every worker and here; what is done is kept",
        )  # fmt: skip


@dataclass(frozen=True)
class LocalExecutor:
    """Worker processes on this machine, one thread each, and what they do with a case."""

    workers: int
    work: Work = solve_specification

    def run(self, cases: Mapping[str, Case], *, time_limit_s: float) -> Generator[Ended]:
        """Compute the cases; give each as it ends."""
        orders = {
            key: (self.work, case.specification(), time_limit_s) for key, case in cases.items()
        }
        # the solver keeps the limit itself; this one is for a solver that hangs
        timeout_s = 1.5 * time_limit_s + 60.0
        with closing(answers(signed, orders, workers=self.workers, timeout_s=timeout_s)) as found:
            for key, answer in found:
                if answer.value is None:
                    yield Ended(key, None, answer.message)
                else:
                    yield _ended(key, answer.value, where="a worker of this machine")


@dataclass(frozen=True)
class DaskExecutor:
    """Workers of a dask cluster, as many as were known when the connection was made.

    `patience_s` is how long to go on without any.
    """

    address: str
    workers: int
    client: Any
    work: Work = solve_specification
    patience_s: float = _PATIENCE_S

    @classmethod
    def connect(
        cls, address: str, *, timeout_s: float = 10.0, patience_s: float = _PATIENCE_S
    ) -> DaskExecutor:
        """Connect to a scheduler, wait for a worker, and see that all are of this source.

        The address is `tcp://HOST:PORT`, or `tls://HOST:PORT` with the certificates of dask's
        configuration. Refused where dask is not installed, nobody answers within `timeout_s`, no
        worker comes within `patience_s`, now or later, or one has other versions.
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
        except (OSError, ValueError, TypeError, RuntimeError, TimeoutError) as error:
            raise InputError(
                f"no dask scheduler at {address} ({first_line(error)})",
                key="scheduler",
                allowed="tcp://HOST:PORT, or tls://HOST:PORT and the certificates of "
                "distributed.comm.tls in dask's configuration",
            ) from None
        made = cls(address, 1, client, patience_s=patience_s)
        made._wait_for_worker()
        return replace(made, workers=made._check_workers())

    def run(self, cases: Mapping[str, Case], *, time_limit_s: float) -> Generator[Ended]:
        """Compute the cases in a sliding window of a few a worker; give each as it ends.

        Workers may come and go, as under a batch system: the window follows their number, and dask
        sends the cases of a worker that died to another. Refused where the scheduler went away, all
        workers did, or one has other versions.
        """
        from distributed import as_completed

        todo = iter(cases.items())
        running = as_completed()
        keys: dict[str, str] = {}
        workers, counted = 0, -math.inf

        def fill() -> None:
            nonlocal workers, counted
            if time.monotonic() - counted > _LOOK_S:
                workers, counted = self._worker_count(), time.monotonic()
            while len(keys) < _AHEAD * max(1, workers):
                key, case = next(todo, ("", None))
                if case is None:
                    return
                future = self.client.submit(
                    signed, self.work, case.specification(), time_limit_s, key=f"case-{key}"
                )
                keys[future.key] = key
                running.add(future)

        fill()
        while keys:
            future = self._next(running)
            key = keys.pop(future.key)
            error = None if future.cancelled() else future.exception()
            if future.cancelled() or isinstance(error, CancelledError):
                raise self._went_away()
            if error is None:
                yield _ended(key, future.result(), where=f"a worker of {self.address}")
            else:
                yield Ended(key, None, f"{type(error).__name__}: {error}")
            fill()

    def _next(self, running: Any) -> Any:
        """Wait for a case to end; not for ever where nobody computes."""
        looked = time.monotonic()
        while not running.has_ready():
            time.sleep(0.02)
            if time.monotonic() - looked > _LOOK_S:
                if not self._worker_count():
                    self._wait_for_worker()
                looked = time.monotonic()
        return next(running)

    def _wait_for_worker(self) -> None:
        try:
            self.client.wait_for_workers(1, timeout=self.patience_s)
        except TimeoutError:
            raise InputError(
                f"no worker within {self.patience_s:g} s; all completed cases are kept",
                source=self.address,
                allowed="a scheduler with workers: dask worker ADDRESS --nthreads 1",
            ) from None

    def _check_workers(self) -> int:
        """Compare every worker with this process; return how many there are.

        One that goes away while it is asked is no longer a worker.
        """
        try:
            found = self.client.run(environment, on_error="return")
        except OSError:  # the scheduler, which passes the question on
            raise self._went_away() from None
        there = {k: answer for k, answer in found.items() if not isinstance(answer, OSError)}
        for worker, answer in there.items():
            if isinstance(answer, Exception):  # one without this package raises what it likes
                raise InputError(
                    f"a worker cannot say its versions ({first_line(answer)})", source=self.address,
                    allowed="dentscope, of this source, on every worker",
                )  # fmt: skip
            _check_same(answer, where=worker)
        return max(1, len(there))

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
