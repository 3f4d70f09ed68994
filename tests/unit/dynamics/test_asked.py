"""`[mechanisms]` of an impact file: the mechanisms of a diagnosis, forward."""

import pytest
from dentscope.core import InputErrors
from dentscope.dynamics.files.blow import blow_of
from dentscope.models import LAWS
from made_blows import BALL, blow, setup

LAW = LAWS["fitted"]


def test_waves_asked_for_are_those_of_the_support_of_that_name():
    by_name = blow(BALL + "[mechanisms]\nhalf-space-waves = true\n")["fitted"]
    by_key = blow(BALL.replace("laws", 'support = "half-space"\nlaws'))["fitted"]
    assert by_name.restitution == pytest.approx(by_key.restitution, rel=1e-12)
    assert by_name.radiated_J == pytest.approx(by_key.radiated_J, rel=1e-9)


def test_a_sweep_takes_the_mechanism_at_each_speed_as_single_blows_do():
    text = BALL + (
        "[sweep]\nimpact_speed_m_s = [0.3, 3.0]\n"
        "[mechanisms.strain-rate-hardening]\nrise_at_1000_per_s = 0.4\nrate_exponent = 0.3\n"
    )
    found = setup(text).swept(LAW)
    for k, speed in enumerate((0.3, 3.0)):
        alone = text.split("[sweep]")[0] + text.partition("3.0]\n")[2]
        one = blow(alone.replace("impact_speed_m_s = 1.0", f"impact_speed_m_s = {speed}"))
        assert found["restitution"][k] == pytest.approx(one["fitted"].restitution, rel=1e-4)
        dent = one["fitted"].residual_flat_m
        assert found["permanent_depth_m"][k] == pytest.approx(dent, rel=1e-4)


def test_the_effect_is_that_against_the_blow_without_it():
    found = blow(BALL + "[mechanisms]\ncontact-damping = { damping_s_m = 0.1 }\n")
    plain = blow(BALL)["fitted"]
    e = 100.0 * (found["fitted"].restitution / plain.restitution - 1.0)
    dent = 100.0 * (found["fitted"].residual_flat_m / plain.residual_flat_m - 1.0)
    (line,) = (one for one in found.checks() if one.startswith("contact-damping"))
    assert line.endswith(f"dent {dent:+.2g} %, restitution {e:+.2g} %")
    assert e < -1.0


def test_a_standard_deviation_of_a_mechanism_enters_the_band():
    key = "mechanisms.contact-damping.damping_s_m"
    text = BALL + "[mechanisms]\ncontact-damping = { damping_s_m = { value = 0.1, std = 0.05 } }\n"
    band = blow(text).bands["fitted"]
    half, twice = (
        blow(BALL + f"[mechanisms]\ncontact-damping = {{ damping_s_m = {x} }}\n")["fitted"]
        for x in (0.05, 0.15)
    )
    wide = 0.5 * abs(half.restitution - twice.restitution)
    assert abs(band.parts[key]["restitution"]) == pytest.approx(wide, rel=0.15)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("contact-damping = 0.1", "true, false, or a table of its numbers"),
        ("nonsense = false", "mechanisms.nonsense: unknown key"),
        ("contact-damping = { damping_s_m = 3.0 }", r"0.003 to 0.3 \[s/m\]"),
        ("contact-damping = { damping = 0.1 }", "unknown key"),
        ("damping = true", "contact-damping"),
        ("adhesion = true", "missing"),
        ("half-space-waves = true", r"mechanisms.half-space-waves: given beside"),
    ],
)
def test_a_wrong_mechanism_is_one_line(lines, words):
    waves = 'support = "half-space"\nlaws' if "half-space" in lines else "laws"
    with pytest.raises(InputErrors, match=words):
        setup(BALL.replace("laws", waves) + "[mechanisms]\n" + lines + "\n")


def test_what_changes_nothing_by_any_law_is_refused_with_the_reason():
    file = setup(BALL + "[mechanisms.squeeze-film]\nfilm_drag_Pa_s = 0.1\n")
    with pytest.raises(InputErrors, match=r"mechanisms.squeeze-film: .* environment.viscosity_Pa"):
        file.check_laws([LAW])


def test_what_changes_nothing_at_one_speed_is_told_there():
    made = blow(BALL + "[mechanisms.adhesion]\nwork_of_adhesion_J_m2 = 0.1\n")
    begins = "adhesion changes nothing here: pulling the bodies apart takes"
    assert any(line.startswith(begins) for line in made.checks())


def test_what_changes_nothing_by_one_law_of_several_is_told():
    """Roughness takes no energy of bodies that do not yield, so Hertz's law has none."""
    file = setup(BALL + "[mechanisms]\nroughness = true\n")
    file.check_laws([LAWS["hertz"], LAW])
    told = blow_of(file, [LAWS["hertz"], LAW])
    assert told["hertz"].restitution == pytest.approx(1.0, abs=1e-9)
    assert any(one.startswith("roughness changes nothing here: ") for one in told.checks())


def test_a_rough_flat_over_a_plate_ends_within_the_usual_steps():
    """The bends of its layer cut steps short for a while; 400,000 of these had found 0.22."""
    text = BALL.replace("laws", 'support = "plate"\nlaws').replace("2.0e11", "6.9e10", 1)
    text = text.replace("3.05e8", "1.5e8").replace("7870", "2700\nthickness_m = 0.015")
    text = text.replace("2.0e11", "6.2e11").replace("1.7e9", "4.0e9").replace("7800", "14900")
    text = text.replace("0.005", "0.010").replace("_m_s = 1.0", "_m_s = 2.8014")
    made = blow(text + "[mechanisms]\nroughness = true\n")
    found, trace = made["fitted"], made.traces["fitted"]
    assert found.outcome.completed
    assert found.restitution == pytest.approx(0.22, abs=0.005)
    assert trace.column("time_s")[-1] == pytest.approx(found.contact_time_s, rel=0.02)
