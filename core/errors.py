"""What a user did wrong, told in one line, and how a computation ended, told as a value.

`InputError` is for a mistake in what the user gave: the command line prints its single line and
ends with exit code 2. `Outcome` is what a solve, an integration or a fit returns instead of
raising: a computation that did not get there is a result with a reason, never a silent NaN.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Any

EXIT_INPUT_ERROR = 2
"""Exit code of the command line for a mistake in the input."""

EXIT_NOT_CONVERGED = 3
"""Exit code of the command line for a computation that did not reach its end."""


# limit: characters of a key or a message of an error [-]: some lines of a terminal
_KEY_SHOWN, _MESSAGE_SHOWN = 120, 800


def shortened(text: str, most: int) -> str:
    """Return a text of at most so many characters; what was left out of its middle is `...`.

    Examples
    --------
    >>> shortened("A" * 50, 20)
    'AAAAAAAAAA...AAAAAAA'
    """
    return text if len(text) <= most else f"{text[: most - 10]}...{text[-7:]}"


def printable(text: str) -> str:
    r"""Return a text of one line, control characters escaped.

    Names in a file must not command the terminal, nor pass for a line of their own.

    Examples
    --------
    >>> printable("a\x1b[2J\nb")
    'a\\x1b[2J\\nb'
    """
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


class InputError(ValueError):
    """A mistake in the user's input: file, key, value and what is allowed, in one line.

    - `message`: what is wrong, including the value found.
    - `source`: the file (or `"command line"`) the value came from.
    - `key`: the key, column or option within `source`.
    - `allowed`: what would have been accepted.

    Examples
    --------
    >>> str(InputError("-2e11 is negative", source="pair.toml", key="sphere.E_Pa",
    ...                allowed="a number above 0"))
    'pair.toml: sphere.E_Pa: -2e11 is negative (allowed: a number above 0)'
    """

    def __init__(self, message: str, *, source: str = "", key: str = "", allowed: str = "") -> None:
        self.message = message
        self.source = source
        self.key = key
        self.allowed = allowed
        shown = (source, shortened(key, _KEY_SHOWN), shortened(message, _MESSAGE_SHOWN))
        head = ": ".join(filter(None, shown))
        super().__init__(printable(f"{head} (allowed: {allowed})" if allowed else head))

    def at(self, source: str, key: str) -> InputError:
        """Return the same mistake where a person finds it."""
        return InputError(self.message, source=source, key=key, allowed=self.allowed)


class InputErrors(InputError):
    """Several mistakes found in one reading, one line each."""

    def __init__(self, errors: tuple[InputError, ...]) -> None:
        self.errors = errors
        ValueError.__init__(self, "\n".join(str(error) for error in errors))
        self.message, self.source, self.key, self.allowed = str(self), "", "", ""

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        """Cross to another process with every mistake."""
        return InputErrors, (self.errors,)


Mistake = tuple[str, str, str]
"""A mistake of a file that is named later: key, what is wrong, what is allowed."""


def amiss(rows: Iterable[tuple[object, str, str, str]]) -> Iterator[Mistake]:
    """Return the mistakes of a table: what a row begins with says whether it is one."""
    return ((key, message, allowed) for wrong, key, message, allowed in rows if wrong)


def in_file(found: Iterable[Mistake], source: str) -> tuple[InputError, ...]:
    """Return the mistakes of a file as errors that name it."""
    return tuple(InputError(m, source=source, key=k, allowed=allowed) for k, m, allowed in found)


def missing_extra(what: str, extra: str) -> InputError:
    """Return the line that says which optional packages something needs."""
    return InputError(
        f"{what} needs packages that are not installed", source="installation",
        allowed=f"pip install 'dentscope[{extra}]'",
    )  # fmt: skip


def optional(module: str, what: str, extra: str) -> Any:
    """Return a module that `what` needs, or refuse where its package, an extra, is missing."""
    try:
        return import_module(module)
    except ImportError:
        raise missing_extra(what, extra) from None


def first_line(error: BaseException) -> str:
    """Return what a library says of its failure, in one line; its kind where it says nothing."""
    lines = str(error).strip().splitlines()
    return lines[0][:120] if lines else type(error).__name__


@contextmanager
def reading(
    path: Path, allowed: str, failed: str = "cannot be read", *, raised: Any = Exception
) -> Iterator[None]:
    """Refuse a file in which a library fails with `raised`; by default with whatever it has."""
    try:
        yield
    except InputError:
        raise
    except raised as error:
        raise InputError(
            f"{failed} ({first_line(error)})", source=str(path), allowed=allowed
        ) from None


class Ending(Enum):
    """How a computation ended; the value is the stored code."""

    COMPLETED = "completed"
    NOT_CONVERGED = "not-converged"
    OUT_OF_RANGE = "out-of-range"
    TIME_LIMIT = "time-limit"
    STEP_LIMIT = "step-limit"
    WORKER_LOST = "worker-lost"
    CRASHED = "crashed"


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a computation ended, how far it got, and what to try.

    `ending`: the kind of end; `message`: one sentence: what happened and how far it got; `advice`:
    one sentence: what to try next; empty when completed.
    """

    ending: Ending
    message: str = ""
    advice: str = ""

    @property
    def completed(self) -> bool:
        """Whether the computation reached the end it was asked for."""
        return self.ending is Ending.COMPLETED

    def __str__(self) -> str:
        return " ".join(filter(None, (f"{self.ending.value}:", self.message, self.advice)))


COMPLETED = Outcome(Ending.COMPLETED)
