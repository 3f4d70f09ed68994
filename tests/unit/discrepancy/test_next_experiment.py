"""The next experiment: worth by hand, rivals, candidates."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.next_experiment import _worth, propose, rivals_of

SEEN = "rebound_speed_m_s"


def test_worth_is_the_gap_over_what_blurs_it(toy) -> None:
    given = toy.problem([0.0])
    one, two = {SEEN: np.array([1.0, 3.0])}, {SEEN: np.array([6.0, 8.0])}
    # means 2 and 7, variances 2 and 2, unit noise of each measurement: 25/(2 + 2 + 2)
    assert _worth([one, two], given) == pytest.approx(25.0 / 6.0)
    # over three rivals the mean of the pairs: 25/6, 25/6 and 0
    assert _worth([one, two, one], given) == pytest.approx(2.0 / 3.0 * 25.0 / 6.0)


def test_rivals_are_those_of_the_verdict_or_the_next_best(toy) -> None:
    a, b, c = (toy.fit_of([0.0], toy.Effect(n, (0.0,))) for n in "abc")
    base = toy.fit_of([0.0])
    ranking = toy.ranking_of(None, base, singles=[a, b])

    def names(members):
        return [f.name for f in rivals_of(members, ranking)]

    assert names([c, a]) == ["c", "a"]
    assert names([a]) == ["a", "b"]
    assert names([]) == ["baseline", "a"]
    alone = toy.ranking_of(None, base)
    assert [f.name for f in rivals_of([], alone)] == ["baseline"]


class Bench:
    """A simulator in which one mechanism doubles what is seen at high speeds only."""

    def __init__(self, problem):
        self.problem = problem

    def of(self, problem):
        return Bench(problem)

    def observe(self, mechanisms, points):
        speed = np.array([c.speed for c in self.problem.conditions])
        doubled = 2.0 if mechanisms else 1.0
        seen = np.where(speed > 3.0, doubled * speed, speed)
        return {name: np.tile(seen, (len(points), 1)) for name in [SEEN, *OTHERS]}


OTHERS = ("restitution", "permanent_depth_m", "contact_time_s", "peak_force_N",
          "friction_impulse_ratio", "rebound_spin_rad_s")  # fmt: skip


def test_the_trial_that_tells_rivals_apart_comes_first(toy) -> None:
    table = SimpleNamespace(
        length=0.0, tip_radius_m=SimpleNamespace(value=0.01),
        model_copy=lambda update: SimpleNamespace(**update),
    )  # fmt: skip
    rig = SimpleNamespace(
        strikers={"ball": table}, model_copy=lambda update: SimpleNamespace(**update)
    )
    given = toy.problem([0.0, 0.0], speeds=[0.5, 1.0], rig=rig)
    rivals = [toy.fit_of([0.0, 0.0]), toy.fit_of([0.0, 0.0], toy.Effect("a", (0.0, 0.0)))]
    found = propose(Bench(given), rivals, np.random.default_rng(0))
    assert found[0].change.startswith("ball at 4 m/s")
    worth = [p.expected_discrimination for p in found]
    assert worth == sorted(worth, reverse=True)
    plain = next(p for p in found if p.change == "ball at 4 m/s, measuring rebound speed")
    assert plain.expected_discrimination == pytest.approx(16.0 / 2.0)  # (8 - 4)^2 over 1 + 1
    assert propose(Bench(given), rivals[:1], np.random.default_rng(0)) == []
