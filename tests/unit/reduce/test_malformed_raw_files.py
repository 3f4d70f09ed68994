"""Raw files, options and names that are no good: one line each, exit code 2, nothing elsewhere."""

import struct
import wave
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core.errors import InputError
from dentscope.core.inputs.toml_input import parse_model
from dentscope.core.rig import Rig
from dentscope.reduce.images import clip as clips
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.measured import Measured, Trial
from dentscope.reduce.output.into_set import store
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced
from dentscope.reduce.shared.media import container_of
from dentscope.reduce.sound.file import _decoded, read_sound
from dentscope.studies.synthetic.sounds import write_wav

RAMP = "time_s,force_N\n" + "".join(f"{k * 1e-4},{k % 7}\n" for k in range(60))
PULSE = "time_s,force_N\n" + "".join(
    f"{k * 1e-4:.4f},{100.0 * max(0.0, np.sin((k - 40) / 6.4)) if 40 < k < 60 else 0.0}\n"
    for k in range(100)
)
FALL = "t_s,height_m\n" + "".join(f"{k / 100},{1.0 - 4.905 * (k / 100) ** 2}\n" for k in range(40))
TIMES = "t (s)\n0.5\n1.0\n1.4\n1.72\n1.98\n"


ROWS = "impact_speed_m_s,restitution\n1.5,0.6\n2.0,0.55\n"
TRACK = "time_s,A_x_mm,A_y_mm,A_z_mm\n" + "".join(
    f"{k / 100},0,0,{1000 - 4905 * (k / 100) ** 2}\n" for k in range(30)
)

