"""Reading TOML files that a person wrote: every mistake found at once, a line each."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any, TypeVar, cast, get_args

from pydantic import BaseModel, ConfigDict, ValidationError

from .errors import InputError, InputErrors

Model = TypeVar("Model", bound=BaseModel)


class InputTable(BaseModel):
    """Base of the tables of an input file: unknown keys and non-finite numbers are mistakes."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True
    )


def read_toml(path: Path) -> dict[str, Any]:
    """Return the content of a TOML file.

    Raises
    ------
    InputError
        The file is missing, unreadable or not TOML.
    """
    try:
        with path.open("rb") as stream:
            return tomllib.load(stream)
    except FileNotFoundError:
        raise InputError(
            "no such file", source=str(path), allowed="an existing TOML file"
        ) from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot be read ({error})", source=str(path)) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"not valid TOML ({error})", source=str(path)) from None


def read_model(path: Path, model: type[Model]) -> Model:
    """Read a TOML file into a pydantic model; all mistakes come at once.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.
    """
    return parse_model(read_toml(path), model, source=str(path))


def parse_model(content: dict[str, Any], model: type[Model], *, source: str) -> Model:
    """Validate `content` against a pydantic model; `source` names the file in errors."""
    try:
        return model.model_validate(content)
    except ValidationError as failure:
        raise InputErrors(
            tuple(_as_input_error(item, model, source) for item in failure.errors())
        ) from None


def _as_input_error(item: Any, model: type[BaseModel], source: str) -> InputError:
    location = tuple(item["loc"])
    key = ".".join(str(part) for part in location)
    if item["type"] == "missing":
        return InputError("missing", source=source, key=key, allowed="this key is needed")
    if item["type"] == "extra_forbidden":
        known = ", ".join(_known_keys(model, location[:-1]))
        return InputError("unknown key", source=source, key=key, allowed=known)
    message = item["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    if location[-1:] == ("[key]",):
        key = key.removesuffix(".[key]")
        return InputError("unknown key", source=source, key=key, allowed=message)
    # TOML has no null: a validator that complains of None misses the key
    found = "missing" if item["input"] is None else f"{item['input']!r}"
    return InputError(found, source=source, key=key, allowed=message)


def _known_keys(model: type[BaseModel], path: tuple[Any, ...]) -> list[str]:
    found: Any = model
    for part in path:
        if _is_table(found) and str(part) in found.model_fields:
            found = _table_in(found.model_fields[str(part)].annotation) or found
    return list(found.model_fields)


def _is_table(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _table_in(annotation: Any) -> type[BaseModel] | None:
    """The table that an annotation such as `dict[str, Table]` or `Table | None` holds."""
    if _is_table(annotation):
        return cast("type[BaseModel]", annotation)
    inner = (_table_in(part) for part in get_args(annotation))
    return next((table for table in inner if table is not None), None)
