"""`dentscope.Material`: a material as a person types it, whose magnitudes are asked back."""

from __future__ import annotations

import math
from typing import Any

from ..core.inputs.toml_input import parse_model
from ..core.material import Material as Body
from ..core.rig import MaterialTable

_KEYS = {"E": "E_Pa", "nu": "nu", "Sy": "Sy_Pa", "density": "density_kg_m3"}


class _Checked(type):
    """Makes `core.Material`; what it makes is an instance of both."""

    def __call__(cls, *given: Any, **named: Any) -> Body:
        texts = {_KEYS[k]: v for k, v in named.items() if k in _KEYS and isinstance(v, str)}
        parse_model(texts, MaterialTable, source="Material")  # "200 GPa" is no number
        body = Body(*given, **named)
        numbers = {key: float(getattr(body, name)) for name, key in _KEYS.items()}
        if not body.rigid:
            stated = {key: x for key, x in numbers.items() if math.isfinite(x)}
            parse_model(stated, MaterialTable, source="Material")
        return body

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, Body)


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


Material = CheckedMaterial
"""The name that `dentscope` gives it."""
