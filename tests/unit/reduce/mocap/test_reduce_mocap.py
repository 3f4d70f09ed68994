"""Motion capture: files, exports, rigid bodies and points; flights, spin, friction of tracks."""

import csv
import math
import runpy
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.recordings import audit, read
from dentscope.recordings.checks.rigid import RigidTouch
from dentscope.reduce.gates import Refused
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.mocap.body import Body, centre_of
from dentscope.reduce.mocap.exports import read_export
from dentscope.reduce.mocap.file import read_markers
from dentscope.reduce.mocap.kind import reduce
from dentscope.reduce.mocap.options import Options
from dentscope.reduce.mocap.reduction import MocapScene, reduce_mocap
from dentscope.reduce.mocap.rigid import kabsch, rigid_poses
from dentscope.studies.synthetic.mocap import (
    MocapTruth,
    random_ball,
    random_rod,
    simulate,
    write_c3d,
    write_csv,
)
from made_files import put
from scipy.spatial.transform import Rotation

SPIN = 0.005
"""Relative error of the spin that is asked for."""


def _body_file(truth: MocapTruth, folder: Path) -> Path:
    path = folder / "body.toml"
    places = (f"M{i + 1} = {list(p)}" for i, p in enumerate(truth.markers))
    path.write_text("[markers]\n" + "\n".join(places) + "\n")
    return path


def _reduced(truth: MocapTruth, folder: Path, *, body: bool = True):
    write_csv(simulate(truth), folder / "track.csv")
    given = {"shape": truth.shape, "tip_radius_m": truth.tip_radius}
    if truth.shape == "rod":
        given["length_m"] = truth.length
    if body:
        given["body"] = str(_body_file(truth, folder))
    return reduce(folder / "track.csv", Options(**given))


def _is_found(truth: dict[str, float], measured) -> None:
    for name, value in truth.items():
        assert abs(measured[name].value - value) < 4.0 * measured[name].std, name


def test_synthetic_impact_agrees_with_the_mobility_of_the_set_audit():
    truth = MocapTruth(tangential=0.3, spin=2.0)
    c, s = truth.arm
    before = RigidTouch(1.0, truth.inertia_over_mass, c, s, 0.3, -truth.normal + 2.0 * c, 2.0)
    dx, dy, _ = truth.changes()
    after = before.after(np.array([dx, dy]))
    assert before.tip[1] == pytest.approx(-truth.normal, rel=1e-12)
    assert after.tip[1] == pytest.approx(truth.restitution * truth.normal, rel=1e-12)
    assert after.spin == pytest.approx(truth.values()["rebound_spin_rad_s"], rel=1e-12)


def test_kabsch_finds_a_known_pose():
    shape = np.array([[0.1, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, -0.2], [0.03, 0.02, 0.01]])
    turn = Rotation.from_euler("zyx", [0.4, -1.1, 2.0]).as_matrix()
    origin, found = kabsch(shape, shape @ turn.T + np.array([1.0, 2.0, 3.0]))
    np.testing.assert_allclose(found, turn, atol=1e-14)
    np.testing.assert_allclose(origin, [1.0, 2.0, 3.0], atol=1e-14)


def test_c3d_and_csv_hold_the_same_tracks(tmp_path):
    pytest.importorskip("ezc3d")
    markers = simulate(random_rod(1, missing=0.1))
    write_csv(markers, tmp_path / "a.csv")
    write_c3d(markers, tmp_path / "a.c3d")
    table = read_markers(tmp_path / "a.csv", unit=None, rate=None)
    c3d = read_markers(tmp_path / "a.c3d", unit=None, rate=None)
    assert c3d.names == table.names == markers.names
    assert c3d.rate == pytest.approx(500.0)
    np.testing.assert_array_equal(np.isnan(c3d.position), np.isnan(markers.position))
    np.testing.assert_allclose(c3d.position, markers.position, atol=1e-7)
    np.testing.assert_allclose(table.position, markers.position, atol=1e-7)


