"""Reading a file whose format may claim anything, in a process that may not take much.

Some libraries believe what a file says of its own size, or end the process when memory runs out.
They run in a child with a limit of memory and of time; what it does not survive is one line.
"""

from __future__ import annotations

import os
import pickle
import resource
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

from ..errors import InputError
from .children import die_with, python_command

# limit: processor time of a confined child [s]
_CHILD_S = 60.0

# limit: memory of a confined child [bytes]
_CHILD_BYTES = 1_000_000_000

Result = TypeVar("Result")


def confined(work: Callable[..., Result], *arguments: Any, source: str) -> Result:
    """Do something in a child process within limits of memory and time.

    `work` is a function at the top of a module of this package; arguments and result are pickled.
    What it raises, or that it went beyond a limit, is an InputError that names `source`.
    """
    order = pickle.dumps((work.__module__, work.__qualname__, arguments))
    command = python_command("-m", __name__)
    try:
        child = subprocess.run(
            command, input=order, capture_output=True, timeout=_CHILD_S, check=False
        )
    except subprocess.TimeoutExpired:
        raise InputError(
            f"not read within {_CHILD_S:g} s", source=source, allowed="a smaller file, or CSV"
        ) from None
    if child.returncode != 0:
        raise InputError(
            f"holds, or claims to hold, more than {_CHILD_BYTES / 1e9:g} GB of memory takes, "
            "or is damaged", source=source, allowed="a smaller file, or CSV",
        )  # fmt: skip
    answer = pickle.loads(child.stdout)
    if isinstance(answer, InputError):
        raise answer
    return answer  # type: ignore[no-any-return]


def _child() -> None:
    die_with(os.getppid())
    module, name, arguments = pickle.load(sys.stdin.buffer)
    work = getattr(import_module(module), name)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = _CHILD_BYTES + pages * resource.getpagesize()  # beside the libraries themselves
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        answer = work(*arguments)
    except InputError as error:
        answer = error
    sys.stdout.buffer.write(pickle.dumps(answer))


if __name__ == "__main__":
    _child()
