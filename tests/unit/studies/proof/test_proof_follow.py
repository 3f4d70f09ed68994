"""What a proposed trial brings: entropy, trials of the same truth added to a set."""

import csv
import math

import numpy as np
import pytest
from dentscope.studies.proof.case import Case
from dentscope.studies.proof.follow import Trial, at_random, brought, entropy, with_trials
from dentscope.studies.proof.generators import truth as truths
from dentscope.studies.proof.generators.folder import write_set


def test_entropy_of_even_odds_is_the_logarithm_of_their_number():
    assert entropy({"probabilities": {"a": 0.25, "b": 0.25, "c": 0.25, "d": 0.25}}) == (
        pytest.approx(math.log(4.0))
    )
    assert entropy({"probabilities": {"a": 1.0, "b": 0.0}}) == 0.0


def test_what_is_brought_is_the_mean_fall_and_a_failure_counts_for_nothing():
    lines = [
        {"before": 1.0, "proposed": 0.2, "random": 0.6},
        {"before": 0.8, "proposed": 0.4, "random": 0.6},
        {"before": 0.8, "proposed": None, "random": 0.6},
    ]
    found = brought(lines)
    assert found["sets"] == 2
    assert found["proposed"] == pytest.approx(0.6)
    assert found["ratio"] == pytest.approx(2.0)
    assert brought([])["sets"] == 0


def test_added_trials_are_of_the_same_truth_and_the_old_ones_stay(tmp_path):
    case = truths.draw(np.random.default_rng(3), "null")
    write_set(case, tmp_path / "set", name="set")
    body = case.rig.strikers[-1].name
    angle = math.degrees(float(case.rig.angle[0]))
    speed = float(np.median(case.rig.speed))
    out = with_trials(case, tmp_path / "set", Trial(body, speed, angle), tmp_path / "more")
    before, after = (
        list(csv.DictReader((p / "trials.csv").read_text().splitlines()))
        for p in (tmp_path / "set", out)
    )
    assert after[: len(before)] == before
    added = after[len(before) :]
    assert [row["striker"] for row in added] == [body] * 3
    assert len({row["trial"] for row in after}) == len(after)
    near = [r for r in before if r["striker"] == body and r["restitution"]]
    seen = [float(r["restitution"]) for r in near]
    # the same contact between the tested speeds: no far from what was read there
    for row in added:
        if row["restitution"]:
            assert min(seen) - 0.2 < float(row["restitution"]) < max(seen) + 0.2


def test_a_random_trial_lies_within_the_rig_and_is_the_sets_own():
    told = {
        "strikers": ["a", "b"], "speeds": [0.5, 2.0], "angles": [math.radians(20.0), math.pi / 2],
    }  # fmt: skip
    case = Case("set-0012", told, {}, {})
    one = at_random(case)
    assert one == at_random(case)
    assert one.striker in told["strikers"]
    assert 0.5 <= one.speed <= 2.0
    assert 20.0 <= one.angle <= 90.0
