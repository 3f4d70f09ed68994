"""Evidence, fits, draws, held-out conditions and the free correction, against closed forms."""

import math
from dataclasses import replace
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.discrepancy import diagnose
from dentscope.discrepancy.correction import correct, widened
from dentscope.discrepancy.estimates import parameters_of
from dentscope.discrepancy.heldout import groups_of, held_out, missed
from dentscope.discrepancy.inference.fit import Fit, expand, moved_towards, tried_steps
from dentscope.discrepancy.inference.grid import Axis, Grid, interval, posterior
from dentscope.discrepancy.inference.linear import Linear, Mixture, Sizes
from dentscope.discrepancy.unknowns.lawerror import FREE, LawError, Spread
from dentscope.dynamics.mechanisms import Parameter
from dentscope.dynamics.strength import NODES
from dentscope.recordings import read
from dentscope.recordings.shipped import FOLDER
from scipy.stats import beta, multivariate_normal, norm


def test_likelihood_is_scipys_multivariate_normal() -> None:
    rng = np.random.default_rng(1)
    J, r = rng.normal(size=(6, 3)), rng.normal(size=(4, 6))
    noise = np.diag(rng.uniform(0.5, 2.0, 6))
    expected = multivariate_normal(np.zeros(6), noise + J @ J.T).logpdf(r)
    assert Linear(noise, J).log_likelihood(r) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("given", [{}, {"prior": np.array([1.0, 0.5, 3.0])}])
def test_unknowns_are_those_of_ridge_regression_and_a_prior_scales_the_derivatives(given) -> None:
    rng = np.random.default_rng(3)
    J, r, prior = rng.normal(size=(8, 3)), rng.normal(size=8), given.get("prior", np.ones(3))
    linear = Linear(np.eye(8), J, **given)
    assert linear.log_likelihood(r) == pytest.approx(Linear(np.eye(8), J * prior).log_likelihood(r))
    mean, cov = linear.unknowns(r)
    normal = J.T @ J + np.diag(prior**-2.0)
    assert mean == pytest.approx(np.linalg.solve(normal, J.T @ r), rel=1e-10)
    assert cov == pytest.approx(np.linalg.inv(normal), rel=1e-9)


def test_grid_is_exact_for_cubics() -> None:
    one = Parameter("a", "-", 1.0, 10.0, "log", 0.0, "", nodes=5)
    two = Parameter("b", "-", -1.0, 1.0, "linear", 0.0, "", nodes=3)
    grid = Grid((Axis("m", one), Axis("m", two)))
    x, y = np.meshgrid(*grid.coarse, indexing="ij")
    table = (x**3 - x + 2.0 * y**2 * x).reshape(-1, 1)
    u, v = grid.places().T
    assert grid.refine(table)[:, 0] == pytest.approx(u**3 - u + 2.0 * v**2 * u, abs=1e-12)
    assert grid.nodes()[0] == {"m": {"a": 1.0, "b": -1.0}}


def test_two_mechanisms_may_use_the_same_word() -> None:
    share = Parameter("share", "-", 0.0, 1.0, "linear", 0.0, "", nodes=5)
    own = Parameter("own", "-", 0.0, 1.0, "linear", 0.0, "", nodes=3)
    grid = Grid((Axis("one", share), Axis("two", share), Axis("two", own)))
    nodes = grid.nodes()
    assert len({(n["one"]["share"], n["two"]["share"]) for n in nodes}) == 25
    assert grid.labels == ("one.share", "two.share", "own")


def test_window_and_whole_prior_give_one_evidence() -> None:
    """A likelihood that is nothing beyond a window: the window's part of the prior counts."""
    p = Parameter("a", "-", 0.0, 1.0, "linear", 0.0, "", nodes=9)

    def evidence(grid: Grid) -> float:
        found, _ = posterior(norm.logpdf(grid.places()[:, 0], 0.4, 0.02))
        return found + grid.log_volume

    axis = Axis("m", p)
    whole, part = Grid((axis,)), Grid((axis,), ((0.3, 0.5),))
    assert part.coarse[0][[0, -1]] == pytest.approx([0.3, 0.5])
    assert evidence(part) == pytest.approx(0.0, abs=1e-5)  # all of the density is inside
    assert evidence(whole) == pytest.approx(evidence(part), abs=1e-3)


