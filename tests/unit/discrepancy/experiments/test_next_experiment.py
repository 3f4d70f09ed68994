"""The next experiment: worth by hand, rivals, what a laboratory can do."""

import math
from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.odds import Odds
from dentscope.discrepancy.experiments import feasible
from dentscope.discrepancy.experiments import next_experiment as proposing
from dentscope.discrepancy.experiments.feasible import again, candidates_of, presses_of, to_build
from dentscope.discrepancy.experiments.foreseen import (
    Foreseen,
    Settled,
    discrimination,
    foreseen,
    information,
)
from dentscope.discrepancy.experiments.session import chosen, takes
from dentscope.discrepancy.unknowns.nuisances import Nuisance
from dentscope.dynamics.mechanisms import Surroundings
from dentscope.recordings.bench import Bench, Minutes

SEEN = "rebound_speed_m_s"


def odds(**p: float) -> Odds:
    return Odds({k: () for k in p}, p)


def of_one(mean: float, variance: float) -> Foreseen:
    return Foreseen(np.array([mean]), np.array([[variance]]))


def test_discrimination_is_the_gap_over_what_blurs_it() -> None:
    one, two = of_one(2.0, 3.0), of_one(7.0, 3.0)
    assert discrimination([one, two], [0.5, 0.5]) == pytest.approx(25.0 / 6.0)
    # over three rivals by the products of their probabilities: 25/6, 0 and 25/6
    assert discrimination([one, two, one], [0.5, 0.4, 0.15]) == pytest.approx(
        (0.5 * 0.4 + 0.4 * 0.15) / (0.5 * 0.4 + 0.5 * 0.15 + 0.4 * 0.15) * 25.0 / 6.0
    )


def test_information_ends_at_the_entropy_and_begins_at_nothing() -> None:
    """Of two rivals alike nothing is learnt; of two far apart, which of them it is."""
    alike = information([of_one(1.0, 2.0), of_one(1.0, 2.0)], [0.3, 0.7])
    assert alike == pytest.approx(0.0, abs=1e-12)
    apart = information([of_one(0.0, 1.0), of_one(50.0, 1.0)], [0.3, 0.7])
    assert apart == pytest.approx(-0.3 * math.log(0.3) - 0.7 * math.log(0.7))
    # small gaps: p (1 - p) D by the expansion, with D over twice the one variance
    near = information([of_one(0.0, 1.0), of_one(0.2, 1.0)], [0.5, 0.5])
    assert near == pytest.approx(0.25 * 0.2**2 / 2.0, rel=0.05)
    # rivals without probability tell nothing
    one, two = of_one(0.0, 1.0), of_one(50.0, 1.0)
    assert information([one, two], [0.0, 0.0]) == 0.0
    assert information([one, two], [1.0, 0.0]) == 0.0
    assert information([one, two, two], [0.5, 0.5, 0.0]) == information([one, two], [0.5, 0.5])


def test_rivals_of_one_mean_are_told_by_how_sure_they_are() -> None:
    one, two = of_one(0.0, 1.0), of_one(0.0, 100.0)
    assert discrimination([one, two], [0.5, 0.5]) == 0.0
    # by quadrature of the two normal densities
    y = np.linspace(-80.0, 80.0, 200001)
    p = [np.exp(-0.5 * y**2 / v) / math.sqrt(2.0 * math.pi * v) for v in (1.0, 100.0)]
    mixed = 0.5 * (p[0] + p[1])
    exact = sum(0.5 * np.trapezoid(q * np.log(np.maximum(q, 1e-300) / mixed), y) for q in p)
    assert information([one, two], [0.5, 0.5]) == pytest.approx(exact, rel=0.1)


def test_rivals_are_those_that_share_the_probability(toy) -> None:
    a, b = (toy.Effect(n, (0.0,)) for n in "ab")
    ranking = toy.ranking_of(
        None, toy.fit_of([0.0]), singles=[toy.fit_of([0.0], a), toy.fit_of([0.0], b)],
        pairs=[toy.fit_of([0.0], a, b)],
    )  # fmt: skip

    def names(**p):
        given = Odds({}, {"baseline": 0.0, "a": 0.0, "b": 0.0, "a+b": 0.0, **p})
        return [f.name for f, _ in proposing.rivals_of(ranking, given)]

    # the pair that shares it, not the next single
    assert names(a=0.6, **{"a+b": 0.39})[:2] == ["a", "a+b"]
    assert names(a=0.6, b=0.25, baseline=0.15)[:3] == ["a", "b", "baseline"]


