"""What is halved, doubled and taken away from a verdict, and how changes are counted."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from dentscope.discrepancy import diagnose
from dentscope.discrepancy.choice import odds
from dentscope.discrepancy.choice.odds import OUTSIDE
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.recordings import read
from dentscope.recordings.shipped import FOLDER
from dentscope.studies import sensitivity
from dentscope.studies.proof import altered

SET = "kharaz-2001-oblique"


@pytest.fixture(scope="module")
def problem():
    return problem_of(read(FOLDER / SET))


@pytest.fixture(scope="module")
def found(problem):
    return sensitivity.explained(problem)


def test_as_it_is_is_what_a_diagnosis_says(found) -> None:
    verdict = diagnose(read(FOLDER / SET)).to_dict()
    told = sensitivity.said(found)
    assert told["verdict"] == verdict["verdict"]
    assert told["names"] == [verdict["mechanisms"]]
    for name, p in told["odds"].items():
        assert p == pytest.approx(verdict["probabilities"][name], abs=1e-4)


def test_prior_odds_count_in_full(found) -> None:
    """What leads and nothing at all."""
    told = sensitivity.altered(found)
    before = told[altered.AS_IT_IS]["odds"]
    lead = next(iter(before))
    assert lead == "tangential-compliance"
    for times in (0.5, 2.0):
        after = told[altered.label("prior odds of a second one", times)]["odds"]
        pair = next(k for k in before if "+" in k)
        more = (after[pair] / after[lead]) / (before[pair] / before[lead])
        assert more == pytest.approx(times, rel=0.15)
    assert sensitivity.said(found) == told[altered.AS_IT_IS]
    short = sensitivity.brief(told)
    line = {"set": "a", "truth": None, "said": short}
    assert altered.by_set([line])["a"].said == told


def test_without_second_explanations_no_pair_has_a_probability(found) -> None:
    told = sensitivity.taken_away(found)
    assert OUTSIDE in told["all outside the library"]["odds"]  # beside what leads
    assert not [k for k in told["second explanations"]["odds"] if "+" in k]


def _spoilt() -> None:
    with sensitivity.ruled("temper", 2.0), sensitivity.priors(second=2.0):
        raise KeyError((odds.RULES.temper, odds.PRIORS["second"]))


def test_values_stand_again_after_an_error() -> None:
    rules, priors = odds.RULES, odds.PRIORS
    with pytest.raises(KeyError) as caught:
        _spoilt()
    assert caught.value.args[0] == pytest.approx((2.0 * rules.temper, 2.0 * priors["second"]))
    assert (odds.RULES, odds.PRIORS) == (rules, priors)


def test_a_prior_half_as_wide_gains_what_it_keeps() -> None:
    """Ln 2 for each parameter that the data pin down; nothing where they say nothing."""
    m = next(x for x in MECHANISMS if len(x.parameters) == 2)
    grid = Grid(tuple(Axis(m.name, p) for p in m.parameters))
    places = grid.places()
    sharp = -0.5 * np.sum(((places - 0.1) / 0.02) ** 2, axis=1)
    assert sensitivity.narrowed(sharp, grid) == pytest.approx(2.0 * math.log(2.0), abs=1e-6)
    assert sensitivity.narrowed(np.zeros(len(places)), grid) == pytest.approx(0.0, abs=1e-9)
    one = -0.5 * ((places[:, 0] - 0.9) / 0.02) ** 2
    assert sensitivity.narrowed(one, grid) == pytest.approx(math.log(2.0), abs=1e-6)


def test_errors_of_law_and_metal_are_both_multiplied(problem) -> None:
    twice = sensitivity.with_error(problem, 2.0).error.parts
    for kind, (law, metal) in problem.error.parts.items():
        assert twice[kind] == pytest.approx((2.0 * law, 2.0 * metal))


def test_lines_go_on_where_they_stopped(tmp_path, monkeypatch) -> None:
    names = [f"open-00{k}" for k in range(4)]
    monkeypatch.setattr(sensitivity, "sets_of", lambda folder: names)
    monkeypatch.setattr(sensitivity, "truths_of", lambda folder, sets: {"open-001": ("tilt",)})
    monkeypatch.setattr(sensitivity, "_asked", lambda place, ask: {place.name: {}})
    out = tmp_path / "altered.jsonl"
    whole = list(sensitivity.lines(tmp_path, out))
    assert [x["fit"] for x in whole if x["set"] == "open-003"] == list(sensitivity.FITS)
    assert [x["fit"] for x in whole if x["set"] == "open-001"] == [altered.AS_IT_IS]
    assert [x["truth"] for x in whole if x["set"] == "open-001"] == [("tilt",)]
    assert sum(x["set"] == SET for x in whole) == 3
    out.write_text("".join(json.dumps(x) + "\n" for x in whole[:4]))
    assert list(sensitivity.lines(tmp_path, out)) == whole[4:]


def told(verdict: str, *names: str, lead: str = "") -> dict:
    return {"verdict": verdict, "names": [[n] for n in names], "odds": {lead or names[0]: 0.6}}


SILENT = told("undetermined", lead="tilt")
LINES = [
    {"set": "a", "truth": ["tilt"], "said": {
        altered.AS_IT_IS: told("missing-physics", "tilt"), "priors, x 0.5": SILENT,
        "priors, x 2": told("missing-physics", "adhesion"),
        "without pairs": told("missing-physics", "tilt"),
    }},
    {"set": "b", "truth": [], "said": {
        altered.AS_IT_IS: SILENT, "priors, x 0.5": told("adequate", lead="baseline"),
        "priors, x 2": told("indistinguishable", "adhesion", "tilt"),
        "without pairs": SILENT,
    }},
    {"set": "a", "truth": ["tilt"], "said": {"without fits": SILENT}},
    {"set": "real", "truth": None, "said": {
        altered.AS_IT_IS: SILENT, "priors, x 0.5": SILENT,
        "priors, x 2": told("missing-physics", "tilt"),
    }},
]  # fmt: skip


def test_changes_are_counted() -> None:
    drawn = [s for s in altered.by_set(LINES).values() if s.truth is not None]
    assert altered.change(drawn, "priors, x 0.5") == (2, 1, 2, 1, 1, 0, 0)
    assert altered.change(drawn, "priors, x 2") == (2, 2, 2, 1, 0, 1, 0)
    assert altered.outcome(drawn[1], "priors, x 0.5") == altered.RIGHT
    assert altered.outcome(drawn[1], "priors, x 2") == altered.WRONG
    assert altered.outcome(drawn[0], "without fits") == altered.SILENT
    text = altered.altered_lines(LINES)
    assert "| priors | 2 | 1, 2 | 2, 2 | 1, 1 | 1, 0 | 0, 1 |" in text
    assert text[-4].startswith("At most 1 a row turn from right to wrong or back.")
    assert "Of the shipped real changes" in text[-4]


def test_a_stage_on_fewer_sets_stands_beside_those_as_they_are(tmp_path) -> None:
    path = altered.stages_picture(LINES, tmp_path / altered.STAGES)
    assert path.stat().st_size > 10_000
