"""Command line of dentscope: `dentscope COMMAND --help`."""

from __future__ import annotations

import sys

from .core.processes.children import forget_current_folder, plot_without_the_folders_settings
from .core.processes.streams import left_with, steady_streams
from .core.threads import one_thread_each


def main() -> None:
    """Run the command line and leave with its exit code."""
    forget_current_folder()
    one_thread_each()  # before numpy is loaded
    plot_without_the_folders_settings()
    steady_streams()
    from .cli import run

    sys.exit(left_with(run()))


if __name__ == "__main__":
    main()
