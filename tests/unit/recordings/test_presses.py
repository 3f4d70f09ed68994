"""Quasi-static presses of a recording set: read, written again, checked against mechanics."""

import math

import numpy as np
import pytest
from dentscope.recordings import Severity, audit, read, write

SET = """
format = "recording-set/1"
name = "ball and plate"
[target]
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = { value = 3.5e8, std = 2.0e7 }
hardness_Pa = { value = 1.0e9, std = 5.0e7 }
[strikers.ball]
shape = "sphere"
tip_radius_m = 5e-3
density_kg_m3 = 7800
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 2.0e9
[noise]
permanent_depth_m_relative = 0.02
dent_diameter_m_relative = 0.01
recovered_depth_m_relative = 0.02
load_N_relative = 0.005
dent_edge = "rim"
[gauge]
permanent_depth_m = 0.02
"""
HEAD = "trial,striker,impact_speed_m_s,angle_deg,load_N,press_rate_per_s,permanent_depth_m,"
HEAD += "dent_diameter_m,recovered_depth_m\n"
PRESSURE, MODULUS = 1.0e9, 2.0e11 / 0.91 / 2.0


def press(name, load, *, diameter=1.0, recovered=1.0):
    a = math.sqrt(load / (math.pi * PRESSURE))
    back = 0.75 * load / (MODULUS * a)
    cells = (diameter * 2.0 * a, recovered * back)
    return f"{name},ball,,,{load},1e-3,{a**2 / 0.01},{cells[0]},{cells[1]}\n"


def folder_of(tmp_path, *rows):
    (tmp_path / "set.toml").write_text(SET, encoding="utf-8")
    (tmp_path / "trials.csv").write_text(HEAD + "".join(rows), encoding="utf-8")
    return tmp_path


def test_a_row_with_a_load_is_a_press_and_normal(tmp_path):
    impact = "a,ball,1.0,90,,,2e-5,1e-3,\n"
    found = read(folder_of(tmp_path, impact, press("p", 400.0), press("q", 800.0)))
    assert found.trials.pressed.tolist() == [False, True, True]
    assert np.isnan(found.approach.normal).tolist() == [False, True, True]
    assert found.trials.angle_deg.tolist() == [90.0, 90.0, 90.0]
    assert found.load_std[1:] == pytest.approx([2.0, 4.0])
    assert len(set(found.conditions)) == 3
    assert found.impacts.trials.trial == ("a",)
    assert found.presses.trials.trial == ("p", "q")


def test_presses_alone_need_no_angle_and_come_back(tmp_path):
    (tmp_path / "one").mkdir()
    found = read(folder_of(tmp_path / "one", press("p", 400.0), press("q", 800.0)))
    write(found, tmp_path / "two")
    again = read(tmp_path / "two")
    assert again.setup == found.setup
    assert again.setup.dent_edge == "rim"
    assert again.setup.gauge == {"permanent_depth_m": 0.02}
    assert again.trials.load_N.tolist() == [400.0, 800.0]
    assert again.trials.press_rate_per_s.tolist() == [1e-3, 1e-3]
    assert again.plot().axes[0].get_xlabel() == "load of a press [N]"
    assert "load [N]" in again._repr_html_()


@pytest.mark.parametrize(
    ("wrong", "check"),
    [({}, ""), ({"diameter": 0.5}, "load"), ({"recovered": 2.0}, "recovery")],
)
def test_audit_finds_a_radius_for_a_diameter_and_the_compliance_of_the_machine(
    tmp_path, wrong, check
):
    rows = [press(f"p{k}", load, **wrong) for k, load in enumerate((200.0, 400.0, 800.0))]
    found = audit(read(folder_of(tmp_path, *rows)))
    told = [f.check.split()[0] for f in found.of(Severity.CONTRADICTION)]
    assert told == ([check] if check else [])
    if check == "recovery":
        assert "compliance" in found.of(Severity.CONTRADICTION)[0].message