def test_a_window_has_no_fewer_nodes_than_the_prior_has_there() -> None:
    fine = Parameter("a", "-", 1.0, 10.0, "log", 0.0, "", nodes=17)
    share = Parameter("b", "-", 0.0, 1.0, "half-low", 0.0, "", nodes=5)
    first, second = Grid((Axis("m", fine), Axis("m", share)), ((0.1, 0.9), (0.4, 0.5))).coarse
    assert len(first) == 14  # 0.8 of 16 steps
    assert len(second) == 5


def test_a_state_that_occurs_has_half_of_the_prior() -> None:
    """Above it the arcsine distribution of its quantiles: scipy's beta(1/2, 1/2)."""
    share = Parameter("b", "-", 2.0, 4.0, "half-low", 0.0, "", nodes=5)
    place = np.linspace(0.0, 1.0, 11)
    assert share.value(0.5 * place) == pytest.approx(2.0, abs=1e-9)
    above = 2.0 + 2.0 * beta(0.5, 0.5).ppf(place)
    assert share.value(0.5 + 0.5 * place) == pytest.approx(above, abs=1e-9)


def test_one_of_two_has_its_two_places_in_any_window_and_takes_none_from_the_others() -> None:
    either = Parameter("b", "-", 2.0, 4.0, "either", 2.0, "", nodes=2)
    size = Parameter("a", "-", 0.0, 1.0, "linear", 0.0, "")
    grid = Grid((Axis("m", size), Axis("m", either)), ((0.2, 0.4), (0.0, 1.0)))
    assert either.value([0.2, 0.8]).tolist() == [2.0, 4.0]
    assert grid.fine[1].tolist() == grid.coarse[1].tolist() == [0.0, 1.0]
    assert len(grid.fine[0]) == len(Grid((Axis("m", size),)).fine[0])


def test_interval_of_a_normal_sample() -> None:
    edges = np.linspace(-6.0, 6.0, 4002)
    weight = np.diff(norm.cdf(edges))
    expected = (0.0, norm.ppf(0.05), norm.ppf(0.95))
    assert interval(edges, weight, 0.9) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("centre", [0.45, 0.4829, 0.5, 0.5171])
def test_ends_of_an_interval_are_not_bound_to_the_places_of_a_grid(centre: float) -> None:
    """Three correlated parameters: 17 places along each, half a deviation apart."""
    one = Parameter("a", "-", 0.0, 1.0, "linear", 0.0, "", nodes=5)
    grid = Grid(tuple(Axis("m", replace(one, name=name)) for name in "abc"))
    sd = 2.0 / 17.0
    cov = sd**2 * np.array([[1.0, 0.7, 0.0], [0.7, 1.0, 0.5], [0.0, 0.5, 1.0]])
    weight = multivariate_normal([0.5, centre, 0.5], cov).pdf(grid.places())
    middle, low, high = interval(*grid.marginal(weight / weight.sum(), 1), 0.9)
    assert middle == pytest.approx(centre, abs=0.002)
    reach = norm.ppf(0.95) * sd
    assert (middle - low, high - middle) == pytest.approx((reach, reach), rel=0.05)


def test_evidence_of_a_flat_likelihood_is_its_height() -> None:
    evidence, weight = posterior(np.full(50, -3.0))
    assert evidence == pytest.approx(-3.0)
    assert math.isclose(weight.sum(), 1.0)