def test_markers_that_were_mixed_up_are_left_out():
    clean = random_rod(4, missing=0.0, gap=(0, 0), noise=1e-4)
    poses = rigid_poses(simulate(MocapTruth(**{**vars(clean), "mixed_up": 0.05})))
    assert 0 < poses.dropped < 20
    assert poses.spread < 3e-4


@pytest.mark.parametrize("seed", [11, 12, 13])
def test_rod_spin_speed_and_friction(seed, tmp_path):
    truth = random_rod(seed)
    found = _reduced(truth, tmp_path)
    (trial,) = found.trials
    _is_found(truth.values(), trial.observables)
    spin = truth.values()["rebound_spin_rad_s"]
    assert trial.observables["rebound_spin_rad_s"].value == pytest.approx(spin, rel=SPIN)
    angle = trial.observables["angle_deg"]
    assert angle.value == pytest.approx(math.degrees(truth.angle), abs=5.0 * angle.std + 0.1)
    found.draw(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 20_000


def test_ball_needs_no_body_file(tmp_path):
    truth = random_ball(3)
    (trial,) = _reduced(truth, tmp_path, body=False).trials
    _is_found(truth.values(), trial.observables)
    for name, value in truth.values().items():
        assert trial.observables[name].std < 0.02 * abs(value) + 0.02, name
    slope = math.degrees(math.atan2(truth.normal, -truth.tangential))
    assert trial.observables["angle_deg"].value == pytest.approx(slope, abs=0.1)


def test_flights_show_the_centre_of_mass(tmp_path):
    truth = random_rod(21, missing=0.0, gap=(0, 0))
    markers = simulate(truth)
    write_csv(markers, tmp_path / "track.csv")
    given = {"tip_radius_m": truth.tip_radius, "length_m": truth.length}
    known = reduce(tmp_path / "track.csv", Options(**given, body=str(_body_file(truth, tmp_path))))
    ball = reduce(tmp_path / "track.csv", Options(shape="body"))
    assert not ball.trials
    for name in ("rebound_spin_rad_s", "rebound_speed_m_s"):
        one, two = known.trials[0].observables[name], ball.values[name]
        assert abs(one.value) == pytest.approx(abs(two.value), abs=4.0 * (one.std + two.std))


@pytest.mark.parametrize("seed", [8, 144])
def test_a_rod_without_spin_and_body_file_shows_one_impact(seed):
    """Its flights must not fall apart although no spin shows the centre of mass."""
    truth = random_rod(seed)
    poses = rigid_poses(simulate(truth))
    _, turn = kabsch(np.array(truth.markers), poses.shape)
    axis = turn[:, 2]
    centre = centre_of(poses, axis, truth.tip_radius, truth.tip_radius)
    body = Body(
        "rod", axis, truth.length, truth.tip_radius, truth.inertia_over_mass, centre, poses.shape
    )
    found = reduce_mocap(poses, body, MocapScene(np.array([0.0, 0.0, 1.0])), source="rendered")
    (hit,) = found.hits
    _is_found(truth.values(), hit.measured)
    speed = hit.measured["impact_speed_m_s"]
    assert speed.value == pytest.approx(truth.normal, rel=0.005)
    assert speed.std < 0.005 * truth.normal


def test_wrong_unit_is_seen_in_the_fall(tmp_path):
    write_csv(simulate(random_ball(5)), tmp_path / "track.csv")
    options = Options(shape="sphere", tip_radius_m=0.03, gravity_m_s2=9.0)
    notes = reduce(tmp_path / "track.csv", options).notes
    assert any("check unit, rate and up" in note for note in notes)


def _table(rows: int = 20, header: str = "time_s,A_x_mm,A_y_mm,A_z_mm,B_x_mm,B_y_mm,B_z_mm") -> str:
    count = header.count(",")
    lines = [header, *(f"{k / 100}" + ",1" * count for k in range(rows))]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("", "empty"),
        (_table(5), "5 frames"),
        (_table(), "2 markers"),
        (_table(header="time_s,A_x_mm,A_y_mm"), "marker 'A' has no z"),
        (_table(header="time_s,A_x,A_y,A_z"), "unit of marker 'A' is not stated"),
        (_table(header="A_x_mm,A_y_mm,A_z_mm"), "no column of time"),
        (_table(header="time_s,height_m"), "no marker"),
        (_table().replace("0.05,1", "0.01,1"), "does not increase"),
        (_table().replace("0.05,1", "0.05,abc"), "'abc'"),
        (_table().replace("0.05,", ","), "time is missing"),
        (_table().replace("0.05,1", "0.05,1,1"), "cells under"),
    ],
)
def test_mistakes_in_a_table_are_a_line(text, line, tmp_path):
    with pytest.raises(InputError, match=line):
        reduce(put(tmp_path / "track.csv", text), Options(shape="body"))


