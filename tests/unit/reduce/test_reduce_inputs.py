"""Files as laboratories keep them: tracker projects, packed exports, stacks of pages, strengths."""

import struct
import zipfile

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core.errors import InputError, InputErrors
from dentscope.recordings import read
from dentscope.recordings.recording_set import read_as
from dentscope.reduce.images.clip import read_clip
from dentscope.reduce.table.file import read_columns
from made_records import tracker_project


def test_a_tracker_project_in_its_own_axes(tmp_path):
    # 500 pixels a metre, origin at (100, 200), rows downwards
    (tmp_path / "a.trk").write_text(tracker_project({3: (100.0, 200.0), 0: (150.0, 100.0)}))
    table = read_columns(tmp_path / "a.trk")
    assert table.names == ("t [s]", "x [m]", "y [m]")
    assert table.values == pytest.approx(np.array([[0.0, 0.1, 0.2], [0.015, 0.0, 0.0]]))
    # axes turned by 90 degrees: their x points up in the picture
    (tmp_path / "b.trk").write_text(tracker_project({0: (150.0, 100.0)}, angle=90.0))
    assert read_columns(tmp_path / "b.trk").values[0] == pytest.approx([0.0, 0.2, -0.1])
    # what is damaged is left out, and axes without a number are those of the picture
    (tmp_path / "d.trk").write_text(
        tracker_project({0: ("nan", "1e999"), 1: ("lost", 2.0), 2: (150.0, 100.0)}, angle="inf")
    )
    assert read_columns(tmp_path / "d.trk").values == pytest.approx(np.array([[0.01, 0.1, 0.2]]))
    for text, words in (("<object>", "cannot be read"), ("<object/>", "0 tracks"),
                        ("<!ENTITY a><object/>", "not a plain project")):  # fmt: skip
        (tmp_path / "c.trk").write_text(text)
        with pytest.raises(InputError, match=words):
            read_columns(tmp_path / "c.trk")


def test_a_packed_export(tmp_path):
    with zipfile.ZipFile(tmp_path / "run.zip", "w") as archive:
        archive.writestr("Raw Data.csv", "Time (s);Height (mm)\n0,0;1,5\n0,1;2,5\n")
        archive.writestr("meta/device.csv", "property;value\n")
    table = read_columns(tmp_path / "run.zip")
    assert table.values[1] == pytest.approx([0.1, 2.5])
    assert table.unit(1) == "mm"
    with pytest.raises(InputError, match=r"no table 'x'.*Raw Data"):
        read_columns(tmp_path / "run.zip", sheet="x")
    (tmp_path / "bad.zip").write_bytes((tmp_path / "run.zip").read_bytes()[:60])
    with pytest.raises(InputError, match="cannot be unpacked"):
        read_columns(tmp_path / "bad.zip")


def test_a_stack_of_pages_is_a_clip(tmp_path):
    tifffile = pytest.importorskip("tifffile")
    frames = np.random.default_rng(1).integers(0, 255, (12, 20, 16), dtype=np.uint8)
    tifffile.imwrite(tmp_path / "a.tif", frames)
    assert np.array_equal(read_clip(tmp_path / "a.tif").frames, frames)
    tifffile.imwrite(tmp_path / "b.tif", frames.astype(np.uint16) * 257)
    assert np.array_equal(read_clip(tmp_path / "b.tif").frames, frames)
    (tmp_path / "c.tif").write_bytes(b"II*\0" + bytes(40))
    with pytest.raises(InputError, match=r"TIFF|frames"):
        read_clip(tmp_path / "c.tif")


def _cine(frames, path, bits):
    """Write a Phantom file: three headers, offsets, frames bottom up (Vision Research, 12-bit)."""
    count, rows, columns = frames.shape
    at_image, at_setup = 44, 84
    at_offsets = at_setup + 6000
    first = at_offsets + 8 * count
    setup = bytearray(6000)
    struct.pack_into("<2sH", setup, 140, b"ST", 0x163C)
    struct.pack_into("<I", setup, 768, 5000)  # frames a second
    struct.pack_into("<I", setup, 896, bits)
    size = 8 + 2 * rows * columns
    with path.open("wb") as out:
        out.write(struct.pack("<2sHHHiIiIIIIQ", b"CI", 44, 0, 1, 0, count, 0, count,
                              at_image, at_setup, at_offsets, 0))  # fmt: skip
        out.write(struct.pack("<IiiHHIIiiII", 40, columns, rows, 1, 16, 0, 0, 0, 0, 0, 0))
        out.write(setup)
        out.write(struct.pack(f"<{count}Q", *(first + size * k for k in range(count))))
        for frame in frames:
            out.write(struct.pack("<II", 8, size - 8) + frame[::-1].astype("<u2").tobytes())


def test_a_phantom_file_of_twelve_bits_is_a_clip(tmp_path):
    pytest.importorskip("av")
    frames = np.random.default_rng(1).integers(0, 4096, (12, 20, 16))
    _cine(frames, tmp_path / "a.cine", 12)
    clip = read_clip(tmp_path / "a.cine")
    assert np.abs(clip.frames.astype(int) - frames / 4095.0 * 255.0).max() <= 1.0
    assert clip.container_rate == pytest.approx(5000.0)


