"""What is said, on probabilities that are put in by hand; something outside as an explanation."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.decide import decide
from dentscope.discrepancy.choice.families import family_of
from dentscope.discrepancy.choice.odds import OUTSIDE, PRIORS, Odds, odds_of, prior_shares, tempered
from dentscope.discrepancy.choice.outside import odd_repeats, outside_of
from dentscope.discrepancy.comparison.cells import Scatter
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.repeats import Drift, Followed
from dentscope.discrepancy.unknowns.wrong_number import WrongNumber

CELLS = 8
ZERO = (0.0,) * CELLS


def odds(**p: float) -> Odds:
    """Return odds of names joined by `_` for a pair; the rest is the baseline's."""
    found = {k.replace("_", "+"): x for k, x in p.items()}
    found = {OUTSIDE: found.pop("outside", 0.0), **found}
    found["baseline"] = 1.0 - math.fsum(found.values())
    names = {k: () if k in ("baseline", OUTSIDE) else tuple(k.split("+")) for k in found}
    return Odds(names, dict(sorted(found.items(), key=lambda item: -item[1])), {})


@pytest.fixture
def case(toy):
    """Return a function that decides by odds."""

    def decided(given: Odds, *, cells=CELLS, speeds=(), drifts=(), scatters=(), cautious=False):
        labels = [k for k in given.probability if given.names[k]]
        fits = [toy.fit_of(ZERO, *(toy.Effect(n, ZERO) for n in given.names[k])) for k in labels]
        known = toy.problem([0.0] * cells, speeds=speeds, scatters=scatters, drifts=drifts)
        one = [f for f in fits if len(f.mechanisms) == 1]
        two = [f for f in fits if len(f.mechanisms) == 2]
        ranking = toy.ranking_of(known, toy.fit_of(ZERO), singles=one, pairs=two)
        return decide(ranking, given, cautious=cautious)

    return decided


def named(choice):
    return [f.name for f in choice.members]


def test_too_few_numbers_or_conditions_say_nothing(case) -> None:
    found = case(odds(a=1.0), cells=5)
    assert (found.verdict, named(found)) == ("undetermined", [])
    assert "only 5 readings" in found.reasons[0]
    assert case(odds(a=1.0), cells=6).verdict == "missing-physics"


def test_few_numbers_may_say_that_something_is_missing_but_not_what(case) -> None:
    told = case(odds(a=0.9, outside=0.0995), cells=4).reasons
    assert told[1] == (
        "something is missing with a probability of more than 99.8 %; the numbers are too few to "
        "say what"
    )
    assert len(case(odds(a=0.9), cells=4).reasons) == 1


def test_no_probability_is_told_beyond_what_the_nulls_support(case) -> None:
    told = case(odds(a=0.9999999)).reasons[0]
    assert "missing with a probability of more than 99.8 %" in told
    assert "not in the library with less than 0.2 %" in told


def test_numbers_of_one_condition_say_nothing(toy) -> None:
    given = toy.problem([0.0] * CELLS)
    given.cells.condition[:] = 0
    found = decide(toy.ranking_of(given, toy.fit_of(ZERO)), odds(a=1.0))
    assert found.verdict == "undetermined"
    assert "of one condition" in found.reasons[0]


@pytest.mark.parametrize(
    ("given", "verdict", "names"),
    [
        # what leads is said from one half on
        (odds(a=0.49), "adequate", []),
        (odds(a=0.51), "missing-physics", ["a"]),
        (odds(a=0.58, outside=0.42), "missing-physics", ["a"]),
        (odds(a=0.43, outside=0.57), OUTSIDE, []),
        (odds(a_b=0.6, a=0.4), "missing-physics", ["a+b"]),
        # below it what takes part with four fifths, whatever else does
        (odds(a_b=0.4, a_c=0.3, a=0.2), "missing-physics", ["a"]),
        (odds(a_b=0.45, a=0.4, c=0.1), "missing-physics", ["a"]),
        (odds(a_b=0.4, a=0.38, b=0.15), "indistinguishable", ["a+b", "a", "b"]),
        # or what together has as much
        (odds(a=0.49, b=0.48), "indistinguishable", ["a", "b"]),
        (odds(a=0.45, a_b=0.3, b=0.2), "indistinguishable", ["a", "a+b", "b"]),
        (odds(a=0.3, b=0.3, c=0.25), "indistinguishable", ["a", "b", "c"]),
        # more than three that differ are no finding, nor is what nothing or outside is among
        (odds(a=0.25, b=0.25, c=0.25, d=0.25), "undetermined", []),
        (odds(a=0.45, b=0.1), "undetermined", []),
        (odds(a=0.45, outside=0.42), "undetermined", []),
    ],
)
def test_what_leads_is_said_from_one_half_on(case, given, verdict, names) -> None:
    found = case(given)
    assert found.verdict == verdict
    assert named(found) == names


def test_a_cautious_reader_asks_for_four_fifths(case) -> None:
    assert case(odds(a=0.79), cautious=True).verdict == "undetermined"
    assert case(odds(a=0.81), cautious=True).verdict == "missing-physics"
    assert case(odds(a=0.3), cautious=True).verdict == "undetermined"


