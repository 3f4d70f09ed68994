"""docs/theory.md lists every numbered equation of the thesis once, with functions that exist."""

import importlib
import re
from pathlib import Path

import pytest

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


def numbers(text):
    for chapter, first, last in NUMBER.findall(text):
        yield from ((int(chapter), n) for n in range(int(first), int(last or first) + 1))


def listed():
    # the bracket only says which of them are corrected
    return [n for equation, _, _ in rows() for n in numbers(re.sub(r"\(.*?\)", "", equation))]


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


def test_every_corrected_equation_has_an_erratum():
    errata = (DOCS / "thesis" / "errata.md").read_text("utf-8")
    known = set(numbers(" ".join(re.findall(r"\*\*(.*?)\*\*", errata))))
    for equation, _, _ in rows():
        if "corrected)" in equation:
            assert known & set(numbers(equation)), equation