def test_the_size_of_an_error_is_integrated_over() -> None:
    """One fixed unknown and one of three sizes: scipy's densities, weighted."""
    rng = np.random.default_rng(4)
    J, r = rng.normal(size=(6, 2)), rng.normal(size=(5, 6))
    sizes, weights = (0.5, 1.0, 2.0), (0.2, 0.5, 0.3)
    found = Mixture.of(Linear(np.eye(6), J), 1, Sizes(sizes, weights))
    dense = [
        w * multivariate_normal(np.zeros(6), np.eye(6) + scaled @ scaled.T).pdf(r)
        for s, w in zip(sizes, weights, strict=True)
        for scaled in [J * np.array([1.0, s])]
    ]
    assert found.log_likelihood(r) == pytest.approx(np.log(np.sum(dense, axis=0)), rel=1e-10)
    likely = int(np.argmax([d[0] for d in dense]))
    assert found.likeliest(r[0]) is found.parts[likely]
    mean, cov = found.unknowns(r[0])
    share = np.array([d[0] for d in dense]) / sum(d[0] for d in dense)
    means = [p.unknowns(r[0])[0] for p in found.parts]
    assert mean == pytest.approx(share @ np.array(means))
    plain = share @ np.array([np.diag(p.unknowns(r[0])[1]) for p in found.parts])
    assert np.all(np.diag(cov) >= plain - 1e-12)
    # large residuals along the sized unknown speak for the largest size
    far = 10.0 * J[:, 1]
    assert found.likeliest(far) is found.parts[2]


def test_without_unknowns_that_scale_there_is_one_size() -> None:
    linear = Linear(np.eye(2), np.zeros((2, 1)))
    assert len(Mixture.of(linear, 1, Sizes((0.5, 1.0), (0.5, 0.5))).parts) == 1


def test_interval_holds_what_a_form_may_be_off_in_size() -> None:
    """Effect theta times a shape, nearly no noise: 15 % of the effect are 15 % of theta."""
    shape, theta, noise = np.array([1.0, 2.0, -1.0]), 0.4, 1e-2
    p = Parameter("theta", "-", 0.2, 0.6, "linear", 0.0, "", nodes=5)
    grid = Grid((Axis("m", p),))
    at = p.value(grid.places()[:, 0])
    residuals = (theta - at)[:, None] * shape
    form = 0.15 * theta * shape[:, None]
    linear = Linear(noise**2 * np.eye(3), np.zeros((3, 1)), form)
    _, weight = posterior(linear.log_likelihood(residuals))
    fitted = SimpleNamespace(
        mechanisms=(SimpleNamespace(form=0.15),), grid=grid, weight=weight, residuals=residuals,
        linear=linear, prediction=theta * shape, z=np.zeros(1), covariance=np.zeros((1, 1)),
    )  # fmt: skip
    found = parameters_of(SimpleNamespace(problem=SimpleNamespace(nuisances=())), fitted)["theta"]
    assert found["value"] == pytest.approx(theta, rel=2e-3)
    wide = norm.ppf(0.95) * 0.15 * theta
    assert found["high"] - found["value"] == pytest.approx(wide, rel=0.02)
    assert found["value"] - found["low"] == pytest.approx(wide, rel=0.02)
    # the level is that which is asked for
    half = parameters_of(SimpleNamespace(problem=SimpleNamespace(nuisances=())), fitted, 0.5)
    assert half["theta"]["high"] - theta == pytest.approx(wide * 0.6745 / 1.6449, rel=0.02)


def test_gain_is_the_mean_likelihood_ratio_over_the_places() -> None:
    plain = Mixture((Linear(np.eye(2), np.zeros((2, 0))),), np.zeros(1))
    # ratio 1 at no effect, exp(2 * 2 - 2^2/2) = e^2 at the other
    found = plain.gain(np.array([[2.0, 0.0]]), np.array([[0.0, 0.0], [2.0, 0.0]]))
    assert found == pytest.approx([math.log(0.5 * (1.0 + math.e**2))], rel=1e-12)


