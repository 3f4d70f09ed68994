"""Tuned numbers of fits and of their ranking where they act, worked out by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.discrepancy.choice.pairs import _candidates, pair_effect, with_pairs
from dentscope.discrepancy.inference.derivatives import _beside
from dentscope.discrepancy.inference.fit import (
    expand,
    fit,
    fit_anchored,
    moved_towards,
    sharpened,
    tried_steps,
)
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.discrepancy.inference.outliers import _neighbours, without_weight
from dentscope.discrepancy.inference.together import refined
from dentscope.discrepancy.rank import rank, sharpened_leading
from dentscope.dynamics import Press
from dentscope.dynamics.mechanisms.base import Parameter

NOWHERE = np.zeros(0)


@pytest.fixture
def shifted(toy):
    """A fit of one unknown that wants to be elsewhere, and where it stands."""
    found = toy.fit_of([0.0], J=[[1.0]])
    return lambda to: replace(found, z=np.array([to]), place=NOWHERE)


def test_no_unknown_moves_by_more_than_two_deviations_and_one_settles_at_a_seventh(shifted) -> None:
    z = np.zeros(1)
    assert moved_towards(shifted(1.9), z, NOWHERE)[0] == pytest.approx([1.9])
    assert moved_towards(shifted(5.0), z, NOWHERE)[0] == pytest.approx([2.0])
    assert [moved_towards(shifted(x), z, NOWHERE)[1] for x in (0.14, 0.16)] == [True, False]


def test_a_place_settles_at_a_twelfth_of_the_prior(shifted) -> None:
    def settled(by):
        found = replace(shifted(0.0), place=np.array([0.5 + by]))
        return moved_towards(found, np.zeros(1), np.array([0.5]))[1]

    assert [settled(x) for x in (0.07, 0.09)] == [True, False]


@pytest.mark.parametrize(("best", "gone"), [(0.1, 0.1), (0.3, 0.25), (0.6, 0.5), (0.9, 1.0)])
def test_of_a_step_the_best_of_a_tenth_a_quarter_a_half_and_all_is_gone(
    toy, shifted, best, gone
) -> None:
    """One cell that shows ten times how far the unknown is from where the data have it."""
    off = toy.Simulator(
        toy.problem([0.0], derivative=[[0.0]]),
        lambda _, points: np.array([10.0 * np.abs(p.z - best) for p in points]),
    )
    assert tried_steps(off, shifted(1.0), np.zeros(1), NOWHERE)[0] == pytest.approx([gone])


@pytest.mark.parametrize(("fall", "settled"), [(0.09, True), (0.11, False)])
def test_a_fall_of_chi2_by_a_tenth_is_none(toy, shifted, fall, settled) -> None:
    """Chi2 falls evenly with the step, but for the unknown's own square that is taken off."""
    falling = toy.Simulator(
        toy.problem([0.0], derivative=[[0.0]]),
        lambda _, points: np.array([np.sqrt(4.0 - fall * p.z - p.z**2) for p in points]),
    )
    assert tried_steps(falling, shifted(1.0), np.zeros(1), NOWHERE)[2] is settled


def test_a_fit_has_four_rounds(toy) -> None:
    """An unknown that never settles: each round asks for where it then stands."""
    asked = []

    def restless(_, points):
        asked.append(float(points[0].z[0]))
        # the data are always as far off in the other direction
        return np.array([[9.0 * (-1.0) ** len(asked) + p.z[0]] for p in points])

    fit(toy.Simulator(toy.problem([0.0], derivative=[[1.0]]), restless), ())
    assert len(asked) == 4


def test_of_the_two_rounds_of_a_pair_the_better_counts(toy, shifted, monkeypatch) -> None:
    rounds = [replace(shifted(1.0), log_evidence=x) for x in (5.0, 3.0)]
    monkeypatch.setattr("dentscope.discrepancy.inference.fit.expand", lambda *_: rounds.pop(0))
    simulator, half = toy.Simulator(toy.problem([0.0])), np.array([0.5])
    effect = toy.Effect("m", (1.0,))
    found = fit_anchored(simulator, (effect,), lambda *_: NOWHERE, z=np.zeros(1), place=half)
    assert (found.log_evidence, rounds) == (5.0, [])


def test_where_outcomes_jump_a_cell_is_looked_at_2_5_and_10_per_cent_aside(toy) -> None:
    jumping = toy.Effect("m", (1.0,), jumps=True)
    seen = [v["m"]["size"] for v in _beside((jumping,), {"m": {"size": 1.0}})]
    assert sorted(seen) == pytest.approx([0.9, 0.95, 0.98, 1.02, 1.05, 1.1])


