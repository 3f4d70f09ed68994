"""Many impacts at once: arrays of conditions in, named columns out.

Each row goes the quickest way that answers it: normal impacts of a rigid striker by work alone,
all others by the time steps, there too with the law from its table.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.approach import speeds_at_touch
from ..core.arrays import Array, Integers, Mask, numbers
from ..core.errors import Ending, InputError
from ..core.observables import OBSERVABLES as MEASURED
from ..models.base import ContactLaw
from ..models.turned import as_made, turned
from .columns import Impacts
from .integrate import Settings, arrays_of, strike_batch, strike_rows
from .mechanisms.asked import NONE_ASKED, SIMULATED, Asked, unstruck
from .result import leave_resting
from .scene import Approach, ForceTransform, Friction, Scene
from .stepping import layout as c
from .surface import NONE
from .tabulated.energy_route import NAMES, energy_impacts, why_not
from .tabulated.law_table import tabulated

BY_WORK, BY_STEPS = "work", "steps"
"""What the column `route` says."""

Change = Callable[[ForceTransform], ForceTransform]


def unchanged(force: ForceTransform) -> ForceTransform:
    """Return what is done to the force as it is."""
    return force


QUICK = Settings(tolerance=1e-8)
"""Accuracy of the time steps of a batch."""

# What a normal impact without vibration leaves at nothing, and what it makes equal.
_NOTHING = (
    "rebound_spin_rad_s", "sliding_length_m", "scar_travel_m", "scar_excess_m",
    "friction_impulse_ratio", "tangential_impulse_Ns", "friction_work_J", "modal_energy_J",
    "modal_stored_J", "structural_loss_J", "support_energy_J", "support_stored_J",
    "support_loss_J", "damping_work_J", "radiated_J", "tangential_rebound_m_s", "energy_residual",
    "momentum_residual", "angular_residual", "clearance_m",
)  # fmt: skip
_SAME = {
    "touching_time_s": "contact_time_s", "tip_rebound_m_s": "rebound_speed_m_s",
    "clearance_rate_m_s": "rebound_speed_m_s", "plastic_work_J": "contact_work_J",
    "scar_length_m": "scar_width_m",
}  # fmt: skip


def impacts(
    scene: Scene, *, speeds: ArrayLike | None = None, angles: ArrayLike | None = None,
    friction: ArrayLike | None = None, masses: ArrayLike | None = None,
    tangential: ArrayLike | None = None, spins: ArrayLike | None = None,
    settings: Settings = QUICK, asked: Asked = NONE_ASKED, change: Change = unchanged,
) -> Impacts:  # fmt: skip
    """Simulate impacts of a scene over arrays of conditions, which are broadcast.

    - `scene`: gives whatever is left out, the law and all seams.
    - `speeds`: normal approach speed of the contact point [m/s].
    - `angles`: rod: between axis and flat. Sphere: between velocity and flat, which gives the
      tangential speed unless `tangential` does [rad].
    - `friction`: coefficient, at rest as in motion [-].
    - `masses`: of the striker [kg]; its inertia follows.
    - `tangential`, `spins`: of the approach [m/s, rad/s].
    - `settings`: of the time steps.
    - `asked`: mechanisms that act beside the law.
    - `change`: what is done to the force of each impact, with the mechanisms' part in it.

    Returned: in the order of the broadcast arrays, flattened; of one that did not end the column
    `outcome` says why, and what it would show is nan.

    Raises `InputError`: shapes that cannot be broadcast, or a number outside its range.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> from dentscope.dynamics import Approach, Striker, impacts, scene_of
    >>> from dentscope.models import LAWS
    >>> steel = Material(E=200e9, nu=0.3, Sy=760e6)
    >>> ball = scene_of(LAWS["fitted"], sphere=steel, flat=steel,
    ...                 striker=Striker(mass=0.004, tip_radius=0.005), approach=Approach(1.0))
    >>> found = impacts(ball, speeds=[0.5, 1.0, 2.0])
    >>> found["route"].tolist(), bool((np.diff(found["restitution"]) < 0).all())
    (['work', 'work', 'work'], True)
    """
    given = _conditions(scene, speeds, angles, friction, masses, tangential, spins)
    if asked:
        return _with_mechanisms(scene, given, settings, asked, change)
    if change is not unchanged:
        scene = scene.with_(force=change(scene.force))
    return _quickest(scene, given, settings)


def _quickest(scene: Scene, given: Mapping[str, Array], settings: Settings) -> Impacts:
    """Simulate each row by work alone where that answers it, else by steps."""
    values = {name: np.full(len(given["speed"]), np.nan) for name in c.OBSERVABLES + c.COUNTS}
    route = np.full(len(given["speed"]), BY_STEPS, dtype="<U5")
    normal = (given["tangential"] == 0.0) & (given["spin"] == 0.0) & (given["friction"] >= 0.0)
    if scene.striker.length > 0.0:
        normal &= np.abs(given["angle"] - 0.5 * math.pi) < 1e-12
    upright = replace(scene.approach, angle=0.5 * math.pi, tangential=0.0, spin=0.0)
    if normal.any() and not why_not(scene.with_(approach=upright)):
        _by_work(scene, given, normal, values, route)
    if len(rest := np.flatnonzero(route == BY_STEPS)):
        _by_steps(scene, {k: v[rest] for k, v in given.items()}, rest, values, settings)
    return _named(scene, given, values, route)


def scenes_over(scene: Scene, **conditions: Any) -> list[Scene]:
    """Return the scene of each row of `impacts`, which says what its conditions are."""
    return _each(scene, _conditions(scene, **conditions))


def _each(scene: Scene, given: Mapping[str, Array]) -> list[Scene]:
    """Return the scene of each row."""
    count = len(given["speed"])
    return [_one(scene, {k: float(v[i]) for k, v in given.items()}) for i in range(count)]


def _one(scene: Scene, at: Mapping[str, float]) -> Scene:
    approach = Approach(
        at["speed"], at["angle"] if scene.striker.length > 0.0 else 0.5 * math.pi,
        at["tangential"], at["spin"],
    )  # fmt: skip
    return _of_mass(scene, at["mass"]).with_(
        approach=approach, friction=_friction(scene.friction, at["friction"])
    )


def _with_mechanisms(
    scene: Scene, given: Mapping[str, Array], settings: Settings, asked: Asked, change: Change
) -> Impacts:
    """Simulate each row as a scene of its own: a mechanism may follow speed, mass and angle."""
    plain = _each(scene, given)
    acting = asked.without(*asked.idle(plain))
    scenes = [s.with_(force=change(s.force)) for s in acting.attached(plain)]
    found = strike_batch(scenes, settings)
    leave_resting(found)
    values = {name: found[:, j].copy() for j, name in enumerate(c.OBSERVABLES + c.COUNTS)}
    seen = {column: values[name] for column, name in SIMULATED.items()}
    for column, read in acting.observed(plain, seen).items():
        values[SIMULATED[column]] = np.asarray(read)
    for row in np.flatnonzero(values["peak_depth_m"] == 0.0):
        for name, number in {**unstruck(scenes[row]), "contacts": 0.0}.items():
            values[name][row] = number
    return _named(scene, given, values, np.full(len(plain), BY_STEPS))


def _conditions(
    scene: Scene, speeds: Any, angles: Any, friction: Any, masses: Any, tangential: Any, spins: Any
) -> dict[str, Array]:
    """Broadcast the conditions; what is left out is the scene's."""
    approach, sphere = scene.approach, scene.striker.length == 0.0
    named = {
        "speed": (speeds, approach.speed), "angle": (angles, approach.angle),
        "friction": (friction, scene.friction.mu), "mass": (masses, scene.striker.mass),
        "tangential": (tangential, approach.tangential), "spin": (spins, approach.spin),
    }  # fmt: skip
    given = [
        numbers(stated if one is None else one, key=key, allowed="numbers")
        for key, (one, stated) in named.items()
    ]
    try:
        arrays = np.broadcast_arrays(*given)
    except ValueError as error:
        raise InputError(str(error), key="impacts", allowed="shapes that broadcast") from None
    found = {k: np.array(a, dtype=float).ravel() for k, a in zip(named, arrays, strict=True)}
    checks = {
        "speed": (found["speed"] > 0.0, "above 0"),
        "angle": ((found["angle"] > 0.0) & (found["angle"] < 0.5 * math.pi + 1e-9), "0 to pi/2"),
        "friction": (found["friction"] >= 0.0, "0 or more"),
        "mass": (found["mass"] > 0.0, "above 0"),
        "tangential": (np.isfinite(found["tangential"]), "a number"),
        "spin": (np.isfinite(found["spin"]), "a number"),
    }
    for key, (good, allowed) in checks.items():
        if not np.all(good & np.isfinite(found[key])):
            wrong = found[key][~(good & np.isfinite(found[key]))][0]
            raise InputError(f"{wrong:g}", key=key, allowed=allowed)
    if sphere and angles is not None and tangential is None:
        speed, angle = found["speed"], found["angle"]
        _, found["tangential"] = speeds_at_touch(speed, np.nan, angle, False, gravity=scene.gravity)
    return found