LONG = "9" * 131_073
CASES = {
    # kind, bytes or text of the file, options, what the line has to name
    "table: empty": ("table", "", "--holds force", "a.csv"),
    "table: words": ("table", "a,b\nc,d\n", "--holds force", "no row of numbers"),
    "table: binary": ("table", b"\x00\x01\x02" * 50, "--holds force", "not text"),
    # behind the lines by which the separator is told, and among them
    "table: a field too long": ("table", PULSE + LONG, "--holds force", "row 102: not a table"),
    "table: a field too long in the middle": (
        "table", PULSE.replace("0.0040,", "0.0040," + LONG), "--holds force", "row 42: not a table",
    ),
    "table: no contents said": ("table", PULSE, "", "--holds"),
    "table: unknown contents": ("table", PULSE, "--holds forces", "holds"),
    "table: no such column": ("table", PULSE, "--holds force --value load", "value"),
    "table: column 9": ("table", PULSE, "--holds force --value 9", "1 to 2"),
    "table: time goes back": (
        "table", "t,F\n" + "".join(f"{-k},{k}\n" for k in range(50)),
        "--holds force --value-unit N", "do not increase",
    ),
    "table: too few rows": ("table", "t_s,F_N\n0,0\n1,2\n2,0\n", "--holds force", "20 or more"),
    "table: unit not said": ("table", PULSE.replace("force_N", "force"), "--holds force",
                             "does not name its unit"),
    "table: unit of another kind": ("table", PULSE, "--holds force --value-unit mm", "value-unit"),
    "table: time unit": ("table", PULSE, "--holds force --time-unit hours", "time"),
    "table: no pulse": ("table", RAMP, "--holds force", "no impact"),
    "table: constant": (
        "table", "t_s,F_N\n" + "".join(f"{k},5\n" for k in range(50)), "--holds force",
        "comes back",
    ),
    "table: mass in words": ("table", PULSE, "--holds force --mass-kg ten", "mass"),
    "table: part without rows": ("table", PULSE, "--holds force --first-s 5", "0 rows"),
    "table: select without a value": ("table", PULSE, "--holds force --select x", "COLUMN=VALUE"),
    "table: select no row": ("table", PULSE, "--holds force --select 1=ball", "no row"),
    "table: fall without contact": ("table", FALL, "--holds height", "no contact"),
    "table: rate of zero": ("table", FALL, "--holds height --rate-hz 0", "rate"),
    "table: two instants": ("table", "t (s)\n0.5\n1.0\n", "--holds bounces", "three or more"),
    "table: instants that grow apart": (
        "table", "t (s)\n0\n0.1\n0.4\n1.5\n6\n", "--holds bounces", "no run of bounces"
    ),
    "table: contact longer than flight": (
        "table", TIMES, "--holds bounces --contact-time-s 0.5", "contact_time_s"
    ),
    "table: a ball lighter than air": (
        "table", TIMES, "--holds bounces --mass-kg 1e-6 --diameter-m 0.1", "mass"
    ),
    "table: rebound above its drop": (
        "table", "drop_cm,up_cm\n50,60\n40,17\n", "--holds rebounds --value 1", "row 1"
    ),
    "table: no rebounds": (
        "table", "drop_cm\n50\n40\n", "--holds rebounds --value 1", "rebound heights"
    ),
    "table: a column twice": (
        "table", "impact_speed_m_s,impact_speed_mm_s,restitution\n1,1000,0.5\n", "--holds trials",
        "stands in",
    ),
    "sound: empty": ("sound", b"", "", "a.csv"),
    "sound: no sound": ("sound", b"RIFF....WAVE", "", "cannot be decoded"),
    "sound: nothing heard": ("sound", "wav", "", "contacts are heard"),
    "sound: past the end": ("sound", "wav", "--first-s 100", "first"),
    "sound: silence": ("sound", "zeros", "", "silence"),
    "video: text": ("video", TIMES, "--frame-rate-hz 1000", "cannot be decoded"),
    "video: empty": ("video", b"", "--frame-rate-hz 9", "a.csv: cannot be decoded"),
    "video: a pixel in mm": (
        "video", TIMES, "--frame-rate-hz 9 --pixel-m 0.2", "less than or equal to 0.01"
    ),
    "video: no rate": ("video", TIMES, "", "frame-rate-hz"),
    "video: two scales": (
        "video", TIMES, "--frame-rate-hz 9 --pixel-m 1e-4 --diameter-m 0.1", "not both"
    ),
    "tip: text": ("tip", TIMES, "--pixel-m 1e-4", "cannot be read as a picture"),
    "tip: two scales": ("tip", TIMES, "--pixel-m 1e-5 --diameter-m 0.01", "not both"),
    "tip: half a crop": ("tip", TIMES, "--pixel-m 1e-5 --crop 1:2", "four whole num"),
    "mocap: no length": ("mocap", TRACK, "--tip-radius-m 0.01", "length_m"),
    "mocap: fall without contact": ("mocap", TRACK, "--shape sphere --tip-radius-m 0.01", "a.csv"),
    "scan: three heights": ("scan", "1,2,3\n4,5,6\n7,8,9\n", "", "heights"),
    "scan: no unit": ("scan", "1,2,3,4,5,6,7,8,9,9\n" * 10, "", "(allowed: m, mm, um, nm)"),
    "scan: empty": ("scan", "", "--unit um --step-m 1e-6", "a.csv: empty"),
    "scan: words": ("scan", "a,b\nc,d\n", "--unit um --step-m 1e-6", "a.csv: empty"),
    "scan: ragged": ("scan", "1,2,3\n4,5\n", "--unit um --step-m 1e-6", "row 2: 2 cel"),
    "scan: a line": ("scan", "x_m,z_m\n" + "0.1,0.2\n" * 9, "", "belongs into profiles/ of a set"),
    "scan: step of zero": ("scan", "1,2\n3,4\n", "--unit um --step-m 0", "step-m"),
}  # fmt: skip


def _write(path, content):
    if content == "wav":
        write_wav(np.random.default_rng(0).normal(0.0, 0.01, 44100), path)
    elif content == "zeros":
        write_wav(np.zeros(44100), path)
    elif isinstance(content, bytes):
        path.write_bytes(content)
    else:
        path.write_text(content)


@pytest.mark.parametrize("case", CASES)
def test_each_mistake_gives_its_line(case, tmp_path, errs):
    kind, content, options, said = CASES[case]
    path, out = tmp_path / "a.csv", tmp_path / "out"
    _write(path, content)
    message = errs("reduce", kind, path, "--out", out, *options.split()).strip()
    assert said in message
    assert "Traceback" not in message
    # what is refused for what it shows is drawn, and nothing else is written
    assert all(p.name.endswith("-refused.png") for p in out.glob("*"))


NONE = {"restitution": Measured(float("nan"), 0.1)}


