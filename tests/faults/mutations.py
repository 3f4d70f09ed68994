"""Damaged copies of a sound file: bytes, lines, numbers, values of HDF5."""

import io
import json
import re

import h5py
import numpy as np
from dentscope.campaigns.contents import DIGEST, SEALED_FROM, read_tree, seal

NUMBER = re.compile(rb"(?<![\w.\"])-?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.\"])")
NO_NUMBERS = (
    b"true", b'"0.010"', b"[1.0]", b"1979-05-27", b"{ a = 1 }", b"nan", b"inf", b"-inf", b'""',
)  # fmt: skip
ODD_NUMBERS = (
    b"1e400", b"-1e300", b"1e-320", b"-0.0", b"0", b"-1", b"9" * 400, b"9" * 5000, b"1_0", b"0x10",
    b"1e30", b"1e-30", "\uff11\uff12".encode(), b"", b"NaN", b"1,5",
)  # fmt: skip
INSERTS = (
    b"[" * 3000, b"{a=" * 3000, b"\x1b[2J\x1b]0;x\x07", b"\0" * 50, b"\xff\xfe", b"\r", b"\n\n\n",
    b'"', b"'''", b"," * 3000, b"= 1\n", b"a." * 2000 + b"b = 1\n", "\u202e".encode(),
    b"=cmd|' /C'", b'{"a":' * 3000, b"../" * 20,
)  # fmt: skip
_WAYS = (
    "bits", "cut", "slice", "repeat", "insert", "lines", "exchange", "number", "number", "none",
)  # fmt: skip