CIHX = """junk\n<cih><recordInfo><recordRate>8000</recordRate></recordInfo>
<frameInfo><totalFrame>12</totalFrame></frameInfo><imageDataInfo><resolution><width>16</width>
<height>20</height></resolution><effectiveBit><depth>12</depth><side>Lower</side></effectiveBit>
<colorInfo><bit>BITS</bit></colorInfo></imageDataInfo></cih>\nmore"""


@pytest.mark.parametrize("bits", [16, 12])
def test_a_photron_file_is_a_clip(tmp_path, bits):
    frames = np.random.default_rng(1).integers(0, 4096, (12, 20, 16))
    one, two = frames.reshape(-1, 2).T
    packed = np.stack([one >> 4, ((one & 15) << 4) + (two >> 8), two & 255], axis=1)
    raw = frames.astype("<u2") if bits == 16 else packed.astype(np.uint8)
    (tmp_path / "a.mraw").write_bytes(raw.tobytes())
    (tmp_path / "a.cihx").write_text(CIHX.replace("BITS", str(bits)))
    for name in ("a.mraw", "a.cihx"):
        clip = read_clip(tmp_path / name)
        assert np.array_equal(clip.frames, frames >> 4)
        assert clip.container_rate == pytest.approx(8000.0)
    for wrong, words in (("24", "24 bits"), ("", "Color Bit"), ("x", "whole number")):
        (tmp_path / "a.cihx").write_text(CIHX.replace("BITS", wrong))
        with pytest.raises(InputError, match=words):
            read_clip(tmp_path / "a.mraw")
    (tmp_path / "a.cihx").write_text(CIHX.replace("BITS", str(bits)).replace(">12<", ">13<", 1))
    with pytest.raises(InputError, match="13 frames"):
        read_clip(tmp_path / "a.mraw")
    (tmp_path / "a.cihx").unlink()
    with pytest.raises(InputError, match="no header"):
        read_clip(tmp_path / "a.mraw")


def test_tension_and_leeb_tables_into_a_set(tmp_path):
    strain = np.concatenate([np.linspace(0, 0.15, 60), np.linspace(0.2, 8.0, 200)])
    stress = np.minimum(200e3 * strain / 100.0, 300.0) + 5.0 * strain
    rows = "\n".join(f"{a:.5f},{b:.4f}" for a, b in zip(strain, stress, strict=True))
    (tmp_path / "pull.csv").write_text("strain (%),stress (MPa)\n" + rows)
    (tmp_path / "leeb.csv").write_text("plate;1st;2nd\nA;780;775\nB;782;781\n")
    where = str(tmp_path / "set")
    command = ["reduce", "table", str(tmp_path / "leeb.csv"), "--holds", "leeb", "--value", "2"]
    for plate in "ABA":  # each a part of the file, the last once more
        picked = [*command, "--select", f"plate={plate}", "--value-std", "3", "--into", where]
        assert run(picked) == 0
    command = ["reduce", "table", str(tmp_path / "pull.csv"), "--holds", "tension"]
    assert run([*command, "--into", where]) == 0
    found = read(where, unfinished=True)
    assert found.trials.observables["restitution"] == pytest.approx([0.78, 0.775, 0.782, 0.781])
    assert found.trials.impact_speed_m_s == pytest.approx([2.05] * 4)
    assert found.flows["target"].strength == pytest.approx(310e6, rel=0.03)


def test_a_flow_curve_that_is_there_is_kept_and_the_new_one_listed(tmp_path, prints):
    strain = np.linspace(0.0, 0.1, 300)
    for name, slope in (("a", 1e9), ("b", 2e9)):
        stress = np.minimum(200e9 * strain, 300e6 + slope * strain)
        rows = "\n".join(f"{e:.6f},{s:.0f}" for e, s in zip(strain, stress, strict=True))
        (tmp_path / f"{name}.csv").write_text(f"strain,stress (Pa)\n{rows}\n")
    where = tmp_path / "set"
    own = "plastic_strain,true_stress_Pa\n0,2.5e8\n0.10,4.00e8\n"

    def pulled(name, body="target"):
        command = ("reduce", "table", tmp_path / f"{name}.csv", "--holds", "tension")
        return prints(*command, "--into", where, "--body", body)

    assert "target-flow.csv" in pulled("a").partition("written: ")[2]
    first = (where / "target-flow.csv").read_text()
    assert "another one" not in pulled("a")  # the same once more
    (where / "target-flow.csv").write_text(own)
    pulled("a", "ball")
    assert (where / "target-flow.csv").read_text() == own
    assert "there was another one, kept as target-flow-1.csv" in pulled("a")
    assert "kept as target-flow-2.csv" in pulled("b")
    kept = [(where / f"target-flow-{k}.csv").read_text() for k in (1, 2)]
    assert kept == [own, first]


def test_many_mistakes_of_the_set_that_a_reduction_would_write_are_many_lines(tmp_path):
    text = 'format = "recording-set/1"\nname = "a"\n[target]\nE_Pa = 2\nnu = 0.7\n'
    with pytest.raises(InputErrors) as caught:
        read_as(tmp_path / "set", {"set.toml": text, "trials.csv": "trial\n"}, unfinished=True)
    lines = str(caught.value).splitlines()
    assert len(lines) >= 2
    assert all(line.startswith(str(tmp_path / "set")) for line in lines)
