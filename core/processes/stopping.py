"""Ctrl-C ends a command, wherever it is.

Python turns it into an exception once. Where that falls into a callback of a library, as a weak
reference's or one that C code calls, it is printed or lost, and the command goes on. Here it comes
again until the command has taken notice.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

AGAIN_S = 0.5
"""After how long an interruption that nobody has heard comes again."""


@contextmanager
def listening() -> Iterator[None]:
    """Let the first Ctrl-C end what runs inside; a handler of the user's own stays."""
    main = threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT)
    if not main or before is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, _interrupt)
    try:
        yield
    finally:
        heard()
        signal.signal(signal.SIGINT, before)


def heard() -> None:
    """Say that the interruption has arrived; what is still to be tidied up is left in peace."""
    if threading.current_thread() is threading.main_thread():
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    signal.signal(signal.SIGALRM, _interrupt)
    signal.setitimer(signal.ITIMER_REAL, AGAIN_S)
    raise KeyboardInterrupt
