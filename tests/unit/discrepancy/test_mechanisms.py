"""Each mechanism: nothing at its neutral values, the declared direction elsewhere."""

from __future__ import annotations

import math

import pytest
from dentscope.core import Material
from dentscope.discrepancy.mechanisms import MECHANISMS, Mechanism, Surroundings
from dentscope.impact import Approach, Friction, Scene, Striker, scene_of, strike
from dentscope.impact.integrate import arrays_of
from dentscope.models import LAWS

STEEL = Material(E=200e9, nu=0.3, Sy=760e6, density=7800.0)
IRON = Material(E=200e9, nu=0.3, Sy=305e6, density=7870.0)
ROD = Striker(mass=0.2, tip_radius=0.0088, length=0.1, radius=0.0088)
AROUND = Surroundings(from_height=True, temperature=600.0, thickness=0.03)

# as in the list of verdict names
NAMES = """strain-rate-hardening work-hardening thermal-softening half-space-waves
rod-longitudinal-waves rod-flexural-vibration support-compliance tangential-compliance
velocity-dependent-friction ploughing-friction contact-damping adhesion squeeze-film roughness
truncated-tip hardened-layer size-effect impact-speed-loss tilt""".split()

OBSERVED = {
    "permanent_depth_m": "residual_flat_m",
}


def scene(angle: float = 90.0) -> Scene:
    return scene_of(
        LAWS["jackson-green"], sphere=STEEL, flat=IRON, striker=ROD,
        approach=Approach(1.0, math.radians(angle)),
        friction=Friction(0.15) if angle < 90.0 else Friction(),
    )  # fmt: skip


def middle(mechanism: Mechanism) -> dict[str, float]:
    return {p.name: float(p.value(0.6)) for p in mechanism.parameters}


def test_the_library_holds_the_names_of_the_verdict() -> None:
    assert [m.name for m in MECHANISMS] == NAMES


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
@pytest.mark.parametrize("angle", [90.0, 50.0])
def test_neutral_values_leave_the_impact_bit_for_bit(mechanism: Mechanism, angle: float) -> None:
    plain = scene(angle)
    neutral = {p.name: p.neutral for p in mechanism.parameters}
    changed = mechanism.attach(plain, neutral, AROUND)
    assert plain == scene(angle)
    for key in ("par", "force", "factors", "body", "omega", "psi"):
        one, other = getattr(arrays_of(plain), key), getattr(arrays_of(changed), key)
        assert one.tobytes() == other.tobytes()


@pytest.mark.parametrize("mechanism", [m for m in MECHANISMS if m.direction], ids=lambda m: m.name)
def test_observables_move_in_the_declared_direction(mechanism: Mechanism) -> None:
    plain = scene(50.0 if "friction_impulse_ratio" in mechanism.direction else 90.0)
    changed = mechanism.attach(plain, middle(mechanism), AROUND)
    if changed == plain:
        pytest.skip("acts after the motion")
    before, after = strike(plain), strike(changed)
    for name, sign in mechanism.direction.items():
        key = OBSERVED.get(name, name)
        if key == "restitution" and mechanism.name in ("impact-speed-loss", "squeeze-film"):
            continue
        assert sign * (getattr(after, key) - getattr(before, key)) > 0.0, name


def test_a_drop_loses_speed_and_keeps_its_restitution() -> None:
    loss = next(m for m in MECHANISMS if m.name == "impact-speed-loss")
    half = Surroundings(from_height=True, height_share=0.5)
    values = {"speed_loss": 0.19, "loss_growth": 1.0}
    changed = loss.attach(scene(), values, half)
    assert changed.approach.speed == pytest.approx(0.9)  # sqrt(1 - 0.19) at half the height
    seen = strike(changed)
    assert seen.restitution > strike(scene()).restitution  # slower, so less is lost


def test_a_ball_has_no_cut_tip() -> None:
    cut = next(m for m in MECHANISMS if m.name == "truncated-tip")
    ball = scene().with_(striker=Striker(mass=0.2, tip_radius=0.0088))
    assert "ball" in cut.applies([(ball, AROUND)])
    assert cut.attach(ball, {"flat_radius_over_R": 0.05}, AROUND) == ball
    assert cut.applies([(ball, AROUND), (scene(), AROUND)]) == ""


def test_adhesion_takes_the_work_of_parting() -> None:
    # Thornton and Ning 1998: 7.09 (W^5 R^4 / E'^2)^(1/3); 2.2e-8 J here
    import numpy as np

    adhesion = next(m for m in MECHANISMS if m.name == "adhesion")
    s = scene()
    seen = {"restitution": np.array([0.5]), "rebound_speed_m_s": np.array([0.5])}
    adhesion.after([(s, AROUND)], {"work_of_adhesion_J_m2": 1.0}, seen)
    lost = 7.09 * (ROD.tip_radius**4 / s.pair.E_reduced**2) ** (1.0 / 3.0) / (0.5 * ROD.mass)
    assert seen["restitution"][0] == pytest.approx(math.sqrt(0.25 - lost), rel=1e-12)
    assert "at most" in adhesion.applies([(s, AROUND)])
