"""From a recording set to what inference works on: a problem, which knows its baseline scenes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.rig_numbers import RigNumbers
from ...core.material import Pair
from ...core.observables import OBSERVABLES
from ...core.tables import counted
from ...dynamics import CREEP, Approach, ForceTransform, Friction, Press, Scene, Striker
from ...dynamics.files.bodies import bodies_of
from ...dynamics.files.second import second_of
from ...dynamics.mechanisms import MECHANISMS
from ...dynamics.mechanisms.arithmetic import as_deep, deepest
from ...dynamics.mechanisms.base import Constants, Mechanism
from ...dynamics.mechanisms.half_space_waves import HalfSpaceWaves
from ...models.base import ContactLaw
from ...recordings import RecordingSet
from ...recordings.bench import Bench
from ..baseline.laws import LawChoice, laws_of, measured_where_unknown, without_curves
from ..curves.readings import readings_of
from ..rules import RULES
from ..unknowns.lawerror import NO_ERROR, LawError, law_error
from ..unknowns.nuisances import GAUGE, LOAD_SCALE, RIM_SCALE, Nuisance, nuisances_of
from ..unknowns.repeats import Drift, Followed
from ..unknowns.wrong_number import WrongNumber, by_density, wrong_numbers
from .cells import NO_CELLS, Cells, Scatter, cells_of
from .conditions import Condition, conditions_of
from .derived import derived_columns


@dataclass(frozen=True, eq=False)
class Problem:
    """Everything that a diagnosis compares: a recording set in the terms of the simulation."""

    name: str
    laws: Mapping[str, ContactLaw]
    """Of every striker's contact."""
    rig: RigNumbers
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
    baseline: str = "elastic-plastic"
    """What the set takes its contact to do: `law` of its target."""
    assumed: tuple[Mechanism, ...] = ()
    """Mechanisms that act whatever is found, as published."""
    sees_dents: bool = False
    """Whether diameters of dents were measured, so that the contact's radius matters."""
    bench: Bench = field(default_factory=Bench)
    """What can be done next."""
    by_density: Mapping[str, bool] = field(default_factory=dict)
    """Keys of masses and radii to whether a ball's density contradicts them."""
    misread: Mapping[str, float] = field(default_factory=dict)
    """Keys of what is off by a power of ten, and by which."""

    @property
    def n_nuisances(self) -> int:
        """Number of stated-but-uncertain numbers."""
        return len(self.nuisances)

    @property
    def n_z(self) -> int:
        """Length of the vector of standardised unknowns: nuisances, then the law's error."""
        return len(self.nuisances) + self.error.count

    @property
    def law_name(self) -> str:
        """The contact laws by name."""
        return ", ".join(dict.fromkeys(law.name for law in self.laws.values()))

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

    def with_error(self, known: LawError | None = None) -> Problem:
        """Return the same with the law's error as these conditions have it.

        Of strikers whose error is known already, that stays.
        """
        plain = replace(self, error=NO_ERROR)
        scenes: dict[str, list[Scene]] = {}
        stated = plain.scenes(np.zeros(plain.n_z))
        for c, scene in zip(self.conditions, stated, strict=True):
            scenes.setdefault(c.striker, []).append(scene)
        error = law_error(scenes, dents=self.sees_dents, second=second_of(self.rig))
        if known is not None:
            error = replace(known, spreads={**error.spreads, **known.spreads})
        return replace(self, error=error)

    @cached_property
    def assumed_values(self) -> Constants:
        """Numbers of what is assumed."""
        around = self.conditions[0].around
        return {m.name: m.published(around) for m in self.assumed}

    @property
    def wrong_numbers(self) -> tuple[WrongNumber, ...]:
        """Every stated number that may be wrong; not what is taken as unknown already."""
        known = {key for key, x in self.rig.of.items() if math.isfinite(x)}
        # what acts here alone: a friction where bodies slide, a factor on speeds where they strike
        known -= {"friction.coefficient"}
        for n in self.nuisances:
            guess = n.spread >= RULES.guessed or not (n.stated or n.name == "speed.scale")
            (known.discard if guess else known.add)(n.name)
        known -= {f"{body}.mass_kg" for body in self.rig.solids}  # of which nobody said anything
        strikers = tuple(dict.fromkeys(c.striker for c in self.conditions))
        falls = [c.striker for c in self.conditions if c.around.from_height]
        fallen = max((self.rig.of[f"strikers.{s}.tip_radius_m"] for s in falls), default=0.0)
        observed = tuple(dict.fromkeys(self.cells.observable))
        oblique = any(c.incidence < math.pi / 2.0 - 1e-6 for c in self.conditions)
        around = self.conditions[0].around
        plate = around.thickness > 0.0 and not around.support_mass > 0.0 and around.struck is None
        plate &= HalfSpaceWaves.name not in (m.name for m in self.assumed)
        found = wrong_numbers(
            frozenset(known), strikers, observed, fallen=fallen, oblique=oblique,
            squares="restitution" in observed and self.baseline != "measured-restitution",
            plate=plate, misread=self.misread,
        )  # fmt: skip
        return tuple(found)

    @property
    def scales(self) -> tuple[tuple[str, int], ...]:
        """Observables whose readings share a factor, and its place among the unknowns."""
        found = []
        for i, n in enumerate(self.nuisances):
            if n.name == RIM_SCALE:
                found.append(("dent_diameter_m", i))
            elif n.name.startswith(GAUGE) and n.name != LOAD_SCALE:
                found.append((n.name.removeprefix(GAUGE), i))
        return tuple(found)

    def scale(self, observable: str, z: Array) -> float:
        """Return the factor that all readings of an observable share at the unknowns z, (n_z,)."""
        places = [i for name, i in self.scales if name == observable]
        return math.prod(self.nuisances[i].at(float(z[i])) for i in places)

    def rig_at(self, z: Array) -> RigNumbers:
        """Return the rig's numbers at the unknowns z, shape (n_z,)."""
        # written out: a method would be called for every number of every scene
        moved = {
            n.name: n.value * math.exp(n.spread * x) if n.log else n.value + n.spread * x
            for n, x in zip(self.nuisances, z.tolist(), strict=False)
        }
        return self.rig.with_(moved)

    def own_motion(
        self, seen: Mapping[str, Array], z: Array, scenes: Sequence[Scene]
    ) -> dict[str, Array]:
        """Return the striker's own motion, as it is read, where a second sphere is struck.

        `seen`: column to (..., conditions) of the equivalent sphere: rebound, along the contact,
        spin; `z`: (n_z,) unknowns; `scenes`: that of each condition, as it touches.
        """
        second = second_of(self.rig_at(z))
        if second is None:
            return {}
        speed, along, spin, mass, R = np.transpose([
            (s.approach.speed, s.approach.tangential, s.approach.spin, s.striker.mass, s.pair.R)
            for s in scenes
        ])  # fmt: skip
        share = 1.0 - mass / second.mass
        return {
            "rebound_speed_m_s": second.own_rebound(seen["rebound_speed_m_s"], speed, mass),
            "tangential_rebound_m_s": along + share * (seen["tangential_rebound_m_s"] - along),
            "rebound_spin_rad_s": second.own_spin(seen["rebound_spin_rad_s"], spin, R, mass),
        }

    def scenes(self, z: Array, factors: Mapping[str, float] | None = None) -> list[Scene]:
        """Return the baseline scene of every condition at the unknowns z, shape (n_z,).

        `factors` are those on numbers of the rig that are wrong.
        """
        rig = self.rig_at(z)
        if factors:
            # a mass that agrees with a wrong radius was worked out from it
            agrees = {k.removesuffix(".mass_kg") for k, off in self.by_density.items() if not off}
            solid = replace(rig, solids=rig.solids | agrees & rig.metals.keys())
            rig = solid.with_({k: f * rig.of[k] for k, f in factors.items()})
        second = second_of(rig)
        used = {c.striker for c in self.conditions}
        b = z[self.n_nuisances :]
        forces = {name: self.error.transform(b, name) for name in used}
        if self.baseline == "measured-restitution":
            back = rig.of["target.restitution"] ** 2
            forces = {name: replace(f, given_back=back) for name, f in forces.items()}
        parts = {name: bodies_of(rig, name) for name in used}
        scale = rig.of.get("speed.scale", 1.0)
        turn = rig.of.get("angle.offset", 0.0)
        mu = Friction(rig.of.get("friction.coefficient", 0.0))
        heavier = rig.of.get(LOAD_SCALE, 1.0)
        found = [
            self._scene(c, parts[c.striker], scale, turn, mu, forces[c.striker])
            if c.press is None
            else self._press(c, parts[c.striker], heavier * c.press.load, forces[c.striker])
            for c in self.conditions
        ]
        return found if second is None else [second.facing(scene) for scene in found]

    def _press(
        self, c: Condition, parts: tuple[Pair, Striker], load: float, force: ForceTransform
    ) -> Scene:
        pair, striker = parts
        rate = 0.0 if c.press is None else c.press.rate
        return Scene(
            self.laws[c.striker], pair, striker, CREEP, gravity=self.rig.of["gravity_m_s2"],
            force=force, press=Press(load, rate),
        )  # fmt: skip

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
            self.laws[c.striker], pair, striker, approach, gravity=self.rig.of["gravity_m_s2"],
            force=force, friction=friction if slides else Friction(),
        )  # fmt: skip