def _by_work(
    scene: Scene, given: Mapping[str, Array], normal: Mask,
    values: Mapping[str, Array], route: NDArray[Any],
) -> None:  # fmt: skip
    """Fill the rows that the work alone settles."""
    found = energy_impacts(
        scene.law, scene.pair, given["mass"][normal], given["speed"][normal], gravity=scene.gravity
    )
    answered = np.isfinite(found[:, 0])
    rows = np.flatnonzero(normal)[answered]
    route[rows] = BY_WORK
    for k, name in enumerate(NAMES):
        values[name][rows] = found[answered, k]
    for name in _NOTHING:
        values[name][rows] = 0.0
    mass, rest = given["mass"][rows], values["residual_sphere_m"] + values["residual_flat_m"]
    values["kinetic_before_J"][rows] = 0.5 * mass * given["speed"][rows] ** 2
    values["kinetic_after_J"][rows] = 0.5 * mass * values["rebound_speed_m_s"][rows] ** 2
    values["gravity_work_J"][rows] = mass * scene.gravity * rest[rows]
    values["scar_width_m"][rows] = _crater_width(
        scene, values["residual_flat_m"][rows], values["peak_depth_m"][rows]
    )
    for name, same in _SAME.items():
        values[name][rows] = values[same][rows]
    values["ending"][rows], values["contacts"][rows] = c.DONE, 1.0


