"""`[mechanisms]` of a set-up: the physics that a diagnosis can name, asked for with its numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import AfterValidator, ConfigDict, Field, create_model, model_validator

from ...core.errors import Mistake
from ...core.inputs.added import MECHANISMS as ADDED
from ...core.inputs.added import names_added
from ...core.inputs.ranges import Within
from ...core.inputs.toml_input import InputTable, parse_model, table_in
from ...core.rig import Quantity, value_of
from ..mechanisms import MECHANISMS
from ..mechanisms.around import surroundings_of
from ..mechanisms.asked import NONE_ASKED, Asked
from ..mechanisms.base import Mechanism, Parameter, Surroundings, Values
from ..mechanisms.own import own_mechanisms
from .scenes import curves_in

if TYPE_CHECKING:
    from .setup import SetupFile


class _GeneratedTable(InputTable):
    """A table whose keys are made by the program; none has a docstring that takes time to find."""

    model_config = ConfigDict(use_attribute_docstrings=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how it is made again: no module holds a class of its name."""
        return _made_again, (type(self).__name__, dict(self), self.model_fields_set)


class MechanismTable(_GeneratedTable):
    """The numbers of one mechanism; `true` takes those that its source has for usual rigs."""

    mechanism: ClassVar[Mechanism]

    @model_validator(mode="before")
    @classmethod
    def _as_its_source_has_it(cls, given: Any) -> Any:
        if not (given is True or isinstance(given, dict)):
            raise ValueError("true, false, or a table of its numbers")
        return {} if given is True else given