def bumped(toy, spread, nodes=5):
    """A fit whose posterior has a deviation of a part of the prior, and how often it is made."""
    size = Parameter("size", "-", 0.0, 1.0, "linear", 0.0, "", nodes=nodes)
    effect = toy.Effect("m", (1.0 / spread,), parameters=(size,))
    made = []
    simulator = toy.Simulator(
        toy.problem([0.5 / spread]),
        seen=lambda _, points: made.extend(p for p in points if "m" in p.values),
    )
    found = expand(simulator, (effect,), Grid((Axis("m", size),)), NOWHERE, np.array([0.5]), None)
    made.clear()
    return sharpened(simulator, found), made


def test_a_fit_is_made_again_where_it_is_known_to_less_than_a_node_or_two_places(toy) -> None:
    """Nodes count as a quarter of the prior apart at the most, places of the grid 1/241 are."""
    # cut off at the ends of the prior these deviate by 0.27 and 0.24 of it
    assert [bool(bumped(toy, x, 3)[1]) for x in (0.6, 0.3)] == [False, True]
    # of 300 nodes two places, 0.0083, are more
    assert [bool(bumped(toy, x, 300)[1]) for x in (0.0075, 0.009)] == [True, False]


def test_a_window_is_four_deviations_wide_to_both_sides(toy) -> None:
    found, _ = bumped(toy, 0.05)
    [(low, high)] = found.grid.window
    assert (high - low) == pytest.approx(0.4, rel=0.05)


def test_a_window_has_five_nodes_of_one_parameter_and_three_of_each_of_three(toy) -> None:
    axis = Axis("m", Parameter("size", "-", 0.0, 1.0, "linear", 0.0, "", nodes=3))

    def nodes(n):
        return len(Grid((axis,) * n, ((0.4, 0.6),) * n).coarse[0])

    assert [nodes(n) for n in (1, 2, 3, 4, 5)] == [5, 5, 3, 3, 2]


def test_two_mechanisms_of_four_parameters_are_simulated_at_all_nodes_of_both(toy) -> None:
    def together(n):
        sizes = tuple(
            Parameter(f"size{k}" if k else "size", "-", 0.0, 1.0, "linear", 0.0, "", nodes=2)
            for k in range(n)
        )
        effects = toy.Effect("a", (1.0,), parameters=sizes), toy.Effect("b", (1.0,))
        axes = (*(Axis("a", p) for p in sizes), Axis("b", effects[1].parameters[0]))
        grid = Grid(axes, ((0.4, 0.6),) * (n + 1))
        asked = []
        counting = toy.Simulator(
            toy.problem([1.0]), seen=lambda mechanisms, _: asked.append(len(mechanisms))
        )
        refined(counting, effects, grid, NOWHERE, np.full(n + 1, 0.5), np.array([1.0]))
        return asked[0]

    assert [together(3), together(4)] == [2, 1]


def test_neighbours_of_an_impact_are_impacts_even_where_presses_lie_nearer(toy) -> None:
    """Ten deviations aside: an impact e^9 times as fast is still nearer than any press."""
    given = toy.problem([0.0] * 4, speeds=[1.0, math.exp(4.0), math.exp(9.0), 1.01])
    conditions = (*given.conditions[:3], replace(given.conditions[3], press=Press(100.0)))
    near = _neighbours(replace(given, conditions=conditions))
    assert sorted(near[0].tolist()) == [1, 2]


def test_a_slip_counts_as_thirty_times_as_unsure(toy) -> None:
    given = without_weight(toy.problem([0.0, 40.0]), np.array([False, True]))
    assert given.cells.std.tolist() == [1.0, 30.0]


def library_of(toy, *sizes, length=8):
    """Effects on cells of their own, and data that half of each explains."""
    shapes = [tuple(x * (k == j) for k in range(length)) for j, x in enumerate(sizes)]
    return tuple(toy.Effect(f"m{j}", s) for j, s in enumerate(shapes)), shapes


def test_what_moves_no_number_by_a_deviation_cannot_be_seen(toy) -> None:
    library, _ = library_of(toy, 0.99, 1.01)
    found = rank(toy.Simulator(toy.problem([0.0] * 8)), mechanisms=library)
    assert list(found.excluded) == ["m0"]


