"""Laws judged by finite elements, a named flow taken back to them, tuned numbers by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import InputError, Material, Pair
from dentscope.core.errors import Ending, Outcome
from dentscope.core.flow import Flow, tabulated
from dentscope.core.tables import thinned
from dentscope.discrepancy import MECHANISMS
from dentscope.discrepancy.comparison.forward import Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.inference.fit import fit
from dentscope.dynamics.report.onset import first_yield
from dentscope.models import LAWS, critical_depth
from dentscope.recordings import read
from dentscope.start.closing import _kept_out, close, closed_lines, write_closed
from dentscope.start.comparison import compare_laws
from dentscope.start.judged import USABLE, Departure, Reference, _groups, _rise, departure, nearest
from dentscope.start.measured import _dent
from dentscope.start.metal_press import _clock, _flowing, _press
from dentscope.start.pair import Solved
from dentscope.studies.proof.generators import truth
from dentscope.studies.proof.generators.folder import write_set

ALUMINIUM = Material(E=7.0e10, nu=0.33, Sy=3.0e8)
STEEL = Material(E=2.1e11, nu=0.3, Sy=8.0e8)
PAIR = Pair(ALUMINIUM, STEEL, 2.5e-3)


@pytest.fixture(scope="module")
def found():
    return compare_laws(PAIR, max_delta_over_R=0.01)


def test_what_is_recommended_lies_near_the_finite_elements(found):
    """Finite elements of this pair have 266 N at Delta/R = 0.01; thornton says 94, stronge 312."""
    assert found.best[0] == "fitted"
    assert all(found.departures[name].worst <= 0.1 for name in found.best)
    last = {row.law: row.force_N for row in found.last_rows()}
    assert {name: last[name] for name in found.best} == pytest.approx(
        dict.fromkeys(found.best, 266.0), rel=0.03
    )
    for name in ("thornton", "stronge", "ghaednia", "ceb", "hertz"):
        assert found.departures[name].worst > math.log(1.5)
    assert found.departures["thornton"].told == "off by 2.8 times in force at 0.009 R"
    assert found.told("hertz").startswith("off by more than 100 times in dent at ")


def test_a_depth_beyond_what_was_solved_is_told(found):
    assert "not judged beyond" not in found.finding
    deep = compare_laws(PAIR, law="fitted", max_delta_over_R=0.4).finding
    assert "; solved to Delta/R = 0.1" in deep
    assert deep.endswith(", not judged beyond")
    glass = Material(E=7.0e10, nu=0.22)
    elastic = compare_laws(Pair(glass, glass, 1e-3), law="fitted").finding
    assert "at Delta/R = 0.01: neither body yields; regime: elastic" in elastic


def test_an_end_of_a_flow_curve_is_told_with_what_to_use():
    short = Material(7.0e10, 0.33, 3.0e8, flow=Flow(tabulated([0.0, 0.05], [3.0e8, 3.5e8])))
    found = compare_laws(Pair(short, STEEL, 2.5e-3), law="hardening", max_delta_over_R=0.05)
    assert "the sphere's flow curve ends at a strain of 0.05, the contact" in found.finding


def test_soft_bodies_are_judged_by_finite_strain_while_nothing_yields():
    # finite elements of this pair (level smoke): 1.1538 N at Delta/R = 0.03659
    soft = Pair(Material(E=10e6, nu=0.45, Sy=2e6), Material(E=3e9, nu=0.4, Sy=60e6), 3e-3)
    found = compare_laws(soft, max_delta_over_R=0.03659)
    ends = {row.law: row.force_N for row in found.last_rows()}
    assert found.best == ("fitted",)
    assert ends["fitted"] == pytest.approx(1.1538, rel=0.012)
    assert ends["hertz"] == pytest.approx(1.1538, rel=0.1)
    assert found.told("hertz") == "within 11 %"
    shallow = compare_laws(soft, max_delta_over_R=1e-5)
    assert shallow.best == ("hertz",)
    assert shallow.told("johnson") == "within 1 %"


def test_first_yield_is_of_the_body_that_yields_first():
    # the flat has the smaller strength; (pi 1.295 exp(0.736 nu) S/(2 E'))^2 R of each by hand
    pair = Pair(Material(E=200e9, nu=0.2, Sy=500e6), Material(E=200e9, nu=0.45, Sy=480e6), 10e-3)
    assert pair.first_yield * pair.R == pytest.approx(1.0723e-6, rel=1e-4)
    assert critical_depth(pair) == pytest.approx(1.4278e-6, rel=1e-4)
    assert first_yield(pair).depth == pytest.approx(1.0723e-6, rel=1e-4)


def test_restitutions_of_what_is_recommended_agree(found):
    """Side by side stood laws whose restitution is 0.926 and 0.492."""
    from dentscope.dynamics import Approach, Striker, scene_of, strike

    ball = Striker(mass=1.77e-4, tip_radius=PAIR.R)
    met = {"sphere": ALUMINIUM, "flat": STEEL, "striker": ball, "approach": Approach(1.0)}
    e = [strike(scene_of(LAWS[name], **met)).restitution for name in found.best]
    assert max(e) - min(e) < 0.03


def test_the_nearest_pair_is_itself_where_it_was_solved():
    own = nearest(PAIR, last=0.01).pair
    bodies = (own.sphere.with_(E=2.0 * own.sphere.E, Sy=2.0 * own.sphere.Sy),
              own.flat.with_(E=2.0 * own.flat.E, Sy=2.0 * own.flat.Sy))  # fmt: skip
    again = nearest(Pair(*bodies, 7.0 * own.R), last=0.01)
    assert again.distance == pytest.approx(0.0, abs=1e-9)
    assert again.pair.R == own.R


def test_a_law_that_is_twice_as_stiff_is_off_by_two():
    reference = nearest(PAIR, last=0.01)
    own = departure(LAWS["fitted"], reference)
    doubled = reference._replace(force=2.0 * reference.force)
    assert departure(LAWS["fitted"], doubled).force == pytest.approx(math.log(2.0), abs=own.force)
    last = reference.depth == reference.depth[-1]
    deep = reference._replace(force=np.where(last, 2.0, 1.0) * reference.force)
    at = reference.depth[-1] / reference.pair.R
    assert departure(LAWS["fitted"], deep).told == f"off by 2 times in force at {at:.2g} R"
    assert Departure(math.log(2.0), 0.0, 0.0).told == "off by 2 times in force"
    assert Departure(0.028, 0.0, 0.01).told == "within 3 %"
    assert Departure(math.nan, 0.0, 0.0).told == "no number"


def test_the_works_of_the_reference_are_those_of_its_curves():
    """Restitution against an integral by hand, of a path that is Hertz's below the first depth."""
    reference = nearest(PAIR, last=0.01)
    depth, left, e = reference.turns[-1]
    assert 0.0 < left < depth
    d = np.linspace(0.0, 1.0, 4000)
    spent = np.trapezoid(LAWS["fitted"].loading(reference.pair, d * depth), d * depth)
    x = left + (depth - left) * d
    back = np.trapezoid(LAWS["fitted"].unloading(reference.pair, x, np.full(4000, depth)), x)
    assert e == pytest.approx(math.sqrt(back / spent), rel=0.02)


