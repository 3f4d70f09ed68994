"""Keys of a set-up that an impact does not take: refused, with the way that exists.

A file of an impact shares its tables with a recording set. What only a set's diagnosis reads, and
what acts only beside another key, is a line here and never passed over in silence.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ...core.errors import Mistake
from ...core.rig import Quantity, TargetTable
from ..mechanisms import MECHANISMS
from ..mechanisms.around import weaker_table
from .mechanism_tables import read_by

if TYPE_CHECKING:
    from .setup import ImpactTable, SetupFile

_OF_A_SET = "left out: `dentscope diagnose` takes it, in the set.toml of a recording set"
_OF_A_BODY = ("Ra_m", "cp_J_kgK", "melting_K", "layer_thickness_m")
_OF_THE_WEAKER = ("cp_J_kgK", "melting_K")
_TEMPERATURE = "impact.temperature_K"
_SOLVED = "left out: `dentscope case` solves with it, and its law.json goes into impact.laws"
_OF_A_CASE = ("rate", "heating")


def not_taken(found: SetupFile, content: Mapping[str, Any]) -> Iterator[Mistake]:
    """Yield each key that is given and would do nothing.

    What a named material knows beyond what an impact needs is not given by the file.
    """
    if found.format not in ("", "recording-set/1"):
        yield "format", repr(found.format), "recording-set/1, or left out"
    for name, number in found.gauge.items():
        yield _idle(f"gauge.{name}", number, _OF_A_SET)
    if "dent_edge" in content or "dent_edge" in content.get("noise", ()):
        yield _idle("dent_edge", found.dent_edge, _OF_A_SET)
    for name, number in found.noise.items():
        yield _idle(f"noise.{name}", number, _OF_A_SET)
    yield from _of_mechanisms(found, content)
    yield from _of_the_flat(found.target, found.impact)
    yield from _of_the_striker(found)


def _idle(key: str, value: Any, allowed: str) -> Mistake:
    shown = f"{value.value:g}" if isinstance(value, Quantity) else repr(value)
    return key, f"{shown} does nothing here", allowed


def _of_mechanisms(found: SetupFile, content: Mapping[str, Any]) -> Iterator[Mistake]:
    """Yield what only a mechanism reads, where none that is asked for does."""
    read = read_by(found)
    around = {f"environment.{name}": value for name, value in found.environment}
    for key, value in (around | {_TEMPERATURE: found.impact.temperature_K}).items():
        if value not in (None, "") and key not in read:
            yield _idle(key, value, _with_a_mechanism(key))
    known = found.striker in found.strikers
    weaker, stated = weaker_table(found, found.striker) if known else "", _tables(content)
    for table, body in found.bodies.items():
        for name in (name for name in _OF_A_BODY if name in stated[table]):
            key, value = f"{table}.{name}", getattr(body, name)
            if name not in read:
                yield _idle(key, value, _with_a_mechanism(name))
            elif name in _OF_THE_WEAKER and table != weaker:
                softened = f"{weaker}.{name}: heat softens the body that yields first"
                yield _idle(key, value, softened)


def _with_a_mechanism(key: str) -> str:
    by = [f"mechanisms.{m.name}" for m in MECHANISMS if key in m.reads]
    return f"with {' or '.join(by)}; {_OF_A_SET}" if by else _OF_A_SET


def _of_the_flat(target: TargetTable, impact: ImpactTable) -> Iterator[Mistake]:
    laws = {
        "table": "law.json of `dentscope case`, in impact.laws", "measured-restitution": _OF_A_SET,
    }  # fmt: skip
    if target.law in laws:
        yield _idle("target.law", target.law, laws[target.law])
    if impact.support != "sprung":
        allowed = 'with impact.support = "sprung"'
        for name in ("support_mass_kg", "support_stiffness_N_m"):
            value = getattr(target, name)
            if value is not None:
                yield _idle(f"target.{name}", value, allowed)
        if impact.support_damping_N_s_m:
            yield _idle("impact.support_damping_N_s_m", impact.support_damping_N_s_m, allowed)
    if impact.support_radius_m and impact.support != "rod":
        allowed = 'with impact.support = "rod"'
        yield _idle("impact.support_radius_m", impact.support_radius_m, allowed)
    if impact.loss_factor and not impact.modes:
        yield _idle("impact.loss_factor", impact.loss_factor, "with impact.modes above 0")


def _of_the_striker(found: SetupFile) -> Iterator[Mistake]:
    impact, name = found.impact, found.striker
    if name not in found.strikers or found.strikers[name].shape == "rod":
        return
    length = found.strikers[name].length_m
    if impact.modes:
        yield _idle("impact.modes", impact.modes, "of a rod")
    if impact.finite_tip:
        yield _idle("impact.finite_tip", True, "of a rod")
    if length is not None:
        yield _idle(f"strikers.{name}.length_m", length, "of a rod")
    if impact.flight_s is not None and impact.support != "sprung":
        yield _idle("impact.flight_s", impact.flight_s, 'of a rod, or on a "sprung" support')


def _tables(content: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """What the file itself says of each body, as far as it is a table."""
    strikers = content.get("strikers")
    named = strikers if isinstance(strikers, dict) else {}
    given = {"target": content.get("target"), **{f"strikers.{k}": t for k, t in named.items()}}
    return {key: table for key, table in given.items() if isinstance(table, dict)}


def taken_elsewhere(content: dict[str, Any]) -> Iterator[Mistake]:
    """Yield what an impact has elsewhere, or has no equation for."""
    bodies = _tables(content)
    if content.keys() & {"sphere", "flat"} and not content.keys() & {"strikers", "impact"}:
        setup = "a set-up, which `dentscope impact --new ball` writes"
        yield "", "a CASE.toml of `dentscope case`", setup
    if bodies.get("target", {}).get("shape") == "rod":
        end = '"flat" or "sphere"; a rod struck on its end: impact.support = "rod"'
        yield "target.shape", "'rod'", end
    for key, body in bodies.items():
        for name in _OF_A_CASE:
            if name in body:
                yield f"{key}.{name}", "not known here", _SOLVED
