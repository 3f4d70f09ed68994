"""Command line of dentscope: `dentscope COMMAND --help`."""

from __future__ import annotations

import sys

from .core.threads import one_thread_each


def main() -> None:
    """Run the command line and leave with its exit code."""
    one_thread_each()  # before numpy is loaded
    from .cli import run

    sys.exit(run())


if __name__ == "__main__":
    main()
