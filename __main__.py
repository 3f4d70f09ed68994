"""Command line of dentscope: `dentscope COMMAND --help`."""

from __future__ import annotations

import sys

from .core.processes.children import (
    compile_without_the_folders_settings,
    forget_current_folder,
    plot_without_the_folders_settings,
)
from .core.processes.stopping import STOPS, listening, stopped
from .core.processes.streams import left_with, steady_streams
from .core.processes.threads import one_thread_each


def main() -> None:
    """Run the command line and leave with its exit code."""
    try:
        with listening():
            code = _run()
    except STOPS as stop:  # while it is loaded
        sys.stderr.write("stopped\n")
        code = stopped(stop)
    sys.exit(code)


def _run() -> int:
    forget_current_folder()
    one_thread_each()  # before numpy is loaded
    plot_without_the_folders_settings()
    compile_without_the_folders_settings()
    steady_streams()
    from .cli import run

    return left_with(run())


if __name__ == "__main__":
    main()
