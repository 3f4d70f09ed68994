"""TDMS and HDF5: groups of channels as tables, and one line where a reader is missing."""

import sys

import h5py
import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.table.channels import channels_of
from dentscope.reduce.table.file import read_columns

RATE = 2e5
TIME = np.arange(3000) / RATE
FORCE = 900.0 * np.sin(np.pi * np.clip((TIME - 4e-3) / 3e-3, 0.0, 1.0))
FORCE = FORCE + np.random.default_rng(0).normal(0.0, 0.5, TIME.size)


def tdms(path):
    nptdms = pytest.importorskip("nptdms")
    waveform = {"wf_increment": 1.0 / RATE, "unit_string": "Newtons"}
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
            group.attrs["sampling_rate"] = RATE
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