def test_below_first_yield_every_law_is_hertz():
    found = compare_laws(PAIR, law=["fitted", "hertz"], max_delta_over_R=1e-5)
    assert found.best == ("hertz",)
    assert found.told("fitted") == "within 1 %"
    assert found.table()[0][3] == "p/Sy_min"
    elastic = compare_laws(
        Pair(Material(E=7e10, nu=0.3), Material(E=2e11, nu=0.3), 1e-3), max_delta_over_R=1e-5
    )
    assert elastic.table()[0][3] == "p/E'"
    assert elastic.best == ("hertz",)
    assert {row[4] for row in elastic.table()[1]} == {"0"}


def test_a_departure_is_told_in_per_cent_then_in_times_then_not_at_all():
    assert Departure(math.log(1.49), 0.0, 0.0).told == "within 49 %"
    assert Departure(0.0, math.log(99.0), 0.0).told == "off by 99 times in dent"
    assert Departure(0.0, 0.0, math.log(101.0)).told == "off by more than 100 times in restitution"
    assert USABLE == 0.1


def test_strengths_more_than_two_and_a_half_apart_are_alike():
    """The stronger body then hardly matters: nor does the pair's distance to a published one."""
    near, far = (Pair(Material(E=7e10, nu=0.33, Sy=s * 3e8), ALUMINIUM, 1e-3) for s in (2.6, 9.0))
    less = Pair(Material(E=7e10, nu=0.33, Sy=2.4 * 3e8), ALUMINIUM, 1e-3)
    assert _groups(near)[1] == _groups(far)[1] == pytest.approx(2.0 * math.log(2.5) / 1.2)
    assert _groups(less)[1] == pytest.approx(2.0 * math.log(2.4) / 1.2)


