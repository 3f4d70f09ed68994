"""The stress update at one point: yield surface, objectivity, path error, tangent."""

import numpy as np
import pytest
from dentscope.fem.material import EXACT, RADIAL, exponential, log_strain
from dentscope.studies.verification.material_point import IDENTITY, MaterialPoint
from scipy.integrate import solve_ivp
from scipy.linalg import logm, polar

G, RADIUS = 0.4, 0.004


def norm(e):
    return np.sqrt(e[0] ** 2 + e[1] ** 2 + e[3] ** 2 + 2.0 * e[2] ** 2)


def path(t):
    """A strongly bent deformation path."""
    return np.array(
        [
            1.0 + 0.15 * t * np.cos(2.0 * t),
            0.4 * np.sin(3.0 * t) * t,
            0.2 * t * t,
            1.0 - 0.1 * t + 0.06 * np.sin(4.0 * t) ** 2,
            1.0 + 0.05 * np.sin(5.0 * t),
        ]
    )


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
    P, A = here.stress(F), here.tangent(F)
    direction = np.array([0.2, 0.5, -0.3, 0.1, 0.4])
    steps = min(amplitude, 1.0) * np.array([4e-3, 2e-3, 1e-3])
    remainder = [
        np.abs(here.stress(F + h * direction) - P - h * A @ direction).max() for h in steps
    ]
    slope = np.log2(np.array(remainder[:-1]) / remainder[1:])
    assert slope == pytest.approx(2.0, abs=0.1)
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
