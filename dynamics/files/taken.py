"""Keys of a set-up that an impact does not take: refused, with the way that exists.

A file of an impact shares its tables with a recording set. What only a set's diagnosis reads, and
what acts only beside another key, is a line here and never passed over in silence.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError
from ...core.rig import Quantity, TargetTable
from ..mechanisms import MECHANISMS
from ..mechanisms.around import weaker_table
from .mechanism_tables import read_by

if TYPE_CHECKING:
    from .setup import SetupFile

_OF_A_SET = "left out: `dentscope diagnose` takes it, in the set.toml of a recording set"
_OF_A_BODY = ("Ra_m", "cp_J_kgK", "melting_K", "layer_thickness_m")
_OF_THE_WEAKER = ("cp_J_kgK", "melting_K")
_TEMPERATURE = "impact.temperature_K"
_SOLVED = "left out: `dentscope case` solves with it, and its law.json goes into impact.laws"
_OF_A_CASE = {"rate": _SOLVED, "heating": _SOLVED}


def not_taken(found: SetupFile, content: Mapping[str, Any], *, source: str) -> Iterator[InputError]:
    """Yield a line for each key that is given and would do nothing.

    What a named material knows beyond what an impact needs is not given by the file.
    """

    def line(key: str, value: Any, allowed: str) -> InputError:
        shown = f"{value.value:g}" if isinstance(value, Quantity) else repr(value)
        return InputError(f"{shown} does nothing here", source=source, key=key, allowed=allowed)

    if found.format not in ("", "recording-set/1"):
        yield InputError(
            repr(found.format), source=source, key="format", allowed="recording-set/1, or left out"
        )
    for name, number in found.gauge.items():
        yield line(f"gauge.{name}", number, _OF_A_SET)
    if "dent_edge" in content or "dent_edge" in content.get("noise", ()):
        yield line("dent_edge", found.dent_edge, _OF_A_SET)
    for name, number in found.noise.items():
        yield line(f"noise.{name}", number, _OF_A_SET)
    yield from _of_mechanisms(found, content, line)
    yield from _of_the_flat(found.target, found.impact, line)
    yield from _of_the_striker(found, line)


def _of_mechanisms(found: SetupFile, content: Mapping[str, Any], line: Any) -> Iterator[InputError]:
    """Yield what only a mechanism reads, where none that is asked for does."""
    read = read_by(found)
    for name in type(found.environment).model_fields:
        value = getattr(found.environment, name)
        key = f"environment.{name}"
        if value not in (None, "") and key not in read:
            yield line(key, value, _with_a_mechanism(key))
    if found.impact.temperature_K is not None and _TEMPERATURE not in read:
        yield line(_TEMPERATURE, found.impact.temperature_K, _with_a_mechanism(_TEMPERATURE))
    known = found.striker in found.strikers
    weaker, stated = weaker_table(found, found.striker) if known else "", _tables(content)
    for key, body in found.bodies.items():
        for name in _OF_A_BODY:
            if name not in stated[key]:
                continue
            if name not in read:
                yield line(f"{key}.{name}", getattr(body, name), _with_a_mechanism(name))
            elif name in _OF_THE_WEAKER and key != weaker:
                allowed = f"{weaker}.{name}: heat softens the body that yields first"
                yield line(f"{key}.{name}", getattr(body, name), allowed)


def _with_a_mechanism(key: str) -> str:
    by = [f"mechanisms.{m.name}" for m in MECHANISMS if key in m.reads]
    return f"with {' or '.join(by)}; {_OF_A_SET}" if by else _OF_A_SET


def _of_the_flat(target: TargetTable, impact: Any, line: Any) -> Iterator[InputError]:
    if target.law == "table":
        yield line("target.law", target.law, "law.json of `dentscope case`, in impact.laws")
    if target.law == "measured-restitution":
        yield line("target.law", target.law, _OF_A_SET)
    if impact.support != "sprung":
        allowed = 'with impact.support = "sprung"'
        for name in ("support_mass_kg", "support_stiffness_N_m"):
            value = getattr(target, name)
            if value is not None:
                yield line(f"target.{name}", value, allowed)
        if impact.support_damping_N_s_m:
            yield line("impact.support_damping_N_s_m", impact.support_damping_N_s_m, allowed)
    if impact.support_radius_m and impact.support != "rod":
        allowed = 'with impact.support = "rod"'
        yield line("impact.support_radius_m", impact.support_radius_m, allowed)
    if impact.loss_factor and not impact.modes:
        yield line("impact.loss_factor", impact.loss_factor, "with impact.modes above 0")


def _of_the_striker(found: SetupFile, line: Any) -> Iterator[InputError]:
    impact = found.impact
    name = found.striker
    if name not in found.strikers or found.strikers[name].shape == "rod":
        return
    ball, allowed = found.strikers[name], "of a rod"
    if impact.modes:
        yield line("impact.modes", impact.modes, allowed)
    if impact.finite_tip:
        yield line("impact.finite_tip", True, allowed)
    if ball.length_m is not None:
        yield line(f"strikers.{name}.length_m", ball.length_m, allowed)
    if impact.flight_s is not None and impact.support != "sprung":
        yield line("impact.flight_s", impact.flight_s, f'{allowed}, or on a "sprung" support')


def _tables(content: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """What the file itself says of each body, as far as it is a table."""
    strikers = content.get("strikers")
    named = strikers if isinstance(strikers, dict) else {}
    given = {"target": content.get("target"), **{f"strikers.{k}": t for k, t in named.items()}}
    return {key: table for key, table in given.items() if isinstance(table, dict)}


def taken_elsewhere(content: dict[str, Any], *, source: str) -> Iterator[InputError]:
    """Yield a line for what an impact has elsewhere, or has no equation for."""
    bodies = _tables(content)
    if content.keys() & {"sphere", "flat"} and not content.keys() & {"strikers", "impact"}:
        yield InputError(
            "a CASE.toml of `dentscope case`", source=source,
            allowed="a set-up, which `dentscope impact --new ball` writes",
        )  # fmt: skip
    if bodies.get("target", {}).get("shape") == "rod":
        yield InputError(
            "'rod'", source=source, key="target.shape",
            allowed='"flat" or "sphere"; a rod struck on its end: impact.support = "rod"',
        )  # fmt: skip
    for key, body in bodies.items():
        for name, allowed in _OF_A_CASE.items():
            if name in body:
                yield InputError(
                    "not known here", source=source, key=f"{key}.{name}", allowed=allowed
                )
