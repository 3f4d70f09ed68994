"""`dentscope.Material` and `dentscope.Pair`, as a person types them: magnitudes are asked back."""

from __future__ import annotations

import math
from typing import Any

from pydantic import TypeAdapter, ValidationError

from ..core.errors import InputError
from ..core.inputs.toml_input import parse_model
from ..core.material import Material as Body
from ..core.material import Pair as Bodies
from ..core.rig import MaterialTable, Quantity, Radius

_KEYS = {"E": "E_Pa", "nu": "nu", "Sy": "Sy_Pa", "density": "density_kg_m3"}
_ORDER = ("E", "nu", "Sy", "rigid", "density")
_RADIUS: TypeAdapter[Quantity] = TypeAdapter(Radius)


class _Checked(type):
    """Makes `core.Material`; what it makes is an instance of both."""

    def __call__(cls, *given: Any, **named: Any) -> Body:
        stated = {**dict(zip(_ORDER, given, strict=False)), **named}
        texts = {_KEYS[k]: v for k, v in stated.items() if k in _KEYS and isinstance(v, str)}
        parse_model(texts, MaterialTable, source="Material")  # "200 GPa" is no number
        for name in _KEYS.keys() & stated.keys():
            _one_number(stated[name], source="Material", key=name)
        body = Body(*given, **named)
        numbers = {key: float(getattr(body, name)) for name, key in _KEYS.items()}
        if not body.rigid:
            finite = {key: x for key, x in numbers.items() if math.isfinite(x)}
            parse_model(finite, MaterialTable, source="Material")
        return body

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, Body)


class _CheckedPair(type):
    """Makes `core.Pair`; what it makes is an instance of both."""

    def __call__(cls, sphere: Any, flat: Any, R: Any) -> Bodies:
        for key, body in (("sphere", sphere), ("flat", flat)):
            if not isinstance(body, Body):
                raise InputError(repr(body), source="Pair", key=key, allowed="a Material")
        _one_number(R, source="Pair", key="R")
        pair = Bodies(sphere, flat, R)
        try:
            _RADIUS.validate_python(float(R))
        except ValidationError as mistake:
            allowed = mistake.errors()[0]["msg"].removeprefix("Value error, ")
            raise InputError(f"{R:g}", source="Pair", key="R", allowed=allowed) from None
        return pair

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, Bodies)


def _one_number(value: Any, *, source: str, key: str) -> None:
    """Refuse an array, `None` and whatever else is not one number."""
    try:
        float(value)
    except (TypeError, ValueError):
        raise InputError(repr(value), source=source, key=key, allowed="one number") from None


class CheckedMaterial(metaclass=_Checked):
    """A material in SI units, of magnitudes that a file would be allowed to state.

    Takes what `core.Material` takes and returns one. That one knows no units: its numbers may be
    in any consistent set of them.

    Raises
    ------
    InputErrors
        A number that no material has, with the unit that was perhaps meant.

    Examples
    --------
    >>> Material(E=200, nu=0.3)
    Traceback (most recent call last):
    dentscope.core.errors.InputErrors: Material: E_Pa: 200.0 (allowed: a number from 1000 to \
2e+12; 200 GPa would be 2e+11)
    """


class CheckedPair(metaclass=_CheckedPair):
    """A sphere and a flat in SI units, of a radius that a file would be allowed to state.

    Takes what `core.Pair` takes and returns one.

    Raises
    ------
    InputError
        A body that is no material, or a radius of another unit.

    Examples
    --------
    >>> steel = Material(E=2e11, nu=0.3)
    >>> Pair(steel, steel, 10)
    Traceback (most recent call last):
    dentscope.core.errors.InputError: Pair: R: 10 (allowed: a number from 1e-09 to 3; 10 mm \
would be 0.01)
    """


Material = CheckedMaterial
"""The name that `dentscope` gives it."""
Pair = CheckedPair
"""Likewise."""
