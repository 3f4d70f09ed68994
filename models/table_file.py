"""The file of a law that is a table: `dentscope case` writes it, `law_file` reads it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ..core.errors import InputError
from ..core.inputs.json_input import read_json
from ..core.inputs.toml_input import InputTable, Listed, parse_model
from ..core.material import Pair
from ..core.output import write_file
from ..core.rig import MaterialTable, material_keys
from .table import LoadingCurve, PairTable, TableLaw, Turns, table_law

FORMAT = "dentscope-table/1"


# limit: largest file of a law that is read [bytes]: memory of a small machine
MOST_BYTES = 20_000_000

_MADE = "law.json of `dentscope case`"
_Above = Annotated[tuple[Annotated[float, Field(gt=0.0, lt=1e30)], ...], Listed]
_Spread = Annotated[tuple[Annotated[float, Field(ge=0.0, lt=1e3)], ...], Listed]
_Part = Annotated[tuple[Annotated[float, Field(ge=-1.0, le=2.0)], ...], Listed]


class _Loading(InputTable):
    """The columns of `LoadingCurve`."""

    depth: _Above
    force: _Above
    radius: _Above
    share: _Part
    force_std: _Spread
    radius_std: _Spread
    share_std: _Spread


class _Unloading(InputTable):
    """The columns of `Turns`."""

    depth: _Above
    left: Annotated[tuple[Annotated[float, Field(ge=0.0, lt=1.0)], ...], Listed]
    part: _Part
    exponent: Annotated[tuple[Annotated[float, Field(gt=0.0, le=100.0)], ...], Listed]


class _TableFile(InputTable):
    format: Literal["dentscope-table/1"]
    radius_m: float = Field(gt=0.0, le=1e6)
    sphere: MaterialTable
    flat: MaterialTable
    loading: _Loading
    unloading: _Unloading


def write_table(table: PairTable, path: Path) -> Path:
    """Write a pair's table for `read_table` and `read_law`."""
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
    """Read the file that `write_table` wrote."""
    content = read_json(path, most=MOST_BYTES, allowed=_MADE)
    return table_from(content, source=str(path), name=str(path))


def table_from(content: object, *, source: str, name: str) -> TableLaw:
    """Return the law that `dentscope case` wrote; `source` is the law.json that errors name."""
    if not isinstance(content, dict):
        raise InputError("no table", source=source, allowed=_MADE)
    found = parse_model(content, _TableFile, source=source)
    sphere = found.sphere.to_material("sphere", source=source)
    flat = found.flat.to_material("flat", source=source)
    curve = LoadingCurve(**{k: np.array(v) for k, v in found.loading})
    turns = Turns(**{k: np.array(v) for k, v in found.unloading})
    for key, part in (("loading", curve), ("unloading", turns)):
        if len({len(v) for v in part}) != 1:
            raise InputError(
                "columns of unequal length", source=source, key=key, allowed="as many in each"
            )
        if not np.all(np.diff(part.depth) > 0.0):
            raise InputError("falls", source=source, key=f"{key}.depth", allowed="rising depths")
    if len(curve.depth) < 2:
        raise InputError(
            f"{len(curve.depth)} depths", source=source, key="loading", allowed="2 or more"
        )
    table = PairTable(Pair(sphere, flat, found.radius_m), curve, turns)
    if len(turns.depth) and turns.depth[0] <= table.yields_at:
        raise InputError(
            f"{turns.depth[0]:g}", source=source, key="unloading.depth",
            allowed=f"beyond first yield, above {table.yields_at:.4g}",
        )  # fmt: skip
    return table_law([table], name=name)