HARD = Material(E=2e11, nu=0.3, Sy=2e9)
MILD = Material(E=2e11, nu=0.3, Sy=4e8)
PRESSED = Pair(HARD, MILD, 1e-3)


@pytest.mark.parametrize(
    ("speeds", "out"),
    [([1.0] * 6 + [1.8, 2.0], [7]), ([1.0] * 6 + [1.82, 2.0], [6, 7]), ([1.0] * 5 + [2.0], [])],
)
def test_what_is_faster_than_nine_tenths_is_kept_out_where_six_numbers_are_left(speeds, out):
    given = SimpleNamespace(
        conditions=[SimpleNamespace(speed=v) for v in speeds],
        cells=SimpleNamespace(condition=np.arange(len(speeds))),
    )
    assert np.flatnonzero(_kept_out(given)).tolist() == out


@pytest.mark.parametrize(("part", "counts"), [(0.09, False), (0.11, True)])
def test_a_dent_says_something_of_a_law_from_a_tenth_of_the_depth(part, counts) -> None:
    solved = Reference(
        pair=PRESSED, name="a", distance=0.0, depth=np.array([1e-5]), force=np.array([1.0]),
        turns=((1e-5, part * 1e-5, 0.5),), deepest=0.1,
    )  # fmt: skip
    assert (departure(LAWS["fitted"], solved).dent > 0.0) is counts


def test_a_metals_rise_is_that_at_a_strain_of_a_tenth() -> None:
    curve = tabulated(np.array([0.0, 0.1, 0.3]), np.array([4e8, 6e8, 12e8]))
    assert _rise(Material(E=2e11, nu=0.3, Sy=4e8, flow=Flow(curve))) == pytest.approx(math.log(1.5))


def test_a_metal_is_pressed_a_quarter_deeper_than_its_deepest_press() -> None:
    scene = SimpleNamespace(law=None, pair=PRESSED)
    problem = _press(scene, {}, (0.01, 0.02), ())
    assert isinstance(problem, fem.ContactProblem)
    assert max(problem.depths) == pytest.approx(0.025)


def dent(r, z, ball=0.0):
    unloading = SimpleNamespace(
        depth=0.01, residual=1e-5, residual_sphere=ball * 1e-5, residual_flat=(1.0 - ball) * 1e-5,
        curve=SimpleNamespace(
            force=np.array([1000.0]), radius=np.array([3e-4]), delta=np.array([2e-5])
        ),
        crater_r=r, crater_z=z,
    )  # fmt: skip
    loading = SimpleNamespace(delta=np.array([1e-5]), force=np.array([400.0]))
    solution = SimpleNamespace(problem=SimpleNamespace(pair=PRESSED), loading=loading)
    return _dent(solution, unloading)


@pytest.mark.parametrize(("ball", "read"), [(0.049, True), (0.051, False)])
def test_a_dent_has_a_brinell_hardness_where_the_ball_keeps_a_twentieth(ball, read) -> None:
    r = np.linspace(0.0, 1e-3, 20)
    found = dent(r, np.where(r < 5e-4, -1e-5, 0.0), ball)
    assert math.isfinite(found.brinell_by_contact) is read


@pytest.mark.parametrize("top", [3.1e-4, 3.3e-4, 3.5e-4])
def test_the_rim_of_a_dent_lies_between_the_nodes(top) -> None:
    r = np.append(0.0, np.geomspace(1e-4, 1e-3, 20))
    found = dent(r, np.maximum(2e-6 - 200.0 * (r - top) ** 2, -1e-5))
    assert (found.rim_diameter, found.rim_height) == pytest.approx((2.0 * top, 2e-6))


def test_a_solve_beyond_a_flow_curve_is_told() -> None:
    short = Material(2e11, 0.3, 4e8, flow=Flow(tabulated([0.0, 0.1], [4e8, 5e8])))
    last = SimpleNamespace(plastic_strain=np.array([0.2, 0.0, 0.3]), n_sphere_quads=1)
    problem = SimpleNamespace(pair=Pair(HARD, short, 1e-3))
    back = SimpleNamespace(outcome=Outcome(Ending.NOT_CONVERGED, "unloading stopped.", ""))
    solution = SimpleNamespace(problem=problem, snapshots=(last,), unloadings=(back,))
    assert "a strain of 0.1, the contact reaches about 0.3:" in Solved(solution, None).remark
    assert "unloading stopped." in Solved(solution, None).remark


