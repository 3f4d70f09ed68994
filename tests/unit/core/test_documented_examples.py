"""What the documentation shows is run: docstring examples, the README's block and its commands."""

import doctest
import importlib
import math
import re
from pathlib import Path

import dentscope
import pytest
from dentscope.core import Pair

ROOT = Path(dentscope.__file__).parent
STAGES = sorted(p.parent.name for p in ROOT.glob("*/__init__.py"))
EXAMPLES = [
    "dentscope." + ".".join(path.relative_to(ROOT).with_suffix("").parts)
    for stage in STAGES
    for path in sorted((ROOT / stage).rglob("*.py"))
    if ">>>" in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", EXAMPLES)
def test_docstring_examples_show_what_happens(name):
    outcome = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert outcome.attempted > 0
    assert outcome.failed == 0


def test_readme_block_gives_a_force_below_hertz():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    names = {}
    exec(compile(block, "README.md", "exec"), names)
    pair, depth = names["pair"], 20e-6
    assert isinstance(pair, Pair)
    # Johnson, Contact Mechanics (1985), Eq. 4.23: the elastic force, which yielding lowers
    hertz = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R * depth**3)
    assert 0.2 * hertz < float(names["force"]) < hertz


def test_every_target_that_the_readme_names_exists():
    named = set(re.findall(r"`make ([a-z]+)`", (ROOT / "README.md").read_text(encoding="utf-8")))
    listed = re.findall(r"^([a-z]+):.*## ", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
    assert {"install", "campaign", "docs", "test"} <= named <= set(listed)


def test_the_lock_of_every_supported_python_pins_each_dependency_with_hashes():
    declared = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    direct = re.search(r"^dependencies = \[(.*?)\]", declared, flags=re.MULTILINE | re.DOTALL)
    names = re.findall(r'"([A-Za-z0-9-]+)', direct.group(1))
    locks = sorted((ROOT / "tools" / "requirements").glob("py3*.txt"))
    assert [lock.stem for lock in locks] == ["py311", "py312", "py313", "py314"]
    for lock in locks:
        blocks = re.split(r"\n(?=\S)", lock.read_text(encoding="utf-8"))
        pinned = {block.split("==")[0].lower() for block in blocks if "--hash=sha256:" in block}
        assert len(pinned) == len(blocks)
        assert {name.lower() for name in names} <= pinned
        assert "http" not in "".join(re.findall(r"^--.*$", "\n".join(blocks), flags=re.MULTILINE))
