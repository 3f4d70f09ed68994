"""Tuned numbers of the diagnosis and its proposals where they act, worked out by hand."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.core.observables import OBSERVABLES
from dentscope.discrepancy.baseline.solve import solved_table
from dentscope.discrepancy.choice.odds import PRIORS, Odds
from dentscope.discrepancy.choice.outside import odd_repeats, outside_of
from dentscope.discrepancy.comparison.cells import Scatter, cells_of
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.curves.readings import Readings, _corrected
from dentscope.discrepancy.estimates import law_notes
from dentscope.discrepancy.experiments import feasible, next_experiment
from dentscope.discrepancy.experiments.feasible import candidates_of, presses_of
from dentscope.discrepancy.experiments.foreseen import _samples, _spread_out
from dentscope.discrepancy.experiments.session import Proposal, Session
from dentscope.discrepancy.inference.derivatives import FORMS, derivatives, form_error
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.discrepancy.inference.outliers import outlying
from dentscope.discrepancy.metal import next_mark as marks
from dentscope.discrepancy.metal.estimate import rate_prior
from dentscope.discrepancy.rank import rank
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.lawerror import FREE, SIZES, components
from dentscope.discrepancy.unknowns.repeats import Entries, drift_of, followed_of
from dentscope.dynamics import Press
from dentscope.dynamics.force import LOG_DEPTH_FIRST, LOG_DEPTH_LAST
from dentscope.dynamics.mechanisms.base import Parameter
from dentscope.dynamics.strength import NODES
from dentscope.recordings import read
from dentscope.recordings.bench import Bench
from dentscope.recordings.shipped import set_folder


def test_priors_add_to_one_and_a_wrong_number_is_as_probable_as_physics() -> None:
    assert sum(p for k, p in PRIORS.items() if k != "second") == pytest.approx(1.0)
    assert PRIORS["inputs"] >= PRIORS["mechanisms"]


@pytest.mark.parametrize("times", [0.4, 1.0, 4.0])
def test_a_scatter_was_varied_or_its_noise_misjudged(times) -> None:
    """Even up to e^5 in ln: 1/5; a noise misjudged by 0.5 in ln is twice `times` deviations off."""
    scatter = Scatter("restitution", math.exp(times), 9)
    given = SimpleNamespace(drifts=(), followed=(), scatters=(scatter,), misread={})
    misjudged = math.exp(-2.0 * times**2) / (0.5 * math.sqrt(2.0 * math.pi))
    # what no repeat speaks for may act unseen: no less than 0
    assert odd_repeats(given) == pytest.approx(max(math.log(0.2 / misjudged), 0.0))


def test_departures_from_a_law_are_3_10_and_30_per_cent_a_deviation_of_the_covariates_long(toy):
    found = outside_of(toy.problem([200.0, 200.0]), toy.fit_of([0.0, 0.0]))
    sizes = {round(math.sqrt(p.noise[0, 0] - 1.0) / 200.0, 6) for p in found.parts[1:]}
    assert sizes == {0.03, 0.1, 0.3}
    # speeds of 1 and 2 m/s lie a deviation to either side of their mean: exp(-2^2/2)
    smooth = [p.noise[0, 1] / (p.noise[0, 0] - 1.0) for p in found.parts[1:]]
    assert max(smooth) == pytest.approx(math.exp(-2.0))


def test_forms_differ_fourfold_and_laws_twofold() -> None:
    assert max(FORMS.factors) == pytest.approx(4.0, rel=1e-3)
    assert max(SIZES.factors) == pytest.approx(2.0, rel=1e-3)
    assert (FREE["force"], FREE["crater"], FREE["radius"]) == (0.16, 0.24, 0.1)


def test_a_form_is_off_alike_over_twice_the_spread_of_the_conditions(toy) -> None:
    """Nine tenths of it smooth: exp(-(2/2)^2/2) between places two deviations apart."""
    effect = np.array([2.0, -3.0])
    root = form_error(toy.problem([1.0, 1.0]), effect, 0.5)
    alike = root @ root.T / 0.25 / np.outer(effect, effect)
    assert alike[0, 0] == pytest.approx(1.0, abs=1e-6)
    assert alike[0, 1] == pytest.approx(0.9 * math.exp(-0.5), abs=1e-6)


def test_a_refined_grid_has_241_places_of_one_and_49_of_each_of_two() -> None:
    axis = Axis("m", Parameter("size", "-", 0.0, 1.0, "linear", 0.0, "", nodes=5))
    assert [len(f) for f in Grid((axis,)).fine] == [241]
    assert [len(f) for f in Grid((axis, axis)).fine] == [49, 49]
    assert [len(f) for f in Grid((axis,) * 3).fine] == [17] * 3


def test_a_value_is_a_slip_from_four_deviations_on_if_no_neighbour_leans_with_it(toy) -> None:
    def slips(*departures: float) -> list[int]:
        data = [0.0] * 8
        data[3], data[4] = departures
        return np.flatnonzero(outlying(toy.problem(data), toy.fit_of(data))).tolist()

    assert slips(3.9, 0.0) == []
    assert slips(4.1, 0.0) == [3]
    assert slips(4.1, 1.9) == [3]
    assert slips(4.1, 2.1) == []


def test_one_value_in_sixteen_may_be_a_slip(toy) -> None:
    data = [0.0] * 32
    data[5] = data[15] = data[25] = 9.0
    assert np.sum(outlying(toy.problem(data), toy.fit_of(data))) == 2


def test_derivatives_are_differences_over_three_tenths_of_a_deviation(toy) -> None:
    seen = []
    given = toy.problem([1.0, 2.0], derivative=[[1.0], [3.0]])
    watched = toy.Simulator(given, seen=lambda _, points: seen.extend(points))
    here, linear = derivatives(watched, (), {}, np.zeros(1))
    assert here.tolist() == [0.0, 0.0]
    assert linear.J.ravel().tolist() == pytest.approx([1.0, 3.0])
    assert {float(abs(p.z[0])) for p in seen} == {0.0, 0.3}
    assert max(p.faster for p in seen) == 0.01


def test_three_mechanisms_are_fitted_in_full_and_those_from_a_fifth_of_the_leader(toy) -> None:
    """Of a shape s and data s/2 the gain is |s|^2/8, less the prior's width."""
    shapes = [tuple(40.0 * (k == j) for k in range(8)) for j in range(6)]

    def fitted(sizes):
        data = [40.0 * x for x in (*sizes, 0.0, 0.0)]
        library = tuple(toy.Effect(f"m{j}", shape) for j, shape in enumerate(shapes))
        return len(rank(toy.Simulator(toy.problem(data)), mechanisms=library).singles)

    assert fitted([0.9, 0.1, 0.1, 0.1, 0.1, 0.1]) == 3
    # 800 s^2 nats: sizes of 0.5, 0.24 and 0.2 gain some 200, 46 and 32
    assert fitted([0.5, 0.24, 0.24, 0.24, 0.24, 0.24]) == 6
    assert fitted([0.5, 0.2, 0.2, 0.2, 0.2, 0.2]) == 3


