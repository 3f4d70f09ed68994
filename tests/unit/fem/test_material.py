"""Stress updates at one point, flow stress of strain, rate and heat: exact paths, tangents."""

import math

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.core.flow import Flow, Heating, Rate, ludwik, swift, tabulated, voce
from dentscope.fem.material import EXACT, RADIAL, exponential, log_strain
from dentscope.studies.verification.material_point import IDENTITY, MaterialPoint, stretched
from scipy.integrate import solve_ivp
from scipy.linalg import logm, polar

G, RADIUS = 0.4, 0.004


def norm(e):
    return np.sqrt(e[0] ** 2 + e[1] ** 2 + e[3] ** 2 + 2.0 * e[2] ** 2)


def path(t):
    """A strongly bent deformation path."""
    return np.array(
        [1.0 + 0.15 * t * np.cos(2.0 * t), 0.4 * np.sin(3.0 * t) * t, 0.2 * t * t,
         1.0 - 0.1 * t + 0.06 * np.sin(4.0 * t) ** 2, 1.0 + 0.05 * np.sin(5.0 * t)]
    )  # fmt: skip


def taylor_slope(here, F, step):
    """Order in which the remainder of stress and tangent falls, from four steps to one."""
    P, A = here.stress(F), here.tangent(F)
    direction = np.array([0.2, 0.5, -0.3, 0.1, 0.4])
    remainder = [
        np.abs(here.stress(F + h * direction) - P - h * A @ direction).max()
        for h in (4.0 * step, 2.0 * step, step)
    ]
    return np.log2(np.array(remainder[:-1]) / remainder[1:])


def point(rule=EXACT):
    return MaterialPoint(G, radius=RADIUS, rule=rule)


def follow(steps, rule):
    here = point(rule)
    for i in range(1, steps + 1):
        done = here.walk(path(i / steps))
    return done.e


def full(f):
    return np.array([[f[0], f[1], 0.0], [f[2], f[3], 0.0], [0.0, 0.0, f[4]]])


def by_the_flow_rule(F, F_old, b_old, e_old):
    """Elastic strain after a step by the flow rule itself, in matrices.

    The old point turns with the step, then de/ds = d - (rate of flow) e; on the circle the flow
    keeps it there.
    """
    f = full(F) @ np.linalg.inv(full(F_old))
    turn, _ = polar(f[:2, :2])
    Q = np.eye(3)
    Q[:2, :2] = turn
    b = np.array([[b_old[0], b_old[2], 0.0], [b_old[2], b_old[1], 0.0], [0.0, 0.0, b_old[3]]])
    e = np.array([[e_old[0], e_old[2], 0.0], [e_old[2], e_old[1], 0.0], [0.0, 0.0, e_old[3]]])
    trial = 0.5 * logm(f @ b @ f.T)
    mean = np.trace(trial) / 3.0
    start = Q @ e @ Q.T
    d = trial - mean * np.eye(3) - start
    R = RADIUS * np.exp(3.0 * mean)
    along, rest = np.sum(start * d), np.sum(start**2) - R * R
    t = (-along + np.sqrt(along**2 - np.sum(d * d) * rest)) / np.sum(d * d)
    if t >= 1.0:
        return start + d

    def flow(_, x):
        x = x.reshape(3, 3)
        return (d - np.sum(x * d) / np.sum(x * x) * x).ravel()

    begun = start + max(t, 0.0) * d
    found = solve_ivp(flow, (max(t, 0.0), 1.0), begun.ravel(), rtol=1e-11, atol=1e-15)
    return found.y[:, -1].reshape(3, 3)