@pytest.mark.parametrize(
    ("reader", "said"),
    [
        (lambda path, _: float(path.read_text()), "a.csv: its numbers cannot be reduced (could"),
        (lambda path, _: path.read_text().split()[9], "a.csv: its numbers cannot be reduced (list"),
        (lambda path, _: Reduced(path, NONE, (Trial(NONE),), print), "a.csv: nothing was measured"),
    ],
)
def test_what_a_reader_of_ours_does_not_foresee_is_one_line(
    reader, said, tmp_path, monkeypatch, errs
):
    monkeypatch.setattr("dentscope.reduce.sound.kind.reduce", reader)
    (tmp_path / "a.csv").write_text(TIMES)
    (line,) = errs("reduce", "sound", tmp_path / "a.csv", "--out", tmp_path / "out").splitlines()
    assert said in line


def test_a_file_that_is_not_there(tmp_path, errs):
    for kind in ("table --holds force", "sound", "video --frame-rate-hz 9", "tip", "scan",
                 "mocap --shape sphere --tip-radius-m 1"):  # fmt: skip
        assert "none.x" in errs("reduce", *kind.split(), tmp_path / "none.x")


def test_mistakes_leave_a_set_as_it_was(tmp_path, errs):
    where = tmp_path / "set"
    (tmp_path / "a.csv").write_text(ROWS)
    command = ["reduce", "table", str(tmp_path / "a.csv"), "--holds", "trials"]
    assert run([*command, "--into", str(where)]) == 0
    before = {p.name: p.read_bytes() for p in where.iterdir() if p.is_file()}
    (tmp_path / "a.csv").write_text("drop height,restitution\n3.0,0.5\n")
    assert "the header names no unit" in errs(*command, "--into", where)
    assert {p.name: p.read_bytes() for p in where.iterdir() if p.is_file()} == before


