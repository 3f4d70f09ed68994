"""set.toml: a rig with the format of a recording set, read and written.

Writing changes only what differs from what the file held, so that a person's comments and order
survive. A value `"?"` is one that is still to be filled in.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal

import tomlkit
from pydantic import BaseModel, Field

from ..core.rig import BodyTable, Quantity, Rig
from .bench import Bench

FORMAT = "recording-set/1"

MARK = "?"
"""Stands for a value that is still to be filled in."""

_NEEDED = ("tip_radius_m", "mass_kg", "radius_m", "length_m")
"""Sizes without which a striker cannot be read, in the order of the format."""

_STAND_IN = math.nextafter(1.0, 2.0)
"""What they are until then: of order one, and no number that anybody measures."""


class SetFile(Rig):
    """All of set.toml."""

    format: Literal["recording-set/1"]
    """Version of the file's format."""
    assume: tuple[str, ...] = Field(default=(), strict=False)
    """Mechanisms that a diagnosis takes to act, as published."""
    rig: Bench = Bench()
    """What can be done next."""


def flowing(setup: Rig) -> dict[str, BodyTable]:
    """Return the bodies that name a flow curve, by the key of their table."""
    return {key: body for key, body in setup.bodies.items() if body.flow_curve}


def without_marks(content: Mapping[str, Any], key: str = "") -> tuple[dict[str, Any], list[str]]:
    """Return set.toml without the values that are to be filled in, and their keys.

    Sizes that a striker must have are near 1 where they are to be filled in.
    """
    kept: dict[str, Any] = {}
    open_keys: list[str] = []
    for name, value in content.items():
        path = f"{key}.{name}" if key else name
        if isinstance(value, Mapping):
            kept[name], below = without_marks(value, path)
            open_keys += below
        elif value != MARK:
            kept[name] = value
        else:
            open_keys.append(path)
            if name in _NEEDED:
                kept[name] = _STAND_IN
    return kept, open_keys


def setup_text(setup: SetFile, *, before: SetFile | None = None, text: str = "") -> str:
    """Return set.toml; keys at their default are left out, numbers keep every digit.

    `before` and `text` are what the file says now; all else in it stays as it is.
    """
    document = tomlkit.parse(text)
    _change(document, {} if before is None else _as_written(before), _as_written(setup))
    return tomlkit.dumps(document)


def _as_written(setup: SetFile) -> dict[str, Any]:
    """The file's keys; what a dent's edge is stands in `[noise]`."""
    plain = _plain(setup)
    edge = plain.pop("dent_edge", None)
    if edge is not None:
        plain["noise"] = {**plain.get("noise", {}), "dent_edge": edge}
    return plain


def _change(table: Any, old: Mapping[str, Any], new: Mapping[str, Any]) -> None:
    for name, value in new.items():
        if old.get(name) == value:
            continue
        if isinstance(value, dict):
            if name not in table:
                table[name] = tomlkit.table(is_super_table=name == "strikers")
            _change(table[name], old.get(name, {}), value)
        else:
            table[name] = _number(value) if isinstance(value, Quantity) else value
    for name in set(old) - set(new):
        table.pop(name, None)


def _number(quantity: Quantity) -> Any:
    if quantity.std == 0.0:
        return quantity.value
    pair = tomlkit.inline_table()
    pair.update({"value": quantity.value, "std": quantity.std})
    return pair


def _plain(table: BaseModel) -> dict[str, Any]:
    """What differs from the defaults, plain keys before tables."""
    given = {
        name: getattr(table, name)
        for name, field in type(table).model_fields.items()
        if field.is_required() or name == "shape" or getattr(table, name) != field.get_default(
            call_default_factory=True
        )
    }  # fmt: skip
    plain = {k: v for k, v in given.items() if not _is_table(v)}
    for name, value in given.items():
        if isinstance(value, dict):
            plain[name] = {
                k: _plain(v) if isinstance(v, BaseModel) else v for k, v in value.items()
            }
        elif _is_table(value):
            plain[name] = _plain(value)
    return plain


def _is_table(value: Any) -> bool:
    return isinstance(value, dict | BaseModel) and not isinstance(value, Quantity)
