"""Values that leave a number unstated are equal to their like, on every Python."""

import ast
import pickle
from functools import lru_cache
from pathlib import Path

import pytest
from dentscope.core import Material, Pair
from dentscope.discrepancy.mechanisms.base import Surroundings
from dentscope.impact.scene import Friction, Striker

ROOT = Path(__file__).resolve().parents[2]
APART = {"tests", "benchmarks", "examples", "docs", "scripts", "data", "build"}


def name_of(node: ast.expr) -> str:
    return ast.unparse(node.func if isinstance(node, ast.Call) else node).rsplit(".", 1)[-1]


def classes_that_may_leave_a_number_out():
    for path in ROOT.rglob("*.py"):
        first = path.relative_to(ROOT).parts[0]
        if first in APART or first.startswith("."):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.ClassDef):
                continue
            decorators = {name_of(d) for d in node.decorator_list}
            fields = [b for b in node.body if isinstance(b, ast.AnnAssign) and b.value is not None]
            if "dataclass" in decorators and any(name_of(f.value) == "nan" for f in fields):
                yield node.name, decorators


def test_a_dataclass_with_an_unstated_number_compares_by_what_is_stated():
    found = dict(classes_that_may_leave_a_number_out())
    assert {"Material", "Striker", "Surroundings"} <= set(found)
    assert not [name for name, decorators in found.items() if "unstated_equal" not in decorators]


@pytest.mark.parametrize(
    "make",
    [
        lambda: Material(E=200e9, nu=0.3, density=float("nan")),
        lambda: Pair(Material(E=200e9, nu=0.3, density=float("nan")), Material(70e9, 0.3), 0.01),
        lambda: Striker(0.1, 0.01, radius=float("nan")),
        lambda: Friction(0.2, mu_static=float("nan")),
        lambda: Surroundings(thickness=float("nan"), temperature=310.0),
    ],
)
def test_what_was_stored_is_what_is_read(make):
    one, other = make(), pickle.loads(pickle.dumps(make()))
    assert one == other
    assert hash(one) == hash(other)
    asked = []
    kept = lru_cache(lambda value: asked.append(value))
    kept(one), kept(other)
    assert len(asked) == 1


def test_a_number_that_is_stated_tells_values_apart():
    steel = Material(E=200e9, nu=0.3)
    assert steel != steel.with_(density=7800.0)
    assert steel != steel.with_(nu=0.29)
    assert steel != "steel"
    assert steel.with_(density=7800.0) == steel.with_(density=7800.0)