ROD = {"tip_radius_m": 0.01, "mass_kg": 0.5, "length_m": 0.3, "radius_m": 0.01,
       "inertia_kg_m2": 0.0037625}  # fmt: skip


def on_rig(toy, **strikers):
    rig = toy.rig_of(**(strikers or {"ball": toy.BALL}))
    return toy.problem([0.0, 0.0], speeds=[0.5, 2.0], rig=rig)


def test_nothing_is_proposed_that_is_there_already_or_that_a_spring_cannot_do(toy) -> None:
    """Half and 2 m/s are tested; devices D and G know one speed each, as rebound testers do."""
    given = on_rig(toy)
    found = candidates_of(given)
    own = [c.condition.speed for c in found]
    assert own == pytest.approx([2.0**-0.5, 1.0, 2.0**0.5])
    assert all(c.condition.angle == math.pi / 2.0 for c in found)
    # within the rig's speeds
    assert all(0.499 < c.condition.speed < 2.001 for c in (*found, *to_build(given)))
    assert [given.conditions[k].speed for k in again(given)] == [0.5, 2.0]
    devices = [toy.condition(2.0, "D"), toy.condition(3.0, "G")]
    shot = replace(on_rig(toy, D=toy.BALL, G=toy.BALL), conditions=tuple(devices))
    assert candidates_of(shot) == []
    stated = replace(shot, bench=Bench(speeds_m_s=(1.0, 4.0)))
    assert {c.condition.speed for c in candidates_of(stated)} >= {1.0, 4.0}
    high = Surroundings(from_height=True)
    dropped = replace(shot, conditions=tuple(replace(c, around=high) for c in devices))
    assert candidates_of(dropped)


def test_bodies_that_do_not_yield_leave_nothing_to_scan(toy) -> None:
    elastic = replace(on_rig(toy), baseline="elastic")
    left, marks = proposing._not_measured(elastic), {"permanent_depth_m", "dent_diameter_m"}
    assert not marks & set(left)
    assert "contact_time_s" in left
    assert presses_of(elastic) == []
    assert marks <= set(proposing._not_measured(on_rig(toy)))


def test_the_next_shot_of_an_oblique_ball_says_its_angle(toy) -> None:
    given = on_rig(toy)
    shots = [
        replace(toy.condition(1.0), tangential=-1.0 / math.tan(math.radians(a)))
        for a in (30.0, 75.0)
    ]
    found = candidates_of(replace(given, conditions=tuple(shots)))
    assert all(" degrees" in c.change for c in found)
    angles = [math.degrees(c.condition.incidence) for c in found]
    assert min(angles) > 29.9
    assert max(angles) < 75.1
    between = [c for c in found if 31.0 < math.degrees(c.condition.incidence) < 74.0]
    assert between
    # a ball that turns has no lean; its path is what is inclined, to the side that was tested
    assert all(c.condition.angle == math.pi / 2.0 and c.condition.tangential < 0.0 for c in between)


def test_a_body_of_another_size_has_another_mass_and_is_to_be_built(toy) -> None:
    balls = to_build(on_rig(toy))
    assert sorted(c.built["mass_kg"] for c in balls) == pytest.approx([0.00375, 0.24])
    assert all(c.change.startswith("build a ball") for c in balls)
    rods = to_build(on_rig(toy, ball=ROD))
    longer = next(c for c in rods if "0.6 m long" in c.change)
    assert longer.built["mass_kg"] == pytest.approx(1.0)
    tip = next(c for c in rods if "tip radius of 20 mm" in c.change)
    assert tip.built["mass_kg"] == 0.5
    # m (L^2/12 + r^2/4), and 2/5 m r^2
    assert longer.built["inertia_kg_m2"] == pytest.approx(1.0 * (0.03 + 2.5e-5))
    assert {round(c.built["inertia_kg_m2"] / c.built["mass_kg"] * 1e6) for c in balls} == {10, 160}


