"""`dentscope keys`: every key of an input file, read off the schema that checks the file."""

from __future__ import annotations

import typing
from collections.abc import Iterator
from importlib import import_module
from typing import Annotated, Any, NamedTuple

import typer

from .places import misused
from .terminal import entry

if typing.TYPE_CHECKING:
    from pydantic import BaseModel
    from pydantic.fields import FieldInfo

FILES = {
    "case": "CASE.toml, of `dentscope case` and `laws compare`",
    "impact": "set-up of `dentscope impact`",
    "inverse": "file of `dentscope inverse`",
    "set": "set.toml of a recording set",
    "trials": "columns of a set's trials.csv",
}
_SCHEMAS = {
    "case": ("start.case_file", "CaseFile"),
    "impact": ("dynamics.files.setup", "SetupFile"),
    "inverse": ("dynamics.files.inverse_file", "InverseFile"),
    "set": ("recordings.setup_file", "SetFile"),
}
"""Module and table of each, loaded when asked for: some bring the compiler of impacts."""

_LEFT_OUT = "may be left out"
_UNITS = {
    "kg_m3": "kg/m^3", "J_kgK": "J/(kg K)", "J_m3K": "J/(m^3 K)", "Pa_s": "Pa s",
    "kg_m2": "kg m^2", "N_s_m": "N s/m", "N_m": "N/m", "rad_s": "rad/s", "m_s2": "m/s^2",
    "m_s": "m/s", "1_s": "1/s", "per_s": "1/s", "deg": "degrees", "Pa": "Pa", "kg": "kg", "K": "K",
    "m": "m", "s": "s", "N": "N", "Ns": "N s", "Hz": "Hz",
}  # fmt: skip


class Key(NamedTuple):
    """One key of a file."""

    table: str  # where it stands, as in the file: `[target]`, or empty at the top
    name: str
    meaning: str
    allowed: str
    default: str  # what holds without it


def keys(
    file: Annotated[str, typer.Argument(help=f"One of {', '.join(FILES)}; without it, all.")] = "",
) -> None:
    """Say what every key of an input file means, allows and is by default."""
    if file and file not in FILES:
        raise misused(f"no file {file!r}", key="FILE", allowed=", ".join(FILES))
    typer.echo("A quantity is a number, or { value = ..., std = ... }; all are in SI units.\n")
    for kind in [file] if file else FILES:
        typer.echo(f"{kind}: {FILES[kind]}")
        table = ""
        for key in keys_of(kind):
            if key.table != table:
                table = key.table
                typer.echo(f"\n{table}")
            entry(key.name, f"{key.meaning} {key.allowed}; {key.default or 'needed'}.")
        typer.echo("")


def keys_of(kind: str) -> list[Key]:
    """Return the keys of one of `FILES`, in the order of its schema."""
    if kind == "trials":
        from ...recordings import CONDITIONS, MEASURED

        columns = {**CONDITIONS, **MEASURED}
        return [
            Key("", name, f"{c.meaning[:1].upper()}{c.meaning[1:]}.",
                "a text" if c.kind == "text" else _with_unit(c.allowed, name), _LEFT_OUT)
            for name, c in columns.items()
        ]  # fmt: skip
    module, table = _SCHEMAS[kind]
    return list(_keys(getattr(import_module(f"...{module}", __package__), table), ""))


def _keys(model: type[BaseModel], table: str) -> Iterator[Key]:
    """Return the keys of a table, then those of the tables within it."""
    from ...core.inputs.toml_input import table_in
    from ...core.rig import Quantity

    within: list[tuple[str, type[BaseModel]]] = []
    for name, field in model.model_fields.items():
        inner, many = table_in(field.annotation), typing.get_origin(field.annotation)
        if inner is None or inner is Quantity:
            yield Key(table, name, field.description or "", _allowed(name, field), _default(field))
            continue
        place = f"{table.strip('[]')}.{name}".lstrip(".")
        place = f"{place}.NAME" if many is dict else place
        within.append((f"[[{place}]]" if many is list else f"[{place}]", inner))
    for place, inner in within:
        yield from _keys(inner, place)


def _allowed(name: str, field: FieldInfo) -> str:
    words = [_kind(field.annotation)]
    if typing.get_origin(field.annotation) is typing.Literal:
        words = [f'"{value}"' for value in typing.get_args(field.annotation)]
    parts = (field.annotation, *typing.get_args(field.annotation))
    marks = [*field.metadata, *(m for part in parts for m in getattr(part, "__metadata__", ()))]
    limits = [getattr(getattr(m, "func", None), "allowed", "") for m in marks]
    bounds = {"gt": "above {:g}", "ge": "{:g} or more", "lt": "below {:g}", "le": "up to {:g}"}
    for part in field.metadata:
        limits += [text.format(getattr(part, k)) for k, text in bounds.items() if hasattr(part, k)]
    limits = [one.removeprefix("a number ") for one in limits if one]
    return _with_unit(" ".join([" or ".join(words), " and ".join(limits)]).strip(), name)


def _kind(annotation: Any) -> str:
    from ...core.rig import Quantity

    def held(part: Any) -> set[Any]:
        inner = typing.get_args(part)
        return {part} if not inner else {one for p in inner for one in held(p)}

    types_ = held(annotation)
    if Quantity in types_:
        return "a quantity"
    if typing.get_origin(annotation) is tuple:
        return "a list of texts" if str in types_ else "a list of numbers"
    if typing.get_origin(annotation) is dict:
        return "numbers by name"
    for kind, word in ((bool, "true or false"), (str, "a text"), (int, "a whole number")):
        if kind in types_:
            return word
    return "a list of numbers or a range" if tuple in types_ else "a number"


def _default(field: FieldInfo) -> str:
    from ...core.rig import Quantity

    if field.is_required():
        return ""
    value = field.get_default(call_default_factory=True, validated_data={})
    if value is None or value == () or value == "" or value == {}:
        return _LEFT_OUT
    if isinstance(value, Quantity):
        return f"default: {value.value:g}"
    if isinstance(value, bool):
        return f"default: {str(value).lower()}"
    shown = ", ".join(map(str, value)) if isinstance(value, tuple) else value
    return f"default: {shown}"


def _with_unit(text: str, name: str) -> str:
    if text.endswith("]"):
        return text
    unit = next((u for end, u in _UNITS.items() if name.endswith(f"_{end}")), "")
    return f"{text} [{unit}]" if unit else text
