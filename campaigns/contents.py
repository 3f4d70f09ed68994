"""What an HDF5 file of ours holds: whether every byte is as it was written, and plain values only.

A file is made in memory and sealed: HDF5 leaves its first 512 bytes (the user block) to others, and
there stands the SHA-256 of all that follows. It is compared before HDF5 sees a byte. A group is
read as a tree of texts, numbers and arrays; whatever leads elsewhere (links, external storage,
references) or claims more than it holds is refused.
"""

from __future__ import annotations

import hashlib
import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from ..core.errors import InputError
from ..core.inputs.input_file import read_bytes

# limit: largest text in one [bytes]: a specification takes some thousand
_TEXT_BYTES = 1_000_000

# limit: groups of a file within each other [-]: ours have three
_GROUPS_DEEP = 4

SEALED_FROM = 512
"""Size of the user block."""

DIGEST = "digest"
"""What holds the digest of a case's tree without this name: a column of a part."""

# what reading a file raises that was sealed by somebody who meant ill, or by a fault of ours
_DAMAGE = (
    ArithmeticError, AttributeError, LookupError, OSError, RuntimeError, TypeError, ValueError,
)  # fmt: skip

_MAGIC = b"dentscope-sealed-1\n".ljust(32, b"\0")
_LAYOUT = ("v110", "v110")  # of HDF5: the first whose headers carry checksums at no cost of room
# limit: largest dataset of a file that is read [bytes]: memory of a small machine
_MOST_DATA = 256_000_000
_MOST_RATIO = 1100  # of deflate, which gives at most 1032 bytes for one
_KINDS = "fiubSU"


@dataclass
class Image:
    """A file that is made in memory: `file` while it is open, then its bytes, sealed."""

    file: h5py.File
    sealed: bytes = b""


@contextmanager
def new_image() -> Iterator[Image]:
    """Make a sealed HDF5 file in memory."""
    stream = io.BytesIO()
    with h5py.File(stream, "w", libver=_LAYOUT, userblock_size=SEALED_FROM) as file:
        made = Image(file)
        yield made
    image = stream.getvalue()
    made.sealed = seal(image) + image[SEALED_FROM:]


def seal(image: bytes) -> bytes:
    """Return the user block of a file whose bytes are given."""
    digest = hashlib.sha256(memoryview(image)[SEALED_FROM:]).digest()
    return (_MAGIC + digest).ljust(SEALED_FROM, b"\0")


def check_seal(image: bytes, path: Path, *, allowed: str = "") -> None:
    """Refuse a file of another kind, or of which any byte changed since it was written."""
    if image[: len(_MAGIC)] != _MAGIC:
        raise InputError(
            "not a file of ours, or its head is damaged", source=str(path),
            allowed="a file that `dentscope campaign` wrote",
        )  # fmt: skip
    if image[:SEALED_FROM] != seal(image):
        raise InputError(
            "damaged: its bytes are not those that were written", source=str(path), allowed=allowed
        )


@contextmanager
def opened(path: Path, *, most: int, kind: str, remedy: str = "") -> Iterator[h5py.File]:
    """Open a sealed file of so many bytes at most, or refuse one of which a byte has changed.

    `kind` is what is wanted in words, `remedy` what to do about a damaged one.
    """
    image = read_bytes(path, most=most, allowed=kind)
    check_seal(image, path, allowed=remedy)
    try:
        with open_image(image) as file:
            yield file
    except InputError:
        raise
    except _DAMAGE as error:
        told = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(f"damaged ({told})", source=str(path), allowed=remedy) from None


def open_image(image: bytes) -> h5py.File:
    """Open a file that was read into memory; OSError where it is no HDF5 file, or cut short."""
    try:
        return h5py.File(h5py.h5f.open_file_image(image))
    except (ValueError, RuntimeError):
        raise OSError("cut short, or of another kind") from None


@dataclass(frozen=True)
class Tree:
    """One group as plain values."""

    attributes: dict[str, Any] = field(default_factory=dict)
    arrays: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    groups: dict[str, Tree] = field(default_factory=dict)

    def digest(self) -> str:
        """SHA-256 of names, units, kinds, shapes and values, as 64 hexadecimal digits."""
        whole = hashlib.sha256()
        for part in self._parts(""):
            whole.update(len(part).to_bytes(8, "little") + part)
        return whole.hexdigest()

    def _parts(self, place: str) -> Iterator[bytes]:
        for name, value in sorted(self.attributes.items()):
            if name != DIGEST:
                yield f"{place}@{name}={value!r}".encode()
        for name, values in sorted(self.arrays.items()):
            kind = values.dtype.newbyteorder("<")
            yield f"{place}{name} [{self.units[name]}] {kind.str} {values.shape}".encode()
            yield np.ascontiguousarray(values, dtype=kind).tobytes()
        for name, group in sorted(self.groups.items()):
            yield f"{place}{name}/".encode()
            yield from group._parts(f"{place}{name}/")


def read_tree(group: h5py.Group, *, depth: int = 0) -> Tree:
    """Read a group and those in it.

    ValueError where something leads elsewhere, claims more than it holds, or is of a kind that we
    never write.
    """
    if depth > _GROUPS_DEEP:
        raise ValueError(f"{group.name} lies too deep")
    tree = Tree(attributes={name: _attribute(group, name) for name in group.attrs})
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"{group.name}/{name} is a link to elsewhere")
        item = group[name]
        if isinstance(item, h5py.Group):
            tree.groups[name] = read_tree(item, depth=depth + 1)
        elif isinstance(item, h5py.Dataset):
            tree.arrays[name] = read_array(item)
            tree.units[name] = str(_attribute(item, "unit")) if "unit" in item.attrs else ""
        else:
            raise ValueError(f"{group.name}/{name} is neither group nor dataset")
    return tree


def read_array(data: h5py.Dataset) -> npt.NDArray[Any]:
    """Read a dataset that holds what it claims; ValueError as `read_tree`."""
    if data.dtype.kind not in _KINDS or data.dtype.hasobject or data.shape is None:
        raise ValueError(f"{data.name} is of kind {data.dtype}")
    if data.is_virtual or data.external:
        raise ValueError(f"{data.name} lies in another file")
    stored = data.id.get_storage_size()
    if data.nbytes > _MOST_DATA or data.nbytes > _MOST_RATIO * stored:
        raise ValueError(f"{data.name} claims {data.nbytes} bytes and holds {stored}")
    return np.asarray(data[()])


def _attribute(item: Any, name: str) -> Any:
    kind = item.attrs.get_id(name)
    text = h5py.check_string_dtype(kind.dtype) is not None
    if kind.shape != () or not (text or kind.dtype.kind in _KINDS):
        raise ValueError(f"attribute {name} of {item.name} is of kind {kind.dtype}{kind.shape}")
    value = item.attrs[name]
    if isinstance(value, bytes):
        value = value.decode()
    if isinstance(value, str) and len(value) > _TEXT_BYTES:
        raise ValueError(f"attribute {name} of {item.name} has {len(value)} characters")
    return value.item() if isinstance(value, np.generic) else value
