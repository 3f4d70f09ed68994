"""What earlier touches left; tips that are finite, worn or flat; friction higher at rest."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.dynamics import Approach, Scene, Settings, Striker, rod_modes, strike, traced
from dentscope.dynamics import surface as su
from dentscope.dynamics.inverse import mobility
from dentscope.dynamics.scene import ForceTransform, Friction, Instrument, scene_of
from dentscope.dynamics.surface import Imprint, Spot
from dentscope.models import LAWS
from dentscope.models.published.hertz import HERTZ
from dentscope.models.published.jackson_green import JACKSON_GREEN
from made_scenes import IRON, ROD, STEEL, on_iron

TIGHT = Settings(tolerance=1e-9)


def crater(radius: float, a: float, give: float) -> Imprint:
    """A spherical crater of radius R/(1 - q) about x = 0, as a tip of radius R leaves it."""
    depth = a * a * (1.0 - give) / (2.0 * radius)
    return Imprint(0.0, 0.0, -a, a, 0.0, depth, 2.0 * depth, a, give)


def test_a_sphere_in_a_crater_sinks_as_geometry_has_it() -> None:
    """The lowest point of a sphere that rests on a parabolic crater, by brute force."""
    R, a = 0.01, 1e-3
    for give in (0.1, 0.4, 0.8):
        row = Spot(imprints=(crater(R, a, give),)).row()
        depth = a * a * (1.0 - give) / (2.0 * R)
        u = np.linspace(-2.0 * a, 2.0 * a, 400_001)
        for x in np.array([0.0, 0.05, 0.3, 0.7, 0.95, 1.2]) * a:
            metal = depth * np.maximum(1.0 - ((x + u) / a) ** 2, 0.0)
            touches = (metal + u * u / (2.0 * R)).min()
            assert su.height(row, 1.0, x)[0] == pytest.approx(touches, abs=1e-6 * depth)


def test_height_has_the_slope_that_it_states() -> None:
    marks = (
        crater(0.01, 1e-3, 0.2),
        Imprint(4e-4, 7e-4, -5e-4, 1.5e-3, 5e-4, 2e-5, 5e-5, 9e-4, 0.3),
    )
    row = Spot(imprints=marks).row()
    for x in np.linspace(-1.2e-3, 1.8e-3, 61):
        (low, _), (high, _) = su.height(row, 2.0, x - 1e-9), su.height(row, 2.0, x + 1e-9)
        assert su.height(row, 2.0, x)[1] == pytest.approx((high - low) / 2e-9, abs=1e-4)
        assert abs(su.height(row, 2.0, x)[1]) <= su.roughest(row, 2.0)[0]


def test_more_imprints_than_are_kept_apart_never_raise_the_surface() -> None:
    row = Spot().row()
    rng = np.random.default_rng(3)
    for _ in range(3 * su.MOST):
        x, before = rng.uniform(0.0, 4e-3), row.copy()
        mark = np.array([x, x, x - 8e-4, x + 8e-4, x, 1e-6, 1e-5, 8e-4, 0.2])
        row[su.STANDING] = row[su.COUNT]
        su.press(row, mark)
        su.leave(row, x + 2e-5)
        assert row[su.COUNT] <= su.MOST
        for place in np.linspace(-1e-3, 5e-3, 50):
            after = su.height(row, row[su.COUNT], place)[0]
            assert after >= su.height(before, before[su.COUNT], place)[0] - 1e-18


def rod(angle: float, speed: float, mu: float, **seams: object) -> Scene:
    approach = Approach(speed, math.radians(angle))
    return on_iron(LAWS["fitted"], approach=approach, friction=Friction(mu), **seams)


def ball(law: object = JACKSON_GREEN) -> Scene:
    striker, instrument = Striker(mass=0.03, tip_radius=0.01), Instrument(scan_height=2e-8)
    return on_iron(law, striker=striker, gravity=0.0, instrument=instrument)


@pytest.mark.parametrize("law", [JACKSON_GREEN, LAWS["fitted"]], ids=lambda law: law.name)
def test_a_second_touch_fades_from_the_old_peak_to_fresh_metal(law: object) -> None:
    """0 to 2 a in 50 steps: dent, scar and rebound without a jump, both ends exact."""
    scene = ball(law)
    first = strike(scene, TIGHT)
    a = first.spot.imprints[0].radius

    def again(s):
        impact = strike(scene.with_(spot=first.spot.shifted(float(s))), TIGHT)
        assert impact.outcome.completed
        dent, scar = impact.residual_flat_m / first.residual_flat_m, impact.scar_length_m / a
        return dent, scar, impact.restitution

    found = [again(s) for s in np.linspace(0.0, 2.0 * a, 51)]
    # s = 0: together both blows end where one of the same energy ends.
    total = math.sqrt(2.0 - first.restitution**2)
    single = strike(scene.with_(approach=Approach(total)), TIGHT)
    assert found[0][0] * first.residual_flat_m == pytest.approx(single.residual_flat_m, rel=1e-6)
    assert found[0][2] == pytest.approx(single.restitution * total, rel=1e-6)
    # s = 2 a: fresh metal, and a scar as long as both dents side by side.
    fresh = strike(scene.with_(spot=Spot(first.spot.tip_peak, first.spot.tip_flat)), TIGHT)
    assert found[-1][2] == pytest.approx(fresh.restitution, rel=1e-9)
    assert found[-1][0] == pytest.approx(1.0, rel=1e-3)
    assert found[-1][1] == pytest.approx(2.0 + fresh.scar_length_m / a, rel=1e-2)
    steps = np.abs(np.diff(np.array(found), axis=0)).max(axis=0)
    assert np.all(steps < [0.15, 0.1, 0.06])
    # twice as fine, steps half as large: it is continuous and not only small
    fine = [again(s)[::2] for s in np.linspace(0.0, 0.4 * a, 21)]
    finer = np.abs(np.diff(np.array(fine), axis=0)).max(axis=0)
    assert np.all(finer < 0.75 * steps[[0, 2]])


@pytest.mark.parametrize(
    ("angle", "speed", "mu", "slide", "excess"),
    [(20.0, 1.41, 0.20, 29e-6, 1e-6), (45.0, 2.18, 0.13, 107e-6, 3e-6),
     (70.0, 3.45, 0.10, 179e-6, 8e-6)],
)  # fmt: skip
def test_scar_of_the_rigid_rod(angle, speed, mu, slide, excess):
    """An independent simulation of the thesis's three impacts, within the scan's 3 um."""
    scene = rod(angle, speed, mu)
    stiffer = replace(scene.pair, sphere=STEEL.with_(E=212e9))
    impact = strike(scene.with_(pair=stiffer))
    assert impact.contacts == 1
    assert impact.sliding_length_m == pytest.approx(slide, abs=3e-6)
    assert impact.scar_excess_m == pytest.approx(excess, abs=3e-6)
    assert impact.scar_excess_m == impact.scar_length_m - impact.scar_width_m


def test_scar_is_the_union_of_the_circles_of_contact() -> None:
    """The edge of the contact along the written history, loading and recovery."""
    scene = rod(70.0, 3.45, 0.1)
    trace = traced(scene, points=2000)
    x, depth = trace.column("place_m"), trace.column("penetration_m")
    mark = trace.impact.spot.imprints[0]
    k = int(np.argmax(depth))
    a = scene.law.contact_radius(scene.pair, np.maximum(depth, 0.0))
    rest = trace.impact.residual_m
    a[k:] = a[k] * np.sqrt(np.maximum(depth[k:] - rest, 0.0) / (depth[k] - rest))
    assert mark.first == pytest.approx(float((x - a).min()), abs=1e-6)
    assert mark.last == pytest.approx(float((x + a).max()), abs=1e-6)


def test_a_shallow_dent_is_no_scar() -> None:
    polished = Instrument(scan_height=0.4e-6)
    impact = strike(ball().with_(approach=Approach(0.01), instrument=polished))
    assert 0.0 < impact.residual_flat_m < polished.scan_height
    assert impact.scar_length_m == impact.scar_width_m == 0.0


def test_no_bending_rod_falls_through_the_flat() -> None:
    """15 to 80 degrees, 0.5 to 4 m/s: 52 of these 224 once ended with negative restitution."""
    modes = rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=20)
    repeats = 0
    for angle in np.linspace(15.0, 80.0, 14):
        for speed in np.geomspace(0.5, 4.0, 8):
            for mu in (0.1, 0.2):
                impact = strike(rod(angle, speed, mu, modes=modes), Settings(tolerance=1e-7))
                assert impact.outcome.completed
                assert impact.restitution > 0.0
                assert impact.clearance_m > -1e-9
                assert impact.clearance_rate_m_s > 0.0
                repeats += impact.contacts > 1
    assert repeats > 100


def test_rounding_at_rest_does_not_decide_which_way_friction_acts() -> None:
    """The point rests for an instant, slips on, and is back at rest within one step."""
    modes = rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=4)
    for speed in (1.5, 1.50000015):
        scene = rod(40.0, speed, 0.13, modes=modes)
        coarse, fine = (strike(scene, Settings(tolerance=x)) for x in (1e-8, 1e-12))
        assert coarse.contacts == fine.contacts == 4
        assert coarse.restitution == pytest.approx(fine.restitution, abs=1e-6)


def test_named_sinks_add_up() -> None:
    """All that comes in is still there or lost to something with a name."""
    modes = rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=6, loss_factor=0.02)
    impact = strike(rod(50.0, 1.0, 0.15, modes=modes), TIGHT)
    came = impact.kinetic_before_J + impact.gravity_work_J
    left = impact.kinetic_after_J + impact.modal_stored_J + impact.support_stored_J
    lost = (
        impact.plastic_work_J + impact.damping_work_J + impact.radiated_J
        + impact.friction_work_J + impact.structural_loss_J + impact.support_loss_J
    )  # fmt: skip
    assert came == pytest.approx(left + lost, rel=1e-7)
    assert min(impact.plastic_work_J, impact.friction_work_J, impact.structural_loss_J) > 0.0
    assert impact.momentum_residual < 1e-9
    assert impact.angular_residual < 1e-9


def test_history_is_that_of_the_impact() -> None:
    """Rows end where the impact ends, and no row shows force without depth or the reverse."""
    modes = rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=8)
    scene = rod(40.0, 1.5, 0.1, modes=modes)
    trace, alone = traced(scene, TIGHT), strike(scene, TIGHT)
    assert trace.impact.contacts == alone.contacts > 1
    assert trace.impact.restitution == pytest.approx(alone.restitution, rel=1e-7)
    force, gap = trace.column("normal_force_N"), trace.column("clearance_m")
    assert force.max() == pytest.approx(alone.peak_force_N, rel=1e-3)
    assert gap[force == 0.0].min() > -1e-9
    assert gap[force > 0.0].max() < 1e-12
    time = trace.column("time_s")
    assert np.all(np.diff(time) >= 0.0)
    impulse = float(np.trapezoid(force, time))
    assert impulse == pytest.approx(alone.normal_impulse_Ns, rel=1e-3)


ELASTIC = Material(E=200e9, nu=0.3, density=7800.0)
MASS, RADIUS = 0.1, 0.2
TIGHTER = Settings(tolerance=1e-10)


def blunt(speed: float, *, edge: float = math.inf, flat: float = 0.0, **others: object) -> Scene:
    """A rod's blunt end: tip radius 0.2 m, upright."""
    return scene_of(
        HERTZ, sphere=ELASTIC, flat=ELASTIC,
        striker=Striker(mass=MASS, tip_radius=RADIUS, length=0.3, radius=0.005,
                        tip_flat_radius=flat),
        approach=Approach(speed), gravity=0.0, force=ForceTransform(edge=edge), **others,
    )  # fmt: skip


