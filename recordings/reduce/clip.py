"""High-speed clips: frames of a video file or of a folder of pictures, as grey values."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...core.errors import InputError
from .measured import Array

CHANNELS = ("grey", "red", "green", "blue")
DOWN = {"down": 0, "left": 1, "up": 2, "right": 3}
"""Where gravity points in the picture, and the quarter turns counter-clockwise that undo it."""

_CROP = re.compile(r"(\d+):(\d+),(\d+):(\d+)")
_PICTURES = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm")
_LARGEST = 3_000_000_000

_REPEAT = 0.35
"""Change of a frame, in that of its neighbours, below which it may repeat the one before."""

_OFTEN = 0.2
"""Part of the frames that must do so before they count as repeated."""


@dataclass(frozen=True)
class Clip:
    """Frames with gravity downwards, and what the container says about their timing.

    Parameters
    ----------
    frames
        (n, rows, columns), grey values 0-255.
    container_rate
        Frames per second by the container's time stamps, nan for a folder of pictures [1/s].
    uneven
        Number of gaps between time stamps that differ from the usual one by more than half.
    repeats
        Numbers of the frames that show what their predecessor showed, (r,).
    source
        The file or folder.
    """

    frames: npt.NDArray[np.uint8]
    container_rate: float
    uneven: int
    repeats: npt.NDArray[np.int64]
    source: str


def read_clip(
    path: Path,
    *,
    channel: str = "grey",
    down: str = "down",
    first: int = 0,
    last: int | None = None,
    crop: tuple[int, int, int, int] | None = None,
) -> Clip:
    """Read a video file (anything FFmpeg decodes: AVI, MP4, MOV, MKV) or a folder of pictures.

    Parameters
    ----------
    path
        File or folder; pictures are taken in the natural order of their names.
    channel
        One of `CHANNELS`.
    down
        Where gravity points in the picture as a player shows it, one of `DOWN`.
    first, last
        Range of frames, both included.
    crop
        Rows and columns to keep (top, bottom, left, right) after turning, the ends excluded.

    Raises
    ------
    InputError
        The file cannot be decoded, holds too few frames, or is too large for the memory.
    """
    _check_choice(channel, CHANNELS, "channel")
    _check_choice(down, tuple(DOWN), "down")
    if first < 0 or (last is not None and last < first):
        raise InputError(
            f"{first}:{last}", source="command line", key="frames",
            allowed="FIRST:LAST with 0 <= FIRST <= LAST",
        )  # fmt: skip
    if not path.exists():
        raise InputError(
            "no such file or folder", source=str(path),
            allowed="a video or a folder of pictures",
        )  # fmt: skip
    reader = _pictures(path, channel) if path.is_dir() else _video(path, channel)
    frames: list[npt.NDArray[np.uint8]] = []
    stamps: list[float] = []
    total = 0
    for number, (stamp, frame) in enumerate(reader):
        if number < first:
            continue
        if last is not None and number > last:
            break
        frame = np.rot90(frame, DOWN[down])
        if crop is not None:
            frame = cropped(frame, crop)
        if frames and frame.shape != frames[0].shape:
            raise InputError(
                f"frame {number} has {frame.shape[1]} x {frame.shape[0]} pixels, the first one "
                f"{frames[0].shape[1]} x {frames[0].shape[0]}",
                source=str(path), allowed="frames of one size",
            )  # fmt: skip
        total += frame.size
        if total > _LARGEST:
            raise InputError(
                f"more than {_LARGEST // 10**9} GB of frames", source=str(path),
                allowed="a shorter range with --frames FIRST:LAST, or a --crop",
            )  # fmt: skip
        frames.append(np.ascontiguousarray(frame))
        stamps.append(stamp)
    if len(frames) < 10:
        raise InputError(
            f"{len(frames)} frames in the range", source=str(path), allowed="10 frames or more"
        )
    stack = np.stack(frames)
    rate, uneven = _timing(np.array(stamps))
    return Clip(stack, rate, uneven, repeated_frames(stack), str(path))


def repeated_frames(frames: npt.NDArray[np.uint8]) -> npt.NDArray[np.int64]:
    """Return the numbers of frames that show what their predecessor showed, compressed or not.

    A converter that doubles the frame rate makes every other change small; a slow striker makes
    neighbouring changes alike.
    """
    step = max(1, max(frames.shape[1:]) // 250)
    few = frames[:, ::step, ::step].astype(np.int16)
    change = np.array([np.abs(b - a).mean() for a, b in pairwise(few)])
    around = np.maximum(np.append(change[1:], 0.0), np.append(0.0, change[:-1]))
    found = np.flatnonzero(change < _REPEAT * around) + 1
    equal = np.flatnonzero(change == 0.0) + 1
    return np.asarray(found if found.size > _OFTEN * len(frames) else equal)


def _check_choice(value: str, allowed: tuple[str, ...], key: str) -> None:
    if value not in allowed:
        raise InputError(repr(value), source="command line", key=key, allowed=", ".join(allowed))


def _video(path: Path, channel: str) -> Iterator[tuple[float, npt.NDArray[np.uint8]]]:
    try:
        import av
    except ImportError:
        raise missing_extra("reading videos", "video") from None
    try:
        with av.open(str(path)) as container:
            if not container.streams.video:
                raise InputError("no video in it", source=str(path), allowed="a video file")
            for frame in container.decode(video=0):
                stamp = np.nan if frame.pts is None else float(frame.pts * frame.time_base)
                pixels = frame.to_ndarray(format="gray" if channel == "grey" else "rgb24")
                turned = np.rot90(
                    _channel(pixels, channel), int(getattr(frame, "rotation", 0)) // 90
                )
                yield stamp, turned
    except av.FFmpegError as error:
        text = getattr(error, "strerror", None) or type(error).__name__
        raise InputError(
            f"cannot be decoded ({text})", source=str(path), allowed="an AVI, MP4, MOV or MKV file"
        ) from None


def _pictures(path: Path, channel: str) -> Iterator[tuple[float, npt.NDArray[np.uint8]]]:
    names = sorted(
        (p for p in path.iterdir() if p.suffix.lower() in _PICTURES), key=lambda p: _natural(p.name)
    )
    if not names:
        raise InputError("no pictures in it", source=str(path), allowed=" ".join(_PICTURES))
    for name in names:
        yield np.nan, read_picture(name, channel=channel)


def read_picture(path: Path, *, channel: str = "grey") -> npt.NDArray[np.uint8]:
    """Return one picture as grey values 0-255, (rows, columns).

    Raises
    ------
    InputError
        Not a picture that can be read.
    """
    try:
        from skimage.io import imread
    except ImportError:
        raise missing_extra("reading pictures", "video") from None
    if not path.is_file():
        raise InputError("no such file", source=str(path), allowed="a picture")
    if path.suffix.lower() not in _PICTURES:
        raise InputError(
            "cannot be read as a picture", source=str(path), allowed=" ".join(_PICTURES)
        )
    try:
        pixels = np.asarray(imread(path))
    except Exception as error:  # every plug-in of the picture reader raises its own kind
        raise InputError(
            f"cannot be read as a picture ({_first_line(error)})", source=str(path),
            allowed=" ".join(_PICTURES),
        ) from None  # fmt: skip
    if pixels.dtype == np.uint16:
        pixels = (pixels // 257).astype(np.uint8)
    elif pixels.dtype == np.bool_:
        pixels = pixels.astype(np.uint8) * 255
    elif pixels.dtype != np.uint8:
        raise InputError(
            f"pixels of type {pixels.dtype}", source=str(path), allowed="8 or 16 bits a pixel"
        )
    if pixels.ndim == 3 and pixels.shape[2] in (2, 4):
        pixels = pixels[:, :, :-1]  # the last plane is the transparency
    if pixels.ndim == 3 and pixels.shape[2] == 1:
        pixels = pixels[:, :, 0]
    if pixels.ndim not in (2, 3) or (pixels.ndim == 3 and pixels.shape[2] != 3):
        raise InputError(f"shape {pixels.shape}", source=str(path), allowed="one flat picture")
    return _channel(pixels, channel)


def _channel(pixels: npt.NDArray[np.uint8], channel: str) -> npt.NDArray[np.uint8]:
    if pixels.ndim == 2:
        return pixels
    if channel == "grey":  # luma of ITU-R BT.601
        return np.asarray(pixels @ np.array([0.299, 0.587, 0.114]) + 0.5).astype(np.uint8)
    return pixels[:, :, CHANNELS.index(channel) - 1]


def crop_window(text: str) -> tuple[int, int, int, int] | None:
    """Return the four numbers of TOP:BOTTOM,LEFT:RIGHT, None for an empty text.

    Raises
    ------
    ValueError
        Any other text.
    """
    found = _CROP.fullmatch(text)
    if found is None:
        if text:
            raise ValueError("TOP:BOTTOM,LEFT:RIGHT, four whole numbers")
        return None
    top, bottom, left, right = map(int, found.groups())
    return top, bottom, left, right


def cropped(frame: npt.NDArray[np.uint8], crop: tuple[int, int, int, int]) -> npt.NDArray[np.uint8]:
    """Return the rows and columns of a crop, its ends excluded.

    Raises
    ------
    InputError
        The crop is not within the frame.
    """
    top, bottom, left, right = crop
    if not (0 <= top < bottom <= frame.shape[0] and 0 <= left < right <= frame.shape[1]):
        raise InputError(
            f"{top}:{bottom},{left}:{right}", source="command line", key="crop",
            allowed=f"TOP:BOTTOM,LEFT:RIGHT within {frame.shape[0]} rows, {frame.shape[1]} columns",
        )  # fmt: skip
    return frame[top:bottom, left:right]


def _timing(stamps: Array) -> tuple[float, int]:
    gaps = np.diff(stamps)
    if not np.all(np.isfinite(gaps)) or gaps.size == 0 or np.median(gaps) <= 0.0:
        return float("nan"), 0
    usual = float(np.median(gaps))
    uneven = int(np.sum(np.abs(gaps - usual) > 0.5 * usual))
    return float(gaps.size / (stamps[-1] - stamps[0])), uneven


def _natural(name: str) -> list[tuple[int, str]]:
    return [(int(t), "") if t.isdigit() else (-1, t.lower()) for t in re.split(r"(\d+)", name)]


def _first_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[0][:120] if lines else type(error).__name__


def missing_extra(what: str, extra: str) -> InputError:
    """Return the line that says which optional packages a reduction needs."""
    return InputError(
        f"{what} needs packages that are not installed", source="installation",
        allowed=f"pip install 'dentscope[{extra}]'",
    )  # fmt: skip