def test_a_drift_needs_eight_repeats_and_one_in_a_thousand() -> None:
    def drift(n: int, slope: float):
        order = np.linspace(0.0, 1.0, n)
        return drift_of("restitution", [(order, slope * order, np.full(n, 0.1))], observables=1)

    # 1/0.1 of a slope over places from 0 to 1: z = 10 slope sqrt(sum (x - mean)^2) = 9.3 of 1
    assert drift(7, 1.0) is None
    assert drift(8, 1.0).z == pytest.approx(10.0 * math.sqrt(6.0 / 7.0), rel=1e-6)
    # Student's t with six degrees of freedom: one in a thousand lies beyond 5.96
    assert drift(8, 0.63) is None
    assert drift(8, 0.66) is not None


def test_a_column_is_followed_from_one_in_a_thousand_on() -> None:
    """Two entries, five repeats each: F = 2.5 of the offset squared, beyond 25.4 one in 1000."""
    entries = ("a",) * 5 + ("b",) * 5

    def followed(apart: float):
        value = np.array([0.0] * 5 + [apart] * 5) + 0.01 * np.resize([1.0, -1.0], 10)
        repeats = [Entries(entries, value, np.ones(10))]
        return followed_of("x_operator", "restitution", repeats, tested=1)

    assert followed(3.1) is None
    assert followed(3.3) is not None


def test_repeats_do_not_average_a_gauge_away(toy) -> None:
    """Four logarithms known to 1 % each: 0.5 % as a mean, and 0.4 % that stays."""
    c = toy.condition(2.0)
    c = type(c)(**{f: getattr(c, f) for f in c.__slots__} | {"trials": (0, 1, 2, 3)})
    value = 5.0 * np.exp([0.01, -0.01, 0.01, -0.01])
    read = {"peak_force_N": Readings(value, 0.01 * value)}
    found = cells_of(read, np.full(4, 2.0), np.full(4, math.nan), [c], {})
    assert found.cells.std == pytest.approx([math.hypot(0.005, 0.004)], rel=1e-6)
    # of one that is known to 0.1 % a half of that is the floor
    read = {"peak_force_N": Readings(value, 0.001 * value)}
    found = cells_of(read, np.full(4, 2.0), np.full(4, math.nan), [c], {})
    assert found.cells.std == pytest.approx([math.hypot(0.0005, 0.0005)], rel=1e-6)


