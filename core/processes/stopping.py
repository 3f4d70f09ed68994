"""Ctrl-C and SIGTERM end a command, wherever it is.

Python turns Ctrl-C into an exception once. Where that falls into a callback of a library, as a weak
reference's or one that C code calls, it is printed or lost, and the command goes on. Here both
signals raise it, and it comes again until the command has taken notice; what else a command fails
of after that is the interruption, which a library turned into an error of its own.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

# limit: after how long an interruption that nobody has heard comes again [s]
AGAIN_S = 0.5

_asked: list[int] = []
"""Signals that nobody has taken notice of."""

_DEFAULT: dict[int, Any] = {
    signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL,
}  # fmt: skip


class Stopped(BaseException):
    """A signal asks the command to end; no library takes this for a Ctrl-C of its own."""

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__()
        self.number = number


STOPS = (KeyboardInterrupt, Stopped)
"""What ends a command early: a user's own handler of Ctrl-C raises the first."""


@contextmanager
def listening() -> Iterator[None]:
    """Let the first Ctrl-C or SIGTERM end what runs inside; handlers of the user's own stay."""
    main = threading.current_thread() is threading.main_thread()
    ours = [n for n, plain in _DEFAULT.items() if main and signal.getsignal(n) is plain]
    for number in ours:
        signal.signal(number, _stop)
    hook = sys.unraisablehook
    if ours:  # one that a callback swallows comes again: no word of it
        sys.unraisablehook = lambda lost: None if lost.exc_type is Stopped else hook(lost)
    try:
        yield
    except Exception:
        if _asked:
            raise Stopped(_asked[-1]) from None
        raise
    finally:
        if ours:
            heard()
            sys.unraisablehook = hook
        for number in ours:
            signal.signal(number, _DEFAULT[number])


def heard() -> None:
    """Say that the interruption has arrived; what is still to be tidied up is left in peace."""
    if threading.current_thread() is threading.main_thread():
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        _asked.clear()


def stopped(stop: BaseException) -> int:
    """Take notice of an interruption; return the exit code, as a shell has it.

    Examples
    --------
    >>> stopped(KeyboardInterrupt()), stopped(Stopped(signal.SIGTERM))
    (130, 143)
    """
    heard()
    return 128 + getattr(stop, "number", signal.SIGINT)


def _stop(number: int, _frame: FrameType | None) -> None:
    def again(_number: int, frame: FrameType | None) -> None:
        _stop(number, frame)

    _asked.append(number)
    signal.signal(signal.SIGALRM, again)
    signal.setitimer(signal.ITIMER_REAL, AGAIN_S)
    raise Stopped(number)
