"""The report draws what its legend says, and its sentences do not contradict each other."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from dentscope.discrepancy.choice.families import Family
from dentscope.discrepancy.experiments.session import Telling
from dentscope.discrepancy.findings import After, WrongInput
from dentscope.discrepancy.inference.linear import Linear
from dentscope.discrepancy.locate import Located, Miss
from dentscope.discrepancy.report import series
from dentscope.discrepancy.report.figures import comparison
from dentscope.discrepancy.report.next_session import _meaning, change_lines
from dentscope.discrepancy.report.sentences import headline, nowhere, own_parameters, why
from dentscope.discrepancy.report.story import FORM, _doubt, _took
from dentscope.discrepancy.report.wording import compared, miss_sentences
from dentscope.discrepancy.unknowns.nuisances import Nuisance
from dentscope.discrepancy.unknowns.wrong_number import WrongNumber, WrongReading
from dentscope.dynamics.mechanisms import MECHANISMS

OWN = {"sticky-tape": "a tape holds the tip back"}
SPEED = series.Against("speed_m_s", "approach speed [m/s]", None)  # type: ignore[arg-type]


def point(speed: float, *, with_verdict: float = math.nan) -> series.SeriesPoint:
    return series.SeriesPoint(
        "restitution", "-", "ball", 1, 3, {"speed_m_s": speed}, 0.50, 0.49, 0.51, 0.80, 0.60,
        with_verdict, weight=True,
    )  # fmt: skip


def miss(z: float) -> Miss:
    return Miss("restitution", "overall", "recordings lie above", z)


NOWHERE = Located((), (), 3.0)


def said(verdict: str, nothing: float, located: Located = NOWHERE, **more: Any) -> Any:
    usual = {
        "reasons": (), "inclusion": {}, "wrong_inputs": (), "audit": (),
        "probabilities": {"baseline": nothing, "work-hardening": 1.0 - nothing},
        "misfit": {"as_stated": 650.0, "numbers": 40.0, "rest": 0.0},
        "choice": SimpleNamespace(alike=(), family=None),
        "titles": {m.name: m.title for m in MECHANISMS} | OWN,
    }  # fmt: skip
    return SimpleNamespace(verdict=verdict, located=located, **usual | more)


def test_what_the_sheet_contradicts_itself_in_is_said_with_the_finding() -> None:
    rows = [
        {"check": "mass of rod", "message": "contradiction: mass of rod: 0.25 kg stated"},
        {"check": "force", "message": "caution: force: too large"},
    ]
    told = headline(said("adequate", 0.9, audit=rows))
    first = "The set's numbers contradict each other (mass of rod): settle that first. "
    assert told.startswith(first + "Nothing is missing")


def test_a_figure_draws_three_simulations_and_calls_each_by_what_it_is() -> None:
    svg = comparison([point(1.0, with_verdict=0.505), point(2.0, with_verdict=0.505)], SPEED,
                     ["ball"], key="f")  # fmt: skip
    for colour in ("--faint", "--without", "--verdict"):
        assert f"var({colour})" in svg
    assert f"{series.STATED} 0.8; {series.WITHOUT} 0.6; {series.WITH} 0.505" in svg
    alone = comparison([point(1.0), point(2.0)], SPEED, ["ball"], key="f")
    assert "var(--verdict)" not in alone
    assert series.WITH not in alone


@pytest.mark.parametrize(
    ("before", "after", "begins"),
    [
        (-2.9, -1.8, "1.10 nat a number more"),
        (-1.31, -1.306, "no more"),
        (-1.0, -1.31, "0.31 nat a number less"),
    ],
)
def test_what_left_out_trials_say_of_a_name(before, after, begins) -> None:
    found = {"log_density_baseline": before, "log_density_extended": after}
    assert compared(found).startswith(begins)


def test_a_place_below_chance_is_no_miss() -> None:
    located = Located((), (miss(1.8),), 3.0)
    assert located.misses == (miss(1.8),)
    assert miss_sentences(located, most=4) == ()
    (told,) = miss_sentences(Located((miss(6.0),), (), 3.0), most=4)
    assert "2.0 times the largest miss of chance alone" in told


def test_no_place_and_no_all_clear_says_why() -> None:
    nothing_seen = Located((), (miss(1.8),), 3.0)
    told = nowhere(said("missing-physics", 0.02, nothing_seen))
    assert "2 %" in told
    assert "moved they do" in told
    misfit = {"as_stated": 650.0, "numbers": 40.0, "rest": 0.8}
    told = nowhere(said("missing-physics", 0.02, nothing_seen, misfit=misfit))
    assert "each place by itself misses too little" in told
    assert nowhere(said("adequate", 0.9, nothing_seen)).startswith("Nowhere beyond")
    led = {"baseline": 0.4, "roughness": 0.3, "outside-library": 0.3}
    told = nowhere(said("undetermined", 0.4, nothing_seen, probabilities=led))
    assert "nothing is missing leads with a probability of 40 % only" in told
    assert "explanation that leads" not in told


def test_a_place_under_an_all_clear_says_why() -> None:
    seen = Located((miss(3.2),), (), 3.0)
    assert "one set of twenty" in nowhere(said("adequate", 0.9, seen))
    assert nowhere(said("missing-physics", 0.02, seen)) == ""


def test_undetermined_says_what_leads_or_that_the_data_are_too_few() -> None:
    few = ("too few: only 4 readings to compare, 6 are needed",)
    told = headline(said("undetermined", 0.001, reasons=few))
    assert told == "Something is missing (more than 99 %), but too few data to say what."
    assert headline(said("undetermined", 0.4, reasons=few)) == "Too few data to say."
    told = headline(said("undetermined", 0.32))
    assert "nothing is missing 32 %" in told
    assert "68 %" in told
    told = headline(said("undetermined", 0.001))
    assert told.startswith("Something is missing (more than 99 %), but these data do not say what.")
    assert "What leads, by probability: " in told


def test_a_mechanism_of_ones_own_is_told_in_its_own_words() -> None:
    v = said("missing-physics", 0.05, mechanisms=("sticky-tape",), inclusion={"sticky-tape": 0.9})
    assert headline(v).startswith("The simulation lacks this: a tape holds the tip back (sticky-")


def test_what_shares_the_probability_is_told_wrong_numbers_too() -> None:
    v = said("indistinguishable", 0.05)
    number = "wrong-input:target.Sy_Pa"
    v.probabilities = {number: 0.4, "sticky-tape": 0.3, "work-hardening": 0.1}
    v.titles[number] = "the stated strength of the flat is wrong"
    v.mechanisms, v.choice.members = (), tuple(SimpleNamespace(name=n) for n in v.probabilities)
    assert headline(v) == (
        "Something is missing, and these share the probability: the stated strength of the flat is "
        "wrong (40 %), a tape holds the tip back (30 %) or the metal hardens as it is deformed "
        "(10 %)."
    )


def hardens(probabilities: dict[str, float], takes_part: float) -> Any:
    name = "work-hardening"
    return said("missing-physics", 0.002, probabilities=probabilities, mechanisms=(name,),
                inclusion={name: takes_part})  # fmt: skip


def test_a_name_of_less_than_seven_tenths_is_the_most_likely() -> None:
    shares = {"work-hardening": 0.58, "outside-library": 0.418, "baseline": 0.002}
    assert headline(hardens(shares, 0.58)) == (
        "The simulation most likely lacks this: the metal hardens as it is deformed "
        "(work-hardening); probability that it takes part: 58 %."
    )


def test_what_may_act_beside_a_name_is_told() -> None:
    shares = {"work-hardening+sticky-tape": 0.45, "work-hardening": 0.39, "sticky-tape": 0.16}
    assert headline(hardens(shares, 0.84)).endswith(
        "it takes part: 84 %. Beside it perhaps: a tape holds the tip back (45 %)."
    )


def test_why_is_three_sentences_with_the_rivals_of_a_name() -> None:
    seen = Located((miss(6.0),), (), 3.0)
    v = said("missing-physics", 0.1, seen)
    v.probabilities = {"work-hardening": 0.84, "baseline": 0.1, "outside-library": 0.06}
    v.scores = {"work-hardening": {"evidence": math.log(40.0), "chi2": 12.6},
                "baseline": {"evidence": 0.0, "chi2": 178.0}}  # fmt: skip
    where, leads, beside = why(v).split(". ")
    assert where == "The simulation misses most in restitution: recordings lie above"
    assert "the metal hardens as it is deformed (84 %)" in leads
    assert "40 times as probable as with nothing missing (chi2 12.6 in place of 178, moved" in leads
    assert beside == (
        "Beside it: nothing is missing (10 %) and something that dentscope has no name for (6 %)."
    )
    v.scores["work-hardening"]["evidence"] = math.log(12_345.0)
    assert "are 12,000 times as probable" in why(v)
    v.scores["work-hardening"]["evidence"] = 50.0
    assert "more than a million times" in why(v)
    v.probabilities = {"baseline": 0.998, "work-hardening": 0.002}
    told = why(v)
    assert "Most probable: nothing is missing (more than 99 %). Nothing else has a share." in told


def test_a_strength_that_is_not_stated_is_told_as_assumed() -> None:
    """In the rig it is infinite: a test of it would have shown no number."""
    assumed = Nuisance("target.Sy_Pa", "Pa", 3.5e8, 0.7)
    rig = SimpleNamespace(of={"target.Sy_Pa": math.inf})
    v: Any = SimpleNamespace(problem=SimpleNamespace(rig=rig, nuisances=(assumed,)), titles={})
    told = _meaning(v, Telling(0, "target.Sy_Pa", {"baseline": (0.0, 0.1)}))
    assert "350 MPa ± 35 MPa if nothing is missing" in told


def test_a_session_changed_what_takes_part_as_the_finding_says_it() -> None:
    """Alone 60 and 70 %, in a pair 30 and 25 %."""
    history = [
        After(
            k, 20 * k, {"work-hardening": p, "roughness+work-hardening": q, "baseline": 1 - p - q}
        )
        for k, p, q in ((1, 0.6, 0.3), (2, 0.7, 0.25))
    ]
    v: Any = SimpleNamespace(history=history, titles={})
    [told] = change_lines(v)
    assert "(20 trials) changed in what takes part: work hardening 90 %, now 95 %," in told
    assert "roughness 30 %, now 25 %" in told
    assert "nothing is missing 10 %, now 5 %" in told


def test_a_wrong_number_without_one_value_has_the_interval_of_its_factor() -> None:
    number = WrongReading("restitution", "reading", "all readings are off")
    told = WrongInput(number, 0.9, None, 1.15, 1.12, 1.18).told
    assert (told["value"], told["low"], told["factor"], told["high"]) == (None, 1.12, 1.15, 1.18)
    told = WrongInput(WrongNumber("target.Sy_Pa", "strength", ""), 0.9, 2e8, 1.5, 1.4, 1.6).told
    assert (told["value"], told["low"], told["high"]) == (3e8, 2.8e8, 3.2e8)
    assert "press" not in told["settled_by"]  # of which the set may hold some
    tested = WrongInput(WrongNumber("target.Sy_Pa", "strength", ""), 0.9, 2e8, 1.5, 1.4, 1.6, 1.4e9)
    assert tested.told["settled_by"].endswith("a strength of 500 MPa")


def test_what_is_drawn_and_doubted_is_all_that_the_comparison_counts(toy: Any) -> None:
    """Of a variance of 1 + 3^2 + 5^2 + 1 the parts; of a residual of 36 the form takes 26."""
    strength = Nuisance("target.Sy_Pa", "Pa", 3e8, 0.1)
    given = toy.problem([36.0], derivative=[[1.0]], nuisances=(strength,))
    linear = Linear(np.eye(1), np.ones((1, 1)), np.array([[5.0, 1.0]]), np.array([3.0]))
    best = replace(toy.fit_of([36.0]), linear=linear, mechanisms=(toy.Effect("a", (0.0,)),),
                   prediction=np.zeros(1), z=np.zeros(1))  # fmt: skip
    v: Any = SimpleNamespace(problem=given, best=best, stated=np.zeros(1),
                             ranking=SimpleNamespace(base=best))  # fmt: skip
    shares = {bar.name: 36.0 * bar.share for bar in _doubt(v)}
    noise = {"scatter and noise of the readings": 1.0}
    assert shares == pytest.approx({FORM: 26.0, "yield strength of the flat": 9.0} | noise)
    (drawn,) = series.points_of(v)
    assert drawn.with_verdict == pytest.approx(26.0)
    assert f"{FORM} +5.0" in _took(v, best)


def test_a_dent_read_near_zero_is_drawn_with_its_error(toy: Any) -> None:
    """Noise of .5 um leaves 1 nm of a dent: a thousand times the reading, and no exponential."""
    problem = toy.problem([0.0])
    cells = replace(problem.cells, observable=("permanent_depth_m",),
                    value=np.log([1e-9]), std=np.array([500.0]))  # fmt: skip
    v: Any = SimpleNamespace(problem=replace(problem, cells=cells), best=toy.fit_of([0.0]),
                             stated=np.log([1e-6]), ranking=SimpleNamespace(base=toy.fit_of([0.0]))
                             )  # fmt: skip
    (drawn,) = series.points_of(v)
    assert (drawn.low, drawn.measured, drawn.high) == pytest.approx((0.0, 1e-3, 0.501))  # [um]


@pytest.mark.parametrize(("share", "told"), [(0.98, True), (0.87, False)])
def test_what_else_of_its_family_does_as_a_wrong_strength_is_told(share: float, told: bool) -> None:
    v = said("wrong-input", 0.01)
    number = WrongNumber("target.Sy_Pa", "strength", "the stated strength is wrong", "Pa")
    v.wrong_inputs, v.mechanisms = (WrongInput(number, 0.85, 2.5e8, 3.4, 3.0, 3.8),), ()
    v.titles[number.name], v.probabilities = number.title, {number.name: 0.85}
    each = {number.name: 0.85, "work-hardening": share - 0.85}
    v.choice.family = Family("strength", "the metal is stronger", share, each)
    assert ("What they agree on (98 %): the metal is stronger" in headline(v)) is told


@pytest.mark.parametrize(("most", "value"), [(0.5, "22 mm"), (0.7, "not told by these data")])
def test_an_interval_as_wide_as_the_range_gives_no_value(most: float, value: str) -> None:
    """Four fifths of 1 mm to 1 m, a logarithm, are 2 mm to 0.501 m."""
    [drag] = (m for m in MECHANISMS if m.name == "air-drag")
    grid = SimpleNamespace(labels=("s_m",), axes=(SimpleNamespace(parameter=drag.parameters[1]),))
    found = {"s_m": {"value": 0.022, "low": 1.9e-3, "high": most, "unit": "m"}}
    v: Any = SimpleNamespace(best=SimpleNamespace(grid=grid), parameters=found)
    assert own_parameters(v) == [("s", value, f"1.9 mm to {1e3 * most:g} mm")]