def test_a_reduction_that_is_off_by_a_quarter_says_nothing() -> None:
    given = {"peak_force_N": (10.0, 0.1)}
    found = _corrected(given, {"peak_force_N": (1.2, 0.0)})["peak_force_N"]
    # 0.3 % at the least of what was read
    assert found == pytest.approx((10.0 / 1.2, math.hypot(0.1, 0.03) / 1.2))
    assert _corrected(given, {"peak_force_N": (1.26, 0.0)}) == {}
    assert _corrected(given, {"peak_force_N": (1.0, 0.26)}) == {}


def test_a_part_of_the_misfit_below_nothing_is_told_as_nothing() -> None:
    """What the sheet's numbers take may come out of the metal's part."""
    parts = {"force": (0.003, 0.02)}
    problem = SimpleNamespace(law_name="fitted", error=SimpleNamespace(parts=parts))
    misfit = {"error_size": 2.0, "numbers": 8.0, "as_stated": 307.0, "sheet": -0.01, "metal": 0.98,
              "law": 0.0, "rest": 0.03}  # fmt: skip
    _, told = law_notes(problem, misfit)
    assert "of it errors of the data sheet would explain 0 %, a real metal 98 %" in told
    assert "the misfit is chi2 = 307 (8 numbers)" in told


@pytest.mark.parametrize("name", ["kharaz-2001-oblique", "thesis-chapter-5"])
def test_angles_from_the_normal_are_the_complements_at_one_normal_speed(name) -> None:
    problem = problem_of(read(set_folder(Path(name))), law="fitted")
    [turned] = (m for m in problem.wrong_numbers if m.key == "angle_deg")
    for scene, c in zip(problem.scenes(np.zeros(problem.n_z)), problem.conditions, strict=True):
        there = turned.attach(scene, {"angle_deg_turned": 1.0}, c.around).approach
        path = math.atan2(there.speed, abs(there.tangential))
        angle = there.angle if name.startswith("thesis") else path
        assert angle == pytest.approx(math.pi / 2.0 - c.incidence)
        assert there.speed == scene.approach.speed
    upright = problem_of(read(set_folder(Path("leeb-steel-300hv"))), law="fitted")
    assert not [m for m in upright.wrong_numbers if m.key == "angle_deg"]


def test_a_speed_within_a_twentieth_of_a_tested_one_is_not_proposed(toy) -> None:
    def speeds(*tested):
        given = toy.problem([0.0] * len(tested), speeds=tested)
        return [c.condition.speed for c in candidates_of(given)]

    assert speeds(1.0, 1.049) == []
    assert speeds(1.0, 4.0, 2.0 * 1.04) == pytest.approx([2.0**0.5, 2.0**1.5])
    assert speeds(1.0, 4.0, 2.0 * 1.06) == pytest.approx([2.0**0.5, 2.0, 2.0**1.5])


def test_angles_are_proposed_in_eight_steps_between_those_tested(toy) -> None:
    given = toy.problem([0.0, 0.0], speeds=[1.0, 1.0])
    lean = tuple(toy.condition(1.0, angle=math.radians(a)) for a in (40.0, 80.0))
    found = candidates_of(replace(given, conditions=lean))
    seen = [round(math.degrees(c.condition.angle), 6) for c in found]
    assert sorted(set(seen) - {40.0, 80.0}) == [45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0]


@pytest.mark.parametrize(
    ("heights", "angle", "speed", "told"),
    [(True, 90.0, 2.0, "204"), (True, 90.0, 4.43, "1000"), (True, 45.0, 2.0, ""),
     (False, 90.0, 2.0, "")],
)  # fmt: skip
def test_who_drops_is_told_the_height(toy, heights, angle, speed, told) -> None:
    """And not where it slants: a rod's speed is along the normal, a ball's along its path."""
    one = toy.condition(speed, angle=math.radians(angle))
    one = replace(one, around=replace(one.around, from_height=heights))
    fall = f" (a fall of {told} mm)" if told else ""
    assert next_experiment._fall(one, {"gravity_m_s2": 9.81}) == fall


