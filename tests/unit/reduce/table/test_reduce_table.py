"""Tables: readers, pulses of known shape, heights, rows of trials; real pulses and tracks."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core.errors import InputError
from dentscope.recordings import read
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.table.file import read_columns
from dentscope.reduce.table.heading import unit_in
from dentscope.reduce.table.pulse import find_pulse
from raw_files import bouncing
from scipy.integrate import solve_ivp

REAL = Path(__file__).parents[5] / "shared" / "recordings"
measured = pytest.mark.skipif(not REAL.exists(), reason="the recordings are not here")


def hertz_impact(m=0.028, v=1.5, stiffness=6e9):
    """Force of an elastic ball on a flat, m x'' = -K x^(3/2); closed-form duration and peak."""
    touch = solve_ivp(
        lambda _t, y: [y[1], -stiffness / m * max(y[0], 0.0) ** 1.5], (0.0, 3e-3), (0.0, v),
        rtol=1e-10, atol=1e-14, max_step=1e-6,
    )  # fmt: skip
    depth = (1.25 * m * v**2 / stiffness) ** 0.4
    # Johnson, Contact Mechanics, Eq. 11.24: T = 2.94 depth / v
    return touch, 2.9432 * depth / v, stiffness * depth**1.5


@pytest.mark.parametrize("noise", [0.0, 0.01])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_pulse_of_an_elastic_impact(noise, sign):
    rng = np.random.default_rng(3)
    touch, duration, peak = hertz_impact()
    t = np.arange(0.0, 2e-3, 2e-6)
    depth = np.interp(t - 5e-4, touch.t, touch.y[0], left=0.0)
    force = 6e9 * np.maximum(depth, 0.0) ** 1.5
    heard = 3.0 + sign * (force + noise * peak * rng.normal(size=t.size))
    pulse = find_pulse(t, heard, source="test")
    assert pulse.duration.value == pytest.approx(duration, rel=0.03)
    assert abs(pulse.duration.value - duration) < 4.0 * pulse.duration.std + 0.01 * duration
    assert pulse.peak.value == pytest.approx(peak, rel=0.01)
    assert pulse.area.value == pytest.approx(2.0 * 0.028 * 1.5, rel=0.01)
    assert pulse.start.value == pytest.approx(5e-4, abs=0.02 * duration)


def test_force_table_into_a_set(tmp_path):
    touch, duration, peak = hertz_impact()
    t = np.arange(-2e-4, 8e-4, 1e-6)
    force = 6e9 * np.maximum(np.interp(t, touch.t, touch.y[0], left=0.0), 0.0) ** 1.5
    with (tmp_path / "blow.csv").open("w", newline="") as stream:
        rows = csv.writer(stream, delimiter=";")
        rows.writerow(["Zeit (ms)", "Kraft (kN)"])
        rows.writerows(
            [f"{1e3 * a:.6f}".replace(".", ","), f"{1e-3 * b:.7f}".replace(".", ",")]
            for a, b in zip(t, force, strict=True)
        )
    command = ["reduce", "table", str(tmp_path / "blow.csv"), "--holds", "force", "--mass-kg"]
    command += ["0.028", "--approach-speed-m-s", "1.5", "--into", str(tmp_path / "set")]
    assert run(command) == 0
    found = read(tmp_path / "set", unfinished=True)
    assert found.trials.observables["peak_force_N"][0] == pytest.approx(peak, rel=0.005)
    assert found.trials.observables["contact_time_s"][0] == pytest.approx(duration, rel=0.02)
    assert found.trials.observables["restitution"][0] == pytest.approx(1.0, abs=0.01)
    trace = found.trace("blow")
    assert np.nanmax(trace["force_N"]) == pytest.approx(peak, rel=1e-3)


def test_heights_with_and_without_a_unit(tmp_path):
    t, height = bouncing()
    table = np.stack([np.arange(t.size), 700.0 - height / 8e-4], axis=1)
    np.savetxt(tmp_path / "px.txt", table, header="frame row", comments="")
    np.savetxt(tmp_path / "mm.csv", np.stack([t, 1e3 * height], axis=1), delimiter=",",
               header="t_s,height_mm", comments="")  # fmt: skip
    kind = load_kind("table")
    pixels = {"holds": "height", "value_unit": "px", "upwards": "down", "rate_hz": 200.0}
    for name, given in (("px.txt", pixels), ("mm.csv", {"holds": "height"})):
        reduced = kind.run(tmp_path / name, given, source="test")
        first = reduced.trials[0].observables
        assert first["restitution"].value == pytest.approx(0.8, abs=0.003)
        assert first["impact_speed_m_s"].value == pytest.approx(3.13, rel=0.005)
        reduced.draw(tmp_path / "a.png")


def test_rows_of_trials_in_other_units(tmp_path):
    (tmp_path / "rows.csv").write_text(
        "impact_speed_mm/s,permanent_depth (um),restitution,contact_time_us_std,contact_time_us\n"
        "1500,12.5,0.61,4,\n2500,21.0,0.55,4,151\n"
    )
    where = tmp_path / "set"
    given = ["reduce", "table", str(tmp_path / "rows.csv"), "--holds", "trials"]
    assert run([*given, "--into", str(where)]) == 0
    trials = read(where, unfinished=True).trials
    assert trials.impact_speed_m_s == pytest.approx([1.5, 2.5])
    assert trials.observables["permanent_depth_m"] == pytest.approx([12.5e-6, 21e-6])
    assert trials.observables["contact_time_s"][1] == pytest.approx(151e-6)
    assert trials.observables_std["contact_time_s"][1] == pytest.approx(4e-6)


@pytest.mark.parametrize(
    ("text", "names", "first"),
    [
        ("a,b\n1,2\n3,4\n", ("a", "b"), [1.0, 2.0]),
        ("# note\nTime [s]\tF [N]\n0,5\t1,5\n", ("Time [s]", "F [N]"), [0.5, 1.5]),
        ("run of May\nt;F\n(s);(N)\n0;1\n1;2\n", ("t [s]", "F [N]"), [0.0, 1.0]),
        ("1 2\n3 4\n", ("", ""), [1.0, 2.0]),
        ("t,\xb0\n1,2\n", ("t", "\xb0"), [1.0, 2.0]),
    ],
)  # fmt: skip
def test_text_tables(tmp_path, text, names, first):
    path = tmp_path / "t.txt"
    path.write_bytes(text.encode("latin-1"))
    table = read_columns(path)
    assert table.names == names
    assert table.values[0] == pytest.approx(first)


@pytest.mark.parametrize(
    ("text", "holds"),
    [("HLD\n800\n", "leeb"), ("drop_mm,rebound_mm\n1000,640\n", "rebounds")],
)
def test_a_column_is_found_by_what_it_is(tmp_path, text, holds):
    (tmp_path / "a.csv").write_text(text)
    found = load_kind("table").run(tmp_path / "a.csv", {"holds": holds}, source="test")
    assert [t.observables["restitution"].value for t in found.trials] == pytest.approx([0.8])


def test_a_unit_stands_in_a_line_of_its_own():
    assert unit_in("Kraft\nkN") == "kN"


@measured
@pytest.mark.parametrize(
    ("name", "sheets", "e"), [("60", "1", 0.54), ("140", "1", 0.53), ("340", "1", 0.24)]
)
def test_marble_on_paper(name, sheets, e):
    # quick look of the source's description, from parabolas over 14 frames
    given = {"holds": "height", "value": "3", "value_unit": "px", "upwards": "down",
             "rate_hz": 200.0}  # fmt: skip
    found = []
    for repeat in (1, 2, 3):
        file = REAL / f"marble-on-paper-a4/a4/{repeat}-{name}-M.csv"
        reduced = load_kind("table").run(file, given, source="test")
        found.append(reduced.trials[0].observables["restitution"].value)
        speed = reduced.trials[0].observables["impact_speed_m_s"].value
        # released from rest near the highest place that is seen; gravity gives the size of a pixel
        drop = float(np.nanmax(reduced.trials[0].trace["tip_height_m"]))
        assert speed == pytest.approx(math.sqrt(2.0 * 9.81 * drop), rel=0.08)
    assert np.ptp(found) < 0.04
    assert np.mean(found) == pytest.approx(e, rel=0.03)  # nearer than the repeats, apart by 0.03


@measured
def test_shock_of_a_drop_tower():
    # the fixture's two accelerometers see one pulse: top and bottom agree
    found = {}
    for number in (5, 6):
        given = {"holds": "acceleration", "value": "2", "value_unit": "kg"}
        file = REAL / f"shock-drop-package/accel_{number}.csv"
        reduced = load_kind("table").run(file, given, source="test")
        found[number] = reduced.values
    for key, part in (("peak_acceleration_m_s2", 0.1), ("speed_change_m_s", 0.1)):
        assert found[5][key].value == pytest.approx(found[6][key].value, rel=part)


@pytest.mark.parametrize("swings_in", [1.2, 3.0, 7.0])
@pytest.mark.parametrize("part", [0.1, -0.25])
def test_a_ringing_slower_than_the_pulse_stays_unknown(swings_in, part):
    time, long = np.arange(0.0, 0.2, 5e-5), 0.01
    late = np.maximum(time - 0.05 - long, 0.0)
    ring = part * np.exp(-late / (5.0 * long)) * np.sin(2.0 * np.pi * late / (swings_in * long))
    force = 100.0 * (np.sin(np.pi * np.clip((time - 0.05) / long, 0.0, 1.0)) + ring)
    found = find_pulse(time, force, source="made up")
    assert found.duration.value == pytest.approx(long, rel=0.02)
    assert abs(found.peak.value - 100.0) < found.peak.std < 40.0


def test_rebounds_find_their_drops_and_the_unit_of_each_column(tmp_path):
    text = (
        "Nr;Fallhöhe (m);h1 (cm);h2 (mm);e (%);Eindruckdurchmesser (mm);SD (mm);Mittel (cm)\n"
        "1;1,00;64,0;640;80;1,2;3,0;60\n2;0,50;32,0;320;80;1,1;2,0;30\nMittelwert;0,75;40;400;;1;2;\n"
    )
    (tmp_path / "a.csv").write_text(text, "utf-8")
    found = load_kind("table").run(tmp_path / "a.csv", {"holds": "rebounds"}, source="test")
    assert [t.observables["restitution"].value for t in found.trials] == pytest.approx([0.8] * 4)
    (tmp_path / "a.csv").write_text("Fallhöhe (m),h1 (cm)\n1,00,64,0\n", "utf-8")
    with pytest.raises(InputError, match=r"'1,00,64,0': 4 cells below 2 headers"):
        load_kind("table").run(tmp_path / "a.csv", {"holds": "rebounds"}, source="test")
    (tmp_path / "b.csv").write_text("cm,up,up\n100 ,64,63\n50,32,31\n")
    with pytest.raises(InputError, match="no column is named as a drop height"):
        load_kind("table").run(tmp_path / "b.csv", {"holds": "rebounds"}, source="test")
