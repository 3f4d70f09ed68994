"""Rod modes against exact solutions: Timoshenko's frequency equation, Sears's wave solution."""

import math

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.dynamics import Approach, Modes, Settings, Striker, scene_of, strike, traced
from dentscope.dynamics.beam import axial_frequencies, bending_modes, shear_coefficient
from dentscope.dynamics.mechanisms.base import Surroundings
from dentscope.dynamics.mechanisms.half_space_waves import HalfSpaceWaves
from dentscope.dynamics.scene import ForceTransform
from dentscope.dynamics.support import half_space_radiation, plate_support, radiated_shares
from dentscope.models import LAWS
from dentscope.models.published.hertz import HERTZ
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

STEEL = Material(E=200e9, nu=0.3, density=7800.0)
LENGTH, RADIUS = 0.3048, 0.0088


def timoshenko_frequencies(count: int) -> list[float]:
    """Roots of the free-free frequency equation in its symmetric and antisymmetric halves.

    From the general solution of Timoshenko's equations for harmonic motion: w = A cosh(px) +
    B cos(qx) (or sinh, sin), with the moment EI psi' and the shear force kGA (w' - psi) zero at
    x = L/2 (Timoshenko 1921; Traill-Nash and Collar 1953).
    """
    area, second = math.pi * RADIUS**2, math.pi * RADIUS**4 / 4.0
    EI = STEEL.E * second
    kGA = shear_coefficient(STEEL.nu) * STEEL.E / (2.0 * (1.0 + STEEL.nu)) * area
    m, j = STEEL.density * area, STEEL.density * second

    def determinant(w: float, even: bool) -> float:
        b = m * w * w / kGA + j * w * w / EI
        c = m * w * w / EI * (j * w * w / kGA - 1.0)
        root = math.sqrt(b * b / 4.0 - c)
        p, q = math.sqrt(root - b / 2.0), math.sqrt(root + b / 2.0)
        gp, gq = p + m * w * w / (kGA * p), -(q - m * w * w / (kGA * q))
        x = LENGTH / 2.0
        # Even: w = cosh, cos; psi = gp sinh, gq sin. Odd: w = sinh, sin; psi = gp cosh, -gq cos.
        tanh, tan = math.tanh(p * x), math.tan(q * x)
        if even:
            moment, shear = (gp * p, gq * q), ((p - gp) * tanh, (-q - gq) * tan)
        else:
            moment, shear = (gp * p * tanh, gq * q * tan), ((p - gp), (q + gq))
        return moment[0] * shear[1] - moment[1] * shear[0]

    found = []
    for even in (True, False):
        grid = 2.0 * math.pi * np.arange(200.0, 60e3, 25.0)
        values = [determinant(w, even) for w in grid]
        for lo, hi, f, g in zip(grid, grid[1:], values, values[1:], strict=False):
            # A pole of the tangent also changes the sign; there the values are large.
            if f * g < 0.0:
                w = brentq(determinant, lo, hi, args=(even,), xtol=1e-9)
                if abs(determinant(w, even)) < 1e-3 * min(abs(f), abs(g)):
                    found.append(w)
    return sorted(found)[:count]


def test_bending_frequencies_solve_timoshenkos_equation() -> None:
    ours = bending_modes(LENGTH, RADIUS, STEEL, count=8)[0]
    np.testing.assert_allclose(ours, timoshenko_frequencies(8), rtol=1e-6)


def test_bending_modes_converge() -> None:
    coarse = bending_modes(LENGTH, RADIUS, STEEL, count=10, degree=24)
    fine = bending_modes(LENGTH, RADIUS, STEEL, count=10, degree=40)
    np.testing.assert_allclose(coarse[0], fine[0], rtol=1e-5)
    np.testing.assert_allclose(np.abs(coarse[1]), np.abs(fine[1]), rtol=1e-4)


def test_slender_rod_has_the_frequency_of_euler_and_bernoulli() -> None:
    thin = bending_modes(1.0, 1e-3, STEEL, count=1)[0][0]
    c = math.sqrt(STEEL.E / STEEL.density)
    assert thin == pytest.approx(4.730040745**2 * c * 0.5e-3, rel=1e-4)