def test_mistakes_in_a_c3d_file_and_the_options_are_a_line(tmp_path):
    pytest.importorskip("ezc3d")
    (tmp_path / "a.c3d").write_bytes(b"not a c3d file")
    with pytest.raises(InputError, match="cannot be read as C3D"):
        reduce(tmp_path / "a.c3d", Options(shape="body"))
    write_csv(simulate(random_rod(1)), tmp_path / "a.csv")
    sizes = {"tip_radius_m": 0.0088, "length_m": 0.3048}
    with pytest.raises(InputError, match="axis of the rod is not known"):
        reduce(tmp_path / "a.csv", Options(**sizes))
    with pytest.raises(InputError, match="no marker 'Z'"):
        reduce(tmp_path / "a.csv", Options(**sizes, axis="M1:Z"))
    (tmp_path / "body.toml").write_text("[markers]\nX = [0, 0, 1]\nY = [0, 1, 0]\nZ = [1, 0, 0]\n")
    with pytest.raises(InputError, match="0 of the recording's markers"):
        reduce(tmp_path / "a.csv", Options(**sizes, body=str(tmp_path / "body.toml")))
    with pytest.raises(InputError, match="free flights"):
        reduce(tmp_path / "a.csv", Options(shape="body", last_frame=40))


def test_poses_stand_for_markers(tmp_path):
    body = tmp_path / "body.toml"
    body.write_text("[markers]\nA = [0.1, 0, 0]\nB = [0, 0.1, 0]\nC = [0, 0, 0.1]\n")
    rows = ["toss,time_s,x_m,y_m,z_m,qw,qx,qy,qz"]
    half = math.sqrt(0.5)
    rows += [f"{k % 2},{k / 200},1,2,3,{half},0,0,{half}" for k in range(40)]
    (tmp_path / "a.csv").write_text("\n".join(rows) + "\n")
    places = {"A": (0.1, 0.0, 0.0), "B": (0.0, 0.1, 0.0), "C": (0.0, 0.0, 0.1)}
    found = read_markers(tmp_path / "a.csv", unit=None, rate=None, select="toss=1", points=places)
    assert found.time.size == 20
    # a quarter turn about z takes x to y and y to -x
    expected = [[1.0, 2.1, 3.0], [0.9, 2.0, 3.0], [1.0, 2.0, 3.1]]
    np.testing.assert_allclose(found.position[0], expected, atol=1e-12)
    with pytest.raises(InputError, match="select"):
        read_markers(tmp_path / "a.csv", unit=None, rate=None, select="drop=1", points=places)
    with pytest.raises(InputError, match="places on the body"):
        read_markers(tmp_path / "a.csv", unit=None, rate=None)


ROOT = Path(__file__).parents[4]
TOSS = ROOT / "data" / "recordings" / "recipes" / "cube-toss"


