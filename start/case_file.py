"""CASE.toml: two bodies, how far and how fast they are pressed, how finely it is solved."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, get_args

from pydantic import AfterValidator, Field

from ..core.errors import InputError
from ..core.flow import Flow, FlowCurve, tabulated
from ..core.inputs.flow_tables import HardeningTable, HeatingTable, RateTable
from ..core.inputs.input_file import file_beside
from ..core.inputs.ranges import RADII
from ..core.inputs.toml_input import InputTable, Listed, parse_model, read_toml
from ..core.material import Material, Pair
from ..core.rig import FrictionTable, MaterialTable, value_of

if TYPE_CHECKING:
    from ..fem import Accuracy, ContactProblem

Level = Literal["production", "quick", "smoke"]
"""How finely a pair is solved; smoke is coarse, for a first look."""

_SpeedRow = Annotated[tuple[float, float], Listed]


class CaseBody(MaterialTable):
    """A body of CASE.toml: a metal, and how it flows."""

    flow_curve: str | None = None
    """File beside CASE.toml with columns plastic_strain and stress_Pa."""
    hardening: HardeningTable | None = None
    """The flow stress grows with plastic strain."""
    rate: RateTable | None = None
    """The flow stress grows with its rate; needs load.speed_m_s."""
    heating: HeatingTable | None = None
    """The flow stress falls with the heat of the deformation."""

    def to_body(self, key: str, *, file: Path) -> Material:
        """Return the body; a flow curve's file is looked for beside CASE.toml."""
        source = str(file)
        metal = self.to_material(key, source=source)
        if not (self.flow_curve or self.hardening or self.rate or self.heating):
            return metal
        if metal.rigid:
            raise InputError(
                "a rigid body does not flow", source=source, key=key,
                allowed="no flow_curve, hardening, rate or heating with rigid = true",
            )  # fmt: skip
        if self.flow_curve and self.hardening:
            raise InputError(
                "given beside flow_curve", source=source, key=f"{key}.hardening",
                allowed="one of the two",
            )  # fmt: skip
        curve = None
        if self.flow_curve:
            curve = read_flow_curve(file_beside(file, self.flow_curve, key=f"{key}.flow_curve"))
        Sy = curve.strength if curve and math.isinf(metal.Sy) else metal.Sy
        if math.isinf(Sy):
            raise InputError(
                "missing", source=source, key=f"{key}.Sy_Pa", allowed="a number above 0"
            )
        if self.hardening:
            curve = self.hardening.curve(Sy, key=f"{key}.hardening", source=source)
        flow = Flow(
            curve=curve,
            rate=self.rate.rate(key=f"{key}.rate", source=source) if self.rate else None,
            heating=self.heating.heating() if self.heating else None,
        )
        try:
            return metal.with_(Sy=Sy, flow=flow)
        except InputError as error:
            raise error.at(source, f"{key}.{error.key}") from None


class LoadTable(InputTable):
    """How far the sphere is pressed, how fast, and from where it is drawn back."""

    max_delta_over_R: float = Field(ge=1e-12, le=0.5)
    """Largest approach over the sphere's radius; 0.15 is reached where the flat yields."""
    unload_from: tuple[float, ...] = Field(default=(), strict=False)
    """Approaches over R from which the sphere is drawn back."""
    speed_m_s: float | Annotated[tuple[_SpeedRow, ...], Listed] | None = None
    """Speed of the approach: one number, or rows of Delta/R and speed."""

    @property
    def speeds(self) -> tuple[tuple[float, float], ...]:
        """Rows of Delta/R and speed [m/s]; none: no clock."""
        if self.speed_m_s is None:
            return ()
        if isinstance(self.speed_m_s, float):
            return ((0.0, self.speed_m_s),)
        return self.speed_m_s


class _Accuracy(InputTable):
    level: Level = "quick"
    """How finely it is solved; smoke is coarse, for a first look."""


class CaseFile(InputTable):
    """The keys of CASE.toml."""

    radius_m: Annotated[float, AfterValidator(RADII)]
    """Radius of the sphere."""
    sphere: CaseBody
    """What presses."""
    flat: CaseBody
    """What is pressed."""
    load: LoadTable
    """How far, how fast, from where back."""
    friction: FrictionTable = FrictionTable()
    """Between the two bodies; without it they slide freely."""
    accuracy: _Accuracy = _Accuracy()
    """How finely it is solved."""

    @property
    def ball_mass(self) -> float:
        """Mass of the sphere [kg], nan where no density of it is stated."""
        return 4.0 / 3.0 * math.pi * self.radius_m**3 * value_of(self.sphere.density_kg_m3)


