"""High-speed clips: frames of a video file or of a folder of pictures, as grey values."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice, pairwise
from pathlib import Path

import numpy as np

from ...core.arrays import Array, Integers
from ...core.errors import InputError, optional, reading
from ..rules import RULES
from ..shared.media import container_of
from . import photron
from .picture_file import (
    DOWN,
    PICTURES,
    Crop,
    Frame,
    cropped,
    grey_picture,
    natural_order,
    one_channel,
    read_picture,
)

# limit: memory that a clip may take [bytes]: memory of a small machine
_CLIP_BYTES = 3_000_000_000


@dataclass(frozen=True)
class Clip:
    """Frames (n, rows, columns) with gravity downwards, grey 0-255, and what the container says.

    Frames per second by its time stamps [1/s], nan for pictures; how many gaps between the stamps
    (n,) [s] differ from the usual one by more than half; numbers of frames that repeat the one
    before.
    """

    frames: Frame
    container_rate: float
    uneven: int
    repeats: Integers
    source: str
    stamps: Array | None = None


def read_clip(
    path: Path, *, channel: str = "grey", down: str = "down", first: int = 0,
    last: int | None = None, crop: Crop | None = None,
) -> Clip:  # fmt: skip
    """Read a video (what FFmpeg decodes, .mraw, a TIFF of many pages) or a folder of pictures.

    Pictures are taken in the natural order of their names. `channel` is one of `CHANNELS`, `down`,
    where gravity points as a player shows it, of `DOWN`; `first` and `last` frame are both
    included; `crop` keeps rows and columns (top, bottom, left, right) after turning, the ends
    excluded. Refused where it cannot be decoded, holds too few frames, or is too large for the
    memory.
    """
    if not path.exists():
        raise InputError(
            "no such file or folder", source=str(path), allowed="a video or a folder of pictures"
        )
    if path.is_dir():
        reader = _pictures(path, channel)
    elif path.suffix.lower() in (".tif", ".tiff"):
        reader = _pages(path, channel)
    elif path.suffix.lower() in photron.ENDINGS:
        reader = photron.photron_frames(path)
    else:
        reader = _video(path, channel)
    part = islice(reader, first, None if last is None else last + 1)
    turned = ((t, cropped(np.rot90(f, DOWN[down]), crop)) for t, f in part)
    stamps, frames = _gathered(turned, first, str(path))
    stack = np.stack(frames)
    times = np.array(stamps)
    rate, uneven = _timing(times)
    known = times if math.isfinite(rate) else None
    return Clip(stack, rate, uneven, repeated_frames(stack), str(path), known)


def _gathered(
    reader: Iterator[tuple[float, Frame]], first: int, source: str
) -> tuple[list[float], list[Frame]]:
    """Take in all frames while they are of one size and fit into the memory."""
    stamps: list[float] = []
    frames: list[Frame] = []
    for stamp, frame in reader:
        if frames and frame.shape != frames[0].shape:
            raise InputError(
                f"frame {first + len(frames)} has {frame.shape[1]} x {frame.shape[0]} pixels, the "
                f"first one {frames[0].shape[1]} x {frames[0].shape[0]}",
                source=source, allowed="frames of one size",
            )  # fmt: skip
        if (len(frames) + 1) * frame.size > _CLIP_BYTES:
            raise InputError(
                f"more than {_CLIP_BYTES // 10**9} GB of frames", source=source,
                allowed="a shorter range (--first-frame, --last-frame) or a --crop",
            )  # fmt: skip
        frames.append(np.ascontiguousarray(frame))
        stamps.append(stamp)
    if len(frames) < 10:
        raise InputError(
            f"{len(frames)} frames in the range", source=source, allowed="10 frames or more"
        )
    return stamps, frames


def repeated_frames(frames: Frame) -> Integers:
    """Return the numbers of frames that show what their predecessor showed, compressed or not.

    A converter that doubles the frame rate makes every other change small; a slow striker makes
    neighbouring changes alike.
    """
    step = max(1, max(frames.shape[1:]) // 250)
    few = frames[:, ::step, ::step].astype(np.int16)
    change = np.array([np.abs(b - a).mean() for a, b in pairwise(few)])
    around = np.maximum(np.append(change[1:], 0.0), np.append(0.0, change[:-1]))
    found = np.flatnonzero(change < RULES.repeated * around) + 1
    equal = np.flatnonzero(change == 0.0) + 1
    return np.asarray(found if found.size > RULES.often_repeated * len(frames) else equal)


def _video(path: Path, channel: str) -> Iterator[tuple[float, Frame]]:
    with container_of(path, "videos", "an AVI, MP4, MOV, MKV or CINE file") as container:
        if not container.streams.video:
            raise InputError("no video in it", source=str(path), allowed="a video file")
        for frame in container.decode(video=0):
            stamp = np.nan if frame.pts is None else float(frame.pts * frame.time_base)
            pixels = frame.to_ndarray(format="gray" if channel == "grey" else "rgb24")
            turns = int(getattr(frame, "rotation", 0)) // 90
            yield stamp, np.rot90(one_channel(pixels, channel), turns)


def _pictures(path: Path, channel: str) -> Iterator[tuple[float, Frame]]:
    found = [p for p in path.iterdir() if p.suffix.lower() in PICTURES]
    names = sorted(found, key=lambda p: natural_order(p.name))
    if not names:
        raise InputError("no pictures in it", source=str(path), allowed=" ".join(PICTURES))
    for name in names:
        yield np.nan, read_picture(name, channel=channel)


def _pages(path: Path, channel: str) -> Iterator[tuple[float, Frame]]:
    tifffile = optional("tifffile", "reading pictures", "video")
    # its remarks on damaged headers go to the terminal; the one line below says what matters
    logging.getLogger("tifffile").setLevel(logging.CRITICAL)
    allowed = "a TIFF of many pages, 8 or 16 bits a pixel"
    with reading(path, allowed, "cannot be read as a TIFF"), tifffile.TiffFile(path) as pages:
        for page in pages.pages:
            if page.nbytes > _CLIP_BYTES:  # what a header claims is not allocated unseen
                raise InputError(
                    f"a page of {page.nbytes / 1e9:.3g} GB", source=str(path),
                    allowed=f"pages up to {_CLIP_BYTES // 10**9} GB",
                )  # fmt: skip
            yield np.nan, grey_picture(page.asarray(), channel, str(path))


def _timing(stamps: Array) -> tuple[float, int]:
    gaps = np.diff(stamps)
    if not np.all(np.isfinite(gaps)) or gaps.size == 0 or np.median(gaps) <= 0.0:
        return float("nan"), 0
    usual = float(np.median(gaps))
    uneven = int(np.sum(np.abs(gaps - usual) > 0.5 * usual))
    return float(gaps.size / (stamps[-1] - stamps[0])), uneven