def _crater_width(scene: Scene, depth: Array, peak: Array) -> Array:
    """Width of a round crater of parabolic walls as `surface.scar` reads it [m]."""
    step, level = scene.instrument.scan_step, scene.instrument.scan_height
    width, seen = np.zeros_like(depth), depth > level
    if seen.any():
        radius = _quick(scene.law, scene).contact_radius(scene.pair, peak[seen])
        left = depth[seen] > NONE * radius
        seen[seen] = left
        deep, radius = depth[seen], radius[left]
        if level == 0.0:
            width[seen] = 2.0 * radius
            return width
        below = np.floor(radius * (1.0 - np.sqrt(1.0 - level / deep)) / step) + 1.0
        here, before = (deep * (1.0 - (1.0 - k * step / radius) ** 2) for k in (below, below - 1.0))
        width[seen] = 2.0 * (radius - step * (below - (here - level) / (here - before)))
    return width


def _by_steps(
    scene: Scene, given: Mapping[str, Array], rows: Integers,
    values: Mapping[str, Array], settings: Settings,
) -> None:  # fmt: skip
    """Fill the other rows: those of one angle, mass and friction share all but their speeds."""
    scene = scene.with_(law=_quick(scene.law, scene))
    keys = np.stack([given[k] for k in ("angle", "mass", "friction")], axis=1)
    groups, which = np.unique(keys, axis=0, return_inverse=True)
    for k, (angle, mass, mu) in enumerate(groups):
        mine = np.flatnonzero(which.ravel() == k)
        one = _of_mass(scene, float(mass)).with_(
            friction=_friction(scene.friction, float(mu)),
            approach=replace(
                scene.approach, angle=float(angle) if scene.striker.length > 0.0 else 0.5 * math.pi
            ),
        )
        body = np.tile(arrays_of(one, settings).body, (len(mine), 1))
        body[:, c.V_X], body[:, c.V_SPIN] = given["tangential"][mine], given["spin"][mine]
        # the stated speed is the contact point's
        body[:, c.V_Y] = given["spin"][mine] * body[:, c.HALF_COS] - given["speed"][mine]
        found = strike_rows(one, body, settings)
        leave_resting(found)
        for j, name in enumerate(c.OBSERVABLES + c.COUNTS):
            values[name][rows[mine]] = found[:, j]


