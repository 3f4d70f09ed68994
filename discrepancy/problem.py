"""From a recording set to what inference works on: conditions, cells, nuisances and their priors.

A condition is one nominal impact; its repeats share one simulation. A cell is one observable at one
condition: the mean of the repeats after a first-order correction to the condition's mean speed.
Positive observables are compared as logarithms.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from ..core.material import Material, Pair
from ..impact import Approach, ForceTransform, Friction, Scene, Striker
from ..models import LAWS
from ..models.base import ContactLaw
from ..recordings import RecordingSet
from ..recordings.noise import bins
from ..recordings.setup_file import Quantity, Target
from ..recordings.setup_file import Striker as StrikerTable
from .curves import FROM_CURVES, Readings, readings_of
from .drift import Drift, drift_of
from .lawerror import LawError, law_error
from .mechanisms.base import Surroundings

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

LOGARITHMIC = (
    "restitution", "permanent_depth_m", "contact_time_s", "peak_force_N", *FROM_CURVES,
)  # fmt: skip
"""Observables that are compared as logarithms."""

PHASES = {
    "restitution": "unloading",
    "permanent_depth_m": "loading",
    "contact_time_s": "loading",
    "peak_force_N": "loading",
    "rebound_spin_rad_s": "sliding",
    "friction_impulse_ratio": "sliding",
    "sliding_length_m": "sliding",
    "rebound_speed_m_s": "free-flight",
    "tangential_rebound_m_s": "free-flight",
    "peak_depth_m": "loading",
    "loading_time_s": "loading",
    "normal_impulse_Ns": "unloading",
    "below_flat_s": "unloading",
}
"""Phase of the impact that shapes each observable most."""

_SAME_SPEED = 0.05
_SPEED_MEASURED, _SPEED_FROM_HEIGHT = 0.003, 0.005  # systematic, where nothing is stated
# what repeats cannot average away: gauges, definitions; of the value, and of one reading's noise
_FLOOR, _FLOOR_OF_NOISE = 0.004, 0.5


@dataclass(frozen=True, slots=True)
class Nuisance:
    """A stated number that is not exactly known.

    Parameters
    ----------
    name, unit
        Key of set.toml, with its table.
    value
        As stated (or assumed where `stated` is false).
    spread
        Standard deviation: of the logarithm if `log`, else of the number.
    log
        Whether the logarithm is normal.
    stated
        Whether the set gives it.
    """

    name: str
    unit: str
    value: float
    spread: float
    log: bool = True
    stated: bool = True

    def at(self, z: float) -> float:
        """Return the value that lies z standard deviations off."""
        return self.value * math.exp(self.spread * z) if self.log else self.value + self.spread * z


@dataclass(frozen=True, slots=True)
class Condition:
    """One nominal impact.

    Parameters
    ----------
    striker
        Name of the striker.
    speed, angle, tangential, spin
        Mean motion just before touch [m/s, rad, m/s, rad/s].
    speed_spread, angle_spread
        Standard error of the mean speed (fraction) and angle [rad].
    trials
        Rows of trials.csv.
    around
        What mechanisms may know.
    after
        The condition that struck the same place before; -1 on fresh metal.
    """

    striker: str
    speed: float
    angle: float
    tangential: float
    spin: float
    speed_spread: float
    angle_spread: float
    trials: tuple[int, ...]
    around: Surroundings
    after: int = -1


@dataclass(frozen=True, eq=False)
class Cells:
    """The measured numbers, m of them.

    Parameters
    ----------
    condition, observable
        Index of the condition and name of the observable.
    value, std
        Mean (of the logarithm where logarithmic) and its standard error.
    count
        Trials behind it.
    """

    condition: Ints
    observable: tuple[str, ...]
    value: Array
    std: Array
    count: Ints

    def __len__(self) -> int:
        return len(self.value)

    @cached_property
    def is_log(self) -> NDArray[np.bool_]:
        """Whether each cell is a logarithm."""
        return np.array([name in LOGARITHMIC for name in self.observable], dtype=bool)

    def take(self, keep: NDArray[np.bool_]) -> Cells:
        """Return some of the cells."""
        names = tuple(n for n, k in zip(self.observable, keep, strict=True) if k)
        return Cells(
            self.condition[keep], names, self.value[keep], self.std[keep], self.count[keep]
        )


@dataclass(frozen=True, eq=False)
class Problem:
    """Everything that a diagnosis compares: a recording set in the terms of the simulation."""

    name: str
    law: ContactLaw
    target: Target
    strikers: dict[str, StrikerTable]
    conditions: tuple[Condition, ...]
    cells: Cells
    nuisances: tuple[Nuisance, ...]
    error: LawError
    gravity: float
    notes: tuple[str, ...] = ()
    drifts: tuple[Drift, ...] = ()

    @property
    def n_nuisances(self) -> int:
        """Number of stated-but-uncertain numbers."""
        return len(self.nuisances)

    @property
    def n_z(self) -> int:
        """Length of the vector of standardised unknowns: nuisances, then the law's error."""
        return len(self.nuisances) + self.error.count

    @property
    def fresh(self) -> Problem:
        """The same with every blow on fresh metal."""
        return replace(self, conditions=tuple(replace(c, after=-1) for c in self.conditions))

    def restricted(self, keep: NDArray[np.bool_]) -> Problem:
        """Return the problem with some of its cells."""
        return replace(self, cells=self.cells.take(keep))

    def scenes(self, z: Array) -> list[Scene]:
        """Return the baseline scene of every condition at the unknowns z, shape (n_z,)."""
        values = {n.name: n.at(float(x)) for n, x in zip(self.nuisances, z, strict=False)}
        force = self.error.transform(z[self.n_nuisances :])
        elastic = self.target.law == "measured-restitution"
        if elastic:
            force = replace(force, given_back=values["target.restitution"] ** 2)
        flat = material_of(self.target, "target", values)
        parts: dict[str, tuple[Pair, Striker]] = {}
        for name in {c.striker for c in self.conditions}:
            table = self.strikers[name]
            body = material_of(table, f"strikers.{name}", values)
            striker = striker_of(table, name, values)
            parts[name] = Pair(body, flat, striker.tip_radius), striker
        scale = values.get("speed.scale", 1.0)
        turn = values.get("angle.offset", 0.0)
        mu = Friction(values.get("friction.coefficient", 0.0))
        return [self._scene(c, parts[c.striker], scale, turn, mu, force) for c in self.conditions]

    def _scene(
        self, c: Condition, parts: tuple[Pair, Striker], scale: float, turn: float,
        friction: Friction, force: ForceTransform,
    ) -> Scene:  # fmt: skip
        pair, striker = parts
        angle = c.angle
        leaning = striker.length > 0.0 and angle < math.pi / 2.0 - 1e-9
        if leaning:
            angle = min(max(angle + turn, 0.02), math.pi / 2.0)
        approach = Approach(c.speed * scale, angle, c.tangential * scale, c.spin * scale)
        slides = leaning or c.tangential != 0.0 or c.spin != 0.0
        return Scene(
            self.law, pair, striker, approach, gravity=self.gravity, force=force,
            friction=friction if slides else Friction(),
        )  # fmt: skip


