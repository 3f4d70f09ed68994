"""The file of a law that is a table: `dentscope case` writes it, `law_named` reads it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..core.material import Material, Pair
from ..core.output import write_file
from ..core.rig import MaterialTable, material_keys
from .table import Curve, PairTable, TableLaw, Turns, table_law

FORMAT = "dentscope-table/1"


def write_table(table: PairTable, path: Path) -> Path:
    """Write a pair's table for `read_table`."""
    content = {
        "format": FORMAT,
        "radius_m": table.pair.R,
        "sphere": material_keys(table.pair.sphere),
        "flat": material_keys(table.pair.flat),
        "loading": {k: v.tolist() for k, v in table.curve._asdict().items()},
        "unloading": {k: v.tolist() for k, v in table.turns._asdict().items()},
    }
    return write_file(path, json.dumps(content, indent=1) + "\n")


def read_table(path: Path) -> TableLaw:
    """Read the law that `dentscope case` wrote.

    Parameters
    ----------
    path
        Its law.json, or the folder that holds it.

    Raises
    ------
    InputError
        There is none, or it is damaged.
    """
    file = path / "law.json" if path.is_dir() else path
    if not file.is_file():
        raise InputError("no such file", source=str(file), allowed="law.json of `dentscope case`")
    try:
        content = json.loads(file.read_text("utf-8"))
        found = content.get("format") if isinstance(content, dict) else None
    except ValueError:
        found = None
    if found != FORMAT:
        raise InputError(
            f"format {found!r}", source=str(file), key="format",
            allowed=f"{FORMAT}, as `dentscope case` writes it",
        )  # fmt: skip
    return table_law([_table_from(content, source=str(file))], name=str(path))


def _table_from(content: Mapping[str, Any], *, source: str) -> PairTable:
    try:
        sphere, flat = (_body(content[k], key=k, source=source) for k in ("sphere", "flat"))
        pair = Pair(sphere, flat, float(content["radius_m"]))
        curve = Curve(**{k: np.array(content["loading"][k], float) for k in Curve._fields})
        turns = Turns(**{k: np.array(content["unloading"][k], float) for k in Turns._fields})
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{error} is missing or no number", source=source,
            allowed="a file as `dentscope case` writes it",
        ) from None  # fmt: skip
    for name, part in (("loading", curve), ("unloading", turns)):
        sizes = {len(v) for v in part}
        if len(sizes) != 1 or not all(np.all(np.isfinite(v)) for v in part):
            raise InputError(
                "columns of unequal length or no numbers", source=source, key=name,
                allowed="finite numbers, as many in each",
            )  # fmt: skip
        if not np.all(np.diff(part.depth) > 0.0):
            raise InputError("falls", source=source, key=f"{name}.depth", allowed="rising depths")
    return PairTable(pair, curve, turns)


def _body(content: Any, *, key: str, source: str) -> Material:
    return MaterialTable.model_validate(content).to_material(key, source=source)
