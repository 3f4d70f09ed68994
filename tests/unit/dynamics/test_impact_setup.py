"""Set-up files, their mechanisms, those of the inverse: what they mean, one line a mistake."""

import math
import tomllib
from pathlib import Path

import pytest
import tomlkit
from dentscope.cli import run
from dentscope.core import InputError, InputErrors
from dentscope.core.inputs.templates import INVERSE
from dentscope.dynamics.files.blow import blow_of
from dentscope.dynamics.files.inverse_file import read_inverse
from dentscope.dynamics.files.setup import DEFAULT_LAWS, read_setup
from dentscope.dynamics.inverse import MeasuredScar, alpha, infer, mobility
from dentscope.models import LAWS, law_named
from dentscope.models.published.hertz import HERTZ
from dentscope.studies.thesis.chapter5 import thesis_rod, thesis_rows
from made_blows import BALL, blow, setup
from made_files import changed, put

STEEL = {"E_Pa": 2e11, "nu": 0.3, "Sy_Pa": 760e6, "density_kg_m3": 7800}
ROD = {
    "name": "rod",
    "target": {"shape": "flat", "E_Pa": {"value": 2.0e11, "std": 4e9}, "nu": 0.3, "Sy_Pa": 305e6,
               "density_kg_m3": 7870, "thickness_m": 0.03},
    "strikers": {"rod": {**STEEL, "shape": "rod", "tip_radius_m": 0.0088, "radius_m": 0.0088,
                         "length_m": 0.3048, "mass_kg": 0.4607}},
    "friction": {"coefficient": 0.13},
    "impact": {"angle_deg": 45, "impact_speed_m_s": 1.0, "laws": ["hertz", "jackson-green"]},
}  # fmt: skip
METAL = {"E_Pa": 2.05e11, "nu": 0.3, "density_kg_m3": 7860}
PEEN = {
    "gravity_m_s2": 0, "target": METAL,
    "strikers": {"ball": {**METAL, "shape": "sphere", "tip_radius_m": 2.9e-4, "Sy_Pa": 2.0e9}},
    "impact": {"impact_speed_m_s": 50, "laws": ["fitted"]},
}  # fmt: skip


def write(path, content, changes):
    return put(path / "setup.toml", tomlkit.dumps(changed(content, changes)))


def read(*given):
    return read_setup(write(*given))


def test_keys_reach_the_scene(tmp_path: Path) -> None:
    scene = read(tmp_path, ROD, {"impact": {"support": "plate", "modes": 4}}).scene(HERTZ)
    assert scene.pair.flat.E == 2.0e11
    assert scene.striker.inertia == pytest.approx(0.4607 * (0.3048**2 / 12 + 0.0088**2 / 4))
    assert scene.approach.angle == pytest.approx(math.pi / 4)
    assert scene.friction.mu == 0.13
    assert len(scene.modes.frequencies) == 4
    # 1 / (8 sqrt(236.1 kg/m2 * 494.5 kN m)), by hand
    assert scene.support.plate_mobility == pytest.approx(1.1568e-5, rel=1e-4)


