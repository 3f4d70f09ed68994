"""Tables as instruments write them: cells, clocks, headers, holes, levels and feet of pulses."""

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.table.cells import instant, since_first
from dentscope.reduce.table.file import columns_of
from dentscope.reduce.table.heading import heading_of, labview_rows
from made_records import RATE, T, half_sine, run, table
from scipy.signal import lsim


def clocked(write):
    """A table with times of a clock."""
    return "time,force_N", lambda t, v: f"{write(t)},{v:.3f}", {}


def of_device(word):
    """A column between, and blanks after the commas."""
    write = lambda t, v: f' 12:04:{26 + t:09.6f},"{word}", {v:.3f}'  # noqa: E731
    return "time,device,Force (N)", write, {"value": "3"}


TITLE = "Start time:\t3/12/2024 2:02:11 PM\nNumber of ch:\t1\n\nTime (s)\tForce (N)"
WRITTEN = {
    "a clock": clocked(lambda t: f"12:04:{26.746 + t:09.6f}"),
    "a clock over midnight": clocked(lambda t: f"2024-05-17T23:59:{26.7 + t:09.6f}Z"),
    "a date before it": clocked(lambda t: f"17.05.2024 08:59:{26.7 + t:09.6f}"),
    "a clock over noon": clocked(
        lambda t: f"11:59:{59.99 + t:09.6f}" if t < 0.01 else f"12:00:{t - 0.01:09.6f}"
    ),
    "minutes": clocked(lambda t: f"12:{5 + t:07.4f}"),
    "a short year": clocked(lambda t: f"17.05.24 12:04:{26.7 + t:09.6f}"),
    "a month in letters": clocked(lambda t: f"17-May-2024 12:04:{26 + t:09.6f}"),
    "days that are seconds": (
        "uptime,force_N", lambda t, v: f"{45429.5 + t:.5f},{v:.3f}", {"time_unit": "s"}
    ),
    "commas between blanks": (
        "Zeit[s] Kraft[N]", lambda t, v: f"{t:.5f}   {v:.3f}".replace(".", ","), {}
    ),
    "a typeset minus": (
        "Time (s),Force (N)", lambda t, v: f"{t:.5f},{v:.3f}".replace("-", "\u2212"), {}
    ),
    "UTF-8 read as another": (
        "Time (\u00c2\u00b5s),Force (N)", lambda t, v: f"{1e6 * t:.1f},{v:.3f}", {}
    ),
    **{f"beside {word}": of_device(word) for word in ("IMU1", "17 May", "a, b")},
    "a title above short units": (TITLE, lambda t, v: f"{t:.5f}\t{v:.3f}", {}),
    "a rate that is stated": ("force_N", lambda _, v: f"{v:.3f}", {"rate_hz": RATE}),
    **{line: (f"{line}\nForce (N)", lambda _, v: f"{v:.3f}", {}) for line in (
        "Sampling Rate,10,kHz", "Sample Interval: 100 us", "Sampling frequency (Hz),10000")},
    "ms and kN": ("t/ms\tF/kN", lambda t, v: f"{1e3 * t:.6g}\t{1e-3 * v:.7g}", {}),
    "msec": ("Zeit in msec\tKraft in N", lambda t, v: f"{1e3 * t:.6g}\t{v:.7g}", {}),
    "us": ("Time, us\tLOAD (KN)", lambda t, v: f"{1e6 * t:.6g}\t{1e-3 * v:.7g}", {}),
    "ns": ("Time <ns>\tForce (lb)", lambda t, v: f"{1e9 * t:.6g}\t{v / 4.4482216152605:.7g}", {}),
}  # fmt: skip