def test_a_number_that_leads_is_a_verdict_of_its_own(toy) -> None:
    number = WrongNumber("target.Sy_Pa", "strength", "the stated strength is wrong")
    number.shape = ZERO
    given = Odds(
        {"baseline": (), OUTSIDE: (), number.name: (number.name,)},
        {number.name: 0.9, "baseline": 0.09, OUTSIDE: 0.01}, {},
    )  # fmt: skip
    fits = [toy.fit_of(ZERO, number)]
    ranking = toy.ranking_of(toy.problem([0.0] * CELLS), toy.fit_of(ZERO), singles=fits)
    assert decide(ranking, given).verdict == "wrong-input"


def test_a_family_leads_where_its_members_share() -> None:
    p = {"strain-rate-hardening": 0.45, "work-hardening": 0.4, "tilt": 0.1, "baseline": 0.05,
         OUTSIDE: 0.0}  # fmt: skip
    names = {k: () if k in ("baseline", OUTSIDE) else (k,) for k in p}
    found = family_of(Odds(names, p, {}))
    assert found.name == "strength"
    assert found.probability == pytest.approx(0.85)
    assert found.members == {"strain-rate-hardening": 0.45, "work-hardening": 0.4}
    assert family_of(Odds(names, {**p, "tilt": 0.2, "work-hardening": 0.3}, {})) is None


def test_scatter_beyond_the_noise_is_said_first(case) -> None:
    found = case(odds(), scatters=(Scatter("restitution", 78.0, 40),))
    assert found.reasons[0].startswith("repeats of restitution differ 78 times more than")
    assert case(odds()).reasons[0].startswith("something is missing with a probability")


def test_a_drift_is_said_beside_any_verdict(case) -> None:
    drift = Drift("peak_force_N", math.log(1.1), 5.0, -14.0)
    found = case(odds(a=0.99), drifts=(drift,))
    assert found.verdict == "missing-physics"
    assert "peak_force_N: repeats of one condition change by +10.0 %" in found.reasons[-1]


def singles_of(toy, *lifts: float):
    """A ranking of mechanisms a, b, ... whose ln evidence lies so far above the baseline's."""
    effects = [toy.Effect(name, ZERO) for name, _ in zip("abc", lifts, strict=False)]
    fits = [toy.fit_of(ZERO, e, lift=x) for e, x in zip(effects, lifts, strict=True)]
    return toy.ranking_of(
        toy.problem([0.0] * CELLS), toy.fit_of(ZERO), singles=fits,
        screened=[toy.screened_of(e, [ZERO]) for e in effects],
    )  # fmt: skip


def test_a_gain_is_tempered_and_of_thousands_counts_by_its_share() -> None:
    assert tempered(-3.0) == pytest.approx(-3.0 * RULES.temper)
    assert tempered(10.0) == pytest.approx(10.0 * RULES.temper, rel=0.01)
    more = RULES.temper * RULES.by_ratio * math.log(1_000_100 / 1_000_000)
    assert tempered(1e6 + 100.0) - tempered(1e6) == pytest.approx(more, rel=0.02)


def test_probabilities_are_prior_times_tempered_evidence(toy) -> None:
    ranking = singles_of(toy, 4.0, 0.0)
    found = odds_of(ranking).probability
    ratio = math.log(found["a"] / found["baseline"])
    prior = math.log(PRIORS["mechanisms"] / 2 / PRIORS["baseline"])
    assert ratio == pytest.approx(prior + tempered(4.0))
    assert math.log(found["a"] / found["b"]) == pytest.approx(tempered(4.0))
    assert sum(found.values()) == pytest.approx(1.0)


def test_a_pair_has_the_firsts_prior_and_a_seconds(toy) -> None:
    one, two = toy.Effect("a", ZERO), toy.Effect("b", ZERO)
    ranking = toy.ranking_of(
        toy.problem([0.0] * CELLS), toy.fit_of(ZERO), singles=[toy.fit_of(ZERO, one, lift=3.0)],
        pairs=[toy.fit_of(ZERO, one, two, lift=3.0)],
        screened=[toy.screened_of(e, [ZERO]) for e in (one, two)],
    )  # fmt: skip
    found = odds_of(ranking)
    assert found.probability["a+b"] / found.probability["a"] == pytest.approx(PRIORS["second"] / 2)
    assert found.inclusion["a"] == pytest.approx(found.probability["a"] + found.probability["a+b"])


def test_a_mechanism_without_a_fit_counts_by_its_screening(toy) -> None:
    one = toy.Effect("a", ZERO)
    screened = SimpleNamespace(mechanism=one, log_bayes=math.log(6.0))
    ranking = toy.ranking_of(toy.problem([0.0] * CELLS), toy.fit_of(ZERO), screened=[screened])
    found = odds_of(ranking)
    prior = PRIORS["mechanisms"] / PRIORS["baseline"]
    assert found.probability["a"] / found.probability["baseline"] == pytest.approx(
        prior * math.exp(tempered(math.log(6.0)))
    )