def material_of(table: Target | StrikerTable, key: str, values: dict[str, float]) -> Material:
    """Return a body's material at the nuisances' values."""
    plain = table.to_material(E=2e11, nu=0.3, Sy=math.inf)
    return plain.with_(
        E=values.get(f"{key}.E_Pa", plain.E), Sy=values.get(f"{key}.Sy_Pa", plain.Sy)
    )


def striker_of(table: StrikerTable, name: str, values: dict[str, float]) -> Striker:
    """Return a striker at the nuisances' values."""
    mass = values.get(f"strikers.{name}.mass_kg", table.mass_kg.value)
    tip = values.get(f"strikers.{name}.tip_radius_m", table.tip_radius_m.value)
    flat = table.tip_flat_radius_m
    return Striker(
        mass=mass, tip_radius=tip, length=table.length, radius=table.body_radius,
        inertia=table.inertia * mass / table.mass_kg.value,
        tip_flat_radius=flat.value if flat else 0.0, name=name,
    )  # fmt: skip


def problem_of(recordings: RecordingSet) -> Problem:
    """Return what there is to compare in a recording set.

    Raises
    ------
    InputError
        Nothing to compare.
    """
    setup = recordings.setup
    notes: list[str] = list(recordings.notes)
    conditions = _conditions(recordings, notes)
    nuisances = _nuisances(recordings, conditions, notes)
    law = _law_of(setup.target)
    none = np.zeros(0)
    problem = Problem(
        recordings.name, law, setup.target, dict(setup.strikers), conditions,
        Cells(np.zeros(0, dtype=np.intp), (), none, none, np.zeros(0, dtype=np.intp)), nuisances,
        law_error(law), setup.gravity_m_s2.value,
    )  # fmt: skip
    of_trial = {i: s for c, s in zip(conditions, problem.scenes(np.zeros(problem.n_z)), strict=True)
                for i in c.trials}  # fmt: skip
    readings = readings_of(recordings, [of_trial[i] for i in sorted(of_trial)], notes)
    speeds, order = recordings.approach.normal, recordings.trials.order
    cells, drifts = _cells(readings, speeds, order, conditions, notes)
    return replace(problem, cells=cells, drifts=drifts, notes=tuple(notes))


