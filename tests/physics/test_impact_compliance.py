"""Tangential compliance against Maw, Barber and Fawcett, and against measured spins."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.core.rig import value_of
from dentscope.dynamics import Approach, Friction, Scene, Striker, scene_of, strike
from dentscope.dynamics.files.bodies import bodies_of
from dentscope.models.published.hertz import HERTZ
from dentscope.recordings import read

STEEL = Material(E=200e9, nu=0.3, density=7800.0)
MU = 0.1
RATIO = 2.0 * (1.0 - 0.3) / (2.0 - 0.3)
"""Mindlin 1949: tangential over normal stiffness of like bodies."""
CHI = RATIO * 3.5 / 2.0
"""chi of a solid sphere, (1 - nu)(1 + 1/K^2)/(2 - nu) with K^2 = 2/5."""


def sphere(psi: float, *, mu: float = MU, stiffness: float = RATIO) -> Scene:
    """A sphere at the local angle of incidence psi = (k_t/k_n) v_t / (mu v_n)."""
    return scene_of(
        HERTZ, sphere=STEEL, flat=STEEL, striker=Striker(mass=0.03, tip_radius=0.01),
        approach=Approach(1.0, tangential=psi * mu / stiffness), gravity=0.0,
        friction=Friction(mu, stiffness=stiffness),
    )  # fmt: skip


def reflected(psi: float) -> float:
    return strike(sphere(psi)).tangential_restitution * psi


def test_small_angles_are_linear() -> None:
    """While nothing slips all is in proportion: Maw, Barber and Fawcett 1976, psi < 1."""
    ratio = [strike(sphere(p)).friction_impulse_ratio / MU for p in (0.2, 0.4)]
    assert ratio[1] == pytest.approx(2.0 * ratio[0], rel=0.1)


def test_gross_slip_of_large_angles_is_the_rigid_bodys() -> None:
    """psi_2 = psi_1 - 4 chi when it slips throughout, for psi_1 > 4 chi - 1 = 4.76 (1976)."""
    for psi in (4.0 * CHI - 0.8, 4.0 * CHI, 4.0 * CHI + 2.0):
        assert reflected(psi) == pytest.approx(psi - 4.0 * CHI, abs=1e-6)
    # one spring lets go a little later than the annulus of the exact solution: 4 chi - 0.87
    assert reflected(4.0 * CHI - 0.95) > -0.95 + 1e-3
    assert reflected(4.0 * CHI - 1.0) == pytest.approx(-1.0, abs=0.02)


def foundation(psi: float, *, rows: int = 400, steps: int = 4000) -> float:
    """Exact contact of like spheres by the method of dimensionality reduction.

    Independent springs, normal stiffness E' dx and tangential s E' dx, profile x^2/R, each with
    Coulomb's limit (Popov and Hess 2015, ch. 5; Lyashenko and Popov, Sci. Rep. 5 (2015) 8479).
    """
    v_n = 1e-3
    v_t = psi * MU * v_n / RATIO
    deepest = (15.0 * v_n**2 / 16.0) ** 0.4
    x = (np.arange(rows) + 0.5) * math.sqrt(deepest) / rows
    dx, dt = x[1] - x[0], 2.943 * deepest / v_n / steps
    u, d, v, w = np.zeros(rows), 0.0, v_n, v_t
    while True:
        gap = np.maximum(d - x * x, 0.0)
        limit = MU * gap / RATIO
        u = np.clip(u + w * dt, -limit, limit)
        v -= 2.0 * gap.sum() * dx * dt
        w -= 3.5 * 2.0 * RATIO * u.sum() * dx * dt
        d += v * dt
        if d <= 0.0:
            return RATIO * w / (MU * v_n)


def test_one_spring_follows_the_exact_contact() -> None:
    """The exact reflection at every angle, by a spring that is softer than the whole contact."""
    for psi in (0.3, 1.0, 2.0, 2.5, 3.5, 4.5, 5.5):
        assert reflected(psi) == pytest.approx(foundation(psi), abs=0.08)


def test_compliance_never_creates_energy() -> None:
    """A spring that grows by unstressed metal and gives back less as it shrinks."""
    for psi in np.geomspace(0.02, 8.0, 12):
        for stiffness in (0.1, RATIO, 5.0):
            impact = strike(sphere(float(psi), stiffness=stiffness))
            assert impact.friction_work_J >= 0.0
            assert abs(impact.energy_residual) < 1e-6


def test_stiff_spring_is_plain_coulomb() -> None:
    """Without compliance: 5/7 of the approach when friction holds, mu when it slides."""
    rigid = strike(sphere(3.0).with_(friction=Friction(MU)))
    stiff = strike(sphere(3.0).with_(friction=Friction(MU, stiffness=1e4)))
    assert stiff.rebound_spin_rad_s == pytest.approx(rigid.rebound_spin_rad_s, rel=2e-3)
    sliding = strike(sphere(9.0).with_(friction=Friction(MU)))
    assert strike(sphere(9.0)).rebound_spin_rad_s == pytest.approx(
        sliding.rebound_spin_rad_s, rel=1e-9
    )


def test_measured_spin_of_ceramic_balls() -> None:
    """Kharaz, Gorham and Salman 2001, at every angle: Mindlin's stiffness, nothing fitted."""
    found = read(Path(__file__).resolve().parents[2] / "data/recordings/kharaz-2001-oblique")
    pair, ball = bodies_of(found.setup.numbers(), "ball")
    # 1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2; k_t/k_n = 4 G*/E*
    soft = sum((2.0 - b.nu) * 2.0 * (1.0 + b.nu) / b.E for b in (pair.sphere, pair.flat))
    mu = value_of(found.setup.friction.coefficient)
    friction = Friction(mu, stiffness=4.0 / (pair.E_reduced * soft))
    measured, motion = found.values("rebound_spin_rad_s"), found.approach
    rows = np.flatnonzero(np.isfinite(measured))
    assert len(rows) == 10
    off = []
    for i in rows:
        approach = Approach(motion.normal[i], tangential=motion.tangential[i])
        spin = strike(Scene(HERTZ, pair, ball, approach, friction=friction)).rebound_spin_rad_s
        off.append(spin / measured[i] - 1.0)
    assert np.max(np.abs(off)) < 0.11
    assert np.sqrt(np.mean(np.square(off))) < 0.06