@pytest.mark.parametrize("count", [0, 1, 5, 13, 23, 25, 61])
def test_a_table_that_is_thinned_ends_with_its_last_row(count) -> None:
    shown = thinned(count)
    assert shown == sorted(set(shown))
    assert len(shown) == min(count, 13)
    assert shown[:1] + shown[-1:] == ([0, count - 1] if count else [])


def test_the_inferred_constants_are_those_of_ludwik_and_of_cowper_and_symonds():
    constants = {
        "work-hardening": {"hardening_ratio": 0.8, "hardening_exponent": 0.4},
        "strain-rate-hardening": {"rise_at_1000_per_s": 1.5, "rate_exponent": 0.2},
    }  # fmt: skip
    stated = Pair(HARD, MILD.with_(Sy=300e6), 5e-3)
    pair = _flowing(stated, stated, constants)
    assert pair.sphere is HARD
    # Tabor's strain of a contact of a/R = 0.1
    assert pair.flat.flow.curve(0.02) == pytest.approx(300e6 * (1.0 + 0.8 * 0.02**0.4), rel=1e-4)
    rate = pair.flat.flow.rate
    assert rate.law == "cowper-symonds"
    assert (1000.0 / rate.reference) ** (1.0 / rate.number) == pytest.approx(1.5)


def test_the_clock_stops_where_the_striker_does():
    depth, speed = np.array(_clock(0.02, 3.0)).T
    assert depth[0] == 0.0
    assert depth[-1] == 0.02
    assert speed[0] == 3.0
    assert speed[-1] == pytest.approx(0.3)
    assert np.all(np.diff(speed) <= 0.0)
    # a linear force: half the energy is left at 1/sqrt(2) of the depth
    assert np.interp(0.02 / np.sqrt(2.0), depth, speed) == pytest.approx(
        3.0 / np.sqrt(2.0), rel=0.02
    )


def named(folder, name):
    """What `close` asks of a verdict, without the nulls and rivals that it does not."""
    problem = problem_of(read(folder))
    base = fit(Simulator(problem), ())
    best = fit(Simulator(problem), ([m for m in MECHANISMS if m.name == name]), start=base)
    return verdict_of(best, problem=problem, base=base)


def verdict_of(best, **ranking):
    return SimpleNamespace(name="set", best=best, ranking=SimpleNamespace(**ranking),
                           choice=SimpleNamespace(members=(best,)))  # fmt: skip


@pytest.mark.fe
def test_a_metal_that_hardens_goes_back_to_the_finite_elements(tmp_path):
    """Recordings of the proof's own generator: Voce's law in a row of yielding springs."""
    case = truth.draw(np.random.default_rng([21, 23]), "single", name="work-hardening")
    write_set(case, tmp_path / "set", name="set")
    verdict = named(tmp_path / "set", "work-hardening")
    closed = close(verdict, accuracy=fem.Accuracy.smoke())
    assert len(closed.rows) == len(verdict.ranking.problem.cells)
    # constants from the slower conditions say more of the fastest than no mechanism does
    out = {which: closed.miss(which, kept_out=True) for which in ("baseline", "closed_form")}
    assert out["closed_form"] < 0.7 * out["baseline"]
    # Tabor's strain stands for the strains of the elements: to the closed form's error and smoke's
    for row in closed.rows:
        near = 0.05 if row.observable == "restitution" else 0.12
        assert row.finite_elements == pytest.approx(row.closed_form, abs=near), row
    told = "\n".join(closed_lines(closed))
    assert "kept out: baseline" in told
    csv, law = write_closed(closed, tmp_path)
    assert len(csv.read_text().splitlines()) == len(closed.rows) + 1
    assert law.name == "law.json"


def test_what_the_finite_elements_do_not_carry_is_refused():
    best = SimpleNamespace(mechanisms=(SimpleNamespace(name="tilt"),), names=("tilt",))
    with pytest.raises(InputError, match="names tilt"):
        close(verdict_of(best, problem=None))
