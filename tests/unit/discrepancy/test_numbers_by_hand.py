"""Tuned numbers of the diagnosis where they act, in cases that are worked out by hand."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.odds import PRIORS
from dentscope.discrepancy.choice.outside import odd_repeats, outside_of
from dentscope.discrepancy.comparison.cells import Scatter, cells_of
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.curves.readings import Readings, _corrected
from dentscope.discrepancy.estimates import law_notes
from dentscope.discrepancy.inference.derivatives import FORMS, derivatives, form_error
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.discrepancy.inference.outliers import outlying
from dentscope.discrepancy.rank import rank
from dentscope.discrepancy.unknowns.lawerror import FREE, SIZES
from dentscope.discrepancy.unknowns.repeats import Entries, drift_of, followed_of
from dentscope.dynamics.mechanisms.base import Parameter
from dentscope.recordings import read
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


def test_three_mechanisms_are_fitted_in_full_and_those_within_5_nats(toy) -> None:
    """Of a shape s and data s/2 the gain is |s|^2/8, less the prior's width."""
    shapes = [tuple(40.0 * (k == j) for k in range(8)) for j in range(6)]

    def fitted(sizes):
        data = [40.0 * x for x in (*sizes, 0.0, 0.0)]
        library = tuple(toy.Effect(f"m{j}", shape) for j, shape in enumerate(shapes))
        return len(rank(toy.Simulator(toy.problem(data)), mechanisms=library).singles)

    assert fitted([0.9, 0.1, 0.1, 0.1, 0.1, 0.1]) == 3
    # 800 s^2 nats: sizes of 0.5 and 0.497 are 2.4 nats apart, those of 0.5 and 0.49 7.9
    assert fitted([0.5, 0.497, 0.497, 0.497, 0.497, 0.497]) == 6
    assert fitted([0.5, 0.49, 0.49, 0.49, 0.49, 0.49]) == 3


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