def sears(v: float, K: float) -> tuple[float, float, float]:
    """Peak force, contact time and impulse of a free rod on a Hertz tip, by d'Alembert's waves.

    delta' = v - F/Z - (2/Z) sum F(t - 2 n L/c), Z = rho c A (Sears 1908).
    """
    c = math.sqrt(STEEL.E / STEEL.density)
    Z, trip = STEEL.density * c * math.pi * RADIUS**2, 2.0 * LENGTH / c
    n = 4000
    dt = trip / n
    force, depth = [0.0], 0.0
    while True:
        i = len(force) - 1

        def echo(k: int) -> float:
            return sum(2.0 * force[k - j * n] for j in range(1, k // n + 1))

        def rate(d: float, k: int) -> float:
            return v - (K * max(d, 0.0) ** 1.5 + echo(k)) / Z

        k1 = rate(depth, i)
        k2 = rate(depth + dt * k1, i + 1)
        depth += 0.5 * dt * (k1 + k2)
        if depth <= 0.0:
            break
        force.append(K * depth**1.5)
    return max(force), len(force) * dt, float(np.trapezoid(force, dx=dt))


def met(striker, law=HERTZ, *, sphere=STEEL, flat=STEEL, speed=1.0, **seams):
    seams = {"gravity": 0.0, "approach": Approach(speed), **seams}
    return scene_of(law, sphere=sphere, flat=flat, striker=striker, **seams)


WAVES = ForceTransform(radiation=half_space_radiation(STEEL))


@pytest.mark.parametrize("tip_radius", [0.0088, 0.2])
def test_axial_waves_agree_with_sears(tip_radius: float) -> None:
    """A soft tip and a near-rigid one (R = 0.2 m: contact of one wave's round trip)."""
    mass = STEEL.density * math.pi * RADIUS**2 * LENGTH
    count = 40
    zero = (0.0,) * count
    modes = Modes(
        tuple(axial_frequencies(LENGTH, STEEL, count=count)),
        (math.sqrt(2.0 / mass),) * count, zero, zero,
    )  # fmt: skip
    scene = met(
        Striker(mass=mass, tip_radius=tip_radius, length=LENGTH, radius=RADIUS),
        speed=2.0, modes=modes,
    )  # fmt: skip
    impact = strike(scene, Settings(tolerance=1e-7))
    K = 4.0 / 3.0 * scene.pair.E_reduced * math.sqrt(tip_radius)
    peak, time, impulse = sears(2.0, K)
    assert impact.peak_force_N == pytest.approx(peak, rel=0.02)
    assert impact.contact_time_s == pytest.approx(time, rel=0.02)
    assert impact.normal_impulse_Ns == pytest.approx(impulse, rel=0.02)
    assert abs(impact.energy_residual) < 1e-6


def sphere(**seams):
    """A ball of 10 mm at 1 m/s."""
    mass = 4.0 / 3.0 * math.pi * 0.01**3 * STEEL.density
    return met(Striker(mass=mass, tip_radius=0.01), **seams)


def test_plate_loss_solves_zeners_equation() -> None:
    """Zener 1941: sigma'' + (1 + lambda d/dtau) sigma^(3/2) = 0, e = -sigma'(end)."""
    support = plate_support(STEEL, thickness=0.008)
    scene = sphere(support=support)
    m, K = scene.striker.mass, 4.0 / 3.0 * scene.pair.E_reduced * math.sqrt(0.01)
    tau = (m / K) ** 0.4  # time unit at unit speed: T v^(1/5)
    lam = m / tau * support.plate_mobility

    def rhs(_t: float, y: np.ndarray) -> list[float]:
        f = max(y[0], 0.0) ** 1.5
        slope = 1.5 * math.sqrt(max(y[0], 0.0)) * y[1]
        return [y[1], -f - lam * slope]

    def end(_t: float, y: np.ndarray) -> float:
        return float(y[0]) if _t > 0.5 else 1.0

    end.terminal = True
    sol = solve_ivp(rhs, (0.0, 20.0), [0.0, 1.0], events=end, rtol=1e-10, atol=1e-12)
    # sigma' is the rate of approach of both surfaces; the sphere's own speed has the plate's gone
    # when the force is zero, so that it is the restitution.
    assert strike(scene).restitution == pytest.approx(-sol.y[1, -1], abs=1e-6)
    assert -sol.y[1, -1] < 0.9


def test_half_space_takes_hunters_share() -> None:
    """Hunter 1957: share of the energy 1.04 (v/c0)^(3/5) for steel on steel."""
    body, rayleigh = radiated_shares(0.25)
    # Miller and Pursey 1955: compression, shear and Rayleigh waves carry 6.9, 25.8, 67.4 %.
    assert rayleigh / (body + rayleigh) == pytest.approx(0.674, abs=0.001)
    impact = strike(sphere(force=WAVES))
    c0 = math.sqrt(STEEL.E / STEEL.density)
    assert 1.0 - impact.restitution**2 == pytest.approx(1.04 * (1.0 / c0) ** 0.6, rel=0.1)
    # the force ends where the waves would pull: they take no more than the metal gives
    assert abs(impact.energy_residual) < 1e-9


def test_waves_beneath_a_plate_that_gives_way_take_energy_and_give_none() -> None:
    """A plate that runs ahead of the sphere ends the indentation: what waves take ends there."""
    scene = met(
        Striker(mass=0.0041, tip_radius=0.005), LAWS["fitted"], sphere=STEEL.with_(Sy=1.2e9),
        flat=STEEL.with_(Sy=4e8), speed=20.0, support=plate_support(STEEL, thickness=0.001),
        force=WAVES,
    )  # fmt: skip
    impact = strike(scene)
    assert impact.radiated_J > 0.0
    assert abs(impact.energy_residual) < 1e-8


def test_waves_of_a_plate_that_gives_way_go_by_the_rate_that_it_leaves() -> None:
    """F exceeds Hertz's by kappa (dF/d(depth))^2 d', d' that of both surfaces together."""
    kappa, support = 200.0 * WAVES.radiation, plate_support(STEEL, thickness=0.004)
    scene = sphere(support=support, force=ForceTransform(radiation=kappa))
    trace = traced(scene, points=4000)
    t, once = np.unique(trace.column("time_s"), return_index=True)
    depth, force = (trace.column(name)[once] for name in ("penetration_m", "normal_force_N"))
    K = 4.0 / 3.0 * scene.pair.E_reduced * math.sqrt(0.01)
    down = (t < t[np.argmax(depth)]) & (depth > 0.2 * depth.max()) & (depth < 0.9 * depth.max())
    waves = force - K * depth**1.5
    expected = kappa * (1.5 * K) ** 2 * depth * np.gradient(depth, t)
    assert waves[down] == pytest.approx(expected[down], rel=0.01)
    assert waves[down].min() > 0.01 * force.max()


@pytest.mark.parametrize(("share", "back"), [(0.1, 1.0), (0.575, 1.0 / math.pi), (1.0, 0.0)])
def test_a_plate_bends_as_far_as_its_wave_is_back_within_the_contact(share, back) -> None:
    """From 0.15 of the contact to all of it a half-sine of force meets itself, later by the way."""
    scene = sphere()
    K = 4.0 / 3.0 * scene.pair.E_reduced * math.sqrt(0.01)
    contact = 2.943 * (1.25 * scene.striker.mass / K) ** 0.4
    h = 0.5 * share * contact * math.sqrt(0.7 / (1.3 * 0.4) * STEEL.E / STEEL.density)
    found = HalfSpaceWaves().attach(scene, {"wave_scale": 1.0}, Surroundings(thickness=h))
    whole = plate_support(STEEL, thickness=h).plate_mobility
    assert found.support.plate_mobility / whole == pytest.approx(back, abs=2e-3)


def test_a_growing_dent_sends_waves_by_the_slope_of_its_own_force() -> None:
    """F exceeds the law's by kappa (dF/d(depth))^2 d', with the law's exact derivative."""
    law, kappa = LAWS["fitted"], half_space_radiation(STEEL)
    scene = met(
        Striker(mass=0.024, tip_radius=0.009), law, sphere=STEEL.with_(Sy=2e9),
        flat=STEEL.with_(Sy=3e8), gravity=9.81, force=WAVES,
    )  # fmt: skip
    trace = traced(scene, points=200)
    depth, force = trace.column("penetration_m"), trace.column("normal_force_N")
    rate = np.abs(trace.column("normal_velocity_m_s"))
    down = np.arange(len(depth)) < int(np.argmax(depth))
    down &= (depth > 0.1 * depth.max()) & (depth < 0.9 * depth.max())
    extra = force[down] - law.loading(scene.pair, depth[down])
    slope = law.gradient(scene.pair, depth[down])["depth"]
    assert down.sum() > 10
    assert extra == pytest.approx(kappa * slope**2 * rate[down], rel=1e-4)
    elastic = 2.0 * scene.pair.E_reduced * law.contact_radius(scene.pair, depth[down])
    assert slope[-1] < 0.5 * elastic[-1]  # a dent is softer than the contact is elastically
    assert strike(scene).restitution == pytest.approx(trace.impact.restitution, abs=1e-6)
