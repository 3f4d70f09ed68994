"""Tuned numbers of the impact stage where they act, in cases that are worked out by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Scene, Striker, strike
from dentscope.dynamics.beam import rod_modes
from dentscope.dynamics.files.bodies import flowing
from dentscope.dynamics.force import loading_window
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.dynamics.mechanisms.base import Surroundings
from dentscope.dynamics.mechanisms.rod_vibration import axial_modes
from dentscope.dynamics.mechanisms.roughness import Layer
from dentscope.dynamics.mechanisms.strength.strain_rate_hardening import risen
from dentscope.dynamics.report.band import _shifted, _sizes, band_of, last_blow
from dentscope.dynamics.strength import strength_table
from dentscope.dynamics.surface import Imprint, Spot, beside
from dentscope.models import LAWS
from made_blows import ball_setup
from made_files import put

HARD = Material(E=2e11, nu=0.3, Sy=2e9, density=7800.0)
STEEL = Material(E=2e11, nu=0.3, Sy=4e8, density=7800.0)
OF = {m.name: m for m in MECHANISMS}


ROD = Scene(
    LAWS["fitted"], Pair(HARD, STEEL, 5e-3), Striker(0.2, 5e-3, length=0.3, radius=5e-3),
    Approach(1.0),
)  # fmt: skip


def scene(*, law="fitted", ball=HARD, flat=STEEL, radius=5e-3, mass=4e-3, speed=2.0, **more):
    return Scene(
        LAWS[law], Pair(ball, flat, radius), Striker(mass, radius), Approach(speed), **more
    )


def setup(**changed):
    """An elastic ball with numbers changed: `ball` and `target` hold keys of their tables."""
    body = {"E_Pa": 2e11, "nu": 0.3, "density_kg_m3": 7800}
    return ball_setup(**{name: body | changed.get(name, {}) for name in ("target", "ball")})


def test_hertz_is_right_to_three_thousandths_and_what_a_ball_adds():
    """At one energy, (2/5) k delta^(5/2), the largest force goes as k^(2/5); half is the ball's."""
    found = band_of(setup(), LAWS["hertz"]).parts["contact law"]["peak_force_N"]
    blow = last_blow(setup(), LAWS["hertz"])
    x = math.sqrt(blow.peak_depth_m / 5e-3)
    error = 0.003 + 0.5 * x * (0.45 + 1.2 * x)
    assert found / blow.peak_force_N == pytest.approx(0.4 * error, rel=1e-3)


def test_no_law_is_off_by_more_than_a_logarithm_of_one():
    known = SimpleNamespace(
        force=np.array([5.0]), radius=np.array([5.0]), dent=np.array([5.0]),
        given_back=np.array([math.nan]), share=np.array([5.0]),
    )  # fmt: skip
    law = SimpleNamespace(name="mine", uncertainty=lambda pair, depth: known)
    at = SimpleNamespace(
        energetic_restitution=0.5, peak_depth_m=1e-5, residual_flat_m=1e-6, residual_sphere_m=0.0
    )
    found, _ = _sizes(SimpleNamespace(pair=scene().pair, law=law), at)
    assert (found.force, found.recovery, found.crater, found.radius, found.share) == (1.0,) * 5


@pytest.mark.parametrize(("std", "share"), [(0.04, 1.0), (0.06, 0.5), (0.15, 0.25), (0.4, 0.1)])
def test_of_a_deviation_that_leaves_the_range_a_part_is_taken(std, share):
    """A Poisson's ratio of 0.45 may grow by a ninth: share std/0.45 is at most ln(10/9)."""
    given = setup(target={"nu": {"value": 0.45, "std": std}})
    assert [one[1] for one in _shifted(given, LAWS["hertz"])] == [share]


def test_slopes_are_differences_over_a_ten_thousandth_of_the_depth():
    assert loading_window(1.0) == pytest.approx((1.0 - 1e-4, 1.0 + 1e-4), abs=1e-12)


