"""From a recording set to what inference works on: a problem, which knows its baseline scenes."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from ..core.material import Material, Pair
from ..impact import Approach, ForceTransform, Friction, Scene, Striker
from ..models import LAWS
from ..models.base import ContactLaw
from ..recordings import RecordingSet
from ..recordings.setup_file import Striker as StrikerTable
from ..recordings.setup_file import Target
from .cells import NO_CELLS, Cells, cells_of
from .conditions import Condition, conditions_of
from .curves import readings_of
from .drift import Drift
from .lawerror import LawError, law_error
from .nuisances import Nuisance, nuisances_of

Array = NDArray[np.float64]


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
    setup, approach = recordings.setup, recordings.approach
    conditions = conditions_of(recordings)
    nuisances = nuisances_of(recordings, conditions)
    law = _law_of(setup.target)
    problem = Problem(
        recordings.name, law, setup.target, dict(setup.strikers), conditions, NO_CELLS, nuisances,
        law_error(law), setup.gravity_m_s2.value,
    )  # fmt: skip
    stated = problem.scenes(np.zeros(problem.n_z))
    of_trial = {i: s for c, s in zip(conditions, stated, strict=True) for i in c.trials}
    readings, unread = readings_of(recordings, [of_trial[i] for i in sorted(of_trial)])
    cells, drifts, left_out = cells_of(
        readings, approach.normal, recordings.trials.order, conditions
    )
    again = sum(c.after >= 0 for c in conditions)
    later = [f"{again} conditions are later blows on one place: they meet its crater"] * bool(again)
    assumed = [n.note for n in nuisances if n.note]
    notes = (*recordings.notes, *later, *assumed, *unread, *left_out)
    return replace(problem, cells=cells, drifts=drifts, notes=notes)


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
