"""How many threads the linear algebra libraries may start."""

from __future__ import annotations

import os

_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def one_thread_each() -> None:
    """Let processes that start from now on, and libraries not loaded yet, use one thread.

    Work here is spread over cases, and a factorisation's blocks are small: the threads that a
    library would start of its own accord double the processor time and save nothing. What the
    user has set is left alone.
    """
    for name in _VARIABLES:
        os.environ.setdefault(name, "1")