def _quick(law: ContactLaw, scene: Scene) -> ContactLaw:
    """Return the law from its table if it can stand in one."""
    own, pair = as_made(law, scene.pair)
    table = tabulated(own)
    try:
        table.table(pair)
    except InputError:
        return law
    return table if own is law else turned(table)


def _of_mass(scene: Scene, mass: float) -> Scene:
    """Return the scene with a striker of this mass: inertia and modal masses follow."""
    striker, modes = scene.striker, scene.modes
    share = mass / striker.mass
    other = replace(striker, mass=mass, inertia=striker.inertia * share)
    if share != 1.0:
        # the shapes are mass-normalised
        modes = modes.scaled(lambda x: x / math.sqrt(share))
    return scene.with_(striker=other, modes=modes)


def _friction(stated: Friction, mu: float) -> Friction:
    if mu == stated.mu:
        return stated
    return replace(stated, mu=mu, mu_static=mu)


def _named(
    scene: Scene, given: Mapping[str, Array], values: Mapping[str, Array], route: NDArray[Any]
) -> Impacts:
    """Put the columns into the order of trials.csv, all others behind."""
    n = len(route)
    angle = given["angle"]
    if scene.striker.length == 0.0:
        angle = np.arctan2(given["speed"], np.abs(given["tangential"]))
    columns: dict[str, NDArray[Any]] = {
        "striker": np.full(n, scene.striker.name or "striker"),
        "law": np.full(n, scene.law.name),
        "mass_kg": given["mass"],
        "angle_deg": np.degrees(angle),
        "impact_speed_m_s": given["speed"],
        "approach_tangential_m_s": given["tangential"],
        "approach_spin_rad_s": given["spin"],
        "friction": given["friction"],
    }
    ending = values["ending"]
    if not np.all(done := ending == c.DONE):
        # where a budget ended the walk it stands half way: that is no restitution
        values = {name: np.where(done, found, np.nan) for name, found in values.items()}
    measured = {row.column: row.simulated for row in MEASURED.values() if row.simulated in values}
    columns |= {name: values[own] for name, own in measured.items()}
    taken = set(measured.values())
    columns |= {name: values[name] for name in c.OBSERVABLES if name not in taken}
    columns["contacts"] = np.nan_to_num(values["contacts"]).astype(int)
    columns["route"] = route
    columns["outcome"] = _outcomes(ending)
    return Impacts(columns)


def _outcomes(ending: Array) -> NDArray[Any]:
    told = np.full(len(ending), Ending.NOT_CONVERGED.value, dtype="<U16")
    told[ending == c.DONE] = Ending.COMPLETED.value
    budgets = (c.STEP_BUDGET, c.CONTACT_BUDGET, c.FLIGHT_BUDGET)
    told[np.isin(ending, budgets)] = Ending.STEP_LIMIT.value
    return told