def _law_of(target: Target) -> ContactLaw:
    if target.law != "elastic-plastic":
        return _remembering("hertz")
    return _remembering("fitted" if "fitted" in LAWS else "ghaednia")


@cache
def _remembering(name: str) -> ContactLaw:
    """Return a copy of a law that keeps the numbers of the pairs it was asked for.

    A fit asks for the same pair once a condition and point; working them out anew costs more than
    the impact.
    """
    law = copy.copy(LAWS[name])
    object.__setattr__(law, "parameters", lru_cache(maxsize=4096)(LAWS[name].parameters))
    return law


def _conditions(recordings: RecordingSet, notes: list[str]) -> tuple[Condition, ...]:
    setup, trials, approach = recordings.setup, recordings.trials, recordings.approach
    numbers, before = _nominal(recordings)
    target, air = setup.target, setup.environment
    timed = ~np.isnan(trials.impact_speed_m_s)
    heights = np.where(timed, np.nan, trials.drop_height_m)
    highest = np.nanmax(heights) if np.isfinite(heights).any() else 1.0
    found = []
    for number in np.unique(numbers):
        rows = np.flatnonzero(numbers == number)
        first, n = rows[0], len(rows)
        name = trials.striker[first]
        table = setup.strikers[name]
        v = float(np.mean(approach.normal[rows]))
        relative = approach.normal_std[rows] / approach.normal[rows]
        unknown = _SPEED_MEASURED if timed[first] else _SPEED_FROM_HEIGHT
        relative = np.where(np.isnan(relative), unknown, relative)
        lean = np.radians(np.nan_to_num(trials.angle_deg_std[rows], nan=0.0))
        rough = [q.value for q in (target.Ra_m, table.Ra_m) if q is not None]
        temperature = trials.temperature_K[first]
        ambient = _value(air.temperature_K, 293.0)
        around = Surroundings(
            thickness=_value(target.thickness_m),
            support_mass=_value(target.support_mass_kg),
            support_stiffness=_value(target.support_stiffness_N_m),
            roughness=math.hypot(*rough) if rough else math.nan,
            viscosity=_value(air.viscosity_Pa_s),
            fluid=air.fluid,
            heat_capacity=_value(target.cp_J_kgK),
            melting=_value(target.melting_K),
            temperature=ambient if math.isnan(temperature) else float(temperature),
            ambient=ambient,
            layer_thickness=_value(target.layer_thickness_m),
            from_height=not timed[first],
            height_share=1.0 if timed[first] else float(heights[first] / highest),
        )
        found.append(
            Condition(
                name, v, float(np.mean(approach.angle[rows])),
                float(np.mean(approach.tangential[rows])), float(np.mean(approach.spin[rows])),
                float(np.sqrt(np.mean(relative**2) / n)), float(np.sqrt(np.mean(lean**2) / n)),
                tuple(int(r) for r in rows), around, int(before[first]),
            )
        )  # fmt: skip
    again = sum(c.after >= 0 for c in found)
    if again:
        notes.append(f"{again} conditions are later blows on one place: they meet its crater")
    return tuple(found)


