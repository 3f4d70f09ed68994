"""Clips of Photron cameras: `.cihx` or `.cih`, which tell size, bits and rate, beside `.mraw`.

By hand: the format is a header and bare frames, and its one reader is under another licence.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from ...core.errors import InputError, reading
from ...core.inputs.input_file import read_bytes
from .picture_file import Frame

# limit: largest header of a clip [bytes]: a thousand times the usual one
_HEADER_BYTES = 10_000_000

ENDINGS = (".mraw", ".cihx", ".cih")

_HEADERS = {
    "frames": ("Total Frame", "frameInfo/totalFrame"),
    "width": ("Image Width", "imageDataInfo/resolution/width"),
    "height": ("Image Height", "imageDataInfo/resolution/height"),
    "bits": ("Color Bit", "imageDataInfo/colorInfo/bit"),
    "depth": ("EffectiveBit Depth", "imageDataInfo/effectiveBit/depth"),
    "side": ("EffectiveBit Side", "imageDataInfo/effectiveBit/side"),
    "rate": ("Record Rate(fps)", "recordInfo/recordRate"),
}
"""What is needed, by its name in a .cih and its place in a .cihx."""


def photron_frames(path: Path) -> Iterator[tuple[float, Frame]]:
    """Yield time [s] and grey values 0-255 (rows, columns) of each frame.

    Refuses what has no header beside the frames, or one that does not say what is needed, colours,
    or fewer bytes than it claims.
    """
    said = _header(path)
    count, rows, columns, bits, depth = (
        _whole(said, name, path) for name in ("frames", "height", "width", "bits", "depth")
    )
    rate = float(_whole(said, "rate", path))
    if bits not in (8, 12, 16) or not 8 <= depth <= bits:
        raise InputError(
            f"{bits} bits a pixel, {depth} of them used", source=str(path),
            allowed="8, 12 or 16 bits of grey",
        )  # fmt: skip
    raw, size = path.with_suffix(".mraw"), rows * columns * bits // 8
    if not raw.is_file() or raw.stat().st_size < count * size or rows * columns * bits % 8:
        raise InputError(
            f"{count} frames of {columns} x {rows} pixels claimed", source=str(raw),
            allowed=f"{count * size} bytes of them or more",
        )  # fmt: skip
    # 12 packed bits have no room for a choice of side
    shift = bits - 8 if said["side"].lower() == "higher" or bits == 12 else depth - 8
    pixels = np.memmap(raw, dtype=np.uint8, mode="r", shape=(count, size))
    for k, frame in enumerate(pixels):
        grey = np.minimum(_values(frame, bits) >> shift, 255).astype(np.uint8)
        yield k / rate, grey.reshape(rows, columns)


def _values(frame: Frame, bits: int) -> npt.NDArray[np.uint16]:
    """Unpack a frame: two values of 12 bits lie in three bytes, others as they are."""
    if bits == 8:
        return frame.astype(np.uint16)
    if bits == 16:
        return np.asarray(frame.view("<u2"), dtype=np.uint16)
    first, middle, last = frame.reshape(-1, 3).astype(np.uint16).T
    pairs = (first << 4) + (middle >> 4), ((middle & 15) << 8) + last
    return np.stack(pairs, axis=1).ravel()


def _header(path: Path) -> dict[str, str]:
    """Return what is needed, as text, from the header beside the frames."""
    found = next((p for e in ENDINGS[1:] if (p := path.with_suffix(e)).is_file()), None)
    if found is None:
        raise InputError("no header beside it", source=str(path), allowed=".cihx or .cih")
    text = read_bytes(found, most=_HEADER_BYTES, allowed="a header").decode("latin-1")
    pairs = dict(line.split(" : ", 1) for line in text.splitlines() if " : " in line)
    said = {name: pairs.get(label, "").strip() for name, (label, _) in _HEADERS.items()}
    said = _of_xml(text, found) if found.suffix == ".cihx" else said
    for name, (label, _) in _HEADERS.items():
        if not said[name]:
            raise InputError("missing", source=str(found), key=label, allowed="its value")
    return said


def _of_xml(text: str, source: Path) -> dict[str, str]:
    found = re.search(r"<cih>.*</cih>", text, re.DOTALL)
    with reading(source, "a header of Photron", raised=(ElementTree.ParseError, ValueError)):
        if found is None or "<!ENTITY" in text:
            raise ValueError("no table cih")
        root = ElementTree.fromstring(found.group())
    return {name: root.findtext(place, "").strip() for name, (_, place) in _HEADERS.items()}


def _whole(said: Mapping[str, str], name: str, path: Path) -> int:
    number = re.fullmatch(r"(\d{1,9})(\.0*)?", said[name])
    if number is None or int(number[1]) < 1:
        raise InputError(
            repr(said[name][:40]), source=str(path), key=_HEADERS[name][0],
            allowed="a whole number above 0",
        )  # fmt: skip
    return int(number[1])