def test_edge_that_is_not_reached_changes_nothing() -> None:
    ours, plain = strike(blunt(0.1, edge=0.005)), strike(blunt(0.1))
    np.testing.assert_array_equal(list(ours.observables.values()), list(plain.observables.values()))


def test_beyond_the_edge_the_tip_is_a_flat_punch() -> None:
    """Sneddon 1965: dF/d delta = 2 E' b once the contact fills the end; the energy gives depth."""
    b, speed = 0.002, 4.0
    scene = blunt(speed, edge=b)
    E, energy = scene.pair.E_reduced, 0.5 * MASS * speed**2
    start = b * b / RADIUS
    force = 4.0 / 3.0 * E * math.sqrt(RADIUS) * start**1.5
    left = energy - 0.4 * force * start
    assert left > 0.0
    further = (-force + math.sqrt(force**2 + 4.0 * E * b * left)) / (2.0 * E * b)
    impact = strike(scene, TIGHTER)
    assert impact.peak_depth_m == pytest.approx(start + further, rel=1e-7)
    assert impact.peak_force_N == pytest.approx(force + 2.0 * E * b * further, rel=1e-7)


@pytest.mark.parametrize(
    ("tip_strength", "pressure"),
    [(760e6, 760e6), (2e9, 5.69 / math.sqrt(3.0) * 305e6)],
    ids=["the rod yields", "the flat yields"],
)
def test_edge_has_a_plastic_limit(tip_strength: float, pressure: float) -> None:
    """The rod's yield force, or a punch's (5.69/sqrt 3) Sy on the flat, whichever is less."""
    scene = on_iron(
        HERTZ, sphere=STEEL.with_(Sy=tip_strength),
        striker=Striker(mass=MASS, tip_radius=RADIUS, length=0.3, radius=0.005),
        approach=Approach(10.0), gravity=0.0, force=ForceTransform(edge=0.002),
    )  # fmt: skip
    limit = pressure * math.pi * 0.002**2
    assert strike(scene).peak_force_N == pytest.approx(limit, rel=1e-9)


