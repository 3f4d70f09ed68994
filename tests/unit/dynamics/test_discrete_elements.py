"""Parameters for discrete-element codes: Hertz's impact, exact balances, and LAMMPS itself."""

import math

import pytest
import tomlkit
from dentscope.core import InputError, Material, Pair
from dentscope.core.inputs.templates import template
from dentscope.dynamics import strike
from dentscope.dynamics.export.collisions import TSUJI, damping_for
from dentscope.dynamics.export.discrete_elements import substitutes, two_balls
from dentscope.dynamics.export.lammps import lammps_lines
from dentscope.models import LAWS
from dentscope.start.ball_file import read_ball
from made_blows import ball_setup
from made_files import put, rows_of
from scipy.integrate import solve_ivp

STEEL = Material(E=200e9, nu=0.3, Sy=600e6, density=7800.0)
HARD = Material(E=210e9, nu=0.3, Sy=1500e6)
PAIR = Pair(STEEL, HARD, 5e-3)
MASS = 4.0 / 3.0 * math.pi * PAIR.R**3 * 7800.0


@pytest.fixture(scope="module")
def rows():
    return substitutes(LAWS["fitted"], PAIR, mass=MASS, speeds=[0.1, 0.5, 3.0])


def test_an_elastic_ball_is_hertz_impact():
    """Johnson (1985), 11.4: depth (15 m v^2/(16 E' R^(1/2)))^(2/5), time 2.94 depth/v, e = 1."""
    pair = Pair(Material(E=200e9, nu=0.3), Material(E=200e9, nu=0.3), 5e-3)
    (row,) = substitutes(LAWS["hertz"], pair, mass=MASS, speeds=[1.0])
    depth = (15.0 * MASS / (16.0 * pair.E_reduced * math.sqrt(pair.R))) ** 0.4
    own = row.substitutes[0]
    assert own.blow.depth == pytest.approx(depth, rel=1e-4)
    assert own.blow.time == pytest.approx(2.943 * depth, rel=1e-3)
    assert own.blow.restitution == pytest.approx(1.0, abs=1e-4)
    assert max(abs(x) for x in own.missed(row.law)) < 1e-3


def test_each_substitute_returns_what_the_law_returns(rows):
    for row in rows:
        _, soft, linear, *_ = row.substitutes
        for s in row.substitutes:
            assert s.blow.restitution == pytest.approx(row.law.restitution, abs=1e-4)
        assert soft.blow.depth == pytest.approx(row.law.depth, rel=1e-3)
        assert linear.blow.depth == row.law.depth
        # work done by the linear loading is the kinetic energy
        assert 0.5 * linear.stiffness * linear.blow.depth**2 == pytest.approx(
            0.5 * MASS * row.law.speed**2
        )
        # of a force that grows as depth^n the peak is (n + 1) W/depth, of a straight one 2 W/depth
        assert 0.79 * row.law.force < linear.blow.force < row.law.force
    assert rows[-1].substitutes[0].blow.depth < 0.85 * rows[-1].law.depth  # nothing yields in it


def test_a_restitution_below_what_the_damping_can_do_is_one_line():
    with pytest.raises(InputError, match=r"0.001 by hertz-tsuji .*least of this damping: lower"):
        damping_for(TSUJI, 1e-3)


def test_a_damping_that_cannot_is_left_out_and_the_others_get_theirs():
    soft = Material(E=200e9, nu=0.3, Sy=6e6, density=7800.0)
    (row,) = substitutes(LAWS["fitted"], Pair(soft, HARD, 5e-3), mass=MASS, speeds=[30.0])
    assert row.law.restitution < 0.11
    assert set(row.left_out) == {"hertz-tsuji", "hertz-tsuji-softened"}
    assert [s.name for s in row.substitutes] == [
        "linear-hysteretic", "spring-dashpot", "hunt-crossley"
    ]  # fmt: skip
    text = lammps_lines([row], PAIR, mass=MASS)
    assert text.startswith("# 30 m/s: no hertz-tsuji-softened: restitution: ")
    assert len(text.splitlines()) == 1


def test_command_writes_table_and_fragments(tmp_path, errs, prints):
    text = ("radius_m = 0.005\n[sphere]\nE_Pa = 200e9\nnu = 0.3\nSy_Pa = 600e6\n"
            "density_kg_m3 = 7800\n[flat]\nE_Pa = 210e9\nnu = 0.3\nSy_Pa = 1500e6\n"
            "[load]\nmax_delta_over_R = 0.01\n")  # fmt: skip
    file, out = put(tmp_path / "pair.toml", text), tmp_path / "dem"
    assert "hertz-tsuji-softened" in prints("export", "dem", file, "--speed", "0.5,3", "--out", out)
    table = rows_of(out / "dem.csv")
    assert len(table) == 2 * 2 * 6
    by_speed = [float(r["restitution"]) for r in table if r["model"] == "fitted"]
    assert by_speed[0] > by_speed[1]
    lines = (out / "lammps.in").read_text()
    assert len(laws_of(lines, "flat")) == len(laws_of(lines, "balls")) == 2
    told = prints("export", "dem", file, "--speed", "0.5,2e3", "--out", out)
    assert "fitted: 1 of 2 impacts go so deep, to" in " ".join(told.split())
    for line in (["--speed", "10:1"], ["--speed", "1e5"], ["--mass", "-1"], ["--mass", "nan"]):
        assert len(errs("export", "dem", file, *line).splitlines()) == 1


