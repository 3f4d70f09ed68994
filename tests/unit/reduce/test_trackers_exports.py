"""Exports of trackers as they write them: a ball that falls and comes back with four fifths."""

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.mocap.exports import read_export

E, G, HEIGHT, RADIUS = 0.8, 9.81, 1.0, 0.12
POINTS = np.array([[0.11, 0.03, 0.0], [-0.1, 0.05, 0.02], [0.0, -0.06, 0.1], [0.02, 0.09, -0.08]])


def flight(rate, seed=5):
    fall = np.sqrt(2.0 * HEIGHT / G)
    t = np.arange(0.0, 1.9 * fall, 1.0 / rate)
    after = t - fall
    h = np.where(after < 0.0, HEIGHT - 0.5 * G * t**2, E * G * fall * after - 0.5 * G * after**2)
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
    assert abs(e.value - E) < 4.0 * e.std < 0.02
    assert v.value == pytest.approx(np.sqrt(2.0 * G * HEIGHT), rel=2e-3)


@pytest.mark.parametrize("write", [motive, vicon])
def test_an_export_with_semicolons_and_decimal_commas(tmp_path, write):
    path, up = write(tmp_path / "take.csv"), "z" if write is vicon else "y"
    plain = reduced(path, up)
    path.write_text(path.read_text("utf-8-sig").replace(",", ";").replace(".", ","), "utf-8-sig")
    assert reduced(path, up)["restitution"] == plain["restitution"]


@pytest.mark.parametrize(
    "write",
    [lambda v: f"{v:.6f}".replace(".", ","), lambda v: f"{v:.7E}".replace("E", "D")],
    ids=["decimal-commas", "fortran"],
)
def test_a_table_of_markers_as_other_programs_write_it(tmp_path, write):
    t, at = tracks(240.0, up=2, count=1)
    rows = [";".join(map(write, (s, *a[0]))) for s, a in zip(t, at, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["Zeit (s);ball_x_m;ball_y_m;ball_z_m", *rows]))
    found = reduced(tmp_path / "a.csv", "z")["restitution"]
    assert abs(found.value - E) < 4.0 * found.std < 0.02


def test_an_export_without_tracks_says_so(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("Devices\n1000\n,,Plate\nFrame,Sub Frame,Fz\n,,N\n1,0,5\n")
    with pytest.raises(InputError, match=r"export without positions .*Trajectories"):
        read_export(path)
    path.write_text("time_s,A_x_m\n0,1\n")
    assert read_export(path) is None