def problem_of(
    recordings: RecordingSet, *, law: LawChoice | None = None, assume: Sequence[str] = (),
    progress: Callable[[str], None] = lambda _: None,
) -> Problem:  # fmt: skip
    """Return what there is to compare in a recording set.

    - `law`: contact law of the baseline. None: finite elements of the set's own pair where a body
      has a flow curve or the target asks for them, else the fitted law.
    - `assume`: names of mechanisms that act whatever is found, beside those that the set names.

    Raises `InputError`: nothing to compare, or what is assumed has no published numbers or cannot
    act here.
    """
    recordings, unknown = measured_where_unknown(recordings)
    setup, approach = recordings.setup, recordings.approach
    conditions = conditions_of(recordings)
    nuisances = nuisances_of(recordings, conditions)
    plain = without_curves(setup.target)
    laws = dict.fromkeys((c.striker for c in conditions), plain)
    rig = setup.numbers(source=recordings.name).assuming(
        E_Pa=RULES.assumed_modulus, nu=RULES.assumed_poisson
    )
    problem = Problem(
        recordings.name, laws, rig, conditions, NO_CELLS, nuisances, NO_ERROR, bench=setup.rig,
        baseline=setup.target.law, sees_dents="dent_diameter_m" in recordings.observed,
        by_density=by_density({c.striker: setup.strikers[c.striker] for c in conditions}),
    )  # fmt: skip
    asked = setup.target.law == "table" or bool(recordings.flows)
    solve = law == "table" or (law is None and asked)
    named = (*setup.assume, *assume)  # what cannot act is refused before anything is solved
    problem = _with_assumed(problem, named, problem.scenes(np.zeros(problem.n_z)))
    problem, told = _of_its_metal(problem, recordings, solve, progress)
    problem = problem.with_error()
    stated = problem.scenes(np.zeros(problem.n_z))
    of_trial = {i: s for c, s in zip(conditions, stated, strict=True) for i in c.trials}
    readings, unread = readings_of(recordings, [of_trial[i] for i in sorted(of_trial)])
    again = derived_columns(recordings, readings)
    readings = {name: r for name, r in readings.items() if name not in again}
    trials = recordings.trials
    driven = np.where(trials.pressed, trials.load_N, approach.normal)
    seen = cells_of(readings, driven, trials.order, problem.conditions, trials.entries)
    if len(seen.cells) == 0:
        known = ", ".join(name for name, row in OBSERVABLES.items() if row.in_trials)
        raise InputError(
            "no measured number to compare with the simulation", source=recordings.name,
            key="trials.csv", allowed=f"one or more of {known}",
        )  # fmt: skip
    later = sum(c.after >= 0 for c in conditions)
    blows = [f"blows into an earlier crater: {counted(later, 'condition')}"] * bool(later)
    # the stiffness of what is taken as measured moves nothing that was read
    idle = (".E_Pa",) if unknown else ()
    noted = (n.note for n in nuisances if n.note and not n.name.endswith(idle))
    size = "taken to act, at its stated or published size"
    acting = (f"{size}: {m.title} ({m.name})" for m in problem.assumed)
    notes = (
        *recordings.notes, *unknown, *told, *blows, *acting, *noted, *unread, *again.values(),
        *seen.notes,
    )  # fmt: skip
    return replace(
        problem, cells=seen.cells, drifts=seen.drifts, scatters=seen.scatters,
        followed=seen.followed, notes=notes,
    )  # fmt: skip


