"""Content identity and origin of results: what was asked, by which versions, from which commit."""

from __future__ import annotations

import hashlib
import json
import math
import platform
import subprocess
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

_RECORDED_PACKAGES = ("numpy", "scipy", "numba", "scikit-fem", "gmsh", "meshio", "h5py")
_STAGES = ("core", "fem", "models", "campaigns")


def canonical_json(value: Any) -> str:
    """Serialise `value` so that equal content gives equal text on every machine.

    Floats are written with `float.hex`, keys are sorted, tuples become lists.

    Raises `TypeError`: for a value that has no canonical form.

    Examples
    --------
    >>> canonical_json({"b": 0.5, "a": (1, None)})
    '{"a":[1,null],"b":"0x1.0000000000000p-1"}'
    """
    return json.dumps(_canonical(value), sort_keys=True, separators=(",", ":"))


def content_id(value: Any) -> str:
    """SHA-256 of `canonical_json(value)`, as 64 hexadecimal digits."""
    return hashlib.sha256(canonical_json(value).encode()).hexdigest()


def file_digest(path: Path) -> str:
    """SHA-256 of a file's bytes, as 64 hexadecimal digits."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


@cache
def environment() -> dict[str, str]:
    """Versions of Python and of the packages that influence numbers, and the source.

    `commit` is for people; `source` is a digest of the files that results come from, which also
    tells edited ones apart. Both are those of the first call: code that is loaded stays.
    """
    from .. import __version__

    found = {"dentscope": __version__, "python": platform.python_version()}
    for name in _RECORDED_PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "absent"
    found["commit"] = source_commit()
    found["source"] = _source()
    return found


def differences(mine: Mapping[str, str], other: Mapping[str, str]) -> list[str]:
    """Return what two environments do not share, as `NAME: MINE, there OTHER`, sources by commit.

    Examples
    --------
    >>> differences({"numpy": "2.4", "scipy": "1.17"}, {"numpy": "2.3", "scipy": "1.17"})
    ['numpy 2.4, there 2.3']
    """
    lines = [
        f"{name} {mine.get(name, 'none')}, there {other.get(name, 'none')}"
        for name in sorted({*mine, *other} - {"source", "commit"})
        if mine.get(name) != other.get(name)
    ]
    if mine.get("source") != other.get("source"):
        lines.append(
            f"source of commit {mine.get('commit', 'none')}, there {other.get('commit', 'none')}"
        )
    return lines


def _source() -> str:
    """First 16 hexadecimal digits of the SHA-256 of all files that a case's numbers come from."""
    root = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for stage in _STAGES:
        for path in sorted((root / stage).rglob("*.py")):
            digest.update(str(path.relative_to(root)).encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def source_commit() -> str:
    """Commit of the checkout the package runs from; `"installed"` outside a checkout."""
    root = Path(__file__).resolve().parents[1]
    if not (root / ".git").exists():
        return "installed"
    try:
        answer = subprocess.run(
            ["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=12"],
            capture_output=True,
            text=True,
            timeout=10,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return answer.stdout.strip()


def _canonical(value: Any) -> Any:
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return str(value) if math.isnan(value) or math.isinf(value) else value.hex()
    if isinstance(value, dict):
        return {str(key): _canonical(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_canonical(item) for item in value]
    raise TypeError(f"{type(value).__name__} has no canonical form")
