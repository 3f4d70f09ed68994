"""`dentscope materials`: metals and hard materials with their numbers and sources."""

from __future__ import annotations

from typing import Annotated

import typer

from ..core.errors import InputError
from ..core.inputs.materials import Entry, entry_named, materials, sources
from .shared.terminal import entry as told
from .shared.terminal import wrapped

_SHOWN = {
    "E_Pa": ("Young's modulus", 1e9, "GPa"), "nu": ("Poisson's ratio", 1.0, ""),
    "Sy_Pa": ("yield strength", 1e6, "MPa"), "hardness_Pa": ("hardness", 1e9, "GPa"),
    "density_kg_m3": ("density", 1.0, "kg/m^3"),
}  # fmt: skip
_LISTED = ("E_Pa", "Sy_Pa", "hardness_Pa")


def show_materials(
    name: Annotated[str, typer.Argument(
        metavar="NAME", help="A name, or words: 1.4301, S355J2, 'hard brass'. Left out: all.",
    )] = "",
) -> None:  # fmt: skip
    """List metals and hard materials, or show one with spread, sources and its line of a file."""
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
        listed = ", ".join(
            f"{word} {one.numbers[key]['value'] / factor:.4g} {unit}"
            for key, (word, factor, unit) in _SHOWN.items()
            if key in one.numbers and key in _LISTED
        )
        told(one.name, f"{one.title}: {listed}.")
    _in_a_file("NAME")


def _show(one: Entry) -> None:
    typer.echo(f"{one.name}: {one.title} ({one.kind}{one.also and f'; {one.also}'})\n")
    for key, given in one.numbers.items():
        word, factor, unit = _SHOWN[key]
        spread = f"{given['value'] / factor:.4g} +- {given['std'] / factor:.2g} {unit}".rstrip()
        told(word, f"{spread}: {given['source']}.")
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
    _in_a_file(f'"{one.name}"')


def _in_a_file(name: str) -> None:
    typer.echo(f"\nIn a file: material = {name}; what the file states goes first.")