def laws_of(lines, name):
    given = lines.split(f"variable {name} index &")[1].split("\nvariable")[0].split("\nlabel")[0]
    return [part.split() for part in given.split('"')[1::2]]


def number_of(lines, name):
    return float(lines.split(f"variable {name} index ")[1].split()[0])


def test_two_balls_have_half_the_mass_and_half_the_radius():
    """Hertz (Johnson 11.4) for two balls of 2.5 mm and 0.1 g: depth and time from m/2 and R/2."""
    elastic = Material(E=70e9, nu=0.33, density=2700.0)
    pair, mass = two_balls(Pair(elastic, HARD, 2.5e-3), 1e-4)
    (row,) = substitutes(LAWS["hertz"], pair, mass=mass, speeds=[1.0])
    reduced = 70e9 / (2.0 * (1.0 - 0.33**2))
    depth = (15.0 * 0.5e-4 / (16.0 * reduced * math.sqrt(1.25e-3))) ** 0.4
    assert row.law.depth == pytest.approx(depth, rel=1e-4)


BALL = """
[target]
E_Pa = { value = 6.89e10, std = 1e9 }
nu = 0.33
Sy_Pa = 2.76e8
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.003
E_Pa = 1.93e11
nu = 0.29
Sy_Pa = 7.0e8
density_kg_m3 = 8000
[friction]
coefficient = 0.3
[impact]
impact_speed_m_s = 1.0
support = "half-space"
[sweep]
impact_speed_m_s = { from = 0.1, to = 10, count = 21, spacing = "log" }
"""


def test_the_file_of_an_impact_gives_wall_balls_and_friction(tmp_path, prints):
    """LAMMPS returned 0.92622, 0.69347 and 0.45486 with these parameters."""
    text = BALL.replace("[strikers", "density_kg_m3 = 2700\n[strikers")
    file = put(tmp_path / "ball.toml", text)
    told = prints("export", "dem", file, "--out", tmp_path)
    assert "target.E_Pa.std = 1e+09" in told
    assert "impact.support = half-space" in told
    table = rows_of(tmp_path / "dem.csv")
    ours = [float(r["restitution"]) for r in table
            if r["model"] == "fitted" and r["contact"] == "ball on flat"]  # fmt: skip
    assert ours[::3] == pytest.approx([0.9262, 0.6935, 0.4549], abs=1e-4)
    walls = laws_of((tmp_path / "lammps.in").read_text(), "flat")
    assert len(walls) == 7
    # Mindlin's 8 G* over Hertz's (4/3) E', by hand, whatever the softening
    shear = sum((2 - nu) * 2 * (1 + nu) / E for E, nu in ((6.89e10, 0.33), (1.93e11, 0.29)))
    reduced = 1.0 / ((1 - 0.33**2) / 6.89e10 + (1 - 0.29**2) / 1.93e11)
    for words in walls:
        k, kt = float(words[words.index("hertz") + 1]), float(words[words.index("tangential") + 2])
        assert kt / k == pytest.approx(8.0 / shear / (4.0 / 3.0 * reduced), rel=1e-6)
        assert words[words.index("damping") - 1] == "0.3"


def lammps_blow(coefficients, *, R, mass, speed):
    """Restitution, depth and time of LAMMPS's `hertz K E ... damping tsuji`, from its manual.

    F = K R^(1/2) d^(3/2) + eta d', eta = alpha(E) (m F_e/d)^(1/2); no force where d < 0.
    """
    k, entered = coefficients
    powers = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)
    alpha = sum(c * entered**n for n, c in enumerate(powers))
    k *= math.sqrt(R)
    scale = (mass * speed**2 / k) ** 0.4  # of depth; time in scale/speed

    def rates(_t, state):
        x, v = max(state[0], 0.0), state[1]
        return [v, -(x**1.5) - alpha * x**0.25 * v]

    def parts(_t, state):
        return state[0]

    parts.terminal, parts.direction = True, -1.0
    found = solve_ivp(rates, (0.0, 1e3), [1e-12, 1.0], events=parts, rtol=1e-9, atol=1e-12)
    return -found.y[1, -1], scale * found.y[0].max(), scale / speed * found.t[-1]