@pytest.mark.parametrize(("size", "acts"), [(0.5, False), (2.0, True)])
def test_what_surely_acts_is_beside_everything_once_a_set_would_show_it(toy, size, acts) -> None:
    drag, other = toy.Effect("drag", ZERO, acts=True), toy.Effect("b", ZERO)
    shape = (size,) * CELLS
    ranking = toy.ranking_of(
        toy.problem([0.0] * CELLS), toy.fit_of(ZERO), pairs=[toy.fit_of(ZERO, drag, other)],
        singles=[toy.fit_of(ZERO, e) for e in (drag, other)],
        screened=[toy.screened_of(drag, [shape, (9.0,) * CELLS]), toy.screened_of(other, [ZERO])],
    )  # fmt: skip
    assert (RULES.shows < size * math.sqrt(CELLS)) == acts
    found = odds_of(ranking).probability
    odds = RULES.acts / (1.0 - RULES.acts)
    if acts:
        assert found["drag"] / found["baseline"] == pytest.approx(odds)
        assert found["drag+b"] / found["b"] == pytest.approx(odds)
    else:
        assert found["drag"] / found["b"] == pytest.approx(1.0)
        assert found["drag+b"] / found["b"] == pytest.approx(PRIORS["second"] / 2)


def test_wrong_numbers_share_by_kind_and_the_struck_strength_has_most() -> None:
    numbers = [
        WrongNumber("target.Sy_Pa", "strength", ""), WrongNumber("strikers.a.mass_kg", "mass", ""),
        WrongNumber("strikers.b.mass_kg", "mass", ""),
    ]  # fmt: skip
    share = {k: math.exp(x) for k, x in prior_shares(numbers).items()}
    assert sum(share.values()) == pytest.approx(PRIORS["inputs"])
    strength, one, two = (share[n.name] for n in numbers)
    assert one == two
    assert strength / (one + two) == pytest.approx(RULES.strength_wrong)


def test_a_pair_without_a_fit_counts_by_its_screening(toy) -> None:
    found = odds_of(replace(singles_of(toy, 30.0, 29.0), unfitted={"a+b": 40.0})).probability
    ratio = PRIORS["second"] / 2.0 * math.exp(tempered(40.0) - tempered(29.0))
    assert found["a+b"] / found["b"] == pytest.approx(ratio)


def test_a_drift_that_is_sure_leaves_the_rest_to_something_outside(toy) -> None:
    ranking = toy.ranking_of(
        toy.problem([0.0] * CELLS, drifts=(Drift("restitution", 0.1, 20.0, -200.0),)),
        toy.fit_of(ZERO),
    )
    assert odds_of(ranking).probability[OUTSIDE] > 0.99


def test_the_baseline_is_no_surer_than_sets_drawn_can_support(toy) -> None:
    ranking = toy.ranking_of(toy.problem([0.0] * CELLS), toy.fit_of(ZERO))
    assert odds_of(ranking).probability["baseline"] <= 1.0 - RULES.supported


def gained(toy, departure) -> float:
    """Ln odds of something outside for numbers of about 200 that are known to 1."""
    base = toy.fit_of(departure)
    found = outside_of(toy.problem([200.0 + x for x in departure]), base)
    return float(found.log_likelihood(base.residual)) - base.log_evidence


def test_its_weights_are_a_prior_and_its_departures_are_parts_of_the_value(toy) -> None:
    given = toy.problem([200.0] * CELLS)
    found = outside_of(given, toy.fit_of([0.0] * CELLS))
    assert np.exp(found.log_weight).sum() == pytest.approx(1.0)
    assert np.sqrt(found.parts[-1].noise[0, 0] - 1.0) == pytest.approx(RULES.amplitudes[-1] * 200.0)
    # of a logarithm the departure is the part itself
    force = toy.problem([5.0] * CELLS, observable="peak_force_N")
    parts = outside_of(force, toy.fit_of([0.0] * CELLS)).parts
    assert np.sqrt(parts[-1].noise[0, 0] - 1.0) == pytest.approx(RULES.amplitudes[-1])


def test_noise_alone_speaks_against_it_and_what_no_law_explains_for_it(toy) -> None:
    assert gained(toy, np.random.default_rng(1).standard_normal(CELLS).tolist()) < 0.0
    assert gained(toy, [40.0 * (-1) ** k for k in range(CELLS)]) > 100.0


@pytest.mark.parametrize("p", [1e-4, 1e-8])
def test_a_drift_or_a_column_is_worth_what_its_p_value_can_be(toy, p) -> None:
    """At most 1/(-e p ln p) (Sellke, Bayarri and Berger 2001)."""
    drifts = (Drift("restitution", 0.1, 3.9, math.log(p)),)
    followed = (Followed("x_oil", "restitution", 0.1, math.log(p)),)
    for given in ({"drifts": drifts}, {"followed": followed}):
        found = odd_repeats(toy.problem([0.0], **given))
        assert found == pytest.approx(-math.log(-math.e * p * math.log(p)))
    # what is not seen may act all the same, with its prior
    assert odd_repeats(SimpleNamespace(drifts=(), scatters=(), followed=())) == 0.0
