"""Contact laws judged by finite elements of the published pair nearest to one's own."""

import math

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow, tabulated
from dentscope.dynamics.report.onset import first_yield
from dentscope.models import LAWS, critical_depth
from dentscope.start.comparison import compare_laws
from dentscope.start.judged import USABLE, Departure, _groups, departure, nearest

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
    e = [
        strike(
            scene_of(LAWS[name], sphere=ALUMINIUM, flat=STEEL, striker=ball, approach=Approach(1.0))
        ).restitution
        for name in found.best
    ]
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
