"""The stress update at one point: yield surface, objectivity, path error, tangent."""

import numpy as np
import pytest
from dentscope.fem.material import (
    EXACT,
    NO_LAW,
    RADIAL,
    MaterialStep,
    deviatoric_pk1,
    deviatoric_tangent,
    elastic_deviator,
    exponential,
    log_strain,
)

G, RADIUS = 0.4, 0.004
IDENTITY = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
UNSTRAINED = np.array([1.0, 1.0, 0.0, 1.0])
NO_STRAIN = np.zeros(4)
NO_CURVE = np.empty((3, 0))


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


def first_step(F, rule=EXACT):
    return MaterialStep(F, IDENTITY, UNSTRAINED, NO_STRAIN, RADIUS, rule, False, NO_LAW)


def follow(steps, rule):
    step = first_step(IDENTITY, rule)
    for i in range(1, steps + 1):
        F = path(i / steps)
        e, m, *_ = elastic_deviator(step._replace(F=F), NO_CURVE)
        step = step._replace(F_old=F, b_old=np.array(exponential(e, m)), e_old=np.array(e))
    return np.array(e)


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
def test_plastic_stress_lies_on_the_yield_surface(rule):
    F = path(0.7)
    (e0, e1, e2, e3), m, plastic, slip, _ = elastic_deviator(first_step(F, rule), NO_CURVE)
    assert plastic
    assert slip > 0.0
    J = (F[0] * F[3] - F[1] * F[2]) * F[4]
    assert norm((e0, e1, e2, e3)) == pytest.approx(RADIUS * J, rel=1e-10)
    assert np.exp(3.0 * m) == pytest.approx(J, rel=1e-12)
    assert e0 + e1 + e3 == pytest.approx(0.0, abs=1e-15)


def test_pure_volume_change_has_no_deviator():
    F = 1.02 * IDENTITY
    e, _, plastic, *_ = elastic_deviator(first_step(F), NO_CURVE)
    assert not plastic
    assert norm(e) < 1e-15


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
def test_a_rotation_of_the_body_rotates_the_stress(rule):
    angle = 0.8
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    F = path(0.6)
    turned = np.append((Q @ F[:4].reshape(2, 2)).ravel(), F[4])
    e, *_ = elastic_deviator(first_step(F, rule), NO_CURVE)
    r, *_ = elastic_deviator(first_step(turned, rule), NO_CURVE)
    plain = np.array([[e[0], e[2]], [e[2], e[1]]])
    rotated = np.array([[r[0], r[2]], [r[2], r[1]]])
    assert rotated == pytest.approx(Q @ plain @ Q.T, abs=1e-10 * RADIUS)
    assert r[3] == pytest.approx(e[3], rel=1e-10)


def test_logarithm_and_exponential_are_inverse():
    e, m = (0.01, -0.02, 0.005, 0.01), 0.003
    d, mean = log_strain(exponential(e, m))
    assert d == pytest.approx(e, abs=1e-15)
    assert mean == pytest.approx(m, abs=1e-15)


def test_exact_update_is_second_order_in_the_path_and_radial_return_first():
    reference = follow(6000, EXACT)
    error = {
        rule: [np.abs(follow(n, rule) - reference).max() for n in (80, 160, 320)]
        for rule in (RADIAL, EXACT)
    }
    order = {rule: np.log2(np.array(e[:-1]) / e[1:]) for rule, e in error.items()}
    assert order[RADIAL] == pytest.approx(1.0, abs=0.1)
    assert order[EXACT] == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("amplitude", [1e-4, 0.3])
def test_tangent_is_the_derivative_of_the_stress(amplitude):
    F = IDENTITY + amplitude * np.array([0.3, -0.2, 0.5, -0.4, 0.1])
    P, A = np.empty(5), np.empty((5, 5))
    plastic = deviatoric_pk1(first_step(F), NO_CURVE, G, P)
    deviatoric_tangent(first_step(F), NO_CURVE, G, P, A)
    direction = np.array([0.2, 0.5, -0.3, 0.1, 0.4])
    remainder = []
    steps = amplitude * np.array([4e-3, 2e-3, 1e-3])
    for h in steps:
        new = np.empty(5)
        deviatoric_pk1(first_step(F + h * direction), NO_CURVE, G, new)
        remainder.append(np.abs(new - P - h * A @ direction).max())
    slope = np.log2(np.array(remainder[:-1]) / remainder[1:])
    assert slope == pytest.approx(2.0, abs=0.1)
    assert bool(plastic) == (amplitude > 0.01)