def test_p_of_a_fit_is_that_of_as_many_numbers_as_no_parameter_takes(toy) -> None:
    # two cells: the square of their length is exponential of mean 2
    assert toy.fit_of([3.0, 4.0]).p_value == pytest.approx(math.exp(-12.5))
    # a parameter takes one up: the other is a normal variable
    taken = toy.fit_of([25.0, 2.0], toy.Effect("size", (50.0, 0.0)))
    assert taken.p_value == pytest.approx(2.0 * norm.sf(2.0))


NOWHERE = np.zeros(0)


@pytest.fixture
def bench(toy):
    """One cell that shows the root of its unknown, with its sign, to a tenth."""
    given = toy.problem([0.0], derivative=[[0.0]])
    given = replace(given, cells=replace(given.cells, std=np.array([0.1])))
    return toy.Simulator(
        given, lambda _, points: np.array([np.sign(p.z) * np.sqrt(np.abs(p.z)) for p in points])
    )


def expanded(bench, z: np.ndarray) -> Fit:
    return expand(bench, (), Grid(()), z, NOWHERE, None)


def test_whole_steps_swing_and_tried_ones_arrive(bench) -> None:
    """Newton's method turns the root of z into -z at every step; secants a little less."""
    whole = tried = np.array([1.0])
    for _ in range(4):
        whole, _ = moved_towards(expanded(bench, whole), whole, NOWHERE)
        tried, _, _ = tried_steps(bench, expanded(bench, tried), tried, NOWHERE)
    assert abs(whole[0]) > 0.2
    assert abs(tried[0]) < 0.2 * abs(whole[0])


@pytest.mark.parametrize(("start", "to", "gone"), [(1e-4, -1.5, 1e-4), (0.2, 0.1, 0.1)])
def test_a_step_that_fits_worse_is_not_gone_and_one_that_hardly_matters_ends_the_fit(
    bench, start, to, gone
) -> None:
    z = np.array([start])
    after, place, settled = tried_steps(
        bench, replace(expanded(bench, z), z=np.array([to])), z, NOWHERE
    )
    assert after == pytest.approx([gone])
    assert place.size == 0
    assert settled


@pytest.fixture(scope="module")
def verdict():
    return diagnose(read(FOLDER / "kharaz-2001-oblique"))


def test_draws_have_the_bounds_that_the_verdict_tells(verdict) -> None:
    found = verdict.samples(4000)
    assert list(found.parameters) == list(verdict.parameters)
    for name, told in verdict.parameters.items():
        low, high = np.quantile(found.parameters[name], [0.05, 0.95])
        wide = told["high"] - told["low"]
        assert low == pytest.approx(told["low"], abs=0.1 * wide), name
        assert high == pytest.approx(told["high"], abs=0.1 * wide), name


def test_what_is_shown_is_a_screen(verdict) -> None:
    told = repr(verdict).splitlines()
    assert told[0].split() == ["kharaz-2001-oblique:", "missing-physics", "probability"]
    assert told[1].split() == ["tangential-compliance", "0.96"]
    rows = repr(verdict.samples(100)).splitlines()
    assert len(rows) == 1 + len(verdict.parameters)
    assert all(len(line) < 100 for line in (*told, *rows))


def test_what_is_read_again_scatters_about_what_was_read(verdict) -> None:
    """As wide as posterior and noise together: never narrower than the noise of the means."""
    found, cells = verdict.samples(2000), verdict.problem.cells
    for name, again in found.predicted.items():
        at = [k for k, one in enumerate(cells.observable) if one == name]
        spread = np.log(again).std(0) if cells.is_log[at].all() else again.std(0)
        noise = np.sqrt(np.diag(verdict.best.linear.noise))[at]
        assert (spread > 0.93 * noise).all()
        assert (np.abs(found.measured[name] - again.mean(0)) < 4.0 * again.std(0)).all()
    # with nothing missing the spins of this set are not met
    nothing = verdict.samples(2000, explanation="baseline")
    off = [np.abs(x.measured["rebound_spin_rad_s"] / x.predicted["rebound_spin_rad_s"].mean(0) - 1)
           for x in (nothing, found)]  # fmt: skip
    assert off[0].max() > 3.0 * off[1].max()
    with pytest.raises(InputError, match=r"'magic' .*baseline"):
        verdict.samples(explanation="magic")
    for draws in (0, -1, 2.5, "x"):
        with pytest.raises(InputError, match=r"draws: .* \(allowed: a whole number above 0\)"):
            verdict.samples(draws)