def mutated(content, draw):
    """Return a changed copy, and whether a number was replaced by what is none."""
    way = draw.choice(_WAYS)
    data = bytearray(content)
    if way in ("number", "none", "exchange"):
        return _other_numbers(content, way, draw)
    if way == "bits":
        for _ in range(draw.choice((1, 1, 3, 20))):
            at = draw.randrange(8 * len(data))
            data[at // 8] ^= 1 << at % 8
    elif way == "cut":
        del data[draw.randrange(len(data)) :]
    elif way == "slice":
        at = draw.randrange(len(data))
        del data[at : at + draw.choice((1, 10, 200))]
    elif way == "repeat":
        at = draw.randrange(len(data))
        piece = data[at : at + draw.choice((1, 30, 300))]
        data[at:at] = piece * draw.choice((1, 10, 1000))
    elif way == "insert":
        at = draw.randrange(len(data) + 1)
        data[at:at] = draw.choice(INSERTS)
    else:
        lines = bytes(data).splitlines(keepends=True)
        one, other = draw.randrange(len(lines)), draw.randrange(len(lines))
        change = draw.choice(("lost", "twice", "exchanged"))
        if change == "lost":
            del lines[one]
        elif change == "twice":
            lines.insert(other, lines[one])
        else:
            lines[one], lines[other] = lines[other], lines[one]
        return b"".join(lines), False
    return bytes(data), False


def _other_numbers(content, way, draw):
    found = list(NUMBER.finditer(content))
    if not found:
        return content, False
    token = draw.choice(found)
    if way == "exchange":  # a legal number in a place that is not its own
        new = draw.choice(found).group()
    else:
        new = draw.choice(ODD_NUMBERS if way == "number" else NO_NUMBERS)
    line = content[: token.start()].rsplit(b"\n", 1)[-1]
    is_value = b"#" not in line and line.count(b'"') % 2 == 0
    return content[: token.start()] + new + content[token.end() :], way == "none" and is_value


def resealed(content):
    """Seal a damaged campaign file: what one who means ill would send."""
    return seal(content) + content[SEALED_FROM:]


def tampered(content, draw):
    """Change one value, shape, kind or link within an HDF5 file, and seal it anew."""
    stream = io.BytesIO(content)
    with h5py.File(stream, "r+", libver=("v110", "v110")) as file:
        places = []
        file.visit(places.append)
        item = file[draw.choice(["/", *places])]
        if len(item.attrs) and draw.random() < 0.5:
            _other_attribute(item, draw.choice(list(item.attrs)), draw)
        elif isinstance(item, h5py.Dataset):
            _other_dataset(item, draw)
        elif len(item):
            _other_link(item, draw.choice(list(item)), draw)
        for case in file.get("cases", {}).values():
            if isinstance(case, h5py.Group) and draw.random() < 0.9:
                try:
                    case.attrs[DIGEST] = read_tree(case).digest()
                except (ValueError, KeyError, OSError, RuntimeError):
                    pass
    return resealed(stream.getvalue()), False


def _other_attribute(item, name, draw):
    old = item.attrs[name]
    text = old.encode() if isinstance(old, str) else json.dumps(str(old)).encode()
    new = draw.choice((
        lambda: mutated(text or b"0", draw)[0].replace(b"\0", b"").decode(errors="replace"),
        lambda: mutated(text or b"0", draw)[0].replace(b"\0", b"").decode(errors="replace"),
        lambda: "", lambda: "[]", lambda: "{}", lambda: "1" * 4400, lambda: "[" * 5000,
        lambda: "x" * 60_000, lambda: np.nan, lambda: -1, lambda: 2**63 - 1, lambda: True,
        lambda: np.zeros((3, 3)), lambda: h5py.Empty("f8"), lambda: item.ref,
        lambda: np.bytes_(b"\xff\xfe"),
    ))()  # fmt: skip
    del item.attrs[name]
    try:
        item.attrs[name] = new
    except (ValueError, TypeError):
        item.attrs[name] = "x"


def _other_dataset(data, draw):
    old, parent, name = data[()], data.parent, data.name.rsplit("/", 1)[1]
    about = dict(data.attrs)
    way = draw.choice(("values", "values", "shape", "kind", "claim", "away", "text"))
    del parent[name]
    if way == "values" and old.dtype.kind in "fi" and old.size:
        new = old.copy()
        at = draw.randrange(new.size)
        odd = (np.nan, np.inf, -1.0, 0.0, 1e300) if new.dtype.kind == "f" else (-1, 2**30, -(2**30))
        new.flat[at] = draw.choice(odd)
        made = parent.create_dataset(name, data=new)
    elif way in ("values", "shape"):
        shapes = (old[:0], old[: len(old) // 2], np.repeat(old, 3, axis=0), old[None], old[:1])
        made = parent.create_dataset(name, data=draw.choice(shapes))
    elif way == "kind":
        kinds = (np.zeros(old.shape, "c16"), np.zeros(old.shape, "i1"), np.bytes_(b"x"), 3.0)
        made = parent.create_dataset(name, data=draw.choice(kinds))
    elif way == "claim":
        size = draw.choice((10**7, 10**9, 2**40))
        made = parent.create_dataset(
            name, (size,), dtype="f8", chunks=(10**5,), compression="gzip", fillvalue=1.0
        )
    elif way == "text":
        texts = ["x" * draw.choice((0, 1, 10**6))] * max(1, len(np.atleast_1d(old)))
        made = parent.create_dataset(name, data=texts, dtype=h5py.string_dtype())
    else:
        made = parent.create_dataset(
            name, (10,), dtype="f8", external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)]
        )
    for key, value in about.items():
        made.attrs[key] = value


def _other_link(group, name, draw):
    way = draw.choice(("lost", "soft", "external", "circle", "renamed"))
    if way == "renamed":
        group.move(name, draw.choice(("x", "../x", "unload-x", "\u202e")) + name)
        return
    del group[name]
    if way == "soft":
        group[name] = h5py.SoftLink("/nowhere")
    elif way == "external":
        group[name] = h5py.ExternalLink("/etc/passwd", "/")
    elif way == "circle":
        group[name] = group
