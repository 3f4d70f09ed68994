"""docs/theory.md lists every numbered equation of the thesis once, with functions that exist."""

import importlib
import re
from pathlib import Path

import pytest
from dentscope.studies.thesis.viscous import paradox

DOCS = Path(__file__).parents[3] / "docs"
THEORY = DOCS / "theory.md"
# equations of each chapter, counted in the thesis
COUNT = {1: 22, 2: 43, 3: 7, 4: 32, 5: 14}
ROW = re.compile(r"^\| ([^|]+) \| ([^|]+) \| (.+) \|$", re.MULTILINE)
NUMBER = re.compile(r"(\d)\.(\d+)(?:-\1\.(\d+))?")


def rows():
    # the chapters' tables; what follows them speaks of laws and where they serve
    tables, _, _ = THEORY.read_text("utf-8").partition("## Which law to use when")
    return [m.groups() for m in ROW.finditer(tables)]


def listed():
    found = []
    for equation, _, _ in rows():
        # the bracket only says which of them are corrected
        for chapter, first, last in NUMBER.findall(re.sub(r"\(.*?\)", "", equation)):
            found += [(int(chapter), n) for n in range(int(first), int(last or first) + 1)]
    return found


def test_every_equation_is_listed_once():
    expected = [(chapter, n) for chapter, count in COUNT.items() for n in range(1, count + 1)]
    assert sorted(listed()) == expected


def names():
    text = THEORY.read_text("utf-8")
    return sorted(set(re.findall(r"`((?:core|models|fem|impact)\.[\w.]+)`", text)))


@pytest.mark.parametrize("name", names())
def test_every_named_function_exists(name):
    parts = name.split(".")
    for cut in range(len(parts), 0, -1):
        try:
            thing = importlib.import_module(".".join(["dentscope", *parts[:cut]]))
        except ModuleNotFoundError:
            continue
        for part in parts[cut:]:
            fields = getattr(thing, "__dataclass_fields__", {})
            thing = fields[part] if part in fields else getattr(thing, part)
        return
    pytest.fail(f"{name} is nowhere")


def test_every_row_has_a_function_or_says_why_not():
    for equation, _, function in rows():
        if NUMBER.search(equation):
            assert "`" in function or function.startswith("no function: ")


def test_the_numbers_of_the_paradox():
    told = paradox(mass=0.05, stiffness=2e6, damping=120.0, speed=1.3)
    text = (DOCS / "thesis" / "chapter-1.md").read_text("utf-8")
    assert f"push with {told.force_at_touch:.0f} N at first touch" in text
    assert f"hold back with {-told.pull_at_return:.0f} N at the end" in text
    assert f"a depth of {told.depth_at_zero_force * 1e6:.0f} um stays" in text