def test_flat_on_the_tip_makes_a_linear_spring() -> None:
    """F = 2 E' b delta while the flat alone carries: half a period of contact, e = 1."""
    b = 0.002
    scene = blunt(1e-3, flat=b)
    impact = strike(scene, TIGHTER)
    stiffness = 2.0 * scene.pair.E_reduced * b
    half = math.pi * math.sqrt(MASS / stiffness)
    assert impact.contact_time_s == pytest.approx(half, rel=1e-4)
    assert impact.restitution == pytest.approx(1.0, abs=1e-8)
    assert impact.peak_force_N == pytest.approx(1e-3 * math.sqrt(MASS * stiffness), rel=1e-4)


def test_flattened_tip_of_one_trial_is_the_tip_of_the_next() -> None:
    """Three blows on fresh places: the flat carries v sqrt(1 + (1 - e^2) ...) as one blow does."""
    ball = Striker(mass=0.03, tip_radius=0.01)
    scene = on_iron(JACKSON_GREEN, sphere=IRON, flat=STEEL, striker=ball, gravity=0.0)
    spot, kept, given = Spot(), [], 0.0
    for _ in range(3):
        impact = strike(scene.with_(spot=spot))
        kept.append(impact.residual_sphere_m)
        # elsewhere on the flat: only what the tip keeps is carried on
        spot = Spot(impact.spot.tip_peak, impact.spot.tip_flat)
        given += 1.0 - impact.restitution**2
    assert kept[0] < kept[1] < kept[2]
    # What the metal took up in all is what one blow of the same energy takes up: v^2 = the sum of
    # all losses and the last rebound.
    last = impact.restitution
    single = strike(scene.with_(approach=Approach(math.sqrt(given + last**2))))
    assert kept[2] == pytest.approx(single.residual_sphere_m, rel=1e-6)


@pytest.mark.parametrize("angle", [45.0, 70.0])
def test_friction_at_rest_holds_what_sliding_friction_could_not(angle: float) -> None:
    """A tip that lands without sliding stays if mu_static exceeds c s/(I/m + s^2) (audit)."""
    critical = mobility(ROD, math.radians(angle)).stick_friction
    assert 0.2 < critical < 0.62

    def impact(friction: Friction) -> object:
        approach = Approach(0.5, math.radians(angle))
        return strike(
            on_iron(HERTZ, sphere=ELASTIC, flat=ELASTIC, friction=friction, gravity=0.0,
                    approach=approach)
        )  # fmt: skip

    held = impact(Friction(0.1, mu_static=1.1 * critical, speed=1e-4))
    assert held.stuck
    assert held.friction_impulse_ratio == pytest.approx(critical, rel=0.01)
    assert held.sliding_length_m == pytest.approx(0.0, abs=1e-12)
    # A little less, and it slides off with the lower coefficient.
    slid = impact(Friction(0.1, mu_static=0.9 * critical, speed=1e-4))
    assert slid.friction_impulse_ratio == pytest.approx(0.1, rel=0.05)
    assert slid.sliding_length_m > 0.0
