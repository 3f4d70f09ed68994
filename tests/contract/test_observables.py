"""Facts about observables stand in one place: core/observables.py."""

import ast
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.observables import OBSERVABLES
from dentscope.discrepancy.comparison.cells import compared
from dentscope.dynamics.stepping.layout import OBSERVABLES as SIMULATED
from dentscope.recordings.columns import TRIAL_COLUMNS

ROOT = Path(__file__).parents[2]
STAGES = (
    "core", "fem", "models", "campaigns", "fitting", "dynamics", "recordings", "reduce",
    "discrepancy", "cli",
)  # fmt: skip
CHOICES = {
    ("dynamics/stepping/layout.py", "OBSERVABLES"): "order of the integrator's row",
    ("dynamics/tabulated/energy_route.py", "NAMES"): "order of a computed row",
    ("reduce/mocap/reduction.py", "_NAMES"): "order of a computed vector",
    ("reduce/mocap/point.py", "_NAMES"): "order of a computed vector",
    ("reduce/table/sheet/words.py", "DENTS"): "of which several readings are one trial's",
    ("reduce/table/sheet/words.py", "KINDS"): "words of laboratories' headers",
    ("dynamics/columns.py", "_SHOWN"): "which columns a screen shows",
    ("dynamics/batch.py", "_NOTHING"): "what a normal impact without vibration lacks",
    ("discrepancy/metal/estimate.py", "MARKS"): "which observables are marks left in a metal",
    ("dynamics/export/discrete_elements.py", "HEAD"): "columns beside a law's parameters",
    ("dynamics/report/band.py", "SWEPT"): "which numbers of a sweep have a band",
    ("recordings/template.py", "_COLUMNS"): "which columns a set to fill in begins with",
    ("dynamics/report/draw.py", "SWEPT"): "which observables a figure shows",
}
"""Tuples that choose or order observables and say nothing of them."""

COMPOSED = {"below_flat_s", "dent_diameter_m", "press_depth_m", "recovered_depth_m"}
"""What no single number of an impact is: of several, or of a press."""

FEW = 3


def names_in(node):
    """Observables among the keys or entries of a literal, rows of rows included."""
    entries = node.keys if isinstance(node, ast.Dict) else node.elts
    found = set()
    for entry in entries:
        if isinstance(entry, ast.Constant) and entry.value in OBSERVABLES:
            found.add(entry.value)
        elif isinstance(entry, ast.Tuple | ast.List):
            found |= {e.value for e in entry.elts if isinstance(e, ast.Constant)} & set(OBSERVABLES)
    return found


def is_stated(node):
    """Whether a literal holds what a person wrote, and not numbers that the program computed."""
    if isinstance(node, ast.Dict):
        return any(isinstance(v, ast.Constant | ast.Tuple | ast.List) for v in node.values)
    return True


def tables_in(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    owner = {}
    for statement in ast.walk(tree):
        if isinstance(statement, ast.Assign | ast.AnnAssign):
            targets = getattr(statement, "targets", None) or [statement.target]
            named = ast.unparse(targets[0])
            owner |= {id(node): named for node in ast.walk(statement)}
    return [
        owner.get(id(node), f"line {node.lineno}")
        for node in ast.walk(tree)
        if isinstance(node, ast.Dict | ast.Tuple | ast.List | ast.Set)
        and len(names_in(node)) >= FEW
        and is_stated(node)
    ]


def test_no_other_module_holds_a_table_of_observables():
    found = {
        (str(path.relative_to(ROOT)), name)
        for stage in STAGES
        for path in (ROOT / stage).rglob("*.py")
        for name in tables_in(path)
        # in which direction a mechanism moves each observable is a fact about the mechanism
        if name != "direction"
    }
    assert found == set(CHOICES)


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ('UNIT = {"restitution": "-", "contact_time_s": "s", "peak_force_N": "N"}', 1),
        ('LOG = ("restitution", "contact_time_s", "peak_force_N")', 1),
        ('S = (("e", "restitution"), ("t", "contact_time_s"), ("F", "peak_force_N"))', 1),
        ('P = {n: 1 for n in ["restitution", "contact_time_s", "peak_force_N"]}', 1),
        ('def f():\n return {"restitution": e, "contact_time_s": t, "peak_force_N": F}', 0),
        ('LOG = ("restitution", "contact_time_s", "trial")', 0),
    ],
)
def test_the_walk_sees_tables_and_not_results(tmp_path, text, count):
    (tmp_path / "a.py").write_text(text)
    assert len(tables_in(tmp_path / "a.py")) == count


def test_every_row_reaches_files_and_simulation():
    for name, row in OBSERVABLES.items():
        assert row.simulated in SIMULATED or (name in COMPOSED and not row.simulated)
        assert (name in TRIAL_COLUMNS) is row.in_trials
        if row.log:
            assert row.low == 0.0, "a logarithm of what may be negative"


def test_units_for_people_follow_from_the_column():
    shown = {name: (row.unit, row.scale) for name, row in OBSERVABLES.items()}
    assert shown["restitution"] == ("-", 1.0)
    assert shown["peak_depth_m"] == ("um", 1e6)
    assert shown["contact_time_s"] == ("ms", 1e3)
    assert shown["normal_impulse_Ns"] == ("N s", 1.0)
    assert shown["rebound_spin_rad_s"] == ("rad/s", 1.0)
    assert OBSERVABLES["peak_force_N"].axis == "peak force [kN]"


def test_what_is_compared():
    values = np.array([1.0, np.e, 0.0])
    np.testing.assert_allclose(compared("contact_time_s", values), [0.0, 1.0, np.log(1e-9)])
    # a rebound may be none at all, and near 1 a logarithm says nothing that the number does not
    np.testing.assert_array_equal(compared("restitution", values), values)
    assert compared("rebound_spin_rad_s", -values) is not None
    np.testing.assert_array_equal(compared("rebound_spin_rad_s", -values), -values)
