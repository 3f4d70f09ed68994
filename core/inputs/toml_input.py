"""Reading TOML files that a person wrote: every mistake found at once, a line each."""

from __future__ import annotations

import codecs
import re
import tomllib
import unicodedata
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar, cast, get_args

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from ..errors import InputError, InputErrors, shortened
from .input_file import read_bytes

# limit: tables and lists within each other [-]: files of this package have four
_TOML_DEPTH = 20

# limit: tables of one TOML file [-]: a second's reading
_TOML_TABLES = 20_000

# limit: characters of a value in an error [-]: a line of a terminal
_VALUE_SHOWN = 80

# limit: mistakes of one file that are told [-]: more is no file of this kind
_MISTAKES = 200

# limit: largest TOML file that is read [bytes]: memory of a small machine
_TOML_BYTES = 4_000_000

Model = TypeVar("Model", bound=BaseModel)


class InputTable(BaseModel):
    """Base of the tables of an input file.

    Unknown keys, numbers that are not finite, `true` or "0.01" for a number, and texts with control
    characters are mistakes.
    """

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        allow_inf_nan=False,
        strict=True,
        use_attribute_docstrings=True,
    )

    @model_validator(mode="before")
    @classmethod
    def _texts_can_be_shown(cls, given: Any) -> Any:
        texts = (*given, *given.values()) if isinstance(given, dict) else ()
        for text in texts:
            # what moves a terminal; line ends and tabs are text
            if isinstance(text, str) and any(
                unicodedata.category(one) == "Cc" and one not in "\n\t" for one in text
            ):
                raise ValueError("a text holds control characters")
        return given


Listed = Field(strict=False)
"""For a key that holds a tuple: TOML has lists. What is in it stays strict."""