def test_a_step_solves_the_flow_rule_for_a_constant_increment():
    """By the differential equation, in matrices and their logarithm: nothing is shared."""
    here = point()
    for k in range(1, 9):
        F = path(k / 8)
        e = by_the_flow_rule(F, *here._last)
        done = here.walk(F)
        wanted = [e[0, 0], e[1, 1], e[0, 1], e[2, 2]]
        # the circle of the step has the radius of its end, where the old point may lie outside
        assert done.e / norm(done.e) == pytest.approx(np.array(wanted) / norm(wanted), abs=2e-4)
        if k == 1:
            assert done.e == pytest.approx(wanted, abs=1e-9 * RADIUS)


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
def test_plastic_stress_lies_on_the_yield_surface(rule):
    F = path(0.7)
    done = point(rule).walk(F)
    assert done.flows
    assert done.slip > 0.0
    J = (F[0] * F[3] - F[1] * F[2]) * F[4]
    assert norm(done.e) == pytest.approx(RADIUS * J, rel=1e-10)
    assert np.exp(3.0 * done.mean) == pytest.approx(J, rel=1e-12)
    assert done.e[0] + done.e[1] + done.e[3] == pytest.approx(0.0, abs=1e-15)


def test_pure_volume_change_has_no_deviator():
    done = point().walk(1.02 * IDENTITY)
    assert not done.flows
    assert norm(done.e) < 1e-15


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
def test_a_rotation_of_the_body_rotates_the_stress(rule):
    angle = 0.8
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    F = path(0.6)
    turned = np.append((Q @ F[:4].reshape(2, 2)).ravel(), F[4])
    e, r = (point(rule).walk(x).e for x in (F, turned))
    plain = np.array([[e[0], e[2]], [e[2], e[1]]])
    rotated = np.array([[r[0], r[2]], [r[2], r[1]]])
    assert rotated == pytest.approx(Q @ plain @ Q.T, abs=1e-10 * RADIUS)
    assert r[3] == pytest.approx(e[3], rel=1e-10)


def test_logarithm_and_exponential_are_inverse():
    e, m = (0.01, -0.02, 0.005, 0.01), 0.003
    d, mean = log_strain(exponential(e, m))
    assert d == pytest.approx(e, abs=1e-15)
    assert mean == pytest.approx(m, abs=1e-15)


@pytest.mark.parametrize("stretch", [1.0 + 1e-9, 1.2, 1.6, 4.0])
def test_the_strain_is_the_logarithm_of_the_stretch(stretch):
    """Near one by a series, far from it by the logarithm."""
    done = MaterialPoint(G).walk(np.array([1.0, 0.0, 0.0, stretch, 1.0]))
    assert done.mean == pytest.approx(np.log(stretch) / 3.0, rel=1e-13)
    assert done.e[1] == pytest.approx(2.0 * np.log(stretch) / 3.0, rel=1e-13)


def test_exact_update_is_second_order_in_the_path_and_radial_return_first():
    reference = follow(6000, EXACT)
    error = {
        rule: [np.abs(follow(n, rule) - reference).max() for n in (80, 160, 320)]
        for rule in (RADIAL, EXACT)
    }
    order = {rule: np.log2(np.array(e[:-1]) / e[1:]) for rule, e in error.items()}
    assert order[RADIAL] == pytest.approx(1.0, abs=0.1)
    assert order[EXACT] == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
@pytest.mark.parametrize("amplitude", [1e-4, 0.3, 4.0])
def test_tangent_is_the_derivative_of_the_stress(amplitude, rule):
    F = IDENTITY + amplitude * np.array([0.3, -0.2, 0.5, -0.1, 0.1])
    here = point(rule)
    step = 1e-3 * min(amplitude, 1.0)
    assert taylor_slope(here, F, step) == pytest.approx(2.0, abs=0.1)
    assert here.walk(F).flows == (amplitude > 0.01)


@pytest.mark.parametrize("off", [0.0, 1e-13, -1e-13, 1e-9])
def test_a_circle_that_is_only_touched_leaves_the_tangent_finite(off):
    """Square to the old point the slope of the way out is round-off, which is not divided by."""
    old = np.array([1.0, -1.0, 0.0, 0.0]) * RADIUS / np.sqrt(2.0) * (1.0 + off)
    here = point()
    here.rest(IDENTITY, np.array(exponential(old, 0.0)), old)
    shear = np.array([1.0, 3e-3, 0.0, 1.0, 1.0])
    assert here.walk(shear, stay=True).flows
    assert np.abs(here.tangent(shear)).max() < 20.0 * G


