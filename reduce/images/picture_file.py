"""One picture as grey values: channels, turns and crops."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...core.errors import InputError, optional, reading
from ...core.inputs.input_file import checked_file

# limit: largest picture [bytes]: memory of a small machine
_PICTURE_BYTES = 1_000_000_000

CHANNELS = ("grey", "red", "green", "blue")

Frame = npt.NDArray[np.uint8]
Crop = tuple[int, int, int, int]
"""Rows from and to, columns from and to, the ends excluded."""

DOWN = {"down": 0, "left": 1, "up": 2, "right": 3}
"""Where gravity points in the picture, and the quarter turns counter-clockwise that undo it."""
_CROP = re.compile(r"(\d+):(\d+),(\d+):(\d+)")
PICTURES = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm")


def read_picture(path: Path, *, channel: str = "grey") -> Frame:
    """Return one picture as grey values 0-255, (rows, columns); refuse what cannot be read."""
    skimage_io = optional("skimage.io", "reading pictures", "video")
    checked_file(path, most=_PICTURE_BYTES, allowed="a picture")
    if path.suffix.lower() not in PICTURES:
        raise InputError(
            "cannot be read as a picture", source=str(path), allowed=" ".join(PICTURES)
        )
    with reading(path, " ".join(PICTURES), "cannot be read as a picture"):
        pixels = np.asarray(skimage_io.imread(path))
    return grey_picture(pixels, channel, str(path))


def grey_picture(pixels: npt.NDArray[Any], channel: str, source: str) -> Frame:
    """Return decoded pixels of 8 or 16 bits as grey values 0-255; refuse others."""
    return one_channel(_flat(_eight_bits(pixels, source), source), channel)


def _eight_bits(pixels: npt.NDArray[Any], source: str) -> Frame:
    if pixels.dtype == np.uint16:
        return (pixels // 257).astype(np.uint8)
    if pixels.dtype == np.bool_:
        return pixels.astype(np.uint8) * 255
    if pixels.dtype != np.uint8:
        raise InputError(
            f"pixels of type {pixels.dtype}", source=source, allowed="8 or 16 bits a pixel"
        )
    return pixels


def _flat(pixels: Frame, source: str) -> Frame:
    """Take off a plane of transparency, and a third axis that holds one plane."""
    if pixels.ndim == 3 and pixels.shape[2] in (2, 4):
        pixels = pixels[:, :, :-1]
    if pixels.ndim == 3 and pixels.shape[2] == 1:
        pixels = pixels[:, :, 0]
    flat = pixels.ndim == 2 or (pixels.ndim == 3 and pixels.shape[2] == 3)
    if not flat or not pixels.size:
        raise InputError(f"shape {pixels.shape}", source=source, allowed="one flat picture")
    return pixels


def one_channel(pixels: Frame, channel: str) -> Frame:
    """Return one of `CHANNELS` of a picture in colours, (rows, columns)."""
    if pixels.ndim == 2:
        return pixels
    if channel == "grey":  # luma of ITU-R BT.601
        return np.asarray(pixels @ np.array([0.299, 0.587, 0.114]) + 0.5).astype(np.uint8)
    return pixels[:, :, CHANNELS.index(channel) - 1]


def crop_window(text: str) -> Crop | None:
    """Return the numbers of TOP:BOTTOM,LEFT:RIGHT, None of an empty text; else ValueError."""
    found = _CROP.fullmatch(text)
    if found is None:
        if text:
            raise ValueError("TOP:BOTTOM,LEFT:RIGHT, four whole numbers")
        return None
    top, bottom, left, right = map(int, found.groups())
    return top, bottom, left, right


def cropped(frame: Frame, crop: Crop | None) -> Frame:
    """Return the rows and columns of a crop, its ends excluded; refuse one beyond the frame."""
    if crop is None:
        return frame
    top, bottom, left, right = crop
    if not (0 <= top < bottom <= frame.shape[0] and 0 <= left < right <= frame.shape[1]):
        raise InputError(
            f"{top}:{bottom},{left}:{right}", source="command line", key="crop",
            allowed=f"TOP:BOTTOM,LEFT:RIGHT within {frame.shape[0]} rows, {frame.shape[1]} columns",
        )  # fmt: skip
    return frame[top:bottom, left:right]


def natural_order(name: str) -> list[tuple[int, str]]:
    """Return a key that sorts `2.png` before `10.png`."""
    return [(int(t), "") if t.isdigit() else (-1, t.lower()) for t in re.split(r"(\d+)", name)]
