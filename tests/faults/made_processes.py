"""Pythons of their own for the tests."""

import subprocess
import sys


def python(*words, check=False, timeout=300, **given):
    """Run a Python with these words to its end; what it prints is text."""
    words = [sys.executable, *map(str, words)]
    return subprocess.run(
        words, capture_output=True, text=True, check=check, timeout=timeout, **given
    )
