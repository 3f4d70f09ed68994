"""Six finite-element curves that may not move unnoticed; see regenerate.py."""

import json
import runpy
from pathlib import Path
from types import SimpleNamespace

import pytest
from dentscope import fem

golden = SimpleNamespace(**runpy.run_path(str(Path(__file__).with_name("regenerate.py"))))
KNOWN = json.loads(golden.FILE.read_text())
pytestmark = pytest.mark.fe


def moved(name, new):
    found = golden.differences(new, KNOWN["curves"][name])
    return {key: value for key, value in found.items() if value > golden.TOLERANCE[key]}


@pytest.mark.parametrize("name", golden.CASES)
def test_the_curve_has_not_moved(name):
    assert KNOWN["numerics_version"] == fem.NUMERICS_VERSION
    assert not moved(name, golden.solved(name))


def test_one_percent_of_strength_is_noticed():
    assert "force" in moved("1-1", golden.solved("1-1", strength=1.01))