E, NU, SY = 200e9, 0.3, 400e6
SHEAR = E / (2.0 * (1.0 + NU))

SECONDS = 1e-3

CURVES = {
    "swift": swift(Sy=SY, K=900e6, n=0.2),
    "ludwik": ludwik(Sy=SY, K=500e6, n=0.5),
    "voce": voce(Sy=SY, Q=300e6, b=12.0),
    "table": tabulated(np.array([0.0, 0.02, 0.1, 0.4]), np.array([400e6, 480e6, 560e6, 620e6])),
}
RATES = {
    "cowper-symonds": Rate("cowper-symonds", 40.0, 5.0),
    "johnson-cook": Rate("johnson-cook", 1.0, 0.03),
    "overstress": Rate("overstress", 10.0, 0.5, 50e6),
}
HOT = Heating(0.9, 3.6e6, 1200.0, 1.03)
FLOWS = {
    **{name: Flow(curve) for name, curve in CURVES.items()},
    **{name: Flow(rate=rate) for name, rate in RATES.items()},
    "hot": Flow(CURVES["swift"], heating=HOT),
    "johnson-cook, all of it": Flow(CURVES["ludwik"], RATES["johnson-cook"], HOT),
    "all": Flow(CURVES["voce"], RATES["cowper-symonds"], HOT),
}


def Point(flow, *, rule=EXACT, seconds=SECONDS):
    return MaterialPoint.of(Material(E, NU, SY, flow=flow), seconds=seconds, rule=rule)


LAWS = {
    "swift": lambda p: 900e6 * ((SY / 900e6) ** 5.0 + p) ** 0.2,
    "ludwik": lambda p: SY + 500e6 * math.sqrt(p),
    "voce": lambda p: SY + 300e6 * (1.0 - math.exp(-12.0 * p)),
    "none": lambda p: SY,
}
FACTORS = {
    "cowper-symonds": lambda rate: 1.0 + (rate / 40.0) ** 0.2,
    "johnson-cook": lambda rate: 1.0 + 0.03 * math.log(rate),
    "none": lambda rate: 1.0,
}


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
@pytest.mark.parametrize("hardening", LAWS)
@pytest.mark.parametrize("rate", [*FACTORS, "overstress"])
def test_tension_at_a_constant_rate_of_plastic_strain_is_exact(rule, hardening, rate):
    """Where p = r t the stress is sigma(p) f(r) whatever the steps: strain p + stress/(3 G)."""
    point = Point(Flow(CURVES.get(hardening), RATES.get(rate)), rule=rule)
    speed = 30.0
    for k in range(1, 40):
        p = speed * SECONDS * k
        more = 50e6 * math.sqrt(3.0) if rate == "overstress" else 0.0
        stress = LAWS[hardening](p) * FACTORS.get(rate, FACTORS["none"])(speed) + more
        done = point.walk(stretched(p + stress / (3.0 * SHEAR)))
        assert point.mises(done) == pytest.approx(stress, rel=1e-6)
        assert point.strain == pytest.approx(p, rel=1e-6)


def test_heat_of_an_adiabatic_tension_follows_the_exact_solution():
    """sigma = S (1 - T/D) and dT = b sigma dp: T = D (1 - exp(-b S p/D)), perfectly plastic."""
    point = Point(Flow(heating=Heating(0.9, 3.6e6, 500.0)))
    strain = np.linspace(0.0, 1.0, 400)[1:]
    for value in strain:
        done = point.walk(stretched(value))
    p = point.strain
    assert point.mises(done) == pytest.approx(
        SY * math.exp(-0.9 * SY * p / (3.6e6 * 500.0)), rel=1e-5
    )