def test_a_spheres_angle_is_that_of_its_velocity(tmp_path: Path) -> None:
    fall = {"angle_deg": 30, "impact_speed_m_s": None, "drop_height_m": 0.2}
    ball = {"strikers.rod": {"shape": "sphere", "length_m": None}, "impact": fall}
    approach = read(tmp_path, ROD, ball).scene(HERTZ).approach
    speed = math.sqrt(2 * 9.81 * 0.2)
    assert approach.speed == pytest.approx(0.5 * speed)
    assert approach.tangential == pytest.approx(-speed * math.cos(math.pi / 6))


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"impact.angle_deg": 95}, "impact.angle_deg: 95"),
        ({"impact.angel_deg": 45}, "impact.angel_deg: unknown key"),
        ({"impact.impact_speed_m_s": None}, "impact.impact_speed_m_s: missing (allowed: this or"),
        ({"impact.drop_height_m": 1}, "given beside impact.drop_height_m"),
        ({"mechanisms.squeeze-film": True}, "environment.viscosity_Pa_s)"),
        ({**dict.fromkeys(ROD), "radius_m": 1, "sphere": {}, "flat": {}},
         "setup.toml: a CASE.toml of `dentscope case`"),
        ({"impact.striker": "ball"}, "impact.striker: no striker 'ball'"),
        ({"impact.support": "sprung"}, "target.support_mass_kg: missing"),
        ({"impact.modes": 100}, "impact.modes: 100"),
        ({"impact.laws": "hertz"}, "impact.laws: 'hertz' (allowed: a list"),
    ],
)  # fmt: skip
def test_each_mistake_is_one_line(tmp_path: Path, changes, line: str) -> None:
    with pytest.raises(InputErrors) as caught:
        read(tmp_path, ROD, changes)
    assert line in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_bodies_that_cannot_be_simulated_are_one_line_with_the_file(tmp_path: Path) -> None:
    none = {"E_Pa": None, "nu": None, "Sy_Pa": None}
    for changes, line in (
        ({"strikers.rod": None}, "strikers: {} (allowed: 1 or more, each strikers.NAME)"),
        ({"strikers.rod": {**none, "material": "Stahl"}},
         "strikers.rod.E_Pa: missing (allowed: a number (or rigid = true), or a material of "
         "`dentscope materials`, which 'Stahl' is not)"),
        ({"strikers.rod": {**none, "rigid": True}, "target": {**none, "rigid": True}},
         "target.rigid: given beside a rigid striker"),
    ):  # fmt: skip
        with pytest.raises(InputError) as caught:
            read(tmp_path, ROD, changes).scene(law_named("hertz"))
        assert f"setup.toml: {line}" in str(caught.value)


def test_a_ball_is_told_to_be_a_sphere_and_nothing_else(tmp_path: Path) -> None:
    ball = {"shape": "ball", "tip_radius_m": None, "radius_m": 2.9e-4}
    with pytest.raises(InputErrors) as caught:
        read(tmp_path, PEEN, {"strikers.ball": ball})
    told = "strikers.ball.shape: 'ball' (allowed: 'rod' or 'sphere'; a ball is a sphere)"
    assert [str(e).endswith(told) for e in caught.value.errors] == [True]


def first(setup):
    """The blow by the first of its laws."""
    return blow_of(setup, [law_named(setup.laws[0])])[setup.laws[0]]


def test_a_hardness_gives_the_strength_where_none_is_stated() -> None:
    """Kirk, The Shot Peener (2004): a dent of 199 um at 300 HB, 0.58 mm and 50 m/s."""
    found, stated = (
        first(setup(changed(PEEN, {"target": strength})))
        for strength in ({"hardness_Pa": 2.942e9}, {"Sy_Pa": 1.0507142857e9})
    )
    assert found.restitution == pytest.approx(stated.restitution, rel=1e-9)
    assert found.restitution == pytest.approx(0.4764, abs=0.001)
    assert found.residual_flat_m == pytest.approx(15.0e-6, rel=0.01)
    assert found.scar_width_m == pytest.approx(199e-6, rel=0.1)


@pytest.mark.parametrize("body", ["target", "strikers.ball"])
def test_what_hardens_more_returns_more(body: str) -> None:
    laws = [{"law": "ludwik", "K_Pa": k, "n": 0.4} for k in (2e8, 6e8, 2e9)]
    metals = [{"Sy_Pa": 3e8}, *({"Sy_Pa": 3e8, "hardening": law} for law in laws)]
    blow = {"impact.laws": ["hardening"], "impact.angle_deg": 90.0}
    e = [first(setup(changed(PEEN, {body: metal, **blow}))).restitution for metal in metals]
    assert e == sorted(e)
    assert e[-1] > 1.2 * e[0]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"target.rigid": True, "target.E_Pa": None, "target.nu": None}, "a rigid body"),
        ({"target.Sy_Pa": None}, "target.Sy_Pa: missing"),
        ({"target.law": "elastic"}, "target.hardening"),
        ({"impact.laws": ["hertz"]}, "none of hertz follows it"),
        ({"target.hardening": {"law": "swift", "K_Pa": 1e8, "n": 0.2}}, "above Sy_Pa"),
        ({"target.hardening": {"law": "ludwik", "n": 0.2}}, "K_Pa"),
        ({"target.hardening": {"law": "ludvik", "K_Pa": 1e8, "n": 0.2}}, "ludwik"),
        ({"target.flow_curve": "flow.csv"}, "flow_curve"),
        ({"target.rate": {"law": "cowper-symonds"}}, "dentscope case"),
    ],
)
def test_hardening_that_cannot_be_taken_is_refused_with_a_way(changes, words) -> None:
    base = {"target.Sy_Pa": 3e8, "target.hardening": {"law": "voce", "Q_Pa": 1e8, "b": 9.0}}
    if "target.rigid" in changes:
        base["target.Sy_Pa"] = None
    if "impact.laws" not in changes:
        base["impact.laws"] = ["hardening"]
    with pytest.raises(InputError, match=words):
        first(setup(changed(PEEN, base | changes)))


