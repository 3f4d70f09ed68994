"""Arrays of conditions: the same as one impact after another, and columns as in trials.csv."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core import InputError, InputErrors
from dentscope.core.inputs.templates import template
from dentscope.core.observables import OBSERVABLES
from dentscope.dynamics import Approach, Friction, Settings, Striker, impacts, rod_modes, strike
from dentscope.dynamics.batch import QUICK
from dentscope.dynamics.files.setup import setup_of
from dentscope.dynamics.files.sweep import swept_scenes
from dentscope.dynamics.report.band import swept_stds
from dentscope.models import LAWS
from made_files import changed, rows_of
from made_scenes import ROD, STEEL, on_iron

OWN = {"permanent_depth_m": "residual_flat_m"}
SEEN = (
    "restitution", "permanent_depth_m", "contact_time_s", "peak_force_N", "rebound_spin_rad_s",
    "sliding_length_m", "friction_impulse_ratio", "contact_work_J", "contacts",
)  # fmt: skip


def scene(striker: Striker = ROD, law: str = "fitted", **seams):
    return on_iron(LAWS[law], striker=striker, **{"friction": Friction(0.13), **seams})


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


def test_what_the_work_cannot_settle_is_stepped() -> None:
    # at 4 mm/s gravity does most of the work of this contact
    found = impacts(scene(Striker(0.004, 0.005)), speeds=[1e-3, 1.0], settings=Settings())
    assert found["route"].tolist() == ["steps", "work"]
    assert np.isfinite(found["restitution"]).all()


def test_columns_have_the_names_of_trials_and_go_to_files(tmp_path: Path) -> None:
    found = impacts(scene(), speeds=[0.5, 1.0])
    # these are read with a microscope or from a press, and no simulated impact has them
    others = {"dent_diameter_m", "press_depth_m", "recovered_depth_m"}
    with pytest.raises(InputError, match="no column 'e'"):
        found["e"]
    in_trials = [o.column for o in OBSERVABLES.values() if o.in_trials and o.column not in others]
    assert others.isdisjoint(found.columns)
    assert [name for name in found.columns if name in in_trials] == in_trials
    found.to_csv(tmp_path / "a.csv")
    rows = rows_of(tmp_path / "a.csv")
    assert float(rows[1]["restitution"]) == found["restitution"][1]
    assert rows[0]["tangential_restitution"] == ""
    pd = pytest.importorskip("pandas")
    found.to_parquet(tmp_path / "a.parquet")
    frame = pd.read_parquet(tmp_path / "a.parquet")
    assert list(frame.columns) == list(found.columns) == list(found.frame().columns)
    assert frame["peak_force_N"].tolist() == found["peak_force_N"].tolist()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"speeds": [1.0, -1.0]}, "speed: -1"),
        ({"speeds": math.nan}, "speed: nan"),
        ({"speeds": np.ma.array([1.0, 2.0], mask=[False, True])}, "speed: masked_array(data=[1.0"),
        ({"angles": [1.0, np.ma.masked]}, "angle: [1.0, masked]"),
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
    assert rows_of(tmp_path / "rod-sweep.csv")[1]["restitution"] == ""


BODY = {"E_Pa": 2.0e11, "nu": 0.3}
BALL = {**BODY, "Sy_Pa": 1.7e9, "density_kg_m3": 7800, "tip_radius_m": 0.005, "shape": "sphere"}
FREE = {"shape": "sphere", "radius_m": 0.01, "mass_kg": 0.03}
STRIKERS = {
    "ball": {},
    "rod": {"strikers.one": {"shape": "rod", "radius_m": 0.004, "length_m": 0.2, "mass_kg": 0.05}},
    "two": {"target": FREE},  # the scene is of their relative motion, without gravity
}
ARRIVALS = (
    {"impact_speed_m_s": 1.0},
    {"drop_height_m": 0.1},
    {"impact_speed_m_s": 1.0, "angle_deg": 40.0},
    {"drop_height_m": 0.1, "angle_deg": 40.0},
    {"drop_height_m": 0.1, "approach_tangential_m_s": 0.5, "approach_spin_rad_s": 30.0},
)
RUNS = ({"angle_deg": 5.0}, {"drop_height_m": 0.4}, {"impact_speed_m_s": 2.0},
        {"angle_deg": 25.0, "drop_height_m": 0.4}, {"angle_deg": 25.0, "impact_speed_m_s": 2.0},
        {"mass_kg": 0.02})  # fmt: skip
CASES = [
    (striker, stated, swept)
    for striker in STRIKERS
    for stated in ARRIVALS
    for swept in RUNS
    # refused: a speed along beside the angle that says it, a mass of one of two spheres
    if not (striker != "rod" and "angle_deg" in swept and "approach_tangential_m_s" in stated)
    and not (striker == "two" and "mass_kg" in swept)
]
OTHER = {"impact_speed_m_s": "drop_height_m", "drop_height_m": "impact_speed_m_s"}


def _set_up(striker, impact, sweep=None):
    content = {
        "target": {**BODY, "Sy_Pa": 3.05e8}, "friction": {"coefficient": 0.2},
        "strikers": {"one": BALL}, "impact": {k: v for k, v in impact.items() if k != "mass_kg"},
        "sweep": {k: [v] for k, v in (sweep or {}).items()},
    }  # fmt: skip
    heavy = {"strikers.one.mass_kg": impact["mass_kg"]} if "mass_kg" in impact else {}
    return setup_of(changed(content, {**STRIKERS[striker], **heavy}), source="one.toml")


@pytest.mark.parametrize(("striker", "stated", "swept"), CASES)
def test_a_row_of_a_sweep_arrives_as_the_impact_alone(striker, stated, swept):
    """A fall gives a sphere's whole speed whether its angle is stated or swept."""
    kept = {k: v for k, v in stated.items() if k not in (OTHER.get(name) for name in swept)}
    law = LAWS["fitted"]
    alone = _set_up(striker, {**kept, **swept}).scene(law)
    setup = _set_up(striker, stated, swept)
    (row,) = swept_scenes(setup.sweep, setup.plain(law), stated=setup.stated)[1:]
    got, wanted = row.approach, alone.approach
    for name in ("speed", "angle", "tangential", "spin"):
        assert getattr(got, name) == pytest.approx(getattr(wanted, name), rel=1e-12, abs=1e-12)
    assert row.striker.mass == pytest.approx(alone.striker.mass, rel=1e-12)
    assert row.striker.inertia == pytest.approx(alone.striker.inertia, rel=1e-12)


