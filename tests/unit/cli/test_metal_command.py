"""What `dentscope metal` says before it looks for a curve."""

import pytest
from dentscope.cli.metal import tell_contradictions
from made_sets import made_set


@pytest.mark.parametrize(("load", "told"), [("1000", False), ("1", True)])
def test_loads_in_kilonewtons_are_told(tmp_path, capsys, load, told):
    # 1 kN on a dent of 1.35 mm is 700 MPa, 2.8 times the strength; 1 N a thousandth of that
    found = made_set(
        tmp_path, target="Sy_Pa = 2.5e8\n", noise="dent_diameter_m = 5e-6\n", trial=["p"],
        angle_deg=[90], load_N=[load], dent_diameter_m=[1.35e-3],
    )  # fmt: skip
    tell_contradictions(found)
    assert ("contradiction: load of p" in capsys.readouterr().out) == told