class Seen:
    def __init__(self, problem):
        self.problem = problem

    def of(self, problem):
        return Seen(problem)

    def predict(self, mechanisms, points):
        cells = self.problem.cells
        speed = np.array([self.problem.conditions[k].speed for k in cells.condition])
        seen = [
            speed + 2.0 * (speed > 1.4) * (p.values["a"]["size"] if mechanisms else 0.0)
            for p in points
        ]
        return np.array(seen) + np.array([p.z.sum() for p in points])[:, None]

    def observe(self, mechanisms, points):
        shape = (len(points), len(self.problem.conditions))
        return {name: np.ones(shape) for name in OTHERS}


OTHERS = ("restitution", "permanent_depth_m", "contact_time_s", "peak_force_N",
          "friction_impulse_ratio", "rebound_spin_rad_s")  # fmt: skip


def test_the_trial_that_tells_rivals_apart_comes_first(toy, monkeypatch) -> None:
    given = on_rig(toy)
    monkeypatch.setattr(type(given), "with_error", lambda self, known: self, raising=False)
    # the toy has no law that a press could go by
    monkeypatch.setattr(feasible, "presses_of", lambda problem: [])
    base, one = toy.fit_of([0.0, 0.0]), toy.fit_of([0.0, 0.0], toy.Effect("a", (0.0, 2.0)))
    ranking = toy.ranking_of(given, base, singles=[one])
    shared = odds(baseline=0.5, a=0.5)
    found, session = proposing.propose(Seen(given), ranking, shared, np.random.default_rng(0))
    trials = [p for p in found if p.kind == "trial"]
    assert trials[0].change.startswith("ball at 1.4 m/s")
    assert trials[0].information > 2.0 * trials[-1].information
    assert {p.kind for p in found} >= {"trial", "observable"}
    assert session.goes_on
    assert session.steps[0].trial["speed_m_s"] > 1.4
    alone = toy.ranking_of(given, base)
    none, _ = proposing.propose(Seen(given), alone, odds(baseline=1.0), np.random.default_rng(0))
    assert not none
    # a rig that strikes at low speeds only tells nothing, a larger ball at the largest does not
    slow = replace(given, bench=Bench(speeds_m_s=(0.5, 1.0), minutes=Minutes(build=60.0)))
    slow = replace(slow, conditions=slow.conditions[:1] * 2)
    _, stopped = proposing.propose(Seen(slow), ranking, shared, np.random.default_rng(0))
    assert not stopped.goes_on


def test_what_the_rig_cannot_do_is_not_proposed(toy) -> None:
    assert takes(Bench(), "press") == 5.0
    some = Bench(minutes=Minutes(strike=2.0, weigh=3.0))
    assert [takes(some, k) for k in ("strike", "weigh", "change")] == [2.0, 3.0, 10.0]
    assert all(math.isnan(takes(some, k)) for k in ("press", "build", "hardness", "instrument"))
    idle = {**toy.BALL, "tip_radius_m": 0.02}
    found = candidates_of(on_rig(toy, ball=toy.BALL, larger=idle))
    assert [c.like for c in found if c.condition.striker == "larger"] == ["ball"] * 5


def test_a_hardness_that_is_stated_is_not_tested_again(toy) -> None:
    rig = toy.rig_of(ball={**toy.BALL, "hardness_Pa": 2e9}, larger=toy.BALL)
    both = [SimpleNamespace(name=f"strikers.{name}.Sy_Pa") for name in ("ball", "larger")]
    given = SimpleNamespace(nuisances=both, wrong_numbers=(), bench=Bench(), rig=rig)
    plan = SimpleNamespace(problem=given, cells=[], settled=[], options=[])
    proposing._settling(plan)
    assert [one.key for one in plan.settled] == ["strikers.larger.Sy_Pa"]


def test_greedy_is_nearly_as_good_as_all_that_could_be_chosen() -> None:
    """Three rivals, six trials of correlated readings, three of which fill a session."""
    rng = np.random.default_rng(4)
    shares = []
    for _ in range(25):
        root = rng.normal(size=(6, 6)) * 0.5
        seen = [Foreseen(rng.normal(size=6) * 1.5, np.eye(6) + root @ root.T) for _ in range(3)]
        minutes = rng.choice([10.0, 15.0, 20.0], 6)

        def gain(some, seen=seen):
            return information([s.of(np.array(some)) for s in seen], [0.5, 0.3, 0.2])

        def cost(some, minutes=minutes):
            return float(sum(minutes[k] for k in some))

        fits = [c for n in range(1, 7) for c in combinations(range(6), n) if cost(c) <= 45.0]
        picked = chosen(6, gain, cost, budget=45.0)
        assert cost(picked) <= 45.0
        shares.append(gain(picked) / max(map(gain, fits)))
    assert min(shares) > 0.8
    assert np.mean(shares) > 0.95


