"""The record of a reduction: raw file and checksum, options, values and notes, and the picture."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...core.output import write_file
from ...core.provenance import file_digest
from ..measured import Measured
from ..reduced import Reduced


def write_record(
    reduced: Reduced, folder: Path, name: str, *, kind: str, options: Mapping[str, Any],
    trials: list[str] | None = None,
) -> tuple[Path, Path]:  # fmt: skip
    """Write NAME-KIND.json (file, checksum, options, values, notes) and the picture; both paths."""
    record, picture = (folder / f"{name}-{kind}{end}" for end in (".json", ".png"))
    content = {
        "kind": kind, **_origin(reduced.source), "trials": trials or [],
        "options": {k: v for k, v in options.items() if v not in (None, "")},
        "values": {k: _plain(v) for k, v in reduced.values.items()}, "notes": list(reduced.notes),
    }  # fmt: skip
    write_file(record, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
    reduced.draw(picture)
    return record, picture


def _origin(source: Path) -> dict[str, Any]:
    if source.is_dir():
        files = sorted(p for p in source.iterdir() if p.is_file())
        return {"folder": source.name, "files": {p.name: file_digest(p) for p in files}}
    return {"file": source.name, "bytes": source.stat().st_size, "sha256": file_digest(source)}


def _plain(value: Measured) -> dict[str, float | None]:
    """Numbers for JSON, which has no NaN."""
    pair = {"value": value.value, "std": value.std}
    return {k: float(v) if math.isfinite(v) else None for k, v in pair.items()}