def test_a_table_of_strengths_has_twenty_nodes_to_a_factor_of_ten():
    """From a millionth of the radius to all of it: 120 steps over 6 ln 10."""
    depth = strength_table(LAWS["fitted"], scene().pair).depth
    assert depth[20] / depth[0] == pytest.approx(10.0)


def test_the_work_of_a_table_is_two_fifths_of_hertzs_force_times_depth():
    table = strength_table(LAWS["hertz"], Pair(HARD, STEEL, 5e-3))
    force = LAWS["hertz"].loading(table.pair, table.depth)
    assert table.work == pytest.approx(0.4 * force * table.depth, rel=1e-9)
    assert table.peak(float(table.work[20])) == pytest.approx(table.depth[20], rel=1e-9)


def test_the_wall_of_a_crater_is_three_tenths_of_its_radius_wide_at_the_least():
    steep = Imprint(0.0, 0.0, -1e-5, 1e-5, 0.0, 1e-6, 1e-5, 1e-4, 0.5)
    row = Spot(imprints=(steep,)).row()
    assert beside(row, 5, 2e-5) == pytest.approx((2e-5, 0.3e-4, 1.0))


@pytest.mark.parametrize(("off", "own"), [(5e-4, True), (2e-3, False)])
def test_a_strength_at_which_its_curve_begins_is_that_of_the_curve(tmp_path, off, own):
    """Beside another strength the curve is scaled to reach it at a plastic strain of 0.2 %."""
    put(tmp_path / "curve.csv", "plastic_strain,true_stress_Pa\n0,3e8\n0.004,4e8\n0.1,5e8\n")
    table = SimpleNamespace(flow_curve="curve.csv")
    metal = flowing(
        Material(E=2e11, nu=0.3, Sy=3e8 * (1.0 + off)), table, "target",
        source=str(tmp_path / "a.toml"),
    )  # fmt: skip
    # 350 MPa at 0.2 %, taken as 300
    assert metal.Sy == pytest.approx(3e8 if own else 3e8 * (1.0 + off) * 300.0 / 350.0, rel=1e-3)


def test_a_rod_rings_in_six_lengthwise_modes_and_loses_a_thousandth():
    found = axial_modes(0.3, STEEL, 0.2)
    c = math.sqrt(2e11 / 7800.0)
    assert found.frequencies == pytest.approx([k * math.pi * c / 0.3 for k in range(1, 7)])
    assert found.loss_factor == 0.001


def test_a_leaning_rod_rings_in_nine_modes():
    bent = OF["rod-flexural-vibration"].modes(ROD.striker, HARD)
    assert bent.frequencies == rod_modes(
        0.3, 5e-3, HARD, mass=0.2, count=9, loss_factor=bent.loss_factor
    ).frequencies  # fmt: skip


def test_a_rod_of_more_than_3000_radii_has_no_modes():
    assert rod_modes(29.0, 0.01, STEEL, mass=1.0, count=1).frequencies
    with pytest.raises(ValueError, match="3000 radii"):
        rod_modes(31.0, 0.01, STEEL, mass=1.0, count=1)


def _drag(density):
    """What keeps drag from acting on a ball of 5 mm that strikes with 2 m/s."""
    around = Surroundings(density=density, viscosity=1e-12, fluid="oil")
    return OF["air-drag"].applies([(scene(), around)])


def test_drag_matters_from_a_2000th_of_a_speed_to_four_fifths():
    """Turbulent: the share taken goes as the density; the limits are met in its proportion."""
    thin = 1e-9
    while "takes at most" in _drag(thin):
        thin *= 1.1
    assert float(_drag(thin / 1.1).split("at most ")[1].split(" ")[0]) == pytest.approx(
        5e-4, rel=0.12
    )
    thick = thin
    while not _drag(thick):
        thick *= 1.1
    assert int(_drag(thick).split("takes ")[1].split("%")[0]) in range(80, 88)


def test_an_upright_rod_leans_by_half_a_degree_to_five():
    [lean] = OF["tilt"].ranges([(ROD, Surroundings())])
    assert (lean.low, lean.high) == (0.5, 5.0)


