"""Metals and hard materials by name: their numbers, with spread and source.

The numbers stand in `data/materials/materials.csv`, what was measured of hardening, rate and heat
beside it. A body of any input file that names one of them with `material = "aluminium-6061-t6"`, or
by a designation of it alone, takes from it what the file leaves out; a stated value goes first.
"""

from __future__ import annotations

import csv
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

from ..errors import InputError

FOLDER = Path(__file__).resolve().parents[2] / "data" / "materials"

NUMBERS = ("E_Pa", "nu", "Sy_Pa", "hardness_Pa", "density_kg_m3")
"""Keys of a body's table that an entry may give."""


@dataclass(frozen=True)
class Entry:
    """One material of the table.

    - `name`, `title`, `kind`, `also`, `note`: name in files, name for people, class of material,
      designations, what to beware of.
    - `numbers`: by key of `NUMBERS`: value, standard deviation, source.
    - `laws`: hardening, rate and heat, where they were measured: the keys of a body's table
      `hardening` or `rate`, of Johnson and Cook's softening, and the source.
    """

    name: str
    title: str
    kind: str
    numbers: Mapping[str, Mapping[str, Any]]
    laws: Mapping[str, Mapping[str, Any]]
    also: str = ""
    note: str = ""

    def has(self, words: str) -> bool:
        """Whether every word is a part of its name, designations or description."""
        text = " ".join((self.name, self.title, self.kind, self.also, self.note)).lower()
        return all(word in text for word in words.lower().split())

    def quantity(self, key: str) -> dict[str, float] | None:
        """Return value and standard deviation as a file writes them; none where unknown."""
        found = self.numbers.get(key)
        return None if found is None else {"value": found["value"], "std": found["std"]}


@cache
def materials() -> dict[str, Entry]:
    """Return every entry of the table by its name."""
    laws = _beside()
    with (FOLDER / "materials.csv").open(encoding="utf-8", newline="") as stream:
        return {row["name"]: _entry(row, laws) for row in csv.DictReader(stream)}


def sources() -> dict[str, str]:
    """Return the sources by the short names that the entries use."""
    return _beside()["sources"]


def _beside() -> dict[str, dict[str, Any]]:
    return tomllib.loads((FOLDER / "materials.toml").read_text(encoding="utf-8"))


def _entry(row: Mapping[str, str], laws: Mapping[str, Mapping[str, Any]]) -> Entry:
    numbers = {
        key: {"value": float(row[key]), "std": float(row[f"{key}_std"]),
              "source": row[f"{key}_source"]}
        for key in NUMBERS if row[key]
    }  # fmt: skip
    name = row["name"]
    own = {k: laws[k][name] for k in ("hardening", "rate", "heat") if name in laws[k]}
    return Entry(name, row["title"], row["kind"], numbers, own, row["also"], row["note"])


def entry_named(name: str) -> Entry:
    """Return an entry by its name or a designation, or refuse a name and tell the nearest."""
    if not isinstance(name, str):
        raise InputError(repr(name), key="material", allowed="a name of dentscope materials")
    if len(found := _meant(name)) == 1:
        return found[0]
    raise InputError(f"no material {name!r}", key="material", allowed=_instead_of(name, 0.5))


@cache
def _meant(name: str) -> tuple[Entry, ...]:
    """Entries of a name, or of a designation, which has a digit: words alone are a description."""
    if name in materials():
        return (materials()[name],)
    if not re.search(r"\d", name):
        return ()
    each = materials().values()
    return tuple(e for e in each if _words(name) <= _words(f"{e.name} {e.title} {e.also}"))


def _words(text: str) -> frozenset[str]:
    return frozenset(re.findall(r"[\w.]+", text.lower()))


def _near(name: str, likeness: float) -> list[str]:
    return get_close_matches(name.lower(), materials(), n=3, cutoff=likeness)


def _instead_of(name: str, likeness: float) -> str:
    near = _alike(name, likeness)
    if near:
        return f"{', '.join(near)}; all of them: dentscope materials"
    return "a name that dentscope materials lists"


def _alike(name: str, likeness: float) -> list[str]:
    near = [one.name for one in materials().values() if name and one.has(name)]
    return near if 0 < len(near) <= 3 else _near(name, likeness)


def unlisted(name: str) -> str:
    """Say that a name stands for no material of the table; empty where none is given or it does."""
    if not name or name in materials():
        return ""
    near = _alike(name, 0.6)
    meant = f"did you mean {' or '.join(near)}? " if near else ""
    return f"no material of the table is called {name!r}; {meant}"


class Mistyped(str):
    """A name close to listed ones, of a body that leaves out what the listed ones would give."""

    __slots__ = ()

    @property
    def allowed(self) -> str:
        """What to write in its place."""
        return f"{_instead_of(self, 0.75)}; or a name of your own beside E_Pa and nu"


def filled(given: dict[str, Any], known: frozenset[str]) -> dict[str, Any]:
    """Return a body's table with what it leaves out taken from the material that it names.

    `known` are keys that it may hold. A stated strength or hardness keeps both of the table's out:
    one follows from the other.
    """
    name = given.get("material")
    if given.get("rigid") or not isinstance(name, str):
        return given
    if len(meant := _meant(name)) != 1:
        elastic = given.get("E_Pa") is not None and given.get("nu") is not None
        stays = elastic or not (meant or _near(name, 0.75))
        return given if stays else {**given, "material": Mistyped(name)}
    (entry,) = meant
    strengths = {"Sy_Pa", "hardness_Pa", "flow_curve", "hardening"}
    stated = any(given.get(key) for key in strengths)
    # the strength where it is listed, as it was measured, before what follows from a hardness
    hidden = strengths if stated else {"hardness_Pa"} if "Sy_Pa" in entry.numbers else set()
    taken = {
        key: entry.quantity(key)
        for key in entry.numbers
        if key in known and key not in hidden and given.get(key) is None
    }
    return {**given, **taken, "material": entry.name}
