"""Flow stress of strain, rate and heat: exact paths, tangents, and no change where it is off."""

import math

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.core.flow import Flow, Heating, Rate, ludwik, swift, tabulated, voce
from dentscope.fem.material import EXACT, RADIAL
from dentscope.studies.verification.material_point import MaterialPoint, stretched

E, NU, SY = 200e9, 0.3, 400e6
SHEAR = E / (2.0 * (1.0 + NU))
G = SHEAR / E
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


def bent(t):
    return np.array(
        [1.0 + 0.15 * t * np.cos(2.0 * t), 0.4 * np.sin(3.0 * t) * t, 0.2 * t * t,
         1.0 - 0.1 * t + 0.06 * np.sin(4.0 * t) ** 2, 1.0 + 0.05 * np.sin(5.0 * t)]
    )  # fmt: skip


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
def test_tangent_is_the_derivative_of_the_stress(name):
    for rule, old in ((RADIAL, 0.5), (EXACT, 0.5), (EXACT, 0.0)):
        point = Point(FLOWS[name], rule=rule)
        if old:
            for t in np.linspace(0.0, old, 20)[1:]:
                point.walk(bent(t))
        F = bent(old + 0.03)
        P, A = point.stress(F), point.tangent(F)
        assert point.walk(F, stay=True).flows
        direction = np.array([0.2, 0.5, -0.3, 0.1, 0.4])
        remainder = [
            np.abs(point.stress(F + h * direction) - P - h * A @ direction).max()
            for h in (4e-4, 2e-4, 1e-4)
        ]
        slope = np.log2(np.array(remainder[:-1]) / remainder[1:])
        assert slope == pytest.approx(2.0, abs=0.1), (rule, old)


@pytest.mark.parametrize("name", ["swift", "voce", "overstress"])
def test_exact_update_is_second_order_in_a_bent_path(name):
    def end(steps):
        point = Point(FLOWS[name], seconds=1.0 / steps)
        for k in range(1, steps + 1):
            done = point.walk(bent(0.7 * k / steps))
        return np.array(done.e)

    reference = end(3200)
    error = [np.abs(end(n) - reference).max() for n in (50, 100, 200)]
    order = np.log2(np.array(error[:-1]) / error[1:])
    assert (order > (0.9 if name == "overstress" else 1.8)).all(), order


def test_a_law_that_changes_nothing_is_perfect_plasticity():
    flat = tabulated(np.array([0.0, 1.0]), np.array([SY, SY]))
    hard = Point(Flow(flat))
    plain = MaterialPoint(G, radius=math.sqrt(2.0 / 3.0) * SY / (2.0 * SHEAR))
    for t in np.linspace(0.0, 0.7, 200)[1:]:
        done, same = hard.walk(bent(t)), plain.walk(bent(t))
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
