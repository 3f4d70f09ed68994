"""Arrays of conditions: the same as one impact after another, and columns as in trials.csv."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core import InputError, Material
from dentscope.core.inputs.templates import template
from dentscope.core.observables import OBSERVABLES
from dentscope.impact import (
    Approach,
    Friction,
    Settings,
    Striker,
    impacts,
    rod_modes,
    scene_of,
    strike,
)
from dentscope.impact.batch import QUICK
from dentscope.models import LAWS

STEEL = Material(E=200e9, nu=0.3, Sy=760e6, density=7800.0)
IRON = Material(E=200e9, nu=0.3, Sy=305e6, density=7870.0)
ROD = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, radius=0.0088)
BALL = Striker(mass=0.004, tip_radius=0.005)
OWN = {"permanent_depth_m": "residual_flat_m"}
SEEN = (
    "restitution", "permanent_depth_m", "contact_time_s", "peak_force_N", "rebound_spin_rad_s",
    "sliding_length_m", "friction_impulse_ratio", "contact_work_J", "contacts",
)  # fmt: skip


def scene(striker: Striker = ROD, law: str = "fitted", **seams):
    given = {"approach": Approach(1.0), "friction": Friction(0.13), **seams}
    return scene_of(LAWS[law], sphere=STEEL, flat=IRON, striker=striker, **given)


def check(row, one, within: float = 3e-6) -> None:
    for name in SEEN:
        theirs = getattr(one, OWN.get(name, name))
        assert row[name] == pytest.approx(theirs, rel=within, abs=1e-12), name


def test_normal_impacts_go_by_work_and_agree_with_the_steps() -> None:
    found = impacts(scene(), speeds=[0.3, 1.0, 3.0])
    assert set(found["route"]) == {"work"}
    for row, speed in zip(found.rows(), (0.3, 1.0, 3.0), strict=True):
        one = strike(scene(approach=Approach(speed)), Settings(tolerance=1e-11))
        check(row, one)
        energy = one.kinetic_before_J
        for name, theirs in one.observables.items():
            if name in row:
                small = energy if name.endswith("_J") else one.peak_depth_m
                ours = pytest.approx(row[name], rel=3e-6, abs=1e-6 * small, nan_ok=True)
                assert theirs == ours, name
    assert found["scar_width_m"].min() > 0.0


@pytest.mark.parametrize("law", ["fitted", "jackson-green"])
def test_oblique_and_vibrating_impacts_go_by_steps(law: str) -> None:
    modes = rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=4)
    base = scene(law=law, modes=modes)
    found = impacts(base, speeds=[[0.5], [1.5]], angles=np.radians([40.0, 90.0]))
    assert len(found) == 4
    assert set(found["route"]) == {"steps"}
    assert found["angle_deg"] == pytest.approx([40.0, 90.0, 40.0, 90.0])
    for k, (speed, angle) in enumerate([(0.5, 40.0), (0.5, 90.0), (1.5, 40.0), (1.5, 90.0)]):
        one = base.with_(approach=Approach(speed, math.radians(angle)))
        row = {n: found[n][k] for n in SEEN}
        check(row, strike(one, QUICK))
        # several touches, at rest in between, carry the error of a step on
        check(row, strike(one, Settings(tolerance=1e-10)), within=2e-5)


def test_friction_and_mass_run_through_their_values() -> None:
    angle = math.radians(45.0)
    found = impacts(scene(), angles=angle, friction=[0.0, 0.1], masses=[0.4607, 0.567])
    heavy = Striker(mass=0.567, tip_radius=0.0088, length=0.3048, radius=0.0088)
    one = scene(heavy, approach=Approach(1.0, angle), friction=Friction(0.1))
    check({n: found[n][1] for n in SEEN}, strike(one, Settings(tolerance=1e-10)))
    assert found["friction_impulse_ratio"] == pytest.approx([0.0, 0.1], abs=1e-6)


def test_a_spheres_angle_is_that_of_its_velocity() -> None:
    found = impacts(scene(BALL), speeds=2.0, angles=np.radians([30.0, 90.0]))
    assert found["approach_tangential_m_s"] == pytest.approx([-2.0 * math.sqrt(3.0), 0.0])
    assert found["route"].tolist() == ["steps", "work"]
    one = scene(BALL, approach=Approach(2.0, tangential=-2.0 * math.sqrt(3.0)))
    check({n: found[n][0] for n in SEEN}, strike(one, Settings(tolerance=1e-10)))
    # the normal motion of a sphere does not know of the tangential one
    assert found["restitution"][0] == pytest.approx(found["restitution"][1], abs=1e-6)


def test_what_the_work_cannot_settle_is_stepped() -> None:
    # at 4 mm/s gravity does most of the work of this contact
    found = impacts(scene(BALL), speeds=[1e-3, 1.0], settings=Settings())
    assert found["route"].tolist() == ["steps", "work"]
    assert np.isfinite(found["restitution"]).all()


def test_columns_have_the_names_of_trials_and_go_to_files(tmp_path: Path) -> None:
    found = impacts(scene(), speeds=[0.5, 1.0])
    # these are read with a microscope or from a press, and no simulated impact has them
    others = {"dent_diameter_m", "press_depth_m", "recovered_depth_m"}
    in_trials = [o.column for o in OBSERVABLES.values() if o.in_trials and o.column not in others]
    assert others.isdisjoint(found.columns)
    assert [name for name in found.columns if name in in_trials] == in_trials
    found.to_csv(tmp_path / "a.csv")
    with (tmp_path / "a.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert float(rows[1]["restitution"]) == found["restitution"][1]
    assert rows[0]["tangential_restitution"] == ""
    pd = pytest.importorskip("pandas")
    found.to_parquet(tmp_path / "a.parquet")
    frame = pd.read_parquet(tmp_path / "a.parquet")
    assert list(frame.columns) == list(found.columns) == list(found.to_frame().columns)
    assert frame["peak_force_N"].tolist() == found["peak_force_N"].tolist()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"speeds": [1.0, -1.0]}, "speed: -1"),
        ({"speeds": math.nan}, "speed: nan"),
        ({"angles": 3.0}, "angle: 3"),
        ({"friction": -0.1}, "friction: -0.1"),
        ({"masses": 0.0}, "mass: 0"),
        ({"speeds": [1.0, 2.0], "friction": [0.1, 0.2, 0.3]}, "shapes that broadcast"),
    ],
)
def test_mistakes_are_one_line(given, message: str) -> None:
    with pytest.raises(InputError) as caught:
        impacts(scene(), **given)
    assert message in str(caught.value)
    with pytest.raises(InputError, match="no column 'e'"):
        impacts(scene(), speeds=1.0)["e"]


def test_what_did_not_end_shows_no_number_and_leaves_with_3(tmp_path, capsys) -> None:
    # half way the tip still goes down: a "restitution" of about -1
    leaning = scene(approach=Approach(1.0, angle=math.radians(45.0)))
    found = impacts(leaning, speeds=[1.0, 2.0], settings=Settings(max_steps=12))
    assert list(found["outcome"]) == ["step-limit"] * 2
    assert np.isnan(found["restitution"]).all()
    assert np.isnan(found["peak_force_N"]).all()
    assert found["impact_speed_m_s"] == pytest.approx([1.0, 2.0])
    file = tmp_path / "rod.toml"
    swept = "[sweep]\nangle_deg = [90, 45]\n[impact]\nmax_steps = 12\n"
    text = template("rod").split("[sweep]")[0].replace("angle_deg = 45", "angle_deg = 90")
    rigid = text.replace("modes = 10", "modes = 0").replace("loss_factor = 0.001", "")
    file.write_text(rigid.replace("[impact]\n", swept + 'laws = ["hertz"]\n'))
    assert run(["impact", str(file), "--exact", "--out", str(tmp_path)]) == 3
    rows = list(csv.DictReader((tmp_path / "rod-sweep.csv").read_text().splitlines()))
    assert rows[1]["restitution"] == ""