@pytest.mark.parametrize("name", WRITTEN)
def test_a_pulse_is_read_however_it_is_written(tmp_path, name):
    head, write, given = WRITTEN[name]
    rows = [write(t, v) for t, v in zip(T, half_sine(), strict=True)]
    (tmp_path / "a.txt").write_text("\n".join([head, *rows]), "utf-8")
    found = run(tmp_path / "a.txt", **given).values
    assert found["impulse_N_s"].value == pytest.approx(2.037, abs=0.003)
    assert found["peak_force_N"].value == pytest.approx(800.0, abs=2.0)
    assert found["contact_time_s"].value == pytest.approx(4e-3, abs=3 * found["contact_time_s"].std)
    assert found["contact_time_s"].value == pytest.approx(4e-3, rel=0.1)


def of_force(head, write):
    return "\n".join([head, *(write(t, v) for t, v in zip(T, half_sine(), strict=True))])


MARKS = ("OL", "", "∞", "-∞", "******", "#N/A", "NaN", "9.9E37", "+OVER")
RATES = ("", "Sampling Rate,0,Hz\n", "Sampling Rate,nan,Hz\n", "Sampling Rate,10,furlong\n")
REFUSED = [
    *((of_force("time_s,force_N", lambda t, v, m=mark: f"{t:.4f},{m if v > 500.0 else f'{v:.3f}'}"),
       r"23 cells hold no number .* in or beside the pulse") for mark in MARKS),
    *((of_force(f"{rate}Force (N)", lambda _, v: f"{v:.3f}"), "rate_hz: no column of the time")
      for rate in RATES),
    (of_force("Date,force_N", lambda t, v: f"{45429.503 + t / 86400.0:.10f},{v:.3f}"),
     r"45429\.503 are seconds, or days"),
    (of_force("time_s,force_N", lambda _, v: f"start,{v:.1f} N"),
     "no row of numbers, but 'start,.* N'"),
    (of_force("Time,Force (N)", lambda _, v: f",{v:.3f}"), "no times in column 'Time' .*rate_hz"),
    (of_force("Time (ticks),Force (N)", lambda t, v: f"{1e9 * t:.0f},{v:.3f}"),
     "does not name its unit"),
    (of_force("time,Force (N)", lambda t, v: f"{1.71e18 + 1e9 * t:.0f},{v:.3f}"), "no seconds"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "told"), REFUSED)
def test_a_table_that_tells_no_force_against_time_is_refused(tmp_path, text, told):
    (tmp_path / "a.csv").write_text(text, "utf-8")
    with pytest.raises(InputError, match=told):
        run(tmp_path / "a.csv")


def test_holes_far_from_the_pulse_are_told(tmp_path):
    cells = [f"{v:.3f}" for v in half_sine()]
    cells[20:25] = ["--"] * 5
    found = run(table(tmp_path / "a.csv", cells))
    assert found.values["impulse_N_s"].value == pytest.approx(2.037, abs=0.003)
    assert "5 cells hold no number but '--', none of them beside the pulse" in found.notes


def test_a_name_that_stands_twice_asks_for_its_number(tmp_path):
    cells = [f"{v:.3f},{t:.4f},{v / 2:.3f}" for t, v in zip(T, half_sine(), strict=True)]
    path = table(tmp_path / "a.csv", cells, "Time (s),Force (N),Time (s),Force (N)")
    with pytest.raises(InputError, match=r"any of columns 2, 4 .*number of one"):
        run(path, value="Force (N)")
    assert run(path, value="4").values["peak_force_N"].value == pytest.approx(400.0, abs=3.0)


def test_a_clock_passes_midnight():
    told = since_first(np.array([instant(c) for c in ("23:59:59.5", "00:00:00.5", "00:00:01")]))
    np.testing.assert_allclose(told, [0.0, 1.0, 1.5])
    assert np.isnan(instant("25:00"))
    assert instant("1:02:03 PM") == 13 * 3600 + 123


def labview(times):
    value = half_sine()
    head = ["LabVIEW Measurement\t", "Separator\tTab", f"X_Columns\t{'One' if times else 'No'}",
            "***End_of_Header***\t", "Channels\t1", "Date\t2024/05/17", "Time\t09:51:40.7",
            "Y_Unit_Label\tNewtons", "X_Dimension\tTime", "Delta_X\t1.0E-4",
            "***End_of_Header***\t", "X_Value\tForce\tComment"]  # fmt: skip
    return head + [f"{f'{t:.4f}' if times else ''}\t{v:.4f}" for t, v in zip(T, value, strict=True)]