def test_a_tossed_cube_agrees_with_what_its_source_says():
    body = str(TOSS / "body.toml")
    found = reduce(TOSS / "toss-0.csv", Options(shape="body", body=body, select="toss=0"))
    # gravity; 148 frames a second; the authors' model of the same table takes a friction of 0.18
    assert found.values["fall_acceleration_m_s2"].value == pytest.approx(9.81, rel=0.03)
    assert found.noise["frame_rate_hz"] == pytest.approx(148.0, rel=1e-3)
    for k in (1, 2, 3):
        ratio = found.values[f"bounce{k}_friction_impulse_ratio"]
        assert ratio.value == pytest.approx(0.18, abs=0.03)
        assert 0.0 < found.values[f"bounce{k}_restitution"].value < 0.5
    # nothing is known of the cube's inertia that its spin could be held against
    for k in (1, 2):
        spin = found.values[f"bounce{k}_rebound_spin_rad_s"]
        assert spin.value == pytest.approx(
            found.values[f"bounce{k + 1}_approach_spin_rad_s"].value, abs=0.3
        )
        assert spin.std < 0.1
    # the authors' own velocity, smoothed, three frames before the first contact
    with (TOSS / "toss-0.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    time = found.values["bounce1_time_s"].value
    row = {k: float(v) for k, v in [r for r in rows if float(r["t_s"]) < time][-4].items()}
    speed = math.hypot(row["vx_m_s"], row["vy_m_s"])
    assert -found.values["bounce1_approach_tangential_m_s"].value == pytest.approx(speed, rel=0.01)
    fall = row["vz_m_s"] - 9.81 * (time - row["t_s"])
    assert found.values["bounce1_approach_normal_m_s"].value == pytest.approx(fall, rel=0.05)


RAW = ROOT.parent / "shared" / "recordings" / "tabletennis-spin-bounce" / "trajectories.zip"


def _flight(path: Path, *, drag: float = 2.0, noise: float = 5e-4) -> None:
    random = np.random.default_rng(2)
    t = np.arange(80) / 200.0 - 0.2013
    late = np.maximum(t, 0.0)
    height = -3.0 * t - 4.905 * t**2 + (3.0 + 2.4) * late
    along = 4.0 * t - 0.5 * drag * t * np.abs(t) - 0.2 * 5.4 * late
    p = np.stack([0.8 * along, height, -0.6 * along], axis=1) + random.normal(0, noise, (80, 3))
    rows = [f"{a:.5f},{x:.6f},{y:.6f},{z:.6f}" for a, (x, y, z) in zip(t, p, strict=True)]
    path.write_text("\n".join(["time_s,ball_x_m,ball_y_m,ball_z_m", *rows]) + "\n")


def test_a_point_gives_speeds_and_friction(tmp_path):
    _flight(tmp_path / "a.csv")
    spin = Options(shape="sphere", tip_radius_m=0.02, up="y", spin_before_rad_s="60,0,80")
    found = reduce(tmp_path / "a.csv", spin)
    (trial,) = found.trials
    truth = {
        "impact_speed_m_s": 3.0, "approach_tangential_m_s": -4.0, "restitution": 0.8,
        "friction_impulse_ratio": 0.2, "rebound_speed_m_s": 2.4, "tangential_rebound_m_s": -2.92,
    }  # fmt: skip
    _is_found(truth, trial.observables)
    for name, value in truth.items():
        assert trial.observables[name].value == pytest.approx(value, rel=0.03), name
    # x = (-0.8, 0, 0.6), z = x cross up = (-0.6, 0, -0.8)
    assert trial.observables["approach_spin_rad_s"].value == pytest.approx(-100.0, rel=0.02)
    assert found.noise["frame_rate_hz"] == pytest.approx(200.0, rel=1e-3)
    found.draw(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("wrong", "by", "told"),
    [*(({k: v}, Refused, "falls with")
       for k, v in (("unit", "cm"), ("unit", "mm"), ("frame_rate_hz", 50.0))),
     ({"up": "-y"}, InputError, "no bounce with a flight")],
)  # fmt: skip
def test_a_point_that_does_not_fall_or_bounce_is_refused(tmp_path, wrong, by, told):
    _flight(tmp_path / "a.csv")
    given = {"shape": "sphere", "tip_radius_m": 0.02, "up": "y", **wrong}
    with pytest.raises(by, match=told):
        reduce(tmp_path / "a.csv", Options(**given))


@pytest.mark.skipif(not RAW.exists(), reason="the raw recordings are not beside the checkout")
def test_table_tennis_recipe_makes_a_sound_set(tmp_path):
    path = ROOT / "data" / "recordings" / "recipes" / "tabletennis_spin.py"
    made, left_out = runpy.run_path(str(path))["recipe"](RAW, tmp_path / "set", 12)
    assert made >= 9
    assert len(left_out) <= 3
    found = read(tmp_path / "set")
    e = found.values("restitution")
    # the rules of the game ask a table for a rebound of about 23 cm from 30 cm: e = 0.88
    assert 0.85 < np.median(e) < 0.97
    assert np.all(e < 1.05)
    # spins up to some hundred rad/s, position noise of 1 to 3 mm (SOURCE.md)
    assert 50.0 < np.nanmax(np.abs(found.trials.approach_spin_rad_s)) < 500.0
    assert not [f for f in audit(found).findings if f.severity.value == "contradiction"]


BACK, G, HEIGHT, RADIUS = 0.8, 9.81, 1.0, 0.12
POINTS = np.array([[0.11, 0.03, 0.0], [-0.1, 0.05, 0.02], [0.0, -0.06, 0.1], [0.02, 0.09, -0.08]])


def flight(rate, seed=5):
    fall = np.sqrt(2.0 * HEIGHT / G)
    t = np.arange(0.0, 1.9 * fall, 1.0 / rate)
    after = t - fall
    h = np.where(after < 0.0, HEIGHT - 0.5 * G * t**2, BACK * G * fall * after - 0.5 * G * after**2)
    return t, h + RADIUS, np.random.default_rng(seed)


def tracks(rate, *, up, count):
    t, h, rng = flight(rate)
    centre = np.zeros((t.size, 3))
    centre[:, up] = h
    centre[:, 0] += 0.3 * t
    points = POINTS[:count] if count > 1 else np.zeros((1, 3))
    return t, centre[:, None] + points + rng.normal(0.0, 2e-4, (t.size, count, 3))


def cells(values, scale=1.0):
    return ",".join(f"{scale * v:.6f}" for v in np.ravel(values))


def motive(path, *, units="Meters", scale=1.0):
    t, at = tracks(240.0, up=1, count=4)
    body = at.mean(axis=1)
    names = ["Ball"] * 7 + [f"Ball:Marker{k}" for k in (1, 2, 3, 4) for _ in range(3)]
    kinds = ["Rigid Body"] * 7 + ["Marker"] * 12
    what = ["Rotation"] * 4 + ["Position"] * 15
    head = [
        f"Format Version,1.23,Export Frame Rate,240.0,Length Units,{units}",
        "", ",Type," + ",".join(kinds), ",Name," + ",".join(names), ",ID," + ",".join(['"A"'] * 19),
        ",," + ",".join(what), "Frame,Time (Seconds),X,Y,Z,W" + ",X,Y,Z" * 5, "0,0.0" + "," * 19,
    ]  # fmt: skip
    rows = [
        f"{k + 1},{s + 1 / 240:.6f},0,0,0,1,{cells(b, scale)},{cells(a, scale)}"
        for k, (s, b, a) in enumerate(zip(t, body, at, strict=True))
    ]
    path.write_text("\n".join(head + rows), "utf-8-sig")
    return path


def vicon(path, *, before=""):
    _, at = tracks(250.0, up=2, count=1)
    rows = [f"{k + 1},0,{cells(a, 1e3)}" for k, a in enumerate(at)]
    head = ["Trajectories", "250", ",,Ball:B1,,", "Frame,Sub Frame,X,Y,Z", ",,mm,mm,mm"]
    path.write_text(before + "\n".join(head + rows) + "\n\n")
    return path


def qualisys(path, *, timed):
    t, at = tracks(300.0, up=2, count=1)
    head = ["NO_OF_FRAMES\t" + str(t.size), "NO_OF_MARKERS\t1", "FREQUENCY\t300",
            "DATA_INCLUDED\t3D", "MARKER_NAMES\tball"]  # fmt: skip
    own = [f"{k + 1}\t{s:.5f}\t" if timed else "" for k, s in enumerate(t)]
    rows = [o + cells(a, 1e3).replace(",", "\t") for o, a in zip(own, at, strict=True)]
    path.write_text("\n".join(head + rows))
    return path


def opensim(path):
    t, at = tracks(250.0, up=1, count=1)
    head = ["PathFileType\t4\t(X/Y/Z)\ta.trc", "DataRate\tCameraRate\tNumMarkers\tUnits",
            "250.00\t250.00\t1\tmm", "Frame#\tTime\tball\t\t", "\t\tX1\tY1\tZ1", ""]  # fmt: skip
    rows = [f"{k + 1}\t{s:.5f}\t" + cells(a, 1e3).replace(",", "\t")
            for k, (s, a) in enumerate(zip(t, at, strict=True))]  # fmt: skip
    path.write_text("\n".join(head + rows))
    return path


def reduced(path, up):
    given = {"shape": "sphere", "tip_radius_m": RADIUS, "up": up}
    return load_kind("mocap").run(path, given, source="test").values


@pytest.mark.parametrize(
    ("write", "up"),
    [(motive, "y"), (lambda p: motive(p, units="Millimeters", scale=1e3), "y"), (vicon, "z"),
     (lambda p: p.write_text(motive(p).read_text("utf-8-sig").replace(",Type,", ",,")
                             .replace(",Name,", ",,").replace(",ID,", ",,")) and p, "y"),
     (lambda p: vicon(p, before="Devices\n1000\n,,Plate\nFrame,Sub Frame,Fz\n,,N\n1,0,5\n\n"), "z"),
     (lambda p: qualisys(p, timed=True), "z"), (lambda p: qualisys(p, timed=False), "z"),
     (opensim, "y")],
)  # fmt: skip
def test_the_bounce_is_read_from_the_export_itself(tmp_path, write, up):
    found = reduced(write(tmp_path / "take.csv"), up)
    e, v = found["restitution"], found["impact_speed_m_s"]
    assert abs(e.value - BACK) < 4.0 * e.std < 0.02
    assert v.value == pytest.approx(np.sqrt(2.0 * G * HEIGHT), rel=2e-3)


@pytest.mark.parametrize("write", [motive, vicon])
def test_an_export_with_semicolons_and_decimal_commas(tmp_path, write):
    path, up = write(tmp_path / "take.csv"), "z" if write is vicon else "y"
    plain = reduced(path, up)
    path.write_text(path.read_text("utf-8-sig").replace(",", ";").replace(".", ","), "utf-8-sig")
    assert reduced(path, up)["restitution"] == plain["restitution"]


@pytest.mark.parametrize(
    "write",
    [lambda v: f"{v:.6f}".replace(".", ","), lambda v: f"{v:.7E}".replace("BACK", "D")],
    ids=["decimal-commas", "fortran"],
)
def test_a_table_of_markers_as_other_programs_write_it(tmp_path, write):
    t, at = tracks(240.0, up=2, count=1)
    rows = [";".join(map(write, (s, *a[0]))) for s, a in zip(t, at, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["Zeit (s);ball_x_m;ball_y_m;ball_z_m", *rows]))
    found = reduced(tmp_path / "a.csv", "z")["restitution"]
    assert abs(found.value - BACK) < 4.0 * found.std < 0.02


def test_an_export_without_tracks_says_so(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Devices\n1000\n,,Plate\nFrame,Sub Frame,Fz\n,,N\n1,0,5\n")
    with pytest.raises(InputError, match=r"export without positions .*Trajectories"):
        read_export(path)
    path.write_text("time_s,A_x_m\n0,1\n")
    assert read_export(path) is None
