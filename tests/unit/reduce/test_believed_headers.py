"""Numbers that a header or an option claims are looked at before they are believed."""

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.measured import Measured, Trial
from dentscope.reduce.reduced import Reduced

tifffile = pytest.importorskip("tifffile")
GIVEN = {"frame_rate_hz": 1000.0, "shape": "sphere"}


def clip(path):
    y, x = np.mgrid[:60, :40]
    frames = [
        ((y - 10 - abs(k - 15)) ** 2 + (x - 20) ** 2 < 64).astype(np.uint16) * 60000
        for k in range(30)
    ]
    tifffile.imwrite(path, np.stack(frames), photometric="minisblack")
    return path


def patched(path, tag, value):
    with tifffile.TiffFile(path) as file:
        found = file.pages[0].tags[tag]
        place, kind = found.valueoffset, "<H" if found.dtype == 3 else "<I"
    raw = bytearray(path.read_bytes())
    np.frombuffer(raw, np.uint8)[place : place + np.dtype(kind).itemsize] = np.frombuffer(
        np.array([value], kind).tobytes(), np.uint8
    )
    path.write_bytes(bytes(raw))


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
    from dentscope.reduce.images import clip as clips

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