def _with_assumed(problem: Problem, names: Iterable[str], stated: Sequence[Scene]) -> Problem:
    """Return the problem with what is taken to act, by its names."""
    situations = [(s, c.around) for c, s in zip(problem.conditions, stated, strict=True)]
    sized = ((m, m.parameters[0], m.published(situations[0][1])) for m in MECHANISMS)
    known = {m.name: m for m, size, numbers in sized if numbers[size.name] != size.neutral}
    names = dict.fromkeys(names)
    for name in names:
        why = known[name].ruled_out(situations) if name in known else "no published size for it"
        if why:
            raise InputError(
                f"{name}: {why}", source=problem.name, key="assume", allowed=", ".join(known)
            )
    return replace(problem, assumed=tuple(known[name] for name in names))


def _of_its_metal(
    problem: Problem, recordings: RecordingSet, solve: bool, progress: Callable[[str], None]
) -> tuple[Problem, tuple[str, ...]]:
    """The problem with the laws of the set's own metals, and what to say of them."""
    pairs: dict[str, Pair] = {}
    depths: dict[str, list[float]] = {}
    stated = problem.scenes(np.zeros(problem.n_z))
    for c, s in zip(problem.conditions, stated, strict=True):
        pairs[c.striker] = s.pair
        depths.setdefault(c.striker, []).append(deepest(s) / s.pair.R)
    laws, told = laws_of(recordings, pairs, depths, solve=solve, progress=progress)
    conditions = tuple(
        c if c.press is None else replace(c, speed=as_deep(s))
        for c, s in zip(problem.conditions, stated, strict=True)
    )
    return replace(problem, laws=laws, conditions=conditions), told