def _nominal(recordings: RecordingSet) -> tuple[Ints, Ints]:
    """Number of each trial's nominal condition, and of the one that struck its place before.

    Repeats share one simulation. Their speeds may differ by 5 %: the mean of the repeats is
    compared with a simulation at their mean speed; what is left of second order is below 0.1 %.
    """
    approach, trials = recordings.approach, recordings.trials
    rows = list(
        zip(
            trials.striker,
            bins(np.asarray(trials.angle_deg), width=1.0),
            bins(np.log(approach.normal), width=_SAME_SPEED),
            bins(approach.tangential / approach.normal, width=_SAME_SPEED),
            bins(approach.spin / approach.normal, width=_SAME_SPEED),
            bins(trials.temperature_K, width=1.0),
            strict=True,
        )
    )
    numbers = np.zeros(len(rows), dtype=np.intp)
    before = np.full(len(rows), -1, dtype=np.intp)
    places: dict[object, int] = {}
    latest: dict[str, int] = {}
    # in the order of testing, so that a place's history is known when it is struck again
    for i in np.argsort(np.nan_to_num(trials.order), kind="stable"):
        spot = trials.spot[i]
        before[i] = latest.get(spot, -1) if spot else -1
        numbers[i] = places.setdefault((rows[i], int(before[i])), len(places))
        if spot:
            latest[spot] = int(numbers[i])
    return numbers, before


def _value(quantity: Quantity | None, default: float = math.nan) -> float:
    return default if quantity is None else quantity.value


def _nuisances(
    recordings: RecordingSet, conditions: Sequence[Condition], notes: list[str]
) -> tuple[Nuisance, ...]:
    setup = recordings.setup
    found: list[Nuisance] = []
    found += _of_body(setup.target, "target", setup.target.law == "elastic-plastic", notes)
    used = sorted({c.striker for c in conditions})
    for name in used:
        table = setup.strikers[name]
        key = f"strikers.{name}"
        found += _of_body(table, key, False, notes)
        found += _stated(table.tip_radius_m, f"{key}.tip_radius_m", "m")
        found += _stated(table.mass_kg, f"{key}.mass_kg", "kg")
    measured = not any(c.around.from_height for c in conditions)
    spread = _SPEED_MEASURED if measured else _SPEED_FROM_HEIGHT
    found.append(Nuisance("speed.scale", "-", 1.0, spread, stated=False))
    leaning = [c for c in conditions if c.angle < math.pi / 2.0 - 1e-6]
    oblique = leaning or [c for c in conditions if c.tangential != 0.0 or c.spin != 0.0]
    if leaning:
        found.append(
            Nuisance("angle.offset", "rad", 0.0, math.radians(0.5), log=False, stated=False)
        )
    if oblique:
        mu = setup.friction.coefficient
        if mu is None:
            notes.append("friction.coefficient is not stated: 0.15 within a factor of 2 is assumed")
            found.append(Nuisance("friction.coefficient", "-", 0.15, 0.7, stated=False))
        else:
            spread = max(mu.std / mu.value if mu.value else 0.0, 0.03)
            found.append(Nuisance("friction.coefficient", "-", mu.value, spread))
    if setup.target.law == "measured-restitution":
        e = recordings.values("restitution") if "restitution" in recordings.observed else None
        start = 0.8 if e is None else float(np.nanmedian(e))
        found.append(Nuisance("target.restitution", "-", start, 0.5, stated=False))
    return tuple(found)


def _of_body(
    table: Target | StrikerTable, key: str, yields: bool, notes: list[str]
) -> list[Nuisance]:
    found = _stated(table.E_Pa, f"{key}.E_Pa", "Pa")
    if table.E_Pa is None:
        notes.append(f"{key}.E_Pa is not stated: 200 GPa within 40 % is assumed")
        found.append(Nuisance(f"{key}.E_Pa", "Pa", 2e11, 0.4, stated=False))
    found += _stated(table.Sy_Pa, f"{key}.Sy_Pa", "Pa")
    if table.Sy_Pa is None and table.hardness_Pa is not None:
        Sy = table.hardness_Pa.value / 2.8
        notes.append(f"{key}.Sy_Pa is taken from the hardness: {Sy / 1e6:.0f} MPa within 15 %")
        found.append(Nuisance(f"{key}.Sy_Pa", "Pa", Sy, 0.15, stated=False))
    elif table.Sy_Pa is None and yields:
        notes.append(f"{key}.Sy_Pa is not stated: 350 MPa within a factor of 2 is assumed")
        found.append(Nuisance(f"{key}.Sy_Pa", "Pa", 3.5e8, 0.7, stated=False))
    return found


def _stated(quantity: Quantity | None, name: str, unit: str) -> list[Nuisance]:
    if quantity is None or not quantity.std > 0.0:
        return []
    return [Nuisance(name, unit, quantity.value, quantity.std / abs(quantity.value))]


