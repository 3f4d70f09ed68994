"""Processor seconds until each command's help is shown, and until a wrong use of it is refused.

python tools/benchmarks/bench_commands.py          every command, slowest first
python tools/benchmarks/bench_commands.py reduce   those that begin so
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer.main
from dentscope.cli.app import app

WRONG = """
impact wrong.toml
case wrong.toml
inverse wrong.toml
diagnose folder
recordings check folder
recordings audit folder
recordings new folder
laws show nonsense
laws compare wrong.toml
export law nonsense
export dem wrong.toml
reduce video wrong.toml
reduce tip wrong.toml
reduce mocap wrong.toml
reduce scan wrong.toml --unit um --step-m 1e-6
reduce sound wrong.toml
reduce table wrong.toml --holds force
campaign run --design huge
campaign status --design huge
campaign show zz
campaign publish --design huge
campaign refine zz
fit wrong.toml
figures --chapter 9
verify --only nonsense
proof run --list nonsense
keys nonsense
examples --to wrong.toml
"""


def main(start: str) -> None:
    """Print processor seconds, exit code and the first line told of each use."""
    command = [sys.executable, "-m", "dentscope"]
    helps = [f"{name} -h".strip() for name in _commands(typer.main.get_command(app), "")]
    uses = [use for use in (*helps, *WRONG.strip().splitlines()) if use.startswith(start)]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "wrong.toml").write_text("nothing = 1\n")
        (Path(folder) / "folder").mkdir()
        for use in uses:
            process = subprocess.Popen(
                [*command, *use.split()], cwd=folder, text=True,
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            )  # fmt: skip
            told = process.stderr.read() if process.stderr else ""
            _, status, used = os.wait4(process.pid, 0)
            code = os.waitstatus_to_exitcode(status)
            rows.append((used.ru_utime + used.ru_stime, code, use, told.split("\n")[0][:60]))
    for seconds, code, use, told in sorted(rows, reverse=True):
        print(f"{seconds:6.2f} s  exit {code}  {use:32} {told}")


def _commands(command: Any, name: str) -> Iterator[str]:
    yield name
    for word, below in getattr(command, "commands", {}).items():
        if not below.hidden:
            yield from _commands(below, f"{name} {word}".strip())


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "")