class _AllTables(_GeneratedTable):
    """Every mechanism; `false` says that one is known not to act."""

    @model_validator(mode="before")
    @classmethod
    def _those_that_act(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        return {k: v for k, v in given.items() if not (v is False and k in cls.model_fields)}


def _range(one: Parameter) -> AfterValidator:
    return AfterValidator(
        Within(lambda x: one.low <= x <= one.high, f"{one.low:g} to {one.high:g} [{one.unit}]")
    )


def _meaning(mechanism: Mechanism, one: Parameter) -> str:
    of = f"{mechanism.title[:1].upper()}{mechanism.title[1:]}: {mechanism.equations}; "
    known = f"; left out: {one.literature.value:g}" if one.literature else ""
    return f"{of if one is mechanism.parameters[0] else ''}{one.source}{known}."


def _table(mechanism: Mechanism) -> type[MechanismTable]:
    fields: dict[str, Any] = {}
    for p in mechanism.parameters:
        field = Field(None, description=_meaning(mechanism, p))
        fields[p.name] = Annotated[Quantity, _range(p)] | None, field
    made = create_model(mechanism.name, __base__=MechanismTable, **fields)
    made.mechanism = mechanism
    return made


def _fields(mechanisms: Iterable[Mechanism]) -> dict[str, Any]:
    return {m.name: (_table(m) | None, Field(None, description=m.title)) for m in mechanisms}


if TYPE_CHECKING:

    class MechanismsTable(InputTable):
        """`[mechanisms]`: one table a mechanism, by the names of a verdict."""

else:
    MechanismsTable = create_model("mechanisms", __base__=_AllTables, **_fields(MECHANISMS))


@cache
def _with_added(_names: tuple[str, ...]) -> Any:
    return create_model("mechanisms", __base__=MechanismsTable, **_fields(own_mechanisms(())))


def _tables(names: Iterable[str]) -> Any:
    """Return the table of these mechanisms; other packages are loaded where a name is not ours."""
    others = names_added(ADDED) if set(names) - MechanismsTable.model_fields.keys() else ()
    return _with_added(others) if others else MechanismsTable


def added_in(content: Mapping[str, Any], *, source: str) -> dict[str, Any]:
    """Return the table of a file that names mechanisms of other packages; of no other."""
    given = content.get("mechanisms")
    kind = _tables(given) if isinstance(given, dict) else MechanismsTable
    if kind is MechanismsTable:
        return {}
    model = create_model("file", __base__=InputTable, mechanisms=(kind, ...))
    return dict(parse_model({"mechanisms": given}, model, source=source))


def _made_again(name: str, values: dict[str, Any], given: set[str]) -> InputTable:
    of_all = name == "mechanisms"
    kind = _tables(values if of_all else [name])
    if not of_all:
        kind = table_in(kind.model_fields[name].annotation)
    found: InputTable = kind.model_construct(given, **values)
    return found


_ALONE: dict[str, tuple[str, Callable[[SetupFile], bool]]] = {
    "support-compliance": (
        "impact.support", lambda file: file.impact.support in ("sprung", "plate", "rod"),
    ),
    "half-space-waves": (
        "impact.support", lambda file: file.impact.support in ("plate", "half-space", "rod"),
    ),
    "rod-longitudinal-waves": ("impact.modes", lambda file: file.impact.modes > 0),
    "rod-flexural-vibration": ("impact.modes", lambda file: file.impact.modes > 0),
    "truncated-tip": ("impact.finite_tip", lambda file: file.impact.finite_tip),
    "work-hardening": ("flow_curve or hardening", lambda file: bool(curves_in(file))),
}  # fmt: skip
"""What else of a set-up says how the same thing moves."""


def asked_of(file: SetupFile) -> dict[str, MechanismTable]:
    """Return the tables that a set-up holds, by mechanism."""
    return {name: table for name, table in file.mechanisms if table is not None}


def read_by(file: SetupFile) -> frozenset[str]:
    """Return the keys of the set-up that the mechanisms asked for take numbers from."""
    return frozenset(k for table in asked_of(file).values() for k in table.mechanism.reads)


def asked_in(file: SetupFile, *, swept: bool = False) -> Asked:
    """Return the mechanisms that a set-up asks for; a number that is left out is its source's.

    In its blow, or as the blows of its sweep arrive.
    """
    tables = asked_of(file)
    if not tables:
        return NONE_ASKED
    height, heights = file.impact.drop_height_m, file.sweep.drop_height_m
    falls = bool(heights) or (height is not None and not file.sweep.impact_speed_m_s)
    around = surroundings_of(
        file, file.striker, temperature=value_of(file.impact.temperature_K),
        from_height=falls if swept else height is not None, height_share=1.0,
    )  # fmt: skip
    mechanisms = tuple(table.mechanism for table in tables.values())
    constants = {m.name: _values(m, tables[m.name], around) for m in mechanisms}
    highest = max(value_of(height, 0.0), *heights, 0.0)
    lightest = min([*file.sweep.mass_kg, *(s.mass_kg.value for s in file.strikers.values())])
    return Asked(mechanisms, constants, around, 2.0 * file.gravity_m_s2.value * highest, lightest)


def _values(mechanism: Mechanism, table: InputTable, around: Surroundings) -> Values:
    given = {p.name: getattr(table, p.name) for p in mechanism.parameters}
    known = mechanism.published(around, sized=given[mechanism.parameters[0].name] is not None)
    return {**known} | {name: number.value for name, number in given.items() if number is not None}


def mistakes_of(file: SetupFile) -> Iterator[Mistake]:
    """Yield what the single keys of `[mechanisms]` cannot show."""
    tables, one = asked_of(file), "one of the two"
    for name, (other, given) in _ALONE.items():
        if name in tables and given(file):
            yield f"mechanisms.{name}", f"given beside {other}, which says it already", one
    if {"rod-longitudinal-waves", "rod-flexural-vibration"} <= tables.keys():
        told = "given beside mechanisms.rod-flexural-vibration, which rings along the axis as well"
        yield "mechanisms.rod-longitudinal-waves", told, one
    several, unlike = "several strikers", len(file.strikers) > 1
    for name, key, needed, there in (
        ("impact-speed-loss", "loss_growth", "sweep.drop_height_m", file.sweep.drop_height_m),
        ("impact-speed-loss", "loss_by_mass", several, unlike or file.sweep.mass_kg),
        ("truncated-tip", "flat_by_radius", several, unlike),
    ):
        stated = getattr(tables.get(name), key, None)
        if stated is not None and not there:
            told = f"{stated.value:g} does nothing alone"
            yield f"mechanisms.{name}.{key}", told, f"with {needed}"
    asked = asked_in(file)
    for m in asked.mechanisms:
        size, known = m.parameters[0], m.stated(asked.around)
        # by the rig: 0 is told of as idle
        if asked.constants[m.name][size.name] == size.neutral and size.name not in known:
            stated = getattr(tables[m.name], size.name) is not None
            beside = f"; or {' and '.join(m.reads)}" if m.reads and not stated else ""
            told = f"{size.neutral:g} does nothing here" if stated else "missing"
            allowed = f"{size.low:g} to {size.high:g} [{size.unit}]{beside}"
            yield f"mechanisms.{m.name}.{size.name}", told, allowed
        for name in known:
            if getattr(tables[m.name], name) is not None:
                yield f"mechanisms.{m.name}.{name}", f"given beside {' and '.join(m.reads)}", one
