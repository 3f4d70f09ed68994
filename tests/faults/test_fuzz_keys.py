"""The short form of `tools/benchmarks/fuzz_keys.py`: legal but extreme files to every command."""

import importlib.util
from pathlib import Path

import pytest

_FILE = Path(__file__).parents[2] / "tools" / "benchmarks" / "fuzz_keys.py"
_SPEC = importlib.util.spec_from_file_location("fuzz_keys", _FILE)
fuzz = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(fuzz)

QUICK = ("inverse", "case", "recordings", "export")


def test_the_same_seed_makes_the_same_input():
    first, second = (fuzz.one(4, 7) for _ in range(2))
    assert first["text"] == second["text"]
    assert first["kind"] == "inverse"


@pytest.mark.parametrize("number", range(60))
def test_an_extreme_file_is_answered_or_refused(number):
    found = fuzz.one(number, 11, kinds=QUICK)
    assert found["told"] in ("answered", "refused", "not ended"), found["text"] + found["where"]


@pytest.mark.parametrize(
    ("out", "told"),
    [("a  nan", "NAN"), ("e = inf", "NAN"), ("banana infinite", "answered"), ("0.5", "answered")],
)
def test_a_nan_with_exit_code_0_is_a_fault(out, told):
    assert fuzz.judged("impact", 0, out, "") == told


def test_faults_are_told_from_refusals():
    assert fuzz.judged("impact", 2, "", "a.toml: target.nu: 0.7\n") == "refused"
    assert fuzz.judged("impact", 2, "", "") == "UNSAID"
    assert fuzz.judged("impact", 2, "", "depth: a depth is not a number") == "UNSAID"
    assert fuzz.judged("impact", 1, "", "Traceback (most recent call last)") == "TRACEBACK"
    assert fuzz.judged("impact", 3, "", "budget") == "not ended"
