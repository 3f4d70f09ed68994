"""Which tuned numbers no unit test notices: each is changed by a factor while its tests run.

    python tools/benchmarks/unnoticed_rules.py           # every number, halved and doubled: hours
    python tools/benchmarks/unnoticed_rules.py --random 11 --factor 3
    python tools/benchmarks/unnoticed_rules.py --stage recordings

Limits, which no result hangs on, are left out. A number counts as noticed by the first unit test of
its stage that fails; without a change all of them pass. Numbers that compiled code takes in are
compiled anew, in a folder of their own.
"""

import argparse
import ast
import os
import random
import subprocess
import sys
import tempfile
from dataclasses import fields
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAGES = sorted(path.parent.name for path in ROOT.glob("*/rules.py"))


def changed(value: object, factor: float) -> object:
    """The number, or each of several, times the factor; a whole one stays whole and differs."""
    if isinstance(value, tuple):
        return tuple(changed(one, factor) for one in value)
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return max(round(value * factor), value + 1 if factor > 1.0 else 0)
    return value * factor


def meaning(stage: str, name: str) -> str:
    """What a register says of a number, without loading its stage."""
    for node in ast.walk(ast.parse((ROOT / stage / "rules.py").read_text(encoding="utf-8"))):
        if isinstance(node, ast.AnnAssign) and ast.unparse(node.target) == name:
            return ast.literal_eval(node.value.args[1])
    raise KeyError(name)


def tests_under(stage: str, name: str, factor: float, tests: list[str]) -> int:
    """Run tests in this process with one number changed; pytest's exit status."""
    import pytest
    from dentscope.core import rules

    if stage == "core":
        object.__setattr__(rules.RULES, name, changed(getattr(rules.RULES, name), factor))
    else:
        # changed while the register is made: some modules take a number's value as they are loaded
        told, plain = meaning(stage, name), rules.rule
        rules.rule = lambda value, said, *source: plain(
            changed(value, factor) if said == told else value, said, *source
        )
    return int(pytest.main(["-q", "-x", "-p", "no:cacheprovider", "--no-header", *tests]))


def noticed(stage: str, name: str, factor: float) -> str:
    """The test that notices, or nothing."""
    uses = [
        path
        for path in (ROOT / stage).rglob("*.py")
        if f"RULES.{name}" in path.read_text(encoding="utf-8")
    ]
    compiled = any("jit" in path.read_text(encoding="utf-8") for path in uses)
    # the tests that name a module of its use first, then the rest of the stage's
    words = {path.stem for path in uses}
    tests = sorted(
        (ROOT / "tests" / "unit" / stage).rglob("test_*.py"),
        key=lambda path: not any(word in path.read_text(encoding="utf-8") for word in words),
    )
    with tempfile.TemporaryDirectory() as folder:
        fresh = {"NUMBA_CACHE_DIR": folder} if compiled else {}
        ran = subprocess.run(
            [sys.executable, __file__, "--child", stage, name, str(factor), *map(str, tests)],
            cwd=ROOT, capture_output=True, text=True, env={**os.environ, **fresh}, check=False,
        )  # fmt: skip
    failed = [line for line in ran.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return (
        failed[0] if ran.returncode and failed else "" if not ran.returncode else ran.stderr[-99:]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--stage", choices=STAGES)
    parser.add_argument("--random", type=int, metavar="N", help="only so many, drawn")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--factor", type=float, nargs="+", default=[0.5, 2.0])
    given = parser.parse_args()
    stages = [given.stage] if given.stage else STAGES
    numbers = [
        (stage, item.name)
        for stage in stages
        for item in fields(import_module(f"dentscope.{stage}.rules").RULES)
    ]
    if given.random:
        numbers = random.Random(given.seed).sample(numbers, given.random)
    seen = 0
    for stage, name in numbers:
        by = next(filter(None, (noticed(stage, name, factor) for factor in given.factor)), "")
        seen += bool(by)
        print(f"{stage}.{name}: {by or 'noticed by no unit test'}", flush=True)
    print(f"{seen} of {len(numbers)} noticed")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        sys.exit(tests_under(sys.argv[2], sys.argv[3], float(sys.argv[4]), sys.argv[5:]))
    main()
