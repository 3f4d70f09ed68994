"""What `dentscope metal` says before it looks for a curve."""

import pytest
from dentscope.cli.metal import tell_contradictions
from dentscope.recordings import read

SET = """
format = "recording-set/1"
name = "presses"
[target]
E_Pa = 2e11
nu = 0.3
Sy_Pa = 2.5e8
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.005
mass_kg = 0.004
E_Pa = 2.1e11
nu = 0.3
[noise]
dent_diameter_m = 5e-6
"""


@pytest.mark.parametrize(("load", "told"), [("1000", False), ("1", True)])
def test_loads_in_kilonewtons_are_told(tmp_path, capsys, load, told):
    # 1 kN on a dent of 1.35 mm is 700 MPa, 2.8 times the strength; 1 N a thousandth of that
    (tmp_path / "set.toml").write_text(SET)
    (tmp_path / "trials.csv").write_text(
        f"trial,striker,angle_deg,load_N,dent_diameter_m\np,ball,90,{load},1.35e-3\n"
    )
    tell_contradictions(read(tmp_path))
    assert ("contradiction: load of p" in capsys.readouterr().out) == told
