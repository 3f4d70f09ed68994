"""set.toml: a rig with the format of a recording set, read and written."""

from __future__ import annotations

import json
import re
from typing import Any, Literal

from pydantic import BaseModel

from ..core.rig import Quantity, Rig

FORMAT = "recording-set/1"

_BARE = re.compile(r"[A-Za-z0-9_-]+")


class Setup(Rig):
    """All of set.toml."""

    format: Literal["recording-set/1"]
    """Version of the file's format."""


def setup_text(setup: Setup) -> str:
    """Return set.toml; keys at their default are left out, numbers keep every digit."""
    lines = []
    tables: list[tuple[str, dict[str, Any]]] = []
    for name, value in _given(setup).items():
        if name == "strikers":
            tables += [(f"strikers.{_key(k)}", _given(v)) for k, v in setup.strikers.items()]
        elif isinstance(value, BaseModel) and not isinstance(value, Quantity):
            tables.append((name, _given(value)))
        elif isinstance(value, dict):
            tables.append((name, value))
        else:
            lines.append(f"{name} = {_text(value)}")
    for name, table in tables:
        lines += ["", f"[{name}]", *(f"{_key(k)} = {_text(v)}" for k, v in table.items())]
    return "\n".join(lines) + "\n"


def _given(table: BaseModel) -> dict[str, Any]:
    """What differs from the defaults; `format`, `shape` and `target` are always written."""
    fields = type(table).model_fields
    pairs = ((name, getattr(table, name)) for name in fields)
    return {
        name: value
        for name, value in pairs
        if fields[name].is_required() or name == "shape" or value != fields[name].get_default()
    }


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _quoted(name)


def _quoted(text: str) -> str:
    # a JSON string is a basic TOML string but for the delete character
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _text(value: Any) -> str:
    if isinstance(value, Quantity):
        if value.std == 0.0:
            return repr(value.value)
        return f"{{ value = {value.value!r}, std = {value.std!r} }}"
    return _quoted(value) if isinstance(value, str) else repr(float(value))
