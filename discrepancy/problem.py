"""From a recording set to what inference works on: a problem, which knows its baseline scenes."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError
from ..core.material import Pair
from ..core.observables import OBSERVABLES
from ..core.rig import Rig, TargetTable
from ..impact import Approach, ForceTransform, Friction, Scene, Striker
from ..impact.files.bodies import bodies_of
from ..models import LAWS
from ..models.base import ContactLaw
from ..recordings import RecordingSet
from .cells import NO_CELLS, Cells, Scatter, cells_of
from .conditions import Condition, conditions_of
from .curves import readings_of
from .unknowns.drift import Drift
from .unknowns.followed import Followed
from .unknowns.lawerror import NO_ERROR, LawError, law_error
from .unknowns.nuisances import ASSUMED_E, ASSUMED_NU, Nuisance, nuisances_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Problem:
    """Everything that a diagnosis compares: a recording set in the terms of the simulation."""

    name: str
    law: ContactLaw
    rig: Rig
    conditions: tuple[Condition, ...]
    cells: Cells
    nuisances: tuple[Nuisance, ...]
    error: LawError
    notes: tuple[str, ...] = ()
    drifts: tuple[Drift, ...] = ()
    scatters: tuple[Scatter, ...] = ()
    followed: tuple[Followed, ...] = ()
    weightless: frozenset[int] = frozenset()
    """Cells that are too far off everything else to count."""

    @property
    def n_nuisances(self) -> int:
        """Number of stated-but-uncertain numbers."""
        return len(self.nuisances)

    @property
    def n_z(self) -> int:
        """Length of the vector of standardised unknowns: nuisances, then the law's error."""
        return len(self.nuisances) + self.error.count

    @property
    def without_modulus(self) -> dict[str, tuple[str, ...]]:
        """Bodies whose modulus is assumed, as `target` or `striker`: their tables in set.toml."""
        tables = [
            n.name.removesuffix(".E_Pa")
            for n in self.nuisances
            if n.name.endswith(".E_Pa") and not n.stated
        ]
        flat = tuple(t for t in tables if t == "target")
        strikers = tuple(t for t in tables if t != "target")
        return {"target": flat, "striker": strikers}

    def with_error(self) -> Problem:
        """Return the same with the law's error as these conditions have it."""
        plain = replace(self, error=NO_ERROR)
        scenes: dict[str, list[Scene]] = {}
        stated = plain.scenes(np.zeros(plain.n_z))
        for c, scene in zip(self.conditions, stated, strict=True):
            scenes.setdefault(c.striker, []).append(scene)
        return replace(self, error=law_error(scenes))

    @property
    def fresh(self) -> Problem:
        """The same with every blow on fresh metal."""
        return replace(self, conditions=tuple(replace(c, after=-1) for c in self.conditions))

    def scenes(self, z: Array) -> list[Scene]:
        """Return the baseline scene of every condition at the unknowns z, shape (n_z,)."""
        values = {n.name: n.at(float(x)) for n, x in zip(self.nuisances, z, strict=False)}
        used = {c.striker for c in self.conditions}
        b = z[self.n_nuisances :]
        forces = {name: self.error.transform(b, name) for name in used}
        if self.rig.target.law == "measured-restitution":
            back = values["target.restitution"] ** 2
            forces = {name: replace(f, given_back=back) for name, f in forces.items()}
        parts = {
            name: bodies_of(self.rig, name, values=values, E=ASSUMED_E, nu=ASSUMED_NU)
            for name in used
        }
        scale = values.get("speed.scale", 1.0)
        turn = values.get("angle.offset", 0.0)
        mu = Friction(values.get("friction.coefficient", 0.0))
        return [
            self._scene(c, parts[c.striker], scale, turn, mu, forces[c.striker])
            for c in self.conditions
        ]

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
            self.law, pair, striker, approach, gravity=self.rig.gravity_m_s2.value, force=force,
            friction=friction if slides else Friction(),
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
        recordings.name, law, setup, conditions, NO_CELLS, nuisances, NO_ERROR
    ).with_error()
    stated = problem.scenes(np.zeros(problem.n_z))
    of_trial = {i: s for c, s in zip(conditions, stated, strict=True) for i in c.trials}
    readings, unread = readings_of(recordings, [of_trial[i] for i in sorted(of_trial)])
    trials = recordings.trials
    seen = cells_of(readings, approach.normal, trials.order, conditions, trials.varied)
    if len(seen.cells) == 0:
        known = ", ".join(name for name, row in OBSERVABLES.items() if row.in_trials)
        raise InputError(
            "no measured number to compare with the simulation", source=recordings.name,
            key="trials.csv", allowed=f"one or more of {known}",
        )  # fmt: skip
    again = sum(c.after >= 0 for c in conditions)
    later = [f"{again} conditions are later blows on one place: they meet its crater"] * bool(again)
    assumed = [n.note for n in nuisances if n.note]
    notes = (*recordings.notes, *later, *assumed, *unread, *seen.notes)
    return replace(
        problem, cells=seen.cells, drifts=seen.drifts, scatters=seen.scatters,
        followed=seen.followed, notes=notes,
    )  # fmt: skip


def _law_of(target: TargetTable) -> ContactLaw:
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