@pytest.fixture
def pressed_set(toy, monkeypatch):
    def loads(*reached, pressed=False, second=None, told=False):
        pair = Pair(Material(E=2e11, nu=0.3), Material(E=2e11, nu=0.3), 0.01)
        scenes = [SimpleNamespace(law=None, pair=pair, load=x) for x in reached]
        c = replace(toy.condition(), press=Press(1.0)) if pressed else toy.condition()
        monkeypatch.setattr(feasible, "by_striker", lambda p: {"ball": [(c, s) for s in scenes]})
        x = np.linspace(-5.0, 15.0, 201)
        table = SimpleNamespace(log_depth=x, stated=SimpleNamespace(force=x))
        monkeypatch.setattr(feasible, "strength_table", lambda law, pair: table)
        monkeypatch.setattr(feasible, "at_load", lambda c, s, load: replace(c, press=Press(load)))
        monkeypatch.setattr(feasible, "deepest", lambda s: s.load)  # the table's force is its depth
        given = SimpleNamespace(
            baseline="elastic-plastic", parts=False, rig=SimpleNamespace(of=second or {}),
            bench=Bench(),
        )  # fmt: skip
        found = presses_of(given)
        return [c.change for c in found] if told else [c.condition.press.load for c in found]

    return loads


def test_presses_have_four_loads_where_they_are_half_apart(pressed_set) -> None:
    assert pressed_set(100.0, 800.0) == [100.0, 200.0, 400.0, 800.0]
    # from half the load on where there is one
    assert pressed_set(100.0, 151.0) == pytest.approx([100.0, 110.0, 130.0, 150.0])
    assert pressed_set(100.0, 149.0) == [50.0, 150.0]


def test_a_bench_presses_with_20_to_5000_newtons_and_three_times_beyond_what_was(pressed_set):
    assert pressed_set(2.0, 20000.0) == [20.0, 130.0, 790.0, 5000.0]
    found = pressed_set(100.0, 800.0, pressed=True)
    assert (found[0], found[-1]) == (33.0, 2400.0)


def test_a_press_names_what_is_pressed(pressed_set) -> None:
    assert "on the same flat, each time" in pressed_set(100.0, 800.0, told=True)[0]
    held, *_ = pressed_set(100.0, 800.0, second={"target.radius_m": 0.02}, told=True)
    assert "on the same second sphere, each time" in held


def test_a_press_is_read_to_2_and_1_per_cent_and_its_dent_lies_on_the_law_to_2(toy) -> None:
    given = SimpleNamespace(sees_dents=False)
    load = 0.005
    depth = next_experiment._press_noise(given, "permanent_depth_m")
    power = OBSERVABLES["permanent_depth_m"].power
    assert depth == pytest.approx(math.hypot(0.02 / math.sqrt(3.0), load * power))
    power = OBSERVABLES["dent_diameter_m"].power
    expected = math.sqrt(0.01**2 / 3.0 + 0.02**2 + (load * power) ** 2)
    assert next_experiment._press_noise(given, "dent_diameter_m") == pytest.approx(expected)
    expected = math.hypot(OBSERVABLES["dent_diameter_m"].usual_noise, 0.02)
    none = SimpleNamespace(problem=toy.problem([0.0]))
    assert next_experiment._noise(none, "dent_diameter_m") == pytest.approx(expected)


def test_four_rivals_are_told_apart(toy) -> None:
    effects = [toy.Effect(f"m{k}", (0.0,)) for k in range(6)]
    ranking = toy.ranking_of(
        None, toy.fit_of([0.0]), singles=[toy.fit_of([0.0], e) for e in effects]
    )  # fmt: skip

    def count(*p):
        shared = dict.fromkeys([f"m{k}" for k in range(6)], 0.0) | {"baseline": 0.0}
        shared |= {f"m{k}": x for k, x in enumerate(p)}
        return len(next_experiment.rivals_of(ranking, Odds({}, shared)))

    assert count(0.9, 0.1) == count(0.2, 0.2, 0.2, 0.2, 0.2) == 4


def test_what_tells_most_in_an_hour_comes_first(toy, monkeypatch) -> None:
    def first(more):
        worth = [
            Proposal("strike", 1.0, "trial", information=1.0, minutes=15.0),
            Proposal("press", 1.0, "press", information=more, minutes=30.0),
        ]
        session = Session(information=1.0)
        monkeypatch.setattr(next_experiment, "_options", lambda s: None)
        monkeypatch.setattr(next_experiment, "_worth_of_each", lambda *a: (worth, session))
        base = toy.fit_of([0.0])
        ranking = toy.ranking_of(None, base, singles=[toy.fit_of([0.0], toy.Effect("a", (1.0,)))])
        given = Odds({}, {"baseline": 0.6, "a": 0.4})
        return next_experiment.propose(None, ranking, given, None)[0][0].change

    assert [first(1.9), first(2.1)] == ["strike", "press"]


