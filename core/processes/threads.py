"""How many threads the linear algebra libraries may start."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

_P = ParamSpec("_P")
_R = TypeVar("_R")

_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def one_thread_each() -> None:
    """Let processes that start from now on, and libraries not loaded yet, use one thread.

    Work here is spread over cases, and a factorisation's blocks are small: the threads that a
    library would start of its own accord double the processor time and save nothing. What the
    user has set is left alone.
    """
    for name in _VARIABLES:
        os.environ.setdefault(name, "1")


def in_one_thread(work: Callable[_P, _R]) -> Callable[_P, _R]:
    """Return the function with linear algebra in one thread, also where libraries are loaded.

    How a library shares a sum among threads changes its last bits: results shall not depend on it.
    """

    @wraps(work)
    def alone(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        # not before it is needed: the command line sets its environment first
        from threadpoolctl import threadpool_limits

        with threadpool_limits(1, user_api="blas"):
            return work(*args, **kwargs)

    return alone
