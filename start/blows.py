"""`dentscope.impact(...)`, a blow by several laws, and `dentscope.sweep(...)`, many in a table."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

from numpy.typing import ArrayLike

from ..core.arrays import numbers, one_number
from ..core.errors import InputError, shortened
from ..core.inputs.input_file import path_of
from ..core.inputs.templates import KINDS, template
from ..core.inputs.toml_input import read_toml
from ..core.material import Material, Pair
from ..core.rig import material_keys
from ..dynamics.columns import Impacts
from ..dynamics.files.blow import Blow, blow_of
from ..dynamics.files.setup import DEFAULT_LAWS, FOLLOWING, Setup, setup_of
from ..models import Laws, laws_named

_KEYS = {"speed": "impact_speed_m_s", "mass": "mass_kg"}
_ARRIVALS = ("impact_speed_m_s", "drop_height_m")
_SETUPS = f"a pair, a set-up file, or {', '.join(KINDS)}"
_NOT_SWEPT = ("setup", "law", "over")
_NO_NUMBERS = ("striker", "support", "finite_tip")


def impact(
    setup: Pair | str | Path = "ball", *, law: Laws = (),
    speed: float | None = None, mass: float | None = None, drop_height_m: float | None = None,
    angle_deg: float | None = None, friction: float | None = None,
    approach_tangential_m_s: float | None = None, approach_spin_rad_s: float | None = None,
    striker: str | None = None,
    modes: int | None = None, loss_factor: float | None = None,
    support: Literal["rigid", "sprung", "plate", "half-space", "rod"] | None = None,
    support_damping_N_s_m: float | None = None, support_radius_m: float | None = None,
    finite_tip: bool | None = None,
    repeats: int | None = None, flight_s: float | None = None, temperature_K: float | None = None,
    max_steps: int | None = None, max_contacts: int | None = None,
) -> Blow:  # fmt: skip
    """Simulate a blow, a law beside the other.

    Parameters
    ----------
    setup
        A pair, whose sphere is a ball that meets the flat; a set-up file; or one to start from:
        `ball`, `rod`, `oblique-ball`.
    law
        A contact law or several; by default those of the set-up.
    speed
        Normal speed of the approach [m/s].
    mass
        Of the striker [kg]; a ball without it is solid, of its radius and density.
    drop_height_m, angle_deg
        Height of the fall, in place of a speed; between a rod's axis or a sphere's velocity and
        the flat, 90 is straight down.
    friction
        Coefficient of friction [-]; a pair has none without it.
    approach_tangential_m_s, approach_spin_rad_s
        Speed along the flat, and spin, before the touch.
    striker
        Which one of a file with several.
    modes, loss_factor
        Vibrations of a rod that are simulated, and their damping.
    support, support_damping_N_s_m, support_radius_m
        How the flat rests; the damping of a sprung one, the radius of a rod whose end is the flat.
    finite_tip, repeats
        Whether the curvature of a rod's tip ends at its shank; blows on the same spot.
    flight_s, max_steps, max_contacts, temperature_K
        Longest flight between two touches, steps and touches at most; of the bodies.

    Returns
    -------
    Blow
        `blow["fitted"].restitution`, `blow.plot()`, `blow.frame()`.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.

    Examples
    --------
    >>> found = impact("ball", law="hertz", speed=1.0)
    >>> round(found["hertz"].restitution, 9)  # elastic: everything is given back
    1.0
    """
    stated = _stated({k: v for k, v in locals().items() if k not in ("setup", "law")})
    chosen = _chosen(setup, stated)
    return blow_of(chosen, laws_named(law) or laws_named(chosen.laws))


def sweep(
    setup: Pair | str | Path = "ball", *, law: Laws = (),
    speed: ArrayLike | None = None, mass: ArrayLike | None = None,
    drop_height_m: ArrayLike | None = None, angle_deg: ArrayLike | None = None,
    friction: ArrayLike | None = None, approach_tangential_m_s: ArrayLike | None = None,
    approach_spin_rad_s: ArrayLike | None = None, over: Mapping[str, ArrayLike] | None = None,
) -> Impacts:  # fmt: skip
    """Simulate first blows at every combination of the values that are given.

    Parameters
    ----------
    setup, law
        As of `impact`.
    speed, mass, drop_height_m, angle_deg, friction, approach_tangential_m_s, approach_spin_rad_s
        One value or several, shape (n,) [m/s, kg, m, degrees, -, m/s, rad/s]; what is left out is
        the set-up's. Without any, the set-up's own table `[sweep]`.
    over
        Values of other numbers of a file by their keys: `{"target.thickness_m": [1e-3, 2e-3]}`.

    Returns
    -------
    Impacts
        A row a law and combination, a column an observable: `found["restitution"]`,
        `found.plot()`, `found.frame()`.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.

    Examples
    --------
    >>> sweep("ball", law="hertz", speed=[1.0, 2.0])["restitution"].round(6).tolist()
    [1.0, 1.0]
    """
    if not isinstance(over, Mapping | None):
        raise InputError(shortened(repr(over), 80), key="over", allowed="{'target.nu': [0.2, 0.3]}")
    given = {**locals(), **(over or {})}
    given = {k: v for k, v in given.items() if k not in _NOT_SWEPT and v is not None}
    if over and isinstance(setup, Pair):
        raise InputError("with a pair", key="over", allowed="with a set-up file or template")
    values = {
        _KEYS.get(k, k): numbers(v, key=k, allowed="one number or several").ravel().tolist()
        for k, v in given.items()
    }
    first = {k: row[0] for k, row in values.items() if row and k in (*_ARRIVALS, "mass_kg")}
    chosen = _chosen(setup, first, sweep=values)
    if not chosen.varied:
        raise InputError("no values", key="sweep", allowed="speed=[1.0, 2.0], angle_deg=..., ...")
    laws = laws_named(law) or laws_named(chosen.laws)
    chosen.check_laws(laws)
    found, *others = (chosen.swept(one) for one in laws)
    return replace(found.joined(*others), swept=chosen.varied)


def _stated(given: dict[str, Any]) -> dict[str, Any]:
    """What was given, by the keys of a set-up file; numpy's numbers as Python's own."""
    found = {}
    for key, value in given.items():
        if value is None:
            continue
        if key not in _NO_NUMBERS:
            one_number(value, key=key, allowed="one number; several: dentscope.sweep")
        found[_KEYS.get(key, key)] = value.item() if hasattr(value, "item") else value
    return found


def _chosen(
    setup: Pair | str | Path, stated: dict[str, Any], *, sweep: dict[str, Any] | None = None
) -> Setup:
    """The set-up with what is asked for in place of what it says."""
    mass, friction = stated.pop("mass_kg", None), stated.pop("friction", None)
    if isinstance(setup, Pair):
        content = _content(setup, mass)
    elif isinstance(setup, str) and setup in KINDS:
        content = tomllib.loads(template(setup))
    else:
        content = read_toml(path_of(setup, key="setup", allowed=_SETUPS))
    section = {**content.get("impact", {}), **stated}
    # speed and height exclude each other: what is asked for goes before what the file says
    if len(arrivals := stated.keys() & _ARRIVALS) == 1:
        section = {k: v for k, v in section.items() if k not in _ARRIVALS or k in arrivals}
    content = {**content, "impact": section} | ({"sweep": sweep} if sweep else {})
    if friction is not None:
        content["friction"] = {"coefficient": friction}
    if mass is not None and not isinstance(setup, Pair):
        strikers = content.get("strikers", {})
        name = section.get("striker") or next(iter(strikers), "")
        content["strikers"] = {**strikers, name: {**strikers.get(name, {}), "mass_kg": mass}}
    found = setup_of(content, source="impact" if isinstance(setup, Pair) else str(setup))
    return replace(found, pair=setup) if isinstance(setup, Pair) else found


def _content(pair: Pair, mass: float | None) -> dict[str, Any]:
    """A pair as a set-up: the sphere is a ball."""
    ball: dict[str, Any] = {"shape": "sphere", "tip_radius_m": pair.R, **_body(pair.sphere)}
    if mass is not None:
        ball["mass_kg"] = mass
    elif math.isnan(pair.sphere.density):
        raise InputError(
            "missing", source="impact", key="mass",
            allowed="the mass of the ball [kg], or a density of pair.sphere",
        )  # fmt: skip
    laws = {} if pair.perfectly_plastic else {"laws": [FOLLOWING, *DEFAULT_LAWS]}
    return {
        "name": "ball on a flat", "target": _body(pair.flat), "strikers": {"ball": ball},
        "impact": laws,
    }  # fmt: skip


def _body(body: Material) -> dict[str, Any]:
    density = {} if math.isnan(body.density) else {"density_kg_m3": body.density}
    return {**material_keys(body), **density}