@pytest.mark.parametrize(("slope", "kind"), [(0.95, "noise"), (0.85, "none")])
def test_a_measurement_is_worth_it_that_leaves_less_than_nine_tenths(toy, slope, kind) -> None:
    """A prior of 12 and a slope s of unit noise: s^2 + 12 becomes 4 s^2 + 12."""
    # (12 + s^2)/(12 + 4 s^2) is 0.81 at s = 0.999
    effect = toy.Effect("a", (slope / 0.92 * 0.9986 if slope > 0.9 else 0.9,))
    given = toy.problem([0.0])
    assert next_experiment._sharper(given, toy.fit_of([0.0], effect))[0].kind == kind


def test_twelve_draws_stand_for_a_rivals_parameters_and_256_for_the_noise(toy) -> None:
    found = toy.fit_of([0.5], toy.Effect("a", (1.0,)))
    assert len(_samples(found, np.random.default_rng(0))) == 12
    assert _spread_out(2).shape == (256, 2)


def test_a_law_is_off_alike_over_a_factor_of_twelve_in_depth() -> None:
    """Components of exp(-(x/2.5)^2/2): what they add up to at two depths 2.5 apart in ln."""
    grid = np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES)
    rows = components(RULES.law_length)
    at = np.stack([[np.interp(x, grid, row) for row in rows] for x in (-8.0, -5.5)])
    alike = at @ at.T
    assert alike[0, 1] / math.sqrt(alike[0, 0] * alike[1, 1]) == pytest.approx(
        math.exp(-0.5), rel=0.05
    )


def test_a_metals_curve_is_looked_for_by_eight_presses_of_each_striker(toy, monkeypatch) -> None:
    given = toy.problem([0.0])
    some = {name: [(toy.condition(), None)] for name in "ab"}
    monkeypatch.setattr(marks, "by_striker", lambda p: some)
    monkeypatch.setattr(marks, "at_load", lambda c, s, load: replace(c, press=Press(load)))
    found = marks.with_marks(given, (10.0, 1000.0))
    loads = [c.press.load for c in found.conditions if c.press is not None]
    assert len(loads) == 16
    assert loads[:8] == pytest.approx([10.0 * 100.0 ** (k / 7.0) for k in range(8)], rel=0.05)
    # two numbers of each, a depth to 2 % and a diameter to 1 %
    assert found.cells.std[1:3].tolist() == [0.02, 0.01]


def test_curves_at_several_rates_narrow_the_rise_that_otherwise_has_its_prior() -> None:
    assert rate_prior(()).tolist() == [[0.4, 0.35], [0.15, 0.08]]
    rise, exponent = rate_prior(((1000.0, 1.5),))
    # within a tenth, what two specimens of one metal differ by
    assert rise == pytest.approx([np.log(1.5), 0.096], abs=0.01)
    assert exponent == pytest.approx([0.16, 0.07], abs=0.01)


def test_the_own_pair_is_solved_a_little_deeper_than_the_impacts_go(monkeypatch) -> None:
    class Asked(Exception):
        pass

    def asked(problem, **more):
        raise Asked(f"{problem.depths[-1]:.6g}")

    body = Material(E=2e11, nu=0.3, Sy=3e8)
    monkeypatch.setattr(fem, "solve", asked)
    with pytest.raises(Asked, match=r"^0\.013$"):
        solved_table(Pair(body, body, R=1.0), 0.001, 0.01)


def test_next_mark_is_none_where_a_tenth_is_all_that_is_gained() -> None:
    """One stress, known to a unit variance; a press of noise s leaves s^2/(1 + s^2)."""
    press = SimpleNamespace(load=100.0)
    condition = SimpleNamespace(press=press, striker="ball")

    def worth(noise):
        cells = SimpleNamespace(
            condition=np.array([0]), std=np.array([noise]), observable=("dent_diameter_m",)
        )
        given = SimpleNamespace(cells=cells, conditions=[condition])
        return marks.next_mark(given, 0, np.ones((3, 1)), np.eye(1), np.ones((1, 1))) is not None

    # 0.9 of it is left at a noise of 3
    assert [worth(2.9), worth(3.1)] == [True, False]