def test_the_ball_on_a_metal_with_a_flow_curve(tmp_path: Path) -> None:
    (tmp_path / "flow.csv").write_text("plastic_strain,true_stress_Pa\n0,3e8\n0.01,3e8\n")
    ours = first(setup(changed(PEEN, {"target.Sy_Pa": 3e8})))
    flat = {"target.flow_curve": "flow.csv", "impact.laws": None}
    curved = read(tmp_path, PEEN, flat)
    assert curved.laws == ("hardening", *DEFAULT_LAWS)
    level = blow_of(curved, [law_named("hardening")])
    assert any("the flat's flow curve ends at a strain of 0.01" in line for line in level.checks())
    # a curve that does not rise is perfect plasticity
    assert level["hardening"].restitution == pytest.approx(ours.restitution, rel=2e-3)
    hardens = {"Sy_Pa": 3e8, "hardening": {"law": "ludwik", "K_Pa": 4e8, "n": 0.3}}
    harder = setup(changed(PEEN, {"target": hardens, "impact.laws": None}))
    assert first(harder).residual_flat_m < 0.93 * ours.residual_flat_m
    with pytest.raises(InputError, match="none of fitted follows it"):
        first(setup(changed(PEEN, {"target": hardens})))
    # a stated strength is what the piece has at 0.2 %; one at which the curve begins leaves it
    (tmp_path / "flow.csv").write_text("plastic_strain,true_stress_Pa\n0,3e8\n0.1,5e8\n")
    strengths = [
        read(tmp_path, PEEN, {**flat, "target.Sy_Pa": Sy}).scene(HERTZ).pair.flat.Sy
        for Sy in (None, 3e8, 6.08e8)
    ]
    assert strengths == pytest.approx([3e8, 3e8, 6e8], rel=1e-6)
    (tmp_path / "flow.csv").unlink()
    with pytest.raises(InputError, match=r"target.flow_curve: no such file 'flow.csv'"):
        read(tmp_path, PEEN, flat).scene(HERTZ)


def test_a_rod_that_slides_by_hertz_gets_all_of_its_work_back():
    found = first(setup(ROD))
    assert found.energetic_restitution == pytest.approx(1.0, abs=1e-6)
    assert found.friction_impulse_ratio == pytest.approx(0.13, rel=1e-6)


def test_a_budget_that_runs_out_ends_with_code_3(tmp_path, capsys):
    file = write(tmp_path, ROD, {"impact": {"modes": 2, "max_contacts": 1, "laws": ["hertz"]}})
    assert run(["impact", str(file), "--out", str(tmp_path)]) == 3
    told = capsys.readouterr()
    assert "1 of 1 impacts (hertz): step-limit" in told.err
    assert "max_contacts" in told.err
    assert "unfinished" in told.out


def test_where_the_tip_sticks_and_what_is_objected() -> None:
    """No sliding at either end of the angles for mu = 0.5 (7.3 and 52), never for mu = 1."""
    rod, rows = thesis_rows()
    for angle in (7.3, 52.0):
        assert alpha(rod, math.radians(angle), mu=0.5) == pytest.approx(0.0, abs=0.01)
    steepest = max(mobility(rod, math.radians(a)).stick_friction for a in range(1, 90))
    assert steepest == pytest.approx(0.77, abs=0.01)
    for row in rows:
        assert row.inferred.objections
        flight = row.measured.depth / (row.measured.restitution * row.measured.speed)
        assert row.inferred.return_duration == pytest.approx(row.inferred.duration + flight)


def test_friction_that_sticks_is_a_mistake() -> None:
    with pytest.raises(InputError, match="stick"):
        infer(thesis_rod(), MeasuredScar(math.radians(70), 3.0, 0.5, 0.4, 1e-4, 2e-4))