def _cells(
    readings: Mapping[str, Readings], speeds: Array, order: Array, conditions: Sequence[Condition],
    notes: list[str],
) -> tuple[Cells, tuple[Drift, ...]]:  # fmt: skip
    place = order / np.nanmax(order) if np.isfinite(order).any() else np.full(len(speeds), np.nan)
    drifts = []
    rows: list[tuple[int, str, float, float, int]] = []
    dropped = 0
    for name, read in readings.items():
        values, std = read.value, read.std
        # a value of zero with a fractional noise is not exact
        std = np.maximum(std, 0.01 * np.sqrt(np.nanmean(values**2)) * (std <= 0.0))
        log = name in LOGARITHMIC
        part: list[tuple[int, str, float, float, int]] = []
        squares, degrees = 0.0, 0
        repeats = []
        for k, c in enumerate(conditions):
            index = np.array([i for i in c.trials if np.isfinite(values[i])], dtype=np.intp)
            if log:
                index = index[values[index] > 0.0]
            if index.size == 0:
                continue
            y = np.log(values[index]) if log else values[index]
            s = std[index] / np.abs(values[index]) if log else std[index]
            # to the condition's mean speed, with the power that a plastic contact has
            y = y - _power(name, y, log) * np.log(speeds[index] / c.speed)
            keep = _kept(y, s)
            dropped += int(np.sum(~keep))
            y, s = y[keep], s[keep]
            repeats.append((place[index[keep]], y, s))
            weight = 1.0 / s**2
            mean = float(np.sum(weight * y) / np.sum(weight))
            squares += float(np.sum(((y - mean) / s) ** 2))
            degrees += len(y) - 1
            part.append((k, name, mean, float(np.sum(weight) ** -0.5), len(y)))
        ratio = squares / degrees if degrees >= 8 else 1.0
        if ratio > 1.0 + 3.0 * math.sqrt(2.0 / max(degrees, 1)):
            notes.append(
                f"{name}: repeats scatter {math.sqrt(ratio):.1f} times as much as stated; their "
                "scatter is used"
            )
            part = [(k, n, m, s * math.sqrt(ratio), c) for k, n, m, s, c in part]
        rows += part
        drifts.append(drift_of(name, repeats, observables=len(readings)))
    if dropped:
        notes.append(f"{dropped} single values lie far off their repeats and were left out")
    value = np.array([r[2] for r in rows])
    names = tuple(r[1] for r in rows)
    of_value = np.array([_FLOOR if n in LOGARITHMIC else _FLOOR * _size(n, rows) for n in names])
    one_reading = np.array([r[3] * math.sqrt(r[4]) for r in rows])
    floor = np.minimum(of_value, _FLOOR_OF_NOISE * one_reading)
    cells = Cells(
        np.array([r[0] for r in rows], dtype=np.intp), names, value,
        np.hypot(np.array([r[3] for r in rows]), floor),
        np.array([r[4] for r in rows], dtype=np.intp),
    )  # fmt: skip
    return cells, tuple(d for d in drifts if d is not None)


def _size(name: str, rows: Sequence[tuple[int, str, float, float, int]]) -> float:
    return float(np.sqrt(np.mean([r[2] ** 2 for r in rows if r[1] == name])))


def _power(name: str, y: Array, log: bool) -> Array:
    """D y / d ln v of a fully plastic contact; good enough between repeats."""
    power = {
        "restitution": -0.25, "permanent_depth_m": 1.0, "contact_time_s": 0.0, "peak_force_N": 1.0,
        "rebound_spin_rad_s": 1.0, "friction_impulse_ratio": 0.0, "sliding_length_m": 1.0,
        "rebound_speed_m_s": 0.75, "tangential_rebound_m_s": 1.0, "peak_depth_m": 1.0,
        "loading_time_s": 0.0, "normal_impulse_Ns": 1.0, "below_flat_s": 0.1,
    }[name]  # fmt: skip
    return np.full(y.shape, power) if log else power * y


def _kept(y: Array, s: Array) -> NDArray[np.bool_]:
    """Repeats (three or more) that lie within 5 standard deviations of their median.

    Where most of four or more do not, the stated noise is too small and says nothing of single
    ones; of three the middle one stands.
    """
    near = np.abs(y - np.median(y)) < 5.0 * s
    if len(y) < 3 or (len(y) > 3 and 2 * np.sum(near) < len(y)):
        return np.ones(len(y), dtype=bool)
    return np.asarray(near)
