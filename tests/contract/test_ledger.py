"""The ledger of sizes: growth is found, told, and counted without blanks, comments, docstrings."""

import ast
import runpy
from pathlib import Path

LEDGER = runpy.run_path(str(Path(__file__).resolve().parents[2] / "tools" / "ledger.py"))
SIZE = {"lines": 150.0, "code": 100.0, "modules": 50.0, "numbers": 10.0, "words": 0.0}


def test_a_part_that_grew_by_more_than_two_percent_is_found():
    assert LEDGER["grown"]({"fem": SIZE | {"code": 102.0, "lines": 900.0}}, {"fem": SIZE}) == {}
    assert LEDGER["grown"]({"fem": SIZE | {"code": 103.0}}, {"fem": SIZE}) == {"fem": ["code"]}
    assert LEDGER["grown"]({"new": SIZE}, {}) == {"new": ["code", "modules", "numbers"]}


def test_growth_is_excused_where_the_newest_version_says_what_for():
    older = "## 0.3.0\n\nFor developers:\n\n- cli grew: long ago\n"
    newest = "## 0.4.0\n\n- cli grew: to users\n\nFor developers:\n\n- fem grew: C\n- core grew:\n"
    assert LEDGER["accounted"]("# Changelog\n\n" + newest + older) == {"fem"}


def test_lines_of_code_are_without_blanks_comments_and_docstrings():
    text = '"""Told\nwell."""\n\nX = (  # a comment\n    1,\n)\n# alone\ndef f():\n    """Do."""\n'
    assert LEDGER["code_lines"](text, ast.parse(text)) == {4, 5, 6, 8}


def test_every_stage_is_in_it():
    assert {"fem", "fitting", "models", "campaigns", "dynamics", "reduce"} < set(LEDGER["parts"]())