def test_fits_that_gain_ten_nats_and_six_tenths_of_the_best_are_sharpened(toy) -> None:
    def again(*gains):
        """Places of fits, by their gain, that were made again."""
        asked = set()
        counting = toy.Simulator(
            toy.problem([0.0] * 8), seen=lambda some, _: asked.update(m.name for m in some)
        )
        base = toy.fit_of([0.0] * 8)
        effects, shapes = library_of(toy, *[2000.0] * len(gains))
        fits = [
            replace(
                toy.fit_of(0.5 * np.array(s), e), log_evidence=base.log_evidence + gain
            )
            for e, s, gain in zip(effects, shapes, gains, strict=True)
        ]  # fmt: skip
        sharpened_leading(counting, fits, base)
        return sorted(asked)

    assert again(9.9) == []
    assert again(10.1) == ["m0"]
    assert again(100.0, 61.0) == ["m0", "m1"]
    assert again(100.0, 59.0) == ["m0"]
    # two at the most
    assert again(100.0, 99.0, 98.0) == ["m0", "m1"]


def test_slips_are_judged_under_what_leads_by_three_nats(toy) -> None:
    """A value 4.2 deviations off is no slip under what explains it and gains 8.8 - 1.2 nats."""

    def slips(size):
        effect = toy.Effect("m", (*(0.0,) * 15, size))
        found = rank(toy.Simulator(toy.problem([0.0] * 15 + [4.2])), mechanisms=(effect,))
        return len(found.problem.weightless)

    assert slips(8.4) == 0
    # what explains a seventh of it gains too little
    assert slips(0.6) == 1


def screened_fully(toy, effect):
    """A screening of an effect that grows with its size, over nodes and refined grid."""
    shape = np.array(effect.shape)
    grid = Grid((Axis(effect.name, effect.parameters[0]),))
    return replace(
        toy.screened_of(effect, grid.fine[0][:, None] * shape),
        change=grid.coarse[0][:, None] * shape,
    )


def paired(toy, data, effects):
    """Names of the pairs that are fitted to data, and what the others gain by screening."""
    simulator, asked = toy.Simulator(toy.problem(data)), []
    screened = [screened_fully(toy, e) for e in effects]
    singles = [toy.fit_of(data, e) for e in effects]
    ranking = toy.ranking_of(
        simulator.problem, toy.fit_of(data), singles=singles, screened=screened
    )
    found = with_pairs(simulator, ranking, progress=asked.append)
    return [a.removeprefix("fitting ") for a in asked], found.unfitted


@pytest.mark.parametrize(("sizes", "count"), [((40.0,) * 5, 7), ((40.0, *(30.0,) * 4), 6)])
def test_the_six_best_pairs_and_those_of_four_alike_are_fitted(toy, sizes, count) -> None:
    """Of five alike the first four are in six pairs, of which one is not among the six best."""
    effects, shapes = library_of(toy, *sizes)
    fitted, screened = paired(toy, 0.5 * np.sum(shapes, axis=0), effects)
    assert (len(fitted), len(screened)) == (count, 10 - count)


def screened_pairs(toy, data, effects, singles):
    """What each pair gains by screening beside fits of one of it."""
    given = toy.ranking_of(
        toy.problem(data), toy.fit_of(data), singles=singles,
        screened=[screened_fully(toy, e) for e in effects],
    )  # fmt: skip
    return {c.names: c.gain for c in _candidates(given)}


def test_pairs_are_screened_beside_every_fit(toy) -> None:
    effects, _ = library_of(toy, *[40.0] * 4)
    singles = [toy.fit_of([0.0] * 8, e) for e in effects[:2]]
    seen = screened_pairs(toy, [0.0] * 8, effects, singles)
    assert set(seen) == {("m0", "m1"), ("m0", "m2"), ("m0", "m3"), ("m1", "m2"), ("m1", "m3")}


def test_a_pair_is_screened_with_the_numbers_of_its_fit_free(toy) -> None:
    """The first alone takes half of what the second does: at that place hardly any is left."""
    one, two = toy.Effect("one", (8.0, 8.0)), toy.Effect("two", (0.0, 6.0))
    data = [3.0, 7.5]
    both = toy.fit_of(data, one, two)
    gained = screened_pairs(toy, data, (one, two), [toy.fit_of(data, one)])["one", "two"]
    assert gained == pytest.approx(both.log_evidence - toy.fit_of(data).log_evidence, abs=0.02)


def test_what_two_do_to_each_other_is_simulated_an_eighth_of_the_prior_aside(toy) -> None:
    seen = set()

    def look(some, points):
        seen.update(p.values["a"]["size"] for p in points if len(some) == 2)

    a, b = (screened_fully(toy, toy.Effect(n, (x,))) for n, x in (("a", 1.0), ("b", 2.0)))
    both = pair_effect(toy.Simulator(toy.problem([0.0]), seen=look), a, b)
    both(NOWHERE, np.array([0.5, 0.5]))
    assert sorted(seen) == pytest.approx([0.38, 0.5, 0.62])