def metal_keys(body: str) -> set[str]:
    """Return the keys of a body by which a contact law knows its metal."""
    own = ("E_Pa", "nu", "Sy_Pa", "rigid", "flow_curve")
    hardening = (f"hardening.{key}" for key in ("law", "K_Pa", "B_Pa", "Q_Pa", "n", "b"))
    return {f"{body}.{key}" for key in (*own, *hardening)}


def read_flow_curve(path: Path) -> FlowCurve:
    """Read a table of true stress over plastic strain, from 0 on: plastic_strain and stress_Pa.

    The second may be called true_stress_Pa, as in a set. Every mistake is a line with its row.
    """
    from ..core.inputs.flow_curve import read_flow_curve as read_measured

    found = read_measured(path, ("plastic_strain", "stress_Pa"), also="true_stress_Pa")
    if found.strain[0] != 0.0:
        raise InputError(
            f"{found.strain[0]:g}", source=str(path), key="row 2, column plastic_strain",
            allowed="0 in the first row",
        )  # fmt: skip
    return tabulated(found.strain, found.stress)


def read_pair(file: Path) -> tuple[CaseFile, Pair]:
    """Read CASE.toml: its keys, and its two bodies. Every mistake is a line."""
    stated = read_toml(file)
    if stated.keys() & {"strikers", "impact"}:
        raise InputError(
            "a set-up of `dentscope impact`", source=str(file),
            allowed="CASE.toml, which `dentscope case --new` writes",
        )  # fmt: skip
    content = parse_model(stated, CaseFile, source=str(file))
    sphere = content.sphere.to_body("sphere", file=file)
    flat = content.flat.to_body("flat", file=file)
    if sphere.rigid and flat.rigid:
        raise InputError(
            "given beside a rigid sphere", source=str(file), key="flat.rigid",
            allowed="at most one rigid body",
        )  # fmt: skip
    return content, Pair(sphere, flat, content.radius_m)


def _check_first(first: float, onset: float, last: float, *, source: str) -> None:
    """Refuse what the round-off of coordinates of the order of R would hide."""
    # loaded with the compiler of impacts, which a refused file does without
    from ..dynamics.tabulated.law_table import SHALLOWEST

    if first >= SHALLOWEST:
        return
    if 1e-2 * last < SHALLOWEST:
        raise InputError(
            f"{last:g}", source=source, key="load.max_delta_over_R",
            allowed=f"{100.0 * SHALLOWEST:g} to 0.5",
        )  # fmt: skip
    raise InputError(
        f"first yield at Delta/R = {onset:.2g}", source=source, key="Sy_Pa",
        allowed=f"a strength over E_Pa that yields at {SHALLOWEST / 0.3:.1g} or later",
    )  # fmt: skip


def read_case(file: Path) -> tuple[ContactProblem, Accuracy]:
    """Read CASE.toml into the solver's problem and accuracy. Every mistake is a line."""
    content, pair = read_pair(file)
    friction = value_of(content.friction.coefficient, 0.0)
    return case_of(pair, content.load, friction, level=content.accuracy.level, source=str(file))


def case_of(
    pair: Pair, load: LoadTable, friction: float, *, level: str, source: str
) -> tuple[ContactProblem, Accuracy]:
    """Return problem and accuracy of a pair; refuse a depth beyond the solver, an unknown level."""
    # loaded after the file is read: a mistake in it is told at once
    from .. import fem

    last = load.max_delta_over_R
    # recorded from below first yield; a body that yields late or never still gets two decades
    onset = pair.first_yield
    first = min(0.3 * onset, 1e-2 * last)
    _check_first(first, onset, last, source=source)
    # what the deepest approach leaves is asked of every case
    unload = tuple(sorted({*load.unload_from, last}))
    for depth in unload:
        if not first < depth <= last:
            raise InputError(
                f"{depth:g}", source=source, key="load.unload_from",
                allowed=f"Delta/R above {first:.3g} and up to max_delta_over_R = {last:g}",
            )  # fmt: skip
    depths = fem.geometric_depths(first, last, 60)
    try:
        problem = fem.ContactProblem(
            pair=pair, depths=depths, unload_from=unload, speeds=load.speeds, friction=friction,
            snapshots=(last,), profiles=tuple(depths[k] for k in range(5, 60, 6)),
        )  # fmt: skip
    except InputError as error:
        raise error.at(source, f"load.{error.key}") from None
    if level not in (known := get_args(Level)):
        raise InputError(repr(level), key="level", allowed=", ".join(known))
    return problem, getattr(fem.Accuracy, level)()
