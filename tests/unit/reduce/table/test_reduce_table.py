"""Tables and channels: readers, pulses, heights, rows of trials; real pulses and tracks."""

import csv
import math
import sys
from pathlib import Path

import h5py
import made_records
import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core.errors import InputError
from dentscope.recordings import read
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.table.channels import channels_of
from dentscope.reduce.table.file import read_columns
from dentscope.reduce.table.heading import unit_in
from dentscope.reduce.table.pulse import find_pulse
from made_files import put
from raw_files import bouncing
from scipy.integrate import solve_ivp

REAL = Path(__file__).parents[5] / "shared" / "recordings"
PIXELS = {"value_unit": "px", "upwards": "down", "rate_hz": 200.0}
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
    for name, given in (("px.txt", PIXELS), ("mm.csv", {})):
        reduced = made_records.run(tmp_path / name, holds="height", **given)
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
    found = made_records.run(tmp_path / "a.csv", holds=holds)
    assert [t.observables["restitution"].value for t in found.trials] == pytest.approx([0.8])


def test_a_unit_stands_in_a_line_of_its_own():
    assert unit_in("Kraft\nkN") == "kN"


@measured
@pytest.mark.parametrize(("name", "e"), [("60", 0.54), ("140", 0.53), ("340", 0.24)])
def test_marble_on_paper(name, e):
    # quick look of the source's description, from parabolas over 14 frames
    found = []
    for repeat in (1, 2, 3):
        file = REAL / f"marble-on-paper-a4/a4/{repeat}-{name}-M.csv"
        reduced = made_records.run(file, holds="height", value="3", **PIXELS)
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
        file = REAL / f"shock-drop-package/accel_{number}.csv"
        given = {"holds": "acceleration", "value": "2", "value_unit": "kg"}
        found[number] = made_records.run(file, **given).values
    for key in ("peak_acceleration_m_s2", "speed_change_m_s"):
        assert found[5][key].value == pytest.approx(found[6][key].value, rel=0.1)


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
    found = made_records.run(put(tmp_path / "a.csv", text), holds="rebounds")
    assert [t.observables["restitution"].value for t in found.trials] == pytest.approx([0.8] * 4)
    assert any("drag of the air left out" in note for note in found.notes)
    for wrong, told in (
        ("Fallhöhe (m),h1 (cm)\n1,00,64,0\n", r"'1,00,64,0': 4 cells below 2 headers"),
        ("cm,up,up\n100 ,64,63\n50,32,31\n", "no column is named as a drop height"),
    ):
        with pytest.raises(InputError, match=told):
            made_records.run(put(tmp_path / "a.csv", wrong), holds="rebounds")


SAMPLES_S = 2e5
TIME = np.arange(3000) / SAMPLES_S
FORCE = 900.0 * np.sin(np.pi * np.clip((TIME - 4e-3) / 3e-3, 0.0, 1.0))
FORCE = FORCE + np.random.default_rng(0).normal(0.0, 0.5, TIME.size)


def tdms(path):
    nptdms = pytest.importorskip("nptdms")
    waveform = {"wf_increment": 1.0 / SAMPLES_S, "unit_string": "Newtons"}
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment([
            nptdms.ChannelObject("Hammer", "Force", FORCE, properties=waveform),
            nptdms.ChannelObject("Hammer", "Status", np.array([1.0, 2.0])),
            nptdms.ChannelObject("Notes", "who", ["a", "b"]),
        ])  # fmt: skip
    return path


def hdf5(path, *, timed=True):
    with h5py.File(path, "w") as file:
        group = file.create_group("run 1")
        group["note"] = "no number"
        if timed:
            group["time"] = 1e3 * TIME
            group["time"].attrs["units"] = "ms"
        else:
            group.attrs["sampling_rate"] = SAMPLES_S
        group["Load"] = FORCE / 1e3
        group["Load"].attrs["unit"] = b"kN"
        file["both"] = np.stack([TIME, FORCE])
    return path


@pytest.mark.parametrize(
    ("make", "end", "sheet"),
    [
        (tdms, ".tdms", "Hammer"), (tdms, ".tdms", ""), (hdf5, ".h5", "run 1"),
        (lambda path: hdf5(path, timed=False), ".hdf5", "/run 1"), (hdf5, ".h5", "both"),
    ],
)  # fmt: skip
def test_a_pulse_is_read_from_its_channels(make, end, sheet, tmp_path):
    options = {"holds": "force", "sheet": sheet}
    if sheet == "both":
        options["value_unit"] = "N"
    if end == ".h5" and sheet == "run 1":  # HDF5 sorts its names
        options |= {"time": "time", "value": "Load"}
    found = load_kind("table").run(make(tmp_path / f"a{end}"), options, source="test")
    peak, lasts = found.values["peak_force_N"], found.values["contact_time_s"]
    assert abs(peak.value - 900.0) < 3.0 * peak.std
    assert abs(lasts.value - 3e-3) < 3.0 * lasts.std
    assert lasts.std < 1e-4


def test_rows_are_selected_by_what_a_channel_holds(tmp_path):
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["toss"], file["x"] = np.repeat([1.0, 2.0], 5), np.arange(10.0)
    table = read_columns(path).select("toss=2.0")
    assert table.values[:, 1].tolist() == [5.0, 6.0, 7.0, 8.0, 9.0]
    assert len(table.cells) == 5


@pytest.mark.parametrize("end", [".tdms", ".h5"])
def test_a_file_that_is_none_of_its_kind_is_one_line(end, tmp_path):
    path = tmp_path / f"a{end}"
    path.write_bytes(b"no such file" * 20)
    with pytest.raises(InputError, match="cannot be read") as refused:
        read_columns(path)
    assert len(str(refused.value).splitlines()) == 1


def test_an_unknown_group_names_those_there_are(tmp_path):
    with pytest.raises(InputError, match=r"sheet: no group 'run 9' .*run 1"):
        read_columns(hdf5(tmp_path / "a.h5"), sheet="run 9")


def test_a_missing_reader_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "nptdms", None)
    with pytest.raises(InputError, match=r"reading TDMS .*dentscope\[tables\]"):
        channels_of(tmp_path / "a.tdms", "")
