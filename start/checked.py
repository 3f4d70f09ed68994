"""`dentscope.Material` and `dentscope.Pair`, as a person types them: magnitudes are asked back."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self, cast, overload

from numpy.typing import ArrayLike

from ..core.arrays import numbers, one_number
from ..core.errors import InputError
from ..core.flow import Flow, FlowCurve, tabulated
from ..core.inputs.materials import entry_named
from ..core.inputs.ranges import RADII, STRAINS, STRENGTHS
from ..core.inputs.toml_input import parse_model
from ..core.material import Material as Body
from ..core.material import Pair as Bodies
from ..core.rig import MaterialTable, material_keys, quantities
from .case_file import read_flow_curve

FlowLike = Flow | FlowCurve | str | Path | ArrayLike
"""A flow law, a curve, its file, or strains and stresses: two rows, or an array of two columns."""

_ROWS = "(strains, stresses), or an array of shape (n, 2), from a strain of 0 on"


class _Checked(type):
    """Whatever is an instance of what such a class makes is one of it."""

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, cls.__bases__)


class CheckedMaterial(Body, metaclass=_Checked):
    """A material in SI units, of magnitudes that a file would be allowed to state.

    It makes a `core.Material`. That one knows no units: its numbers may be in any consistent set.

    Parameters
    ----------
    E
        Young's modulus [Pa].
    nu
        Poisson's ratio [-], 0 <= nu < 0.5.
    Sy
        Yield strength [Pa]; left out it is the first stress of `flow`, or the body is elastic.
    density
        [kg/m^3]; only dynamics needs it.
    flow
        True stress [Pa] over plastic strain [-], from 0 on: `(strains, stresses)`, an array of
        shape (n, 2), the name of a CSV file with columns plastic_strain and stress_Pa, or a
        `core.flow.Flow`.
    rigid
        Does not deform at all; `E`, `nu` and `Sy` are then left out, or ignored.
    name
        Text for tables and pictures.

    Raises
    ------
    InputErrors
        What is no number, or a number that no material has, with the unit that was perhaps meant.

    Examples
    --------
    >>> Material(200e9, 0.3, flow=([0.0, 0.1], [300e6, 500e6])).Sy
    300000000.0
    >>> Material(E=200, nu=0.3)
    Traceback (most recent call last):
    dentscope.core.errors.InputErrors: Material: E_Pa: 200.0 (allowed: a number from 1000 to \
2e+12; 200 GPa would be 2e+11)
    """

    __slots__ = ()

    if TYPE_CHECKING:  # a type checker asks for both, of what deforms

        @overload
        def __init__(
            self, E: float, nu: float, Sy: float = ..., density: float = ..., *,
            flow: FlowLike | None = ..., rigid: bool = ..., name: str = ...,
        ) -> None: ...  # fmt: skip
        @overload
        def __init__(
            self, *, rigid: Literal[True], density: float = ..., name: str = ...
        ) -> None: ...
        def __init__(self, *given: Any, **named: Any) -> None: ...

    def __new__(
        cls, E: float = math.nan, nu: float = math.nan, Sy: float = math.inf,
        density: float = math.nan, *, flow: FlowLike | None = None, rigid: bool = False,
        name: str = "",
    ) -> Self:  # fmt: skip
        """Return a `core.Material`."""
        flows = None if flow is None else _flow_of(flow)
        if flows is not None and flows.curve is not None and Sy == math.inf:
            Sy = flows.curve.strength
        stated = {"E_Pa": E, "nu": nu, "Sy_Pa": Sy, "density_kg_m3": density}
        found = {k: one_number(x, source="Material", key=k) for k, x in stated.items()}
        # an infinite strength and a density of nan are what a program writes for none
        given = {} if rigid else {k: x for k, x in found.items() if math.isfinite(x)}
        parse_model(given, MaterialTable, source="Material")
        body = Body(
            found["E_Pa"], found["nu"], found["Sy_Pa"], rigid, found["density_kg_m3"], name, flows
        )
        return cast("Self", body)


class CheckedPair(Bodies, metaclass=_Checked):
    """A sphere and a flat in SI units, of a radius that a file would be allowed to state.

    It makes a `core.Pair`.

    Parameters
    ----------
    sphere, flat
        The two bodies.
    R
        Radius of the undeformed sphere [m].

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

    __slots__ = ()

    def __new__(cls, sphere: Body, flat: Body, R: float) -> Self:
        """Return a `core.Pair`."""
        for key, body in (("sphere", sphere), ("flat", flat)):
            if not isinstance(body, Body):
                raise InputError(repr(body), source="Pair", key=key, allowed="a Material")
            parse_model(material_keys(body), MaterialTable, source=f"Pair: {key}")
        radius = one_number(R, source="Pair", key="R")
        pair = Bodies(sphere, flat, radius)
        if wanted := RADII.wanted(radius):
            raise InputError(f"{R:g}", source="Pair", key="R", allowed=wanted)
        return cast("Self", pair)


def _flow_of(given: FlowLike) -> Flow:
    """Return the flow law that is given, or that of its curve."""
    if isinstance(given, Flow):
        return given
    if isinstance(given, FlowCurve):
        return Flow(given)
    if isinstance(given, str | Path):
        return Flow(read_flow_curve(Path(given)))
    rows = numbers(given, source="Material", key="flow", allowed=_ROWS)
    rows = rows if isinstance(given, tuple) else rows.T
    if rows.ndim != 2 or len(rows) != 2:
        raise InputError(f"shape {rows.shape}", source="Material", key="flow", allowed=_ROWS)
    strain, stress = rows
    for values, known in ((strain, STRAINS), (stress, STRENGTHS)):
        for value in values:
            if wanted := known.wanted(float(value)):
                raise InputError(f"{value:g}", source="Material", key="flow", allowed=wanted)
    return Flow(tabulated(strain, stress))


Material = CheckedMaterial
"""The name that `dentscope` gives it."""
Pair = CheckedPair
"""Likewise."""
for _named in (Material, Pair):
    _named.__name__ = _named.__name__.removeprefix("Checked")  # as `help` tells it


def material(name: str) -> Material:
    """Return a material of the table at its listed values.

    Parameters
    ----------
    name
        As `dentscope materials` lists it.

    Returns
    -------
    Material
        Modulus, Poisson's ratio, yield strength and density in SI units. Without a listed strength
        it is that of the listed hardness (hardened balls), as in files; else the body is elastic.

    Raises
    ------
    InputError
        The name is unknown; the nearest names are told.

    Examples
    --------
    >>> material("aluminium-6061-t6").Sy
    276000000.0
    """
    name = entry_named(name).name
    of = quantities(MaterialTable(material=name))
    return Material(of["E_Pa"], of["nu"], of.get("Sy_Pa", math.inf), of["density_kg_m3"], name=name)
