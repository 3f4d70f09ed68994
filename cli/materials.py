"""`dentscope materials`: metals and hard materials with their numbers and sources."""

from __future__ import annotations

from typing import Annotated

import typer

from ..core.errors import InputError
from ..core.inputs.materials import Entry, entry_named, materials, sources
from .shared.terminal import entry as told
from .shared.terminal import wrapped

_UNITS = {"E_Pa": (1e9, "GPa"), "Sy_Pa": (1e6, "MPa"), "hardness_Pa": (1e9, "GPa"),
          "density_kg_m3": (1.0, "kg/m^3"), "nu": (1.0, "")}  # fmt: skip
_WORDS = {"E_Pa": "Young's modulus", "nu": "Poisson's ratio", "Sy_Pa": "yield strength",
          "hardness_Pa": "hardness", "density_kg_m3": "density"}  # fmt: skip


def show_materials(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME", help="A name, or words: 1.4301, S355J2, 'hard brass'. Left out: all."
        ),
    ] = "",
) -> None:
    """List metals and hard materials, or show one with spread, sources and a table for a file."""
    found = [one for one in materials().values() if one.has(name)]
    if name in materials() or len(found) == 1:
        _show(materials().get(name) or found[0])
        return
    if not found:
        try:
            entry_named(name)
        except InputError as error:
            raise error.at("command line", "NAME") from None
    for one in found:
        listed = ", ".join(_number(one, key) for key in ("E_Pa", "Sy_Pa", "hardness_Pa")
                           if key in one.numbers)  # fmt: skip
        told(one.name, f"{one.title}: {listed}.")
    typer.echo("\nIn a file: material = NAME; what the file states goes first.")


def _number(one: Entry, key: str) -> str:
    given, (factor, unit) = one.numbers[key], _UNITS[key]
    return f"{_WORDS[key]} {given['value'] / factor:.4g} {unit}".rstrip()


def _show(one: Entry) -> None:
    typer.echo(f"{one.name}: {one.title} ({one.kind}{one.also and f'; {one.also}'})\n")
    for key, given in one.numbers.items():
        factor, unit = _UNITS[key]
        spread = f"{given['value'] / factor:.4g} +- {given['std'] / factor:.2g} {unit}".rstrip()
        told(_WORDS[key], f"{spread}: {given['source']}.")
    for name, law in one.laws.items():
        numbers = ", ".join(f"{k} = {v}" for k, v in law.items() if k != "source")
        told(name, f"{numbers}: {law['source']}.")
    if one.note:
        typer.echo(f"\n{wrapped(one.note)}")
    named = {given["source"] for given in (*one.numbers.values(), *one.laws.values())}
    typer.echo("")
    for short, whole in sources().items():
        if short in named:
            told(short, f"{whole}.")
