"""Registers: every tuned number of a stage named, with its unit, its source, and a use."""

import re
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STAGES = sorted(path.parent.name for path in ROOT.glob("*/rules.py"))
MOST = 350


def register(stage):
    return import_module(f"dentscope.{stage}.rules").RULES


def test_the_stages_that_choose_numbers_have_a_register() -> None:
    chosen = {"core", "fem", "fitting", "models", "campaigns", "impact", "recordings"}
    assert chosen | {"discrepancy", "reduce", "start"} == set(STAGES)
    assert sum(len(fields(register(stage))) for stage in STAGES) <= MOST


@pytest.mark.parametrize("stage", STAGES)
def test_each_number_says_what_it_is_and_where_it_is_from(stage) -> None:
    rules = register(stage)
    assert is_dataclass(rules)
    assert type(rules).__dataclass_params__.frozen
    for item in fields(rules):
        told = item.metadata
        assert re.search(r"\[[^\]]+\]", told["meaning"]), f"{item.name}: no unit"
        assert len(told["source"]) > 3, f"{item.name}: no source"
        for named in re.findall(r"(?:benchmarks|docs)/[\w./-]+\w", told["source"]):
            assert (ROOT / named).is_file(), f"{item.name}: {named}"


@pytest.mark.parametrize("stage", STAGES)
def test_each_number_has_a_use(stage) -> None:
    text = "\n".join(
        path.read_text(encoding="utf-8")
        for folder in (stage, "cli", "studies")
        for path in (ROOT / folder).rglob("*.py")
        if path != ROOT / stage / "rules.py"
    )
    unused = [f.name for f in fields(register(stage)) if not re.search(rf"RULES\.{f.name}\b", text)]
    assert not unused


def test_a_register_is_made_in_one_place() -> None:
    for path in ROOT.glob("*/*.py"):
        assert "def _rule(" not in path.read_text(encoding="utf-8"), path