@pytest.mark.parametrize("times", [True, False])
def test_labview_measurements(tmp_path, times):
    path = tmp_path / "a.lvm"
    path.write_text("\n".join(labview(times)))
    for chosen in ({"value": "Force"}, {"value": "2"}, {}):
        found = run(path, **chosen).values
        assert found["impulse_N_s"].value == pytest.approx(2.037, abs=0.003)
    assert labview_rows(["time,force"]) is None


def test_labview_with_decimal_commas_or_another_channel_first(tmp_path):
    commas = [line.replace(".", ",") for line in labview(False)]
    lines = labview(False)
    top = lines.index("X_Value\tForce\tComment")
    two = [*lines[:top], "X_Value\tTrigger\tForce\tComment"]
    two += ["\t0.5" + line for line in lines[top + 1 :]]
    two[two.index("Y_Unit_Label\tNewtons")] = "Y_Unit_Label\tVolts\tNewtons"
    scaled = [line.replace("1.0E-4", "1.0E-1") for line in lines]
    scaled[scaled.index("Y_Unit_Label\tNewtons")] = "Y_Unit_Label\tkN"
    for content, impulse in ((commas, 2.037), (two, 2.037), (scaled, 2.037e6)):
        (tmp_path / "a.lvm").write_text("\n".join(content))
        found = run(tmp_path / "a.lvm", value="Force").values["impulse_N_s"]
        assert found.value == pytest.approx(impulse, rel=0.002)


def test_labview_with_commas_and_times_rounded_to_the_same(tmp_path):
    rounded = [f"{t:.3f},{v:.4f}" for t, v in zip(T, half_sine(), strict=True)]
    head = [line.replace("\t", ",").replace("Tab", "Comma") for line in labview(True)]
    path = tmp_path / "a.lvm"
    path.write_text("\n".join(head[: -len(T)] + rounded))
    for chosen in ({"value": "Force"}, {"value": "2"}):
        found = run(path, **chosen).values["impulse_N_s"]
        assert found.value == pytest.approx(2.037, abs=0.003)


def test_labview_with_a_time_for_each_channel_or_several_segments(tmp_path):
    each = [line.replace("X_Columns\tOne", "X_Columns\tMulti") for line in labview(True)]
    top = each.index("X_Value\tForce\tComment")
    rows = [f"{line.split()[0]}\t0.5\t{line}" for line in each[top + 1 :]]
    each[each.index("Y_Unit_Label\tNewtons")] = "Y_Unit_Label\tVolts\tNewtons"
    path = tmp_path / "a.lvm"
    path.write_text("\n".join([*each[:top], "X_Value\tTrigger\tX_Value\tForce\tComment", *rows]))
    assert run(path, value="Force").values["impulse_N_s"].value == pytest.approx(2.037, abs=0.003)
    first = labview(True)
    second = [line.replace("\t", "\t-") for line in first[first.index("Channels\t1") :]]
    path.write_text("\n".join([*first, "", *second]))
    with pytest.raises(InputError, match=r"sheet: 2 segments \(allowed: 1 to 2\)"):
        run(path)
    assert run(path, sheet="1").values["impulse_N_s"].value == pytest.approx(2.037, abs=0.003)


def test_what_is_no_time_and_what_stands_behind_is_told(tmp_path):
    cells = [f"{v:.3f}" for v in half_sine()]
    twice = table(tmp_path / "a.csv", [*cells, *cells], times=2 * [f"{t:.4f}" for t in T])
    assert f"{T.size} rows at or before the time of an earlier one are left out" in run(twice).notes
    clock = [f"12:04:{26 + t:09.6f}" for t in T]
    path = table(tmp_path / "c.csv", cells, "Time(s),force_N", clock)
    for named in (path, path.with_suffix(".xls")):
        path.rename(named)
        found = run(named, time="Time(s)").values["impulse_N_s"]
        assert found.value == pytest.approx(2.037, abs=0.003)
        path = named