ELASTIC = {"E_Pa": 2e11, "nu": 0.3}
GRAINS = {
    "a rigid wall": ({"rigid": True}, {**ELASTIC, "Sy_Pa": 4e8}, 3e-3, 7800.0, 2.0),
    "a softer ball": ({**ELASTIC, "Sy_Pa": 2e9}, {**ELASTIC, "Sy_Pa": 3e8}, 3e-3, 7800.0, 2.0),
    "equal bodies": ({**ELASTIC, "Sy_Pa": 4e8}, {**ELASTIC, "Sy_Pa": 4e8}, 3e-3, 7800.0, 1.0),
    "elastic": (ELASTIC, ELASTIC, 3e-3, 7800.0, 1.0),
    "dust": ({**ELASTIC, "Sy_Pa": 1e9}, ELASTIC, 5e-7, 7800.0, 30.0),
    "a boulder": ({"E_Pa": 5e10, "nu": 0.2, "Sy_Pa": 2e8}, {"E_Pa": 5e10, "nu": 0.2}, 1.0, 2700.0,
                  5.0),
    "rubber": (ELASTIC, {"E_Pa": 2e6, "nu": 0.49, "Sy_Pa": 4e5}, 0.02, 1100.0, 3.0),
    "barely yielding": ({**ELASTIC, "Sy_Pa": 1e9}, ELASTIC, 5e-3, 7800.0, 0.2),
    "fast": ({"E_Pa": 7e10, "nu": 0.33, "Sy_Pa": 1e8}, ELASTIC, 2e-3, 7800.0, 50.0),
}  # fmt: skip


@pytest.mark.parametrize(("flat", "ball", "R", "density", "speed"), GRAINS.values(), ids=GRAINS)
def test_what_lammps_makes_of_the_lines(flat, ball, R, density, speed, tmp_path, prints):
    ball = {"density_kg_m3": density, **ball}
    given = ball_setup(target=flat, ball=ball, radius=R, speed=speed).content
    prints("export", "dem", put(tmp_path / "b.toml", tomlkit.dumps(given)), "--out", tmp_path)
    mass = 4.0 / 3.0 * math.pi * R**3 * density
    table = rows_of(tmp_path / "dem.csv")
    lines = (tmp_path / "lammps.in").read_text()
    two = "two balls" in lines
    for wall in (True, False)[: 1 + two]:
        (words,) = laws_of(lines, "flat" if wall else "balls")
        at = words.index("hertz") + 1
        half = 1.0 if wall else 0.5
        e, depth, time = lammps_blow(
            [float(x) for x in words[at : at + 2]], R=half * R, mass=half * mass, speed=speed
        )
        place = "ball on flat" if wall else "two balls"
        (law,) = (
            r for r in table
            if r["model"] in ("fitted", "jackson-green") and r["contact"] == place
        )  # fmt: skip
        assert e == pytest.approx(float(law["restitution"]), abs=2e-4)
        assert 1.2 * time < math.prod(number_of(lines, name) for name in ("dt", "steps"))
        assert depth == pytest.approx(float(law["depth_m"]), rel=1e-2)


def test_metals_that_harden_are_told_by_the_law_that_follows_them(tmp_path, prints):
    curve = '[target.hardening]\nlaw = "swift"\nK_Pa = 5e8\nn = 0.2\n'
    rigid = BALL.split("[sweep]")[0].replace('support = "half-space"\n', "")
    file = put(tmp_path / "ball.toml", rigid + 'laws = ["fitted", "hardening"]\n' + curve)
    assert read_ball(file).law == "hardening"
    told = prints("export", "dem", file, "--law", "fitted", "--out", tmp_path)
    assert "fitted takes the first strength of each metal" in told


def test_a_mechanism_of_the_file_acts_on_the_parameters(tmp_path, prints):
    rate = "\n[mechanisms.strain-rate-hardening]\nrise_at_1000_per_s = 1.9\nrate_exponent = 0.2\n"
    plain = BALL.split("[sweep]")[0].replace('support = "half-space"\n', "")
    found = {}
    for name, text in (("without", plain), ("with", plain + rate)):
        file = put(tmp_path / "ball.toml", text)
        ball, told = read_ball(file), prints("export", "dem", file, "--out", tmp_path)
        assert ("no rate is stated; with that of" in told) == (name == "without")
        assert ("with strain-rate-hardening; the lines for two" in told) == (name == "with")
        (row,) = substitutes(
            LAWS["fitted"], ball.pair, mass=ball.mass, speeds=ball.speeds, asked=ball.asked
        )
        found[name] = row.law.restitution
        blow = strike(ball.setup.scene(LAWS["fitted"]))
        assert found[name] == pytest.approx(blow.restitution, rel=1e-3)
    assert found["with"] > 1.2 * found["without"]


def test_heights_of_a_sweep_are_the_speeds_of_their_falls(tmp_path):
    falls = BALL.split("support")[0].replace("impact_speed_m_s = 1.0", "drop_height_m = 1.0")
    swept = falls + "[sweep]\ndrop_height_m = [0.05, 0.2]\n"
    ball = read_ball(put(tmp_path / "ball.toml", swept))
    assert ball.speeds == pytest.approx([math.sqrt(0.981), math.sqrt(3.924)], rel=1e-12)
    assert not any("drop_height_m" in key for key in ball.unused)


def test_a_rod_is_no_ball_of_a_discrete_element_code(tmp_path, errs):
    file = put(tmp_path / "rod.toml", template("rod"))
    assert 'strikers.rod.shape: a rod (allowed: "sphere")' in errs("export", "dem", file)