def test_a_playlist_opens_no_other_file(tmp_path):
    pytest.importorskip("av")
    (tmp_path / "private").mkdir()
    with wave.open(str(tmp_path / "private" / "x.wav"), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(8000)
        sound.writeframes(b"\0\0" * 800)
    assert len(_decoded(tmp_path / "private" / "x.wav")[0]) == 800
    with wave.open(str(tmp_path / "empty.wav"), "wb") as sound:
        sound.setparams((1, 2, 8000, 0, "NONE", ""))
    with pytest.raises(InputError, match="silence"):
        read_sound(tmp_path / "empty.wav")
    listed = tmp_path / "list.mp3"
    listed.write_text("ffconcat version 1.0\nfile private/x.wav\n")
    with (
        pytest.raises(InputError, match=r"list\.mp3: cannot be decoded"),
        container_of(listed, "sounds", "WAV") as container,
    ):
        list(container.decode(audio=0))


TABLE = "drop_height_m,rebound_height_m\n0.5,0.2\n0.4,0.15\n"
PATHS = ("../x", "/tmp/x", "a/b", "..", "a\\b", "C:x", "x\x00y", "x" * 201)


@pytest.mark.parametrize("name", [n for n in PATHS if "\x00" not in n])
@pytest.mark.parametrize("place", ["--out", "--into"])
def test_an_option_names_no_other_folder(tmp_path, errs, name, place):
    raw = tmp_path / "raw.csv"
    raw.write_text(TABLE)
    command = ("reduce", "table", raw, "--holds", "trials", "--trial", name)
    told = errs(*command, place, tmp_path / "o" / "o")
    assert "trial" in told
    assert "text that can name a file" in told
    assert sorted(p.name for p in tmp_path.iterdir()) == ["raw.csv"]


@pytest.mark.parametrize("name", PATHS)
def test_a_striker_of_a_file_names_no_other_folder(name: str) -> None:
    steel = {"E_Pa": 2e11, "nu": 0.3}
    ball = {"shape": "sphere", "tip_radius_m": 0.01, **steel}
    with pytest.raises(InputError, match="text that can name a file"):
        parse_model({"target": steel, "strikers": {name: ball}}, Rig, source="set.toml")


def test_trials_without_a_label_keep_a_row_each(tmp_path: Path) -> None:
    run(["recordings", "new", str(tmp_path / "set")])
    blows = [Trial({"restitution": Measured(e, 0.01)}) for e in (0.8, 0.7)]
    (tmp_path / "gates.txt").write_text("1.0 0.8\n1.0 0.7\n")
    reduced = Reduced(tmp_path / "gates.txt", {}, tuple(blows), lambda to: None)
    row = Row(striker="ball", impact_speed_m_s=1.0)
    found = store(reduced, tmp_path / "set", row, kind="gates", options={})
    assert found.trials == ("gates-1", "gates-2")
    rows = (tmp_path / "set" / "trials.csv").read_text().splitlines()
    assert [line.split(",")[0] for line in rows[-2:]] == ["gates-1", "gates-2"]


GIVEN = {"frame_rate_hz": 1000.0, "shape": "sphere"}


def clip(path):
    tifffile = pytest.importorskip("tifffile")
    y, x = np.mgrid[:60, :40]
    frames = [
        ((y - 10 - abs(k - 15)) ** 2 + (x - 20) ** 2 < 64).astype(np.uint16) * 60000
        for k in range(30)
    ]
    tifffile.imwrite(path, np.stack(frames), photometric="minisblack")
    return path


def patched(path, tag, value):
    with pytest.importorskip("tifffile").TiffFile(path) as file:
        found = file.pages[0].tags[tag]
        place, kind = found.valueoffset, "<H" if found.dtype == 3 else "<I"
    raw = bytearray(path.read_bytes())
    struct.pack_into(kind, raw, place, value)
    path.write_bytes(raw)


@pytest.mark.parametrize(
    ("tag", "value", "words"),
    [("ImageLength", 60_000, "a page of|cannot be read as a TIFF"),
     ("BitsPerSample", 14, "cannot be read as a TIFF"),
     ("BitsPerSample", 12, "cannot be read as a TIFF"),
     ("ImageWidth", 0, "one flat picture"),
     ("ImageLength", 0, "one flat picture"),
     ("SamplesPerPixel", 77, "cannot be read as a TIFF"),
     ("Compression", 65000, "cannot be read as a TIFF"),
     ("StripOffsets", 2**31, "cannot be read as a TIFF")],
)  # fmt: skip
def test_a_header_that_lies_is_one_line(tmp_path, tag, value, words):
    path = clip(tmp_path / "clip.tif")
    patched(path, tag, value)
    with pytest.raises(InputError, match=words) as told:
        load_kind("video").run(path, GIVEN, source="test")
    assert "\n" not in str(told.value)


def test_a_page_larger_than_the_memory_is_not_allocated(tmp_path, monkeypatch):
    monkeypatch.setattr(clips, "_CLIP_BYTES", 4000)
    with pytest.raises(InputError, match=r"a page of 4.8e-06 GB"):
        load_kind("video").run(clip(tmp_path / "clip.tif"), GIVEN, source="test")


@pytest.mark.parametrize(
    "cut",
    [lambda raw: b"", lambda raw: raw[:8], lambda raw: raw[: len(raw) // 2], lambda raw: raw[::-1],
     lambda raw: b"time,height\n0,1\n"],
    ids=["empty", "a header alone", "half", "backwards", "a table"],
)  # fmt: skip
def test_a_file_that_is_no_clip_is_one_line(tmp_path, cut):
    path = clip(tmp_path / "clip.tif")
    path.write_bytes(cut(path.read_bytes()))
    with pytest.raises(InputError, match=r"clip\.tif: ") as told:
        load_kind("video").run(path, GIVEN, source="test")
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [("first_frame", 10**21, "first_frame"), ("last_frame", 10**21, "last_frame"),
     ("first_frame", -1, "first_frame"), ("pixel_m", float("nan"), "pixel_m"),
     ("frame_rate_hz", float("inf"), "frame_rate_hz"), ("last_frame", 0, "1 frames in the range"),
     ("pixel_m", -1e-4, "pixel_m"), ("frame_rate_hz", 0.0, "frame_rate_hz"),
     ("diameter_m", 0.0, "diameter_m"), ("crop", "0,0,1e9,1e9", "crop"),
     ("crop", "5,5,5,5", "crop"),
     ("channel", "ultraviolet", "channel"), ("down", "sideways", "down")],
)  # fmt: skip
def test_options_beyond_all_clips_are_refused(tmp_path, option, value, words):
    with pytest.raises(InputError, match=words):
        load_kind("video").run(clip(tmp_path / "c.tif"), {**GIVEN, option: value}, source="test")


def test_what_was_not_measured_is_not_told(tmp_path):
    values = {"pixel_m": Measured(float("nan"), 1.0), "restitution": Measured(0.5, float("nan"))}
    found = Reduced(tmp_path, values, (Trial(values),), lambda to: None).known()
    assert set(found.values) == set(found.trials[0].observables) == {"restitution"}