def test_a_heading_names_units_and_says_more():
    above = [["Area", "38.1553", "mm^2"], ["Time", "Load"], ["(s)", "(kN)"]]
    found = heading_of(above, 2)
    assert found.names == ("Time [s]", "Load [kN]")
    assert found.quantity("area") == (38.1553, "mm^2")


def test_a_pulse_without_an_end_is_refused(tmp_path):
    value = half_sine(at=0.048)
    with pytest.raises(InputError, match=r"runs over an end of the record|a step|comes back"):
        run(table(tmp_path / "a.csv", [f"{v:.3f}" for v in value]))


def test_a_soft_foot_is_part_of_the_area_and_of_the_errors(tmp_path):
    """The pulse of 4 ms begins with a ramp of 6 ms to 8 % of its peak."""
    foot = 64.0 * np.clip((T - 0.014) / 6e-3, 0.0, 1.0) * (T < 0.02)
    clean = run(table(tmp_path / "a.csv", [f"{v:.3f}" for v in half_sine()]))
    found = run(table(tmp_path / "b.csv", [f"{v:.3f}" for v in half_sine() + foot]))
    truth = 2 / np.pi * 800.0 * 4e-3 + 0.5 * 64.0 * 6e-3
    impulse = found.values["impulse_N_s"]
    assert abs(impulse.value - truth) < 2.0 * impulse.std < 0.25
    assert found.values["contact_time_s"].std > 5.0 * clean.values["contact_time_s"].std
    assert any("a foot before the flank" in note for note in found.notes)
    assert not any("foot" in note for note in clean.notes)


@pytest.mark.parametrize("rings", ["plate", "sensor"])
def test_a_ringing_moves_peak_and_ends_as_far_as_it_lies_within_the_pulse(tmp_path, rings):
    """A plate rings when the blow of 4 ms is over, a sensor on its spring all through it."""
    t = np.arange(0.0, 0.1, 5e-5)
    blow = 800.0 * np.sin(np.pi * np.clip((t - 0.03) / 4e-3, 0.0, 1.0)) ** 1.2
    if rings == "sensor":
        w = 2.0 * np.pi / 1.4e-3
        value = lsim(([w * w], [1.0, 0.1 * w, w * w]), blow, t)[1]
        area = np.trapezoid(blow, t)
    else:
        late = np.maximum(t - 0.034, 0.0)
        value = blow + 160.0 * np.exp(-late / 8e-3) * np.sin(2.0 * np.pi * late / 1.6e-3)
        area = np.trapezoid(value, t)
    value += np.random.default_rng(1).normal(size=t.size)
    path = table(tmp_path / "a.csv", [f"{v:.3f}" for v in value], times=[f"{x:.6f}" for x in t])
    found = run(path)
    for name, truth in (("peak_force_N", 800.0), ("contact_time_s", 4e-3), ("impulse_N_s", area)):
        assert abs(found.values[name].value - truth) < 2.5 * found.values[name].std
    assert found.values["peak_force_N"].std < (80.0 if rings == "sensor" else 4.0)
    assert found.values["impulse_N_s"].std < 0.01
    assert any("rings" in note for note in found.notes)


def test_clocks_with_a_date_keep_their_microseconds():
    cells = [[f"2024-03-12T14:02:11.00000{k}Z", "1.0"] for k in range(4)]
    assert columns_of(cells, "a").values[:, 0] == pytest.approx(1e-6 * np.arange(4.0), abs=1e-9)


def test_rows_of_a_point_not_yet_seen_are_no_names():
    found = heading_of([["pt1_X", "pt1_Y"], ["NaN", "NaN"], ["NaN", "NaN"]], 2)
    assert found.names == ("pt1_X", "pt1_Y")
