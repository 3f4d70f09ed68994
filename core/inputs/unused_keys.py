"""What a file says and a command does not use, told in words instead of passed over."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

_FOR_PEOPLE = frozenset({"name", "description", "source", "licence", "format", "material"})


def unused_keys(content: Mapping[str, Any], used: Collection[str]) -> list[str]:
    """Return `key = value` for each key of a file that is none of `used`.

    `content`: the file as it was read; `used`: keys with their tables; `NAME` stands for any name
    of a striker, and `KEY.std` for the standard deviation of a quantity.

    Examples
    --------
    >>> unused_keys({"flat": {"E_Pa": {"value": 2e11, "std": 4e9}, "nu": 0.3}}, {"flat.E_Pa"})
    ['flat.E_Pa.std = 4e+09', 'flat.nu = 0.3']
    """
    return [
        f"{key} = {value:g}" if isinstance(value, float) else f"{key} = {value}"
        for key, value in _leaves(content, "")
        if _without_name(key) not in used and key.rpartition(".")[2] not in _FOR_PEOPLE
    ]


def _leaves(content: Mapping[str, Any], before: str) -> Iterator[tuple[str, Any]]:
    for name, value in content.items():
        key = f"{before}.{name}" if before else name
        if not isinstance(value, Mapping):
            yield key, value
        elif "value" in value and set(value) <= {"value", "std"}:
            yield key, value["value"]
            if value.get("std"):
                yield f"{key}.std", value["std"]
        else:
            yield from _leaves(value, key)


def _without_name(key: str) -> str:
    parts = key.split(".")
    return ".".join(["strikers", "NAME", *parts[2:]]) if parts[0] == "strikers" else key