def test_the_file_has_the_groups_and_dimensions_that_arviz_reads(verdict, tmp_path) -> None:
    found = verdict.samples(100)
    with h5py.File(found.to_netcdf(tmp_path / "samples.nc")) as file:
        assert set(file) == {"posterior", "posterior_predictive", "observed_data"}
        sizes = file["posterior/target.E_Pa"]
        assert sizes.shape == (4, 25)
        assert [d[0].name for d in sizes.dims] == ["/posterior/chain", "/posterior/draw"]
        assert sizes.attrs["units"] == "Pa"
        again = file["posterior_predictive/restitution"]
        assert again.dims[2][0][:].tolist() == found.condition["restitution"].tolist()
        assert np.ravel(again) == pytest.approx(np.ravel(found.predicted["restitution"]))
        assert file["observed_data/restitution"][:] == pytest.approx(found.measured["restitution"])


def test_whole_strikers_speeds_and_angles_are_left_out(toy) -> None:
    c = toy.condition
    given = replace(
        toy.problem([0.0] * 4),
        conditions=(c(1.0, "a"), c(2.0, "a"), c(1.0, "b"), c(2.0, "b", math.radians(60.0))),
    )
    groups = {tuple(np.flatnonzero(mask).tolist()) for mask in groups_of(given)}
    assert groups == {(0, 1), (2, 3), (0, 2), (1, 3), (0, 1, 2), (3,)}


def test_where_nothing_varies_single_conditions_are_left_out(toy) -> None:
    given = toy.problem([0.0] * 3, speeds=[1.0, 1.001, 1.002])
    assert [np.flatnonzero(m).tolist() for m in groups_of(given)] == [[0], [1], [2]]
    # ln v/0.15 = 0, 0.3 and 1.2
    given = toy.problem([0.0] * 3, speeds=[1.0, 1.05, 1.2])
    assert [np.flatnonzero(m).tolist() for m in groups_of(given)] == [[0, 1], [2]]


def test_cells_that_share_nothing_are_missed_by_their_residual(toy) -> None:
    given = toy.problem([3.0, -4.0])
    found = held_out(given, toy.fit_of([3.0, -4.0]))
    assert found.rms == pytest.approx(math.sqrt((9.0 + 16.0) / 2.0))
    assert found.log_density == pytest.approx(np.mean(norm.logpdf([3.0, -4.0])))
    assert found.trials == 2


def test_what_cells_share_is_learnt_from_those_that_were_kept(toy) -> None:
    """An unknown of variance 9 in two cells of unit noise: 9/10 of one foretells the other."""
    J = [[3.0], [3.0]]
    found = held_out(toy.problem([5.0, 7.0], derivative=J), toy.fit_of([5.0, 7.0], J=J))
    miss = np.array([5.0 - 0.9 * 7.0, 7.0 - 0.9 * 5.0])
    assert found.rms == pytest.approx(math.sqrt(np.mean(miss**2)), rel=1e-12)
    density = norm.logpdf(miss, scale=math.sqrt(1.0 + 9.0 - 0.9 * 9.0))
    assert found.log_density == pytest.approx(np.mean(density), rel=1e-12)


def test_a_mechanism_foretells_what_it_was_not_shown(toy) -> None:
    data = [20.0, 40.0]
    effect = toy.Effect("a", (40.0, 80.0))
    with_it, without = (held_out(toy.problem(data), toy.fit_of(data, *e)) for e in ((effect,), ()))
    assert with_it.rms < 1.0
    assert without.rms == pytest.approx(math.sqrt((400.0 + 1600.0) / 2.0))