def test_more_back_than_came_and_a_depth_beyond_the_tip_are_told() -> None:
    found = infer(thesis_rod(), MeasuredScar(math.radians(45), 2.0, 0.1, 1.5, 0.026, 1e-3))
    assert any("restitution 1.5: more comes back" in line for line in found.objections)
    assert any("0.026 m is above the tip's radius" in line for line in found.objections)


def test_file_and_command(tmp_path: Path, errs) -> None:
    file = tmp_path / "trials.toml"
    file.write_text(INVERSE)
    row = read_inverse(file)[0]
    assert row.inferred.duration == pytest.approx(1.38e-3, rel=0.01)
    assert run(["inverse", str(file), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "trials-inverse.csv").exists()
    file.write_text(INVERSE.replace("1650e-6", "1650"))
    assert "sliding_length_m: 1650 " in (told := errs("inverse", file, "--out", tmp_path))
    assert "1650 um would be 0.00165" in told
    file.write_text(INVERSE.replace("0.13", "0.9"))
    told = errs("inverse", file, "--out", tmp_path)
    assert "trial T01: friction_impulse_ratio: 0.9 makes the tip stick" in told


LAW = LAWS["fitted"]


def test_waves_asked_for_are_those_of_the_support_of_that_name():
    by_name = blow(BALL + "[mechanisms]\nhalf-space-waves = true\n")["fitted"]
    by_key = blow(BALL.replace("laws", 'support = "half-space"\nlaws'))["fitted"]
    assert by_name.restitution == pytest.approx(by_key.restitution, rel=1e-12)
    assert by_name.radiated_J == pytest.approx(by_key.radiated_J, rel=1e-9)


def test_a_sweep_takes_the_mechanism_at_each_speed_as_single_blows_do():
    rate = {"strain-rate-hardening": {"rise_at_1000_per_s": 0.4, "rate_exponent": 0.3}}
    ball = {**tomllib.loads(BALL), "mechanisms": rate}
    found = setup(changed(ball, {"sweep.impact_speed_m_s": [0.3, 3.0]})).swept(LAW)
    for k, speed in enumerate((0.3, 3.0)):
        one = blow(changed(ball, {"impact.impact_speed_m_s": speed}))["fitted"]
        assert found["restitution"][k] == pytest.approx(one.restitution, rel=1e-4)
        assert found["permanent_depth_m"][k] == pytest.approx(one.residual_flat_m, rel=1e-4)


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
        ("contact-damping = { damping_s_m = 3.0 }", r"0.003 to 1 \[s/m\]"),
        ("contact-damping = { damping = 0.1 }", "unknown key"),
        ("damping = true", "contact-damping"),
        ("adhesion = true", "missing"),
        ("half-space-waves = true", r"mechanisms.half-space-waves: given beside"),
        ("support-compliance = true", r"mechanisms.support-compliance: given beside"),
    ],
)
def test_a_wrong_mechanism_is_one_line(lines, words):
    moves = 'support = "rod"\nsupport_radius_m = 0.02\nlaws' if "given" in words else "laws"
    with pytest.raises(InputErrors, match=words):
        setup(BALL.replace("laws", moves) + "[mechanisms]\n" + lines + "\n")


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("[mechanisms.squeeze-film]\nfilm_drag_Pa_s = 0.1\n",
         r"mechanisms.squeeze-film: .* environment.viscosity_Pa"),
        ("[environment]\nviscosity_Pa_s = 0\n[mechanisms]\nair-drag = { drag = 1 }\n",
         "mechanisms.air-drag: there is no air, as stated"),
        ("angle_deg = 5\n[mechanisms]\ntilt = { tilt_deg = -8 }\n",
         r"mechanisms.tilt.tilt_deg: -8 turns the striker onto the flat \(allowed: what leaves"),
        ("[sweep]\nangle_deg = [4, 60]\n[mechanisms]\ntilt = { tilt_deg = -5 }\n",
         "mechanisms.tilt.tilt_deg: -5 turns the striker onto the flat"),
    ],
)  # fmt: skip
def test_what_changes_nothing_by_any_law_or_is_cut_is_refused_with_the_reason(lines, words):
    file = setup(BALL + lines)
    with pytest.raises(InputError, match=words):
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