def test_any_number_of_the_file_is_swept_by_its_key():
    law, radii, moduli = LAWS["hertz"], [0.005, 0.01], [2.0e11, 1.0e11]
    content = _set_up("ball", {"impact_speed_m_s": 1.0}).content | {"sweep": {
        "strikers": {"one": {"tip_radius_m": radii}}, "target.E_Pa": moduli,
        "gravity_m_s2": [0.0], "impact_speed_m_s": [1.0, 32.0],
    }}  # fmt: skip
    setup = setup_of(content, source="one.toml")
    found = setup.swept(law)
    assert next(iter(setup.varied)) == "strikers.one.tip_radius_m"
    assert found["target.E_Pa"].tolist() == 2 * [2.0e11, 2.0e11, 1.0e11, 1.0e11]
    assert found["mass_kg"][[0, 4]] == pytest.approx(
        [7800 * math.pi / 6 * d**3 for d in (0.01, 0.02)]
    )
    # Hertz: T = 2.943 (15 m / (16 E* R^1/2))^2/5 v^-1/5, with the mass of a solid ball
    T = found["contact_time_s"].reshape(2, 2, 2)
    assert T[1] / T[0] == pytest.approx(np.full((2, 2), 2.0), rel=1e-6)
    assert T[:, 1] / T[:, 0] == pytest.approx(np.full((2, 2), 1.5**0.4), rel=1e-6)
    assert T[..., 1] / T[..., 0] == pytest.approx(np.full((2, 2), 0.5), rel=1e-6)
    stds = swept_stds(setup, LAWS["fitted"], setup.swept(LAWS["fitted"]))["restitution"]
    alone = setup.rigs[3]
    assert stds[6:] == pytest.approx(
        swept_stds(alone, LAWS["fitted"], alone.swept(LAWS["fitted"]))["restitution"], rel=1e-12
    )
    many = {"from": 0, "count": 9999}
    swept = {"target.nu": {**many, "to": 0.4}, "friction": {**many, "to": 1}}
    with pytest.raises(InputError, match="up to 10000000"):
        setup_of(content | {"sweep": swept}, source="")


def test_a_swept_mass_carries_modes_of_its_own():
    law, fall = LAWS["fitted"], {"impact_speed_m_s": 1.0, "angle_deg": 40.0, "modes": 3}
    (row,) = _set_up("rod", fall, {"mass_kg": 0.02}).swept(law).rows()
    alone = strike(_set_up("rod", {**fall, "mass_kg": 0.02}).scene(law))
    assert row["restitution"] == pytest.approx(alone.restitution, rel=1e-5)


def test_a_swept_mass_brings_its_inertia_along():
    content = _set_up("rod", {"impact_speed_m_s": 1.0}, {"mass_kg": 0.02}).content
    content["strikers"]["one"]["inertia_kg_m2"] = 1e-5
    with pytest.raises(InputErrors, match=r"given beside strikers\.one\.inertia_kg_m2"):
        setup_of(content, source="one.toml")