def test_sizes_count_by_how_well_they_explain_what_was_kept(toy) -> None:
    """Near the end of its range the sizes that come into question lie to one side."""
    data, effect = [0.8, 1.6], toy.Effect("a", (40.0, 80.0))
    # shown one cell, the size is known to 1/80 or 1/40 of its range: 2 standard errors at the most
    assert held_out(toy.problem(data), toy.fit_of(data, effect)).rms < 1.5


def test_some_cells_foretell_the_others() -> None:
    rng = np.random.default_rng(5)
    linear = Linear(np.eye(4), rng.normal(size=(4, 2)), rng.normal(size=(4, 3)))
    r, out = rng.normal(size=(3, 4)), np.array([False, True, False, True])
    kept = linear.total[np.ix_(~out, ~out)]
    precision = np.linalg.inv(linear.total)
    g = r @ precision
    foretold = r[:, ~out] @ np.linalg.solve(kept, linear.total[np.ix_(~out, out)])
    whole = np.sum(r * g, axis=1)
    miss, squares, log_density = missed(whole, g[:, out], precision[np.ix_(out, out)])
    assert miss == pytest.approx(r[:, out] - foretold)
    assert squares == pytest.approx(
        np.einsum("ki,ij,kj->k", r[:, ~out], np.linalg.inv(kept), r[:, ~out])
    )
    # of all less of the others
    both = linear.log_likelihood(r)
    others = -0.5 * (squares + np.linalg.slogdet(2.0 * math.pi * kept)[1])
    assert log_density == pytest.approx(both - others)


KNOWN = 0.02
KINDS = ("force", "recovery", "recovery exponent", "crater", "radius")
NONE = dict.fromkeys(KINDS, np.zeros(NODES))
ERROR = LawError(
    np.ones((1, NODES)), np.zeros((0, NODES)), np.zeros((0, NODES)),
    {"ball": Spread(NONE, NONE | {"force": np.full(NODES, KNOWN)}, np.array([-5.0]))},
)  # fmt: skip


def corrected(toy, data, noise):
    J = [[KNOWN]]
    given = toy.problem(data, derivative=J, error=ERROR)
    base = replace(toy.fit_of(data, J=J), linear=Linear(noise**2 * np.eye(1), np.array(J)))
    simulator = SimpleNamespace(
        problem=replace(given), observe=lambda *_: {"peak_depth_m": np.array([[1e-4]])}
    )
    object.__setattr__(simulator.problem, "scenes", lambda z: [SimpleNamespace(pair=PAIR)])
    return correct(simulator, base)


PAIR = SimpleNamespace(R=0.01)


def test_a_force_off_by_a_fifth_is_a_factor_of_that_size(toy) -> None:
    (loading,) = corrected(toy, [math.log(1.2)], 1e-3)
    assert loading.phase == "loading"
    # a prior of 16 % hardly holds back what is measured to a thousandth
    held = FREE["force"] ** 2 / (FREE["force"] ** 2 + 1e-6)
    assert loading.factor == pytest.approx(1.2**held, rel=1e-9)
    assert loading.depth_over_R[[0, -1]] == pytest.approx([0.3 * 1e-2, 1e-2])


def test_the_band_is_that_of_the_measurement(toy) -> None:
    (loading,) = corrected(toy, [0.0], 0.05)
    spread = (FREE["force"] ** -2 + 0.05**-2) ** -0.5
    beyond = norm.ppf(0.95)
    assert np.log(loading.high) == pytest.approx(beyond * spread, rel=1e-9)
    assert np.log(loading.low) == pytest.approx(-beyond * spread, rel=1e-9)


def test_only_the_laws_error_is_set_free(toy) -> None:
    J = [[0.5, KNOWN]]
    given = toy.problem([0.0], derivative=J, error=ERROR)
    wide = widened(given, toy.fit_of([0.0], J=J))
    assert wide.scaled == pytest.approx(np.array([[0.5, FREE["force"]]]))
