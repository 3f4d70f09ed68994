"""Whole solves against exact solutions, and the balances that every solve must keep."""

import dataclasses
import time

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import InputError, Material, Pair
from dentscope.core.flow import Flow, Rate, swift
from dentscope.fem.rules import RULES
from dentscope.studies.verification.checks.friction import stuck_ratios

pytestmark = pytest.mark.fe

STEEL = Material(E=200e9, nu=0.3)
ALUMINIUM = Material(E=71.7e9, nu=0.33)
RIGID = Material(E=np.nan, nu=np.nan, rigid=True)


def hertz(pair, delta):
    """F and a of Hertz (Johnson, Contact Mechanics, Eqs. 4.22-4.24)."""
    return 4.0 / 3.0 * pair.E_reduced * np.sqrt(pair.R) * delta**1.5, np.sqrt(pair.R * delta)


def solved(pair, depths, accuracy=fem.Accuracy.smoke, **asked):
    solution = fem.solve(fem.ContactProblem(pair, depths, **asked), accuracy=accuracy())
    assert solution.outcome.completed, str(solution.outcome)
    return solution


@pytest.mark.parametrize(
    ("sphere", "flat"),
    [(STEEL, STEEL), (ALUMINIUM, STEEL), (STEEL, RIGID), (RIGID, STEEL)],
    ids=["equal", "unequal", "rigid flat", "rigid sphere"],
)
def test_elastic_contact_follows_hertz(sphere, flat):
    pair = Pair(sphere=sphere, flat=flat, R=5e-3)
    # a rigid partner doubles the finite sphere's part: the limit of 1 % is then reached earlier
    deepest = 2e-4 if flat.rigid or sphere.rigid else 4e-4
    depths = fem.geometric_depths(1e-5, deepest, 8)
    c = solved(pair, depths, fem.Accuracy.quick).loading
    force, radius = hertz(pair, c.delta)
    assert radius.max() / pair.R <= 0.02
    assert c.force == pytest.approx(force, rel=0.01)
    assert c.radius == pytest.approx(radius, rel=0.01)
    # Eq. 2.3: the elastic share is E'(1 - nu_s^2)/E_s
    if not flat.rigid:
        expected = pair.elastic_share
        assert c.sphere_share == pytest.approx(np.full(8, expected), abs=0.01)


def test_published_force_of_a_light_contact_is_free_of_bias():
    """At a/R = 0.001 the finite sphere adds 0.03 % to Hertz's force."""
    pair = Pair(sphere=STEEL, flat=STEEL, R=5e-3)
    depths = (1e-6, 1.7e-6, 3e-6)
    c = solved(pair, depths, fem.Accuracy.production).loading
    force, radius = hertz(pair, c.delta)
    assert abs(np.mean(c.force / force) - 1.0) < 1e-3
    assert abs(np.mean(c.radius / radius) - 1.0) < 2e-3


def plastic_pair(scale=1.0, radius=1e-3):
    body = Material(E=200e9 * scale, nu=0.3, Sy=503e6 * scale)
    return Pair(body, body, radius)


@pytest.fixture(scope="module")
def equal_strengths():
    depths = fem.geometric_depths(4e-5, 0.01, 24)
    return solved(plastic_pair(), depths, unload_from=(depths[12], 0.01), reload=True)


def test_identical_bodies_share_the_approach_equally_before_yield(equal_strengths):
    c = equal_strengths.loading
    elastic = c.delta / 1e-3 < plastic_pair().first_yield
    assert elastic.sum() >= 3
    assert c.sphere_share[elastic] == pytest.approx(np.full(elastic.sum(), 0.5), abs=0.002)


def test_balances(equal_strengths):
    c = equal_strengths.loading
    assert np.abs(c.energy_defect).max() < 0.01
    assert np.abs(c.force_defect[c.delta / 1e-3 >= 1e-3]).max() < RULES.residual
    assert np.all(np.diff(c.dissipated) >= 0.0)
    assert np.all(np.diff(c.force) > 0.0)


def test_unloading_ends_force_free_in_few_steps(equal_strengths):
    first, second = equal_strengths.unloadings
    for unloading in (first, second):
        assert unloading.outcome.completed
        assert unloading.steps <= 40
        assert unloading.curve.force[-1] < 0.005 * unloading.curve.force[0]
        assert 0.0 < unloading.residual < unloading.depth * 1e-3
        # what is recovered lies between a flat punch's F/(2 E' a) and Hertz's 3/2 of it
        start = unloading.curve
        punch = start.force[0] / (2.0 * plastic_pair().E_reduced * start.radius[0])
        recovered = unloading.depth * 1e-3 - unloading.residual
        assert punch < recovered < 1.5 * punch
    assert second.residual > first.residual


def test_a_reload_meets_the_loading_curve(equal_strengths):
    for unloading in equal_strengths.unloadings:
        again, start = unloading.reload, unloading.curve
        assert again.delta[-1] == pytest.approx(start.delta[0], rel=1e-12)
        assert again.force[-1] == pytest.approx(start.force[0], rel=5e-3)
        assert np.all(np.diff(again.force) > 0.0)


def test_holding_the_top_face_changes_little():
    """Saint-Venant: the face is one radius away from a contact of a/R = 0.03."""
    force = [
        solved(plastic_pair(), (2e-4, 1e-3), top=top).loading.force[-1] for top in ("free", "held")
    ]
    assert force[0] < force[1] < 1.005 * force[0]