def read_toml(path: Path) -> dict[str, Any]:
    """Return the content of a TOML file; refused if missing, unreadable or not TOML."""
    content = read_bytes(path, most=_TOML_BYTES, allowed="an existing TOML file")
    tables = len(re.findall(rb"^[ \t]*\[", content, re.MULTILINE))
    if tables > _TOML_TABLES:
        raise InputError(f"{tables} tables", source=str(path), allowed=f"up to {_TOML_TABLES}")
    try:
        found = tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        wide = content[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
        why = "UTF-16" if wide else str(error)
        raise InputError(
            f"cannot be read ({why})", source=str(path), allowed="a text saved as UTF-8"
        ) from None
    except tomllib.TOMLDecodeError as error:
        allowed = "a point in a number, as 0.5" if _has_comma(content, str(error)) else ""
        raise InputError(f"not valid TOML ({error})", source=str(path), allowed=allowed) from None
    except ValueError:  # Python converts no whole number of more than 4300 digits
        raise InputError("a number of too many digits", source=str(path)) from None
    except RecursionError:
        found = {}
    else:
        if _depth_at_most(_TOML_DEPTH, found):
            return found
    raise InputError(
        "tables or lists nested too deep", source=str(path), allowed=f"up to {_TOML_DEPTH}"
    )


def _has_comma(content: bytes, error: str) -> bool:
    """Whether the line that an error names has a number with a decimal comma."""
    at = re.search(r"line (\d+)", error)
    line = content.split(b"\n")[int(at[1]) - 1] if at else b""
    return re.search(rb"=\s*[-+]?\d+,\d", line) is not None


def _depth_at_most(most: int, content: Any) -> bool:
    level = [content]
    for _ in range(most):
        inner = (x.values() if isinstance(x, dict) else x for x in level)
        level = [x for part in inner for x in part if isinstance(x, dict | list)]
    return not level


def read_model(path: Path, model: type[Model]) -> Model:
    """Read a TOML file into a pydantic model; all mistakes come at once, a line each."""
    return parse_model(read_toml(path), model, source=str(path))


def parse_model(content: dict[str, Any], model: type[Model], *, source: str) -> Model:
    """Validate `content` against a pydantic model; `source` names the file in errors."""
    try:
        return model.model_validate(content)
    except ValidationError as failure:
        wrong = [_as_input_error(item, model, source) for item in failure.errors()[:_MISTAKES]]
        if more := failure.error_count() - len(wrong):
            wrong.append(InputError(f"{more} more mistakes", source=source))
        raise InputErrors(tuple({str(one): one for one in wrong}.values())) from None


def _as_input_error(item: Any, model: type[BaseModel], source: str) -> InputError:
    location = tuple(item["loc"])
    key = ".".join(str(part) for part in location)
    if item["type"] == "missing":
        return InputError("missing", source=source, key=key, allowed="this key is needed")
    if item["type"] == "extra_forbidden":
        known = _known_keys(model, location[:-1])
        hint = _meant(model, str(location[-1]), known)
        allowed = ", ".join(known)
        return InputError(f"unknown key{hint}", source=source, key=key, allowed=allowed)
    if item["type"] in ("model_type", "dict_type"):
        return _no_table(item["input"], location, model, source)
    message = item["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    if item["type"] in ("list_type", "tuple_type", "too_short"):
        table = isinstance(item["input"], dict)
        message = f"a list of tables, [[{key}]]" if table else "a list that is not empty"
        if table and item["type"] == "too_short":
            message = f"{item['ctx']['min_length']} or more, each {key}.NAME"
    if location[-1:] == ("[key]",):
        key = key.removesuffix(".[key]")
        return InputError("unknown key", source=source, key=key, allowed=message)
    given = item["input"]
    if isinstance(given, dict) and item["type"] == "value_error":
        if "value" not in given:
            return InputError(message, source=source, key=key)  # of the table, not of one key
        given = given["value"]
    # TOML has no null: a validator that complains of None misses the key
    found = "missing" if given is None else _shown(given)
    return InputError(found, source=source, key=key, allowed=message)


def _no_table(
    given: Any, location: tuple[Any, ...], model: type[BaseModel], source: str
) -> InputError:
    """Refuse what stands where a table belongs; once for all keys under `[strikers]` alone."""
    found: Any = model
    for place, part in enumerate(location, start=1):
        field = found.model_fields.get(str(part)) if _is_table(found) else None
        found = table_in(field.annotation) if field else None
        named = field is not None and "dict[" in str(field.annotation)
        if found and named and place >= len(location) - 1:
            key = ".".join(map(str, location[:place]))
            return InputError("no table of a name", source=source, key=key, allowed=f"[{key}.NAME]")
    key = ".".join(map(str, location))
    header = f"[{key}]" if isinstance(location[-1], str) else f"[[{location[-2]}]]"
    shown = "missing" if given is None else _shown(given)
    return InputError(shown, source=source, key=key, allowed=f"a table, {header}")


def _shown(value: Any) -> str:
    """The value as Python writes it, shortened; a file may hold a number of 400 digits."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # of too many digits, or nested too deep to be written
        text = type(value).__name__
    return shortened(text, _VALUE_SHOWN)


def _known_keys(model: type[BaseModel], path: tuple[Any, ...]) -> list[str]:
    found: Any = model
    for part in path:
        if _is_table(found) and str(part) in found.model_fields:
            found = table_in(found.model_fields[str(part)].annotation) or found
    return [field.alias or name for name, field in found.model_fields.items()]


def _meant(model: type[BaseModel], key: str, known: list[str]) -> str:
    """Say which key may be meant: one of the same table, or the same one of another."""
    near = get_close_matches(key, known, n=1)
    if near:
        return f"; did you mean {near[0]}?"
    tables = (
        (name, table_in(field.annotation), "dict[" in str(field.annotation))
        for name, field in model.model_fields.items()
    )
    places = [
        f"[{name}.NAME]" if named else f"[{name}]"
        for name, table, named in tables
        if table is not None and key in _known_keys(table, ())
    ]
    return f"; it belongs in {' or '.join(places)}" if places else ""


def _is_table(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def table_in(annotation: Any) -> type[BaseModel] | None:
    """Return the table that an annotation such as `dict[str, Table]` or `Table | None` holds."""
    if _is_table(annotation):
        return cast("type[BaseModel]", annotation)
    inner = (table_in(part) for part in get_args(annotation))
    return next((table for table in inner if table is not None), None)
