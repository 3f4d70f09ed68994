"""Predictions: unknowns and mechanisms in, one number for every cell out, in batches."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np

from ...core.arrays import Array
from ...dynamics import Scene, Settings, dent_radius, pressed, strike_batch, strike_many
from ...dynamics.files.second import second_of
from ...dynamics.mechanisms.asked import SIMULATED
from ...dynamics.mechanisms.base import Constants, Mechanism, Situation, attached, observed
from ...dynamics.stepping import layout as c
from ...models.base import unwarned
from ..unknowns.wrong_number import wrong_factors
from .cells import compared
from .problem import Problem

# limit: scenes from which a second thread pays [-]: starting one costs as much as some ten
_THREAD_FROM = 200

# limit: scenes that are simulated together [-]: memory
_BATCH = 4000

# limit: scenes whose outcome is kept [-]: memory, some 3 kB each
_KEPT = 20_000

_COLUMN = {name: i for i, name in enumerate(c.OBSERVABLES)}
_PRESS_DEPTH, _RECOVERED = c.N_OUT, c.N_OUT + 1
"""Columns behind those of the integrator."""
ACCURACY = Settings(tolerance=1e-6, max_steps=4000, max_contacts=30)


@dataclass(frozen=True, slots=True)
class Point:
    """Where to predict.

    - `z`: (n_z,) standardised nuisances and law errors.
    - `values`: numbers of every mechanism.
    - `faster`: relative change of every condition's speed, of a press's load.
    - `steeper`: change of every condition's angle [rad].
    """

    z: Array
    values: Constants = field(default_factory=dict)
    faster: float = 0.0
    steeper: float = 0.0


def _struck_or_pressed(scenes: list[Scene]) -> Array:
    """Rows of the integrator, those of presses with what they share, and two columns of presses."""
    loaded = np.array([s.press is not None for s in scenes])
    rows = np.full((len(scenes), _RECOVERED + 1), np.nan)
    if not loaded.all():
        rows[~loaded, :_PRESS_DEPTH] = _struck([s for s in scenes if s.press is None])
    if loaded.any():
        found = pressed([s for s in scenes if s.press is not None])
        for name, column in (
            ("residual_sphere_m", found.sphere), ("residual_flat_m", found.flat),
            ("peak_depth_m", found.depth),
        ):  # fmt: skip
            rows[loaded, _COLUMN[name]] = column
        rows[loaded, _PRESS_DEPTH], rows[loaded, _RECOVERED] = found.depth, found.recovered
    return rows


def _struck(scenes: list[Scene]) -> Array:
    """Integrate in two threads: the compiled impacts run free of the interpreter."""
    if len(scenes) < _THREAD_FROM:
        return strike_batch(scenes, ACCURACY)
    # every so-manyth scene: neighbours cost alike, and between two parts an interruption is heard.
    # The filter is set here, because inside a thread the law's own one would race; tables reach
    # beyond the data that the law was fitted to.
    step = max(2, len(scenes) // _THREAD_FROM)
    rows = np.empty((len(scenes), c.N_OUT))

    def fill(k: int) -> None:
        rows[k::step] = strike_batch(scenes[k::step], ACCURACY)

    with unwarned(), ThreadPoolExecutor(min(os.cpu_count() or 1, 2)) as pool:
        list(pool.map(fill, range(step)))
    return rows


@dataclass(frozen=True, eq=False)
class Simulator:
    """Predicts the cells of a problem, and counts the impacts that it takes.

    - `tally`: `impacts` that were simulated, over all problems that share the count.
    - `met`, `rows`: the place of every scene that was simulated, and the rows by place, likewise.
    """

    problem: Problem
    tally: Counter[str] = field(default_factory=Counter)
    met: dict[Scene, int] = field(default_factory=dict, repr=False)
    rows: list[Array] = field(default_factory=list, repr=False)

    def of(self, problem: Problem) -> Simulator:
        """Return the simulator of another problem, with the same tally and rows."""
        return replace(self, problem=problem)

    def predict(self, mechanisms: Sequence[Mechanism], points: Sequence[Point]) -> Array:
        """Return the cells' predictions, shape (points, cells)."""
        seen = self.observe(mechanisms, points)
        cells = self.problem.cells
        out = np.empty((len(points), len(cells)))
        for name in set(cells.observable):
            here = np.array([o == name for o in cells.observable])
            out[:, here] = compared(name, seen[name][:, cells.condition[here]])
        return out

    def observe(self, mechanisms: Sequence[Mechanism], points: Sequence[Point]) -> dict[str, Array]:
        """Return every observable of every condition, each of shape (points, conditions)."""
        n = len(self.problem.conditions)
        per = max(_BATCH // n, 1)
        parts = [self._batch(mechanisms, points[i : i + per]) for i in range(0, len(points), per)]
        return {k: np.concatenate([p[k] for p in parts]) for k in parts[0]}

    def _batch(self, mechanisms: Sequence[Mechanism], points: Sequence[Point]) -> dict[str, Array]:
        problem = self.problem
        if problem.assumed:
            mechanisms = (*problem.assumed, *mechanisms)
            always = problem.assumed_values
            points = [replace(p, values={**always, **p.values}) for p in points]
        situations: list[Situation] = []
        plain: list[Situation] = []
        # the nodes of a grid share their unknowns: one set of scenes serves them all
        known: dict[tuple[object, ...], list[Scene]] = {}
        for point in points:
            factors = wrong_factors(mechanisms, point.values)
            one = (id(point.z), *factors.items())
            if one not in known:
                known[one] = problem.scenes(point.z, factors)
            for condition, scene in zip(problem.conditions, known[one], strict=True):
                if point.faster and scene.press is not None:
                    more = replace(scene.press, load=scene.press.load * (1.0 + point.faster))
                    scene = scene.with_(press=more)
                elif point.faster or point.steeper:
                    a = scene.approach
                    up = 1.0 + point.faster
                    angle = min(a.angle + point.steeper, np.pi / 2.0)
                    if scene.striker.length == 0.0:
                        angle = a.angle
                    a = replace(a, speed=a.speed * up, tangential=a.tangential * up, angle=angle)
                    scene = scene.with_(approach=a)
                plain.append((scene, condition.around))
                scene = attached(mechanisms, scene, point.values, condition.around)
                situations.append((scene, condition.around))
        scenes = [s for s, _ in situations]
        rows = self._rows(scenes)
        self._later_blows(scenes, rows)
        shape = (len(points), len(problem.conditions))
        seen = {k: rows[:, _COLUMN[v]].copy() for k, v in SIMULATED.items()}
        seen["press_depth_m"] = rows[:, _PRESS_DEPTH].copy()
        seen["recovered_depth_m"] = rows[:, _RECOVERED].copy()
        seen["dent_diameter_m"] = self._diameters(scenes, seen["peak_depth_m"])
        self._marks(points, situations, seen)
        # a tip that has parted still has to come out of the crater
        leaving = np.maximum(rows[:, _COLUMN["tip_rebound_m_s"]], 1e-6)
        seen["below_flat_s"] = seen["contact_time_s"] + seen["permanent_depth_m"] / leaving
        for i, point in enumerate(points):
            part = slice(i * shape[1], (i + 1) * shape[1])
            here = {k: v[part] for k, v in seen.items()}
            for k, v in observed(mechanisms, plain[part], point.values, here).items():
                seen[k][part] = v
            if second_of(problem.rig) is not None:
                # what acts between the two takes no momentum from both
                taken = [m for m in mechanisms if not m.mutual]
                met = [attached(taken, s, point.values, around) for s, around in plain[part]]
                here = {k: v[part] for k, v in seen.items()}
                for k, own in problem.own_motion(here, point.z, met).items():
                    seen[k][part] = own
            # last: an instrument's scale multiplies what is there to be read
            for k in dict.fromkeys(name for name, _ in problem.scales):
                seen[k][part] *= problem.scale(k, point.z)
        return {k: v.reshape(shape) for k, v in seen.items()}

    def _rows(self, scenes: list[Scene]) -> Array:
        """Simulate what was not met before: a number of one striker leaves the others' scenes."""
        met, rows = self.met, self.rows
        # what was met and has no rows: the simulation of it was stopped
        if len(rows) < len(met) or len(met) + len(scenes) > _KEPT:
            met.clear()
            rows.clear()
        # hashing a scene takes a tenth of the time of a simple impact: once
        places = [met.setdefault(s, len(met)) for s in scenes]
        if new := list(islice(met, len(rows), None)):
            rows.extend(_struck_or_pressed(new))
            self.tally["impacts"] += len(new)
        return np.stack([rows[i] for i in places])

    def _later_blows(self, scenes: list[Scene], rows: Array) -> None:
        """Integrate again, in order, what meets the crater of an earlier blow."""
        n = len(self.problem.conditions)
        # a condition's number is above that of the one before it
        for k, condition in enumerate(self.problem.conditions):
            if condition.after < 0:
                continue
            earlier = strike_many(scenes[condition.after :: n], ACCURACY)
            for i, impact in enumerate(earlier):
                scenes[k + i * n] = scenes[k + i * n].with_(spot=impact.spot)
            rows[k::n, :_PRESS_DEPTH] = strike_batch(scenes[k::n], ACCURACY)

    def _diameters(self, scenes: list[Scene], peak: Array) -> Array:
        """Diameters of the dents, (n,); nan where the set holds none."""
        if "dent_diameter_m" not in self.problem.cells.observable:
            return np.full(len(scenes), np.nan)
        return 2.0 * dent_radius(scenes, peak)

    def _marks(
        self, points: Sequence[Point], situations: Sequence[Situation], seen: dict[str, Array]
    ) -> None:
        """Put the errors of craters and dents on what stays."""
        n, problem = len(self.problem.conditions), self.problem
        strikers = [c.striker for c in problem.conditions]
        for i, point in enumerate(points):
            part = slice(i * n, (i + 1) * n)
            b = point.z[problem.n_nuisances :]
            R = np.array([s.pair.R for s, _ in situations[part]])
            depth = seen["peak_depth_m"][part] / R
            change = problem.error.crater_change(b, strikers, depth)
            seen["permanent_depth_m"][part] *= np.exp(change)
            if problem.sees_dents:
                wider = np.exp(problem.error.radius_change(b, strikers, depth))
                seen["dent_diameter_m"][part] *= wider