def test_a_number_measured_again_is_what_the_readings_left_of_it(toy) -> None:
    """A mass known to 1 %; a reading of unit noise is 1 low, so that half of it is the mass."""
    mass = Nuisance("strikers.ball.mass_kg", "kg", 0.03, 0.01)
    given = toy.problem([0.0], derivative=[[0.0]], nuisances=(mass,))
    base = toy.fit_of([0.0], J=[[0.0]])
    settled = (Settled(mass.name, 0.001),)
    seen = foreseen(Seen(given), given, base, np.random.default_rng(0), settled)
    assert seen.mean == pytest.approx([-0.005])
    assert seen.covariance == pytest.approx(np.array([[0.5e-4 + 1e-6]]))


def test_what_was_measured_narrows_what_is_foreseen(toy) -> None:
    """An unknown common to all cells: two of unit noise leave 1/3 of its variance, and a mean."""
    given = toy.problem([5.0, 7.0], derivative=[[1.0], [1.0]])
    cells = given.cells
    more = replace(
        cells, condition=np.append(cells.condition, 0), observable=(*cells.observable, SEEN),
        value=np.append(cells.value, 0.0), std=np.append(cells.std, 0.5),
        count=np.append(cells.count, 1),
    )  # fmt: skip
    wider = replace(given, cells=more)
    # the bench shows 1 and 2 at 1 and 2 m/s: what is left of the data is 4 and 5
    base = toy.fit_of([4.0, 5.0], J=[[1.0], [1.0]])
    seen = foreseen(Seen(given), wider, base, np.random.default_rng(0))
    assert seen.mean == pytest.approx([1.0 + (4.0 + 5.0) / 3.0])
    assert seen.covariance == pytest.approx(np.array([[1.0 / 3.0 + 0.25]]))
    assert seen.of(np.array([0])).mean == pytest.approx(seen.mean)


def test_half_the_noise_brings_what_the_curvature_says(toy) -> None:
    """Two observables of unit noise and slopes 30 and 10: their squares add, four times the one."""
    given = toy.problem([0.0, 0.0])
    names = ("rebound_speed_m_s", "tangential_rebound_m_s")
    given = replace(given, cells=replace(given.cells, observable=names))
    best = toy.fit_of([15.0, 5.0], toy.Effect("a", (30.0, 10.0)))
    first = proposing._sharper(given, best)[0]
    assert first.change.startswith("halve the noise of rebound speed")
    expected = math.sqrt((900.0 + 100.0 + 12.0) / (3600.0 + 100.0 + 12.0))
    assert first.interval == pytest.approx(expected, rel=1e-6)


def test_where_other_errors_rule_nothing_is_to_be_gained(toy) -> None:
    given = toy.problem([0.0, 0.0])
    J = [[30.0], [10.0]]
    best = toy.fit_of([15.0, 5.0], toy.Effect("a", (30.0, 10.0)), J=J)
    first = proposing._sharper(given, best)[0]
    assert first.kind == "none"
    assert first.change.startswith("nothing more to gain for size")


def test_half_the_noise_of_cells_that_share_a_reading_is_still_a_covariance() -> None:
    # three cells of one speed: all but a hundredth of their variance is common
    noise = np.full((3, 3), 4.0) + 0.04 * np.eye(3)
    total = noise + 0.01 * np.eye(3)
    every = np.ones(3, dtype=bool)
    assert proposing.with_half_the_noise(total, noise, every) == pytest.approx(
        0.25 * noise + 0.01 * np.eye(3)
    )
    one = proposing.with_half_the_noise(total, noise, np.array([True, False, False]))
    assert one[0] == pytest.approx([1.02, 2.0, 2.0])
    assert np.linalg.eigvalsh(one).min() > 0.0
    assert np.linalg.eigvalsh(total - np.diag(0.75 * np.diag(noise))).min() < 0.0