def test_mean_pressure_lies_where_slip_line_theory_and_indentation_tests_put_it(equal_strengths):
    """Tabor's and Ishlinskii's range for full plasticity is 2.6 to 2.9 Sy; ripple 3 %."""
    c = equal_strengths.loading
    assert 2.4 < c.hardness[-1] / 503e6 < 3.2


def test_units_do_not_matter(equal_strengths):
    depths = tuple(equal_strengths.loading.delta[:6] / 1e-3)
    other = solved(plastic_pair(scale=1e-3, radius=7.0), depths).loading
    plain = equal_strengths.loading
    assert other.force / (1e-3 * 7000.0**2) == pytest.approx(plain.force[:6], rel=2e-3)
    assert other.sphere_share == pytest.approx(plain.sphere_share[:6], abs=1e-4)


def flowing_pair(scale=1.0, radius=1e-3, hurry=1.0, **parts):
    flow = Flow(
        curve=parts.get("curve", swift(Sy=503e6 * scale, K=900e6 * scale, n=0.2)),
        rate=Rate("cowper-symonds", 4e4 * hurry * 1e-3 / radius, 5.0) if hurry else None,
    )
    plain = plastic_pair(scale, radius)
    return dataclasses.replace(plain, flat=plain.flat.with_(flow=flow))


def test_a_metal_that_hardens_and_feels_the_rate_keeps_its_balances(equal_strengths):
    depths = fem.geometric_depths(4e-5, 0.004, 12)
    c = equal_strengths.loading
    soft = float(np.interp(0.004, c.delta / 1e-3, c.sphere_share))
    slow = solved(flowing_pair(hurry=0.0), depths, unload_from=(0.004,))
    fast = solved(flowing_pair(), depths, speeds=((0.0, 8.0), (0.004, 2.0)), unload_from=(0.004,))
    # the flat alone has become harder: the sphere gives way
    shares = [soft, *(float(s.loading.sphere_share[-1]) for s in (slow, fast))]
    assert shares[0] + 0.01 < shares[1] < shares[2] - 0.1, shares
    for solution in (slow, fast):
        c = solution.loading
        assert np.abs(c.energy_defect).max() < 0.012
        assert np.abs(c.force_defect[c.delta / 1e-3 >= 1e-3]).max() < RULES.residual
        assert np.all(np.diff(c.dissipated) >= 0.0)
        assert solution.unloadings[0].outcome.completed


def test_rates_count_in_units_of_speed_over_radius():
    depths = fem.geometric_depths(4e-5, 1e-3, 5)
    one = solved(flowing_pair(), depths, speeds=((0.0, 8.0),)).loading
    half = flowing_pair(scale=1e-3, radius=7.0, hurry=0.5)
    other = solved(half, depths, speeds=((0.0, 4.0),)).loading
    assert other.force / (1e-3 * 7000.0**2) == pytest.approx(one.force, rel=2e-3)


def test_what_cannot_converge_is_a_result_with_a_reason():
    accuracy = dataclasses.replace(fem.Accuracy.smoke(), penalty=1e9)
    solution = fem.solve(
        fem.ContactProblem(plastic_pair(), (1e-4, 2e-4), unload_from=()), accuracy=accuracy
    )
    assert not solution.outcome.completed
    assert "no equilibrium" in solution.outcome.message
    assert solution.outcome.advice


def test_time_limit_keeps_what_was_reached(monkeypatch):
    clock, lost = time.perf_counter, [0.0]
    monkeypatch.setattr(time, "perf_counter", lambda: clock() + lost[0])

    def late(done):
        lost[0] = 1e6 if done > 0.15 else 0.0

    solution = fem.solve(
        fem.ContactProblem(plastic_pair(), (1e-5, 2e-5, 0.04)),
        accuracy=fem.Accuracy.smoke(),
        progress=late,
        time_limit_s=1e5,
    )
    assert solution.outcome.ending.value == "time-limit"
    assert 1 <= len(solution.loading.delta) < 3


@pytest.mark.parametrize("depths", [(), (0.02, 0.01), (0.1, 0.6), (-1.0,)])
def test_impossible_depths_are_refused(depths):
    with pytest.raises(InputError, match="depths"):
        fem.ContactProblem(plastic_pair(), depths)


def test_a_contact_in_which_nothing_slides_is_stiffer_and_smaller():
    """Borodich and Keer (2004): F/F_0 = 1.0529, a/a_0 = 0.9584 at nu = 0."""
    pair = Pair(sphere=RIGID, flat=Material(E=200e9, nu=0.0), R=5e-3)
    depths = fem.geometric_depths(1e-5, 1e-4, 12)
    free, held = (
        solved(pair, depths, fem.Accuracy.quick, friction=mu).loading for mu in (0.0, 20.0)
    )
    later = slice(6, None)  # the first equilibrium slides freely
    force, radius = stuck_ratios(0.0)
    assert (held.force / free.force)[later].mean() == pytest.approx(force, rel=0.005)
    assert (held.radius / free.radius)[later].mean() == pytest.approx(radius, rel=0.005)


def test_friction_keeps_the_balances_through_loading_and_unloading():
    pair = Pair(sphere=plastic_pair().sphere, flat=RIGID, R=1e-3)
    depths = fem.geometric_depths(1e-3, 0.01, 12)
    solution = solved(pair, depths, friction=0.05, unload_from=(0.01,))
    assert solution.unloadings[0].outcome.completed
    # at this mesh; which steps fail decides by a tenth of it
    assert np.abs(solution.loading.energy_defect).max() < 0.02
    assert np.abs(solution.loading.force_defect).max() < RULES.residual
