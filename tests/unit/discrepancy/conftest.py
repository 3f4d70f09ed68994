"""Comparisons small enough to work out by hand: linear cells, shapes for mechanisms."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from dentscope.core.inputs.rig_numbers import RigNumbers
from dentscope.discrepancy.comparison.cells import Cells
from dentscope.discrepancy.comparison.conditions import Condition
from dentscope.discrepancy.inference.fit import Fit
from dentscope.discrepancy.inference.grid import Axis, Grid, posterior
from dentscope.discrepancy.inference.linear import Linear, Mixture
from dentscope.discrepancy.rank import Ranking, Screened
from dentscope.dynamics.mechanisms.base import Parameter, Surroundings
from dentscope.recordings.bench import Bench

BALL = {"tip_radius_m": 0.01, "mass_kg": 0.03, "length_m": 0.0, "radius_m": 0.01,
        "inertia_kg_m2": 1.2e-6}  # fmt: skip


@dataclass(frozen=True)
class Effect:
    name: str
    shape: tuple[float, ...]
    reason: str = ""
    acts: bool = False
    form: float = 0.0
    law_error: float = 1.0
    scale_error: float = 0.0
    jumps: bool = False
    aslant: bool = False
    holds: tuple[str, ...] = ()
    named: bool = True
    rests_on: tuple[str, ...] = ()
    title: str = "a shape"
    parameters: tuple[Parameter, ...] = (
        Parameter("size", "-", 0.0, 1.0, "linear", 0.0, "", nodes=5),
    )

    def ruled_out(self, situations: Any) -> str:
        return self.reason

    def ranges(self, situations: Any) -> tuple[Parameter, ...]:
        return self.parameters

    def certain(self, around: Any) -> bool:
        return self.acts


@dataclass(frozen=True, eq=False)
class Problem:
    """What the rules ask a problem for."""

    conditions: tuple[Condition, ...]
    cells: Cells
    derivative: np.ndarray
    drifts: tuple[Any, ...] = ()
    scatters: tuple[Any, ...] = ()
    followed: tuple[Any, ...] = ()
    weightless: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()
    error: Any = field(
        default_factory=lambda: SimpleNamespace(freedom=np.zeros(0), count=0, parts={}, rows={})
    )
    rig: Any = None
    baseline: str = "elastic-plastic"
    laws: Any = field(default_factory=lambda: defaultdict(lambda: None))
    wrong_numbers: tuple[Any, ...] = ()
    by_density: dict[str, bool] = field(default_factory=dict)
    misread: dict[str, float] = field(default_factory=dict)
    assumed: tuple[Any, ...] = ()
    nuisances: tuple[Any, ...] = ()
    bench: Bench = field(default_factory=Bench)
    without_modulus: Any = field(default_factory=lambda: {"target": (), "striker": ()})

    @property
    def n_z(self) -> int:
        return self.derivative.shape[1]

    @property
    def n_nuisances(self) -> int:
        return self.n_z - self.error.count

    def scenes(self, z: np.ndarray) -> list[Any]:
        return [None for _ in self.conditions]


@dataclass(frozen=True, eq=False)
class Simulator:
    """Linear cells, or what is `shown`; `seen` is told of every prediction."""

    problem: Problem
    shown: Callable[..., np.ndarray] | None = None
    seen: Callable[..., Any] = lambda mechanisms, points: None

    def of(self, problem: Problem) -> Simulator:
        return replace(self, problem=problem)

    def predict(self, mechanisms: Sequence[Effect], points: Sequence[Any]) -> np.ndarray:
        self.seen(mechanisms, points)
        if self.shown is not None:
            return self.shown(mechanisms, points)
        rows = []
        for point in points:
            row = self.problem.derivative @ point.z
            for m in mechanisms:
                row = row + point.values[m.name]["size"] * np.array(m.shape)
            rows.append(row)
        return np.array(rows)


def condition(speed: float = 1.0, striker: str = "ball", angle: float = math.pi / 2) -> Condition:
    return Condition(striker, speed, angle, 0.0, 0.0, 0.0, 0.0, (0,), Surroundings())


def rig_of(**strikers: dict[str, float]) -> RigNumbers:
    return RigNumbers(
        {f"strikers.{name}.{k}": x for name, numbers in strikers.items()
         for k, x in numbers.items()},
        metals={f"strikers.{name}": "" for name in strikers},
    )  # fmt: skip


def problem(
    value: Sequence[float], *, speeds: Sequence[float] = (), observable: str = "rebound_speed_m_s",
    derivative: Any = None, **more: Any,
) -> Problem:  # fmt: skip
    m = len(value)
    speeds = speeds or [float(k + 1) for k in range(m)]
    cells = Cells(
        np.arange(m), (observable,) * m, np.array(value, dtype=float), np.ones(m),
        np.ones(m, dtype=np.intp),
    )  # fmt: skip
    J = np.zeros((m, 0)) if derivative is None else np.array(derivative, dtype=float)
    more.setdefault("rig", rig_of(ball=BALL))
    return Problem(tuple(condition(v) for v in speeds), cells, J, **more)


def fit_of(data: Sequence[float], *effects: Effect, J: Any = None, lift: float = 0.0) -> Fit:
    """Return the fit of data (m,) by effects over their whole grid; `lift` raises its evidence."""
    r = np.array(data, dtype=float)
    m = len(r)
    linear = Linear(np.eye(m), np.zeros((m, 0)) if J is None else np.array(J, dtype=float))
    grid = Grid(tuple(Axis(e.name, e.parameters[0]) for e in effects))
    places = grid.places() if effects else np.zeros((1, 0))
    shapes = np.array([e.shape for e in effects]).reshape(len(effects), m)
    residuals = r - places @ shapes
    log_likelihood = linear.log_likelihood(residuals)
    evidence, weight = posterior(log_likelihood)
    best = int(np.argmax(log_likelihood))
    z, cov = linear.unknowns(residuals[best])
    return Fit(
        effects, grid, weight, places[best], z, cov, r - residuals[best], evidence + lift,
        float(np.sum(linear.white(residuals[best]) ** 2)), linear, residuals[best],
        np.zeros(m), log_likelihood, residuals, np.zeros(linear.J.shape[1]),
        Mixture((linear,), np.zeros(1)),
    )  # fmt: skip


def screened_of(effect: Effect, changes: Any) -> Screened:
    grid = Grid((Axis(effect.name, effect.parameters[0]),))
    return Screened(effect, grid, np.zeros((0, 0)), np.array(changes, dtype=float), 0.0, np.ones(1))


def ranking_of(given: Problem, base: Fit, *, singles=(), pairs=(), screened=()) -> Ranking:
    return Ranking(given, base, base, tuple(screened), tuple(singles), tuple(pairs), {})


@pytest.fixture(scope="session")
def toy() -> SimpleNamespace:
    return SimpleNamespace(**globals())


def balls_on_plate(
    folder: Path, trials: str, *, noise: Mapping[str, object], E: str = "2.0e11",
    Sy: str = "3.5e8", balls: Mapping[str, tuple[float, float]] | None = None, more: str = "",
) -> Path:  # fmt: skip
    """Write a set of hard balls (names to radius [m] and mass [kg]) on a plate of steel."""
    strikers = "".join(
        f'[strikers.{name}]\nshape = "sphere"\ntip_radius_m = {radius}\nmass_kg = {mass}\n'
        "E_Pa = 2.1e11\nnu = 0.3\nSy_Pa = 2e9\n"
        for name, (radius, mass) in (balls or {"ball": (5e-3, 4.1e-3)}).items()
    )
    noises = "".join(f"{name} = {value}\n" for name, value in noise.items())
    setup = (
        'format = "recording-set/1"\nname = "balls"\n'
        f"[target]\nE_Pa = {E}\nnu = 0.3\nSy_Pa = {Sy}\ndensity_kg_m3 = 7800\n{strikers}"
        f"[noise]\n{noises}{more}"
    )
    folder.mkdir(exist_ok=True)
    (folder / "set.toml").write_text(setup, encoding="utf-8")
    (folder / "trials.csv").write_text(trials, encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def set_of_balls() -> Callable[..., Path]:
    return balls_on_plate
