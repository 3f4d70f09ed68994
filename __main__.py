"""Command line of dentscope: `dentscope COMMAND --help`."""

from __future__ import annotations

import sys

from .core.children import forget_current_folder, plot_without_the_folders_settings
from .core.threads import one_thread_each


def main() -> None:
    """Run the command line and leave with its exit code."""
    forget_current_folder()
    one_thread_each()  # before numpy is loaded
    plot_without_the_folders_settings()
    from .cli import run

    sys.exit(run())


if __name__ == "__main__":
    main()
