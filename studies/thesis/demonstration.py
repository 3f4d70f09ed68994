"""Chapter 5 of the thesis as a demonstration: no parameter is fitted to its measurements.

Mechanisms that apply, alone, in pairs and in triples, are put into the simulation of the three
oblique drops at constants from the literature; what is uncertain of the rod is drawn from stated
ranges (`uncertain`). Compared is what was measured, as the shipped set thesis-chapter-5 states it:
the thesis's "sliding length" is the length of the scar less its width (5.3), so it stands against
the scar of all touches, not against the slide of the tip. Durations and forces that the thesis
inferred are not used: they are not measurements.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...discrepancy.comparison.forward import ACCURACY
from ...discrepancy.comparison.problem import Problem, problem_of
from ...discrepancy.inference.fit import label
from ...dynamics import Scene, strike_batch
from ...dynamics.mechanisms import MECHANISMS, Mechanism
from ...dynamics.mechanisms.asked import SIMULATED
from ...dynamics.mechanisms.base import Situation, observed
from ...dynamics.walk import layout as c
from ...recordings import RecordingSet, read
from ...recordings.shipped import set_folder
from .chapter5 import PROFILOMETER
from .later_touch import Later, later_touch
from .uncertain import Rod, draw_rods, scenes_of

BENDING, RATE = "rod-flexural-vibration", "strain-rate-hardening"
SHOWN = ("baseline", BENDING, RATE, f"{RATE}+{BENDING}")
"""Explanations that are simulated with all draws, beside the best."""
_LAW = 0.05  # of a value: metals against an elastic-perfectly plastic law
_HELD = {"rod-longitudinal-waves", BENDING}  # the second holds the first


@dataclass(frozen=True, eq=False)
class Measured:
    """What the thesis measured.

    Parameters
    ----------
    angles
        (angles,) [deg].
    names
        Columns of trials.csv.
    value, std
        (angles, names) [SI]; the second holds the instrument's and the contact law's error.
    """

    angles: Array
    names: tuple[str, ...]
    value: Array
    std: Array


@dataclass(frozen=True, eq=False)
class Row:
    """One explanation.

    Parameters
    ----------
    name
        Mechanisms joined by "+".
    predicted
        (draws, angles, names) [SI]; nan where an impact did not end.
    misfit
        -2 ln of the measurements' probability density, each a normal with the mean of the draws
        and their deviation and the error together, less the same of a perfect prediction.
    z
        (angles, names) measured less predicted, in such deviations.
    """

    name: str
    predicted: Array
    misfit: float
    z: Array

    def band(self, low: float = 5.0, high: float = 95.0) -> tuple[Array, Array]:
        """Return the percentiles of the draws, (angles, names) each."""
        ends = np.nanpercentile(self.predicted, [low, high], axis=0)
        return ends[0], ends[1]


@dataclass(frozen=True, eq=False)
class Demonstration:
    """All explanations, best first, beside the measurements.

    Parameters
    ----------
    measured
        The thesis's.
    ranked
        Singles, pairs, triples and the baseline with few draws, best first.
    shown
        The explanations of `SHOWN` and the best one with all draws.
    later
        For each angle, the tip's return after the impacts of bending and rate together.
    unfinished
        Impacts that did not end, of all.
    """

    measured: Measured
    ranked: tuple[Row, ...]
    shown: tuple[Row, ...]
    later: tuple[tuple[Later | None, ...], ...]
    unfinished: tuple[int, int]


@dataclass(eq=False)
class _Bench:
    problem: Problem
    stated: list[Scene]
    measured: Measured
    usable: tuple[Mechanism, ...]
    struck: int = 0
    unfinished: int = 0

    @classmethod
    def of(cls, recordings: RecordingSet) -> _Bench:
        problem = problem_of(recordings)
        plain = problem.scenes(np.zeros(problem.n_z))
        stated = [scene.with_(instrument=PROFILOMETER) for scene in plain]
        first = [condition.trials[0] for condition in problem.conditions]
        names = recordings.observed
        value = np.stack([recordings.values(name)[first] for name in names], axis=1)
        std = np.stack([recordings.std(name)[first] for name in names], axis=1)
        angles = np.degrees([condition.angle for condition in problem.conditions])
        situations = [(s, k.around) for s, k in zip(stated, problem.conditions, strict=True)]
        usable = tuple(m for m in MECHANISMS if m.literature and not m.applies(situations))
        return cls(
            problem,
            stated,
            Measured(angles, names, value, np.hypot(std, _LAW * np.abs(value))),
            usable,
        )

    def strike(
        self, mechanisms: Sequence[Mechanism], rods: Sequence[Rod]
    ) -> tuple[list[Scene], Array]:
        """Return the scenes and the rows of all rods at all angles."""
        around = self.problem.conditions[0].around
        ratios = self.measured.value[:, self.measured.names.index("friction_impulse_ratio")]
        literature = {m.name: m.literature for m in self.usable}
        scenes = scenes_of(rods, self.stated, ratios, mechanisms, literature, around)
        rows = strike_batch(scenes, ACCURACY)
        open_end = rows[:, c.FIRST_COUNT + c.COUNTS.index("ending")] != c.DONE
        rows[open_end] = np.nan
        self.struck, self.unfinished = (
            self.struck + len(rows),
            self.unfinished + int(open_end.sum()),
        )
        return scenes, rows

    def row(self, mechanisms: Sequence[Mechanism], rods: Sequence[Rod]) -> Row:
        """Simulate one explanation and compare it."""
        scenes, rows = self.strike(mechanisms, rods)
        situations: list[Situation] = [(s, self.problem.conditions[0].around) for s in scenes]
        seen: Mapping[str, Array] = {
            k: rows[:, c.OBSERVABLES.index(v)].copy() for k, v in SIMULATED.items()
        }
        literature = {m.name: m.literature for m in self.usable}
        seen = observed(mechanisms, situations, literature, seen)
        shape = (len(rods), len(self.stated))
        names = self.measured.names
        predicted = np.stack([seen[k].reshape(shape) for k in names], axis=-1)
        return _compared(label(mechanisms), predicted, self.measured)


def demonstrate(*, draws: int = 200, screening: int = 48, seed: int = 0) -> Demonstration:
    """Simulate chapter 5 with mechanisms alone, in pairs and in triples.

    Parameters
    ----------
    draws
        Rods of what is shown.
    screening
        Rods of every explanation of the ranking.
    seed
        Same seed, same answer.
    """
    bench = _Bench.of(read(set_folder(Path("thesis-chapter-5"))))
    angles = len(bench.stated)
    few = draw_rods(screening, angles, seed=seed)
    explanations = {label(ms): ms for ms in _explanations(bench.usable)}
    ranked = sorted((bench.row(ms, few) for ms in explanations.values()), key=lambda r: r.misfit)
    many = draw_rods(draws, angles, seed=seed + 1)
    names = dict.fromkeys((*SHOWN, ranked[0].name))
    shown = tuple(bench.row(explanations[name], many) for name in names)
    scenes, _ = bench.strike(explanations[SHOWN[-1]], many)
    later = [later_touch(scene) for scene in scenes]
    by_angle = tuple(tuple(later[k::angles]) for k in range(angles))
    return Demonstration(
        bench.measured, tuple(ranked), shown, by_angle, (bench.unfinished, bench.struck)
    )


def _explanations(usable: Sequence[Mechanism]) -> Iterator[tuple[Mechanism, ...]]:
    """None, singles, pairs, triples; a bending rod rings along its axis as well."""
    for size in range(4):
        for chosen in itertools.combinations(usable, size):
            if not {m.name for m in chosen} >= _HELD:
                yield chosen


def _compared(name: str, predicted: Array, measured: Measured) -> Row:
    std = np.hypot(np.nanstd(predicted, axis=0), measured.std)
    z = (measured.value - np.nanmean(predicted, axis=0)) / std
    return Row(name, predicted, float(np.sum(z**2 + 2.0 * np.log(std / measured.std))), z)