def test_what_asperities_give_back_alone_is_the_work_of_a_power_of_five_quarters():
    """Work F h/(1 + 5/4) of a recovery over h; a layer that gives back w adds (9/4) w/F to h."""
    table = strength_table(LAWS["hertz"], Pair(HARD, HARD, 5e-3))
    force, recovered = np.exp(table.stated.force), np.exp(table.stated.recovery)
    sigma, start = 1e-9, 1.0
    layer = Layer.of(table, sigma, start, 0.0)
    k = 30
    scale = float(np.exp(np.interp(math.log(sigma), table.log_depth, table.stated.force)))
    turns = math.log1p(force[k] / scale)
    given = sigma * (force[k] - scale * turns)
    depth = table.depth[k] + sigma * turns
    back = np.interp(
        math.log(depth), table.log_depth, np.log(layer.recovery * recovered)
    )  # fmt: skip
    # the layer is a ten thousandth of the depth here: what it adds is seen in the difference
    assert math.exp(back) - recovered[k] == pytest.approx(2.25 * given / force[k], rel=0.05)


def test_at_the_turn_the_rate_is_a_fifth_of_that_at_the_touch():
    """1 + A (r/1000)^n with n = 1: r = 0.4 v/a at the touch, 0.08 v/a where the work is spent."""
    given = scene(speed=3.0)
    table = strength_table(given.law, given.pair)
    strength = risen(given, table, 0.01, 1.0)
    rate = (strength - 1.0) * 1e5
    assert rate[0] * table.radius[0] == pytest.approx(0.4 * 3.0, rel=1e-6)
    turn = math.log(table.peak(0.5 * 4e-3 * 3.0**2, strength))
    assert np.interp(turn, table.log_depth, rate * table.radius) == pytest.approx(0.24, rel=0.01)
    assert np.all(np.diff(rate * table.radius) <= 0.0)


@pytest.mark.parametrize("name", ["strain-rate-hardening", "work-hardening", "hardened-layer"])
def test_over_the_speed_a_stronger_metals_restitution_falls_and_is_at_most_one(name):
    """From first yield on: no place of a node of the table is seen."""
    values = {p.name: p.value(0.6) for p in OF[name].parameters}
    seen = np.array([
        strike(OF[name].attach(scene(speed=v), values, Surroundings())).restitution
        for v in np.geomspace(0.005, 8.0, 120)
    ])  # fmt: skip
    assert seen.max() < 1.0 + 2e-5
    assert np.all(np.diff(seen) < 3e-5)
    falls = -np.diff(seen)[30:]
    assert np.max(np.abs(np.diff(falls))) < 0.15 * falls.max()


@pytest.mark.parametrize(("speed", "acts"), [(0.5, True), (8.0, False)])
def test_size_matters_below_three_tenths_of_a_millimetre(speed, acts):
    rig = [(scene(speed=speed, radius=r), Surroundings()) for r in (5e-3, 8e-3)]
    given = rig[0][0]
    table = strength_table(given.law, given.pair)
    depth = table.peak(0.5 * 4e-3 * speed**2)
    smallest = float(np.interp(math.log(depth), table.log_depth, table.radius))
    assert (smallest < 3e-4) is acts
    assert (OF["size-effect"].applies(rig) == "") is acts


def test_a_published_law_without_a_radius_over_some_depths_has_a_table() -> None:
    """Two metals a millionth of their modulus strong: below 0 by the formula near first yield."""
    pair = Pair(Material(E=7e10, nu=0.0008, Sy=7e4), Material(E=2e11, nu=3e-7, Sy=2e5), 2.3e-4)
    table = strength_table(LAWS["ghaednia"], pair)
    raw = np.asarray(LAWS["ghaednia"].contact_radius(pair, table.depth))
    known = raw > 0.0
    assert not known.all()
    np.testing.assert_allclose(table.radius[known], raw[known], rtol=1e-12)
    assert np.isfinite(table.factors(np.full(len(table.depth), 1.5))).all()