def test_a_slow_step_feels_no_rate():
    fast, slow = Point(FLOWS["cowper-symonds"]), Point(FLOWS["cowper-symonds"], seconds=math.inf)
    assert slow.mises(slow.walk(stretched(0.01))) == pytest.approx(SY, rel=1e-12)
    assert fast.mises(fast.walk(stretched(0.01))) > 1.3 * SY


def test_a_stress_that_is_held_relaxes_exponentially():
    """Overstress V r/r0: it decays over the time V/(3 G r0)."""
    relaxation = 50e6 / (3.0 * SHEAR * 10.0)
    point = Point(Flow(rate=Rate("overstress", 10.0, 1.0, 50e6)), seconds=relaxation / 200)
    before = point.mises(point.walk(stretched(0.004))) - SY
    for _ in range(200):
        done = point.walk(stretched(0.004))
    assert (point.mises(done) - SY) / before == pytest.approx(math.exp(-1.0), rel=0.005)


@pytest.mark.parametrize("name", FLOWS)
def test_tangent_with_a_flow_is_the_derivative_of_the_stress(name):
    for rule, old in ((RADIAL, 0.5), (EXACT, 0.5), (EXACT, 0.0)):
        point = Point(FLOWS[name], rule=rule)
        if old:
            for t in np.linspace(0.0, old, 20)[1:]:
                point.walk(path(t))
        F = path(old + 0.03)
        assert point.walk(F, stay=True).flows
        assert taylor_slope(point, F, 1e-4) == pytest.approx(2.0, abs=0.1), (rule, old)


@pytest.mark.parametrize("name", ["swift", "voce", "overstress"])
def test_exact_update_is_second_order_in_a_bent_path(name):
    def end(steps):
        point = Point(FLOWS[name], seconds=1.0 / steps)
        for k in range(1, steps + 1):
            done = point.walk(path(0.7 * k / steps))
        return np.array(done.e)

    reference = end(3200)
    error = [np.abs(end(n) - reference).max() for n in (50, 100, 200)]
    order = np.log2(np.array(error[:-1]) / error[1:])
    assert (order > (0.9 if name == "overstress" else 1.8)).all(), order


def test_a_law_that_changes_nothing_is_perfect_plasticity():
    flat = tabulated(np.array([0.0, 1.0]), np.array([SY, SY]))
    hard = Point(Flow(flat))
    plain = MaterialPoint(SHEAR / E, radius=math.sqrt(2.0 / 3.0) * SY / (2.0 * SHEAR))
    for t in np.linspace(0.0, 0.7, 200)[1:]:
        done, same = hard.walk(path(t)), plain.walk(path(t))
    assert done.e == pytest.approx(same.e, rel=2e-4, abs=1e-6)


def test_a_written_law_runs_between_its_rows_as_written():
    for strain in np.geomspace(2e-6, 5.0, 37):
        for name in ("swift", "ludwik", "voce"):
            assert CURVES[name](strain) == pytest.approx(LAWS[name](strain), rel=2e-7)
    assert CURVES["table"](0.1) == pytest.approx(560e6)
    assert CURVES["table"](3.0) == 620e6


@pytest.mark.parametrize("n", [1e-4, 1e-3, 0.02, 0.2, 1.0])
def test_swifts_curve_begins_at_the_strength_and_never_overshoots(n):
    # an exponent near 0 takes the strain before to 0, and the slope there to infinity
    curve = swift(Sy=SY, K=900e6, n=n)
    strain = np.linspace(0.0, 3e-6, 301)
    stress = np.array([curve(p) for p in strain])
    assert stress[0] == pytest.approx(SY, rel=1e-12)
    assert (np.diff(stress) >= 0.0).all()
    assert stress[-1] <= 900e6 * ((SY / 900e6) ** (1.0 / n) + 3e-6) ** n * 1.001
