"""Every key of an impact and every option of every command acts, or is refused in one line."""

import ast
import inspect
import textwrap
import tomllib
from dataclasses import asdict
from functools import cache
from pathlib import Path

import dentscope.reduce
import made_blows
import pytest
import tomlkit
from dentscope.cli import run
from dentscope.cli.shared.keys import keys_of
from dentscope.core import InputError, InputErrors
from dentscope.core.inputs.templates import CASE, INVERSE, template
from dentscope.dynamics.files.blow import blow_of
from dentscope.dynamics.files.setup import setup_of
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.models import law_named
from dentscope.reduce.output.row import Row
from dentscope.start.ball_file import read_ball
from made_commands import COMMANDS
from made_files import with_key

BALL = 'name = "ball"\n' + made_blows.BALL.replace("7870", "7870\nthickness_m = 0.03").replace(
    "[impact]", "[friction]\ncoefficient = 0.1\n[impact]\nangle_deg = 60"
)
ROD = BALL.replace('shape = "sphere"', 'shape = "rod"\nradius_m = 0.005\nlength_m = 0.1').replace(
    "density_kg_m3 = 7800", "mass_kg = 0.06\ndensity_kg_m3 = 7800"
)
BARE = BALL.replace("Sy_Pa = 3.05e8\n", "").replace("angle_deg = 60\n", "")
UPRIGHT = BALL.replace("angle_deg = 60\n", "")
ON_ROD = BALL.replace("angle_deg", 'support = "rod"\nsupport_radius_m = 0.01\nangle_deg')
SPRUNG = BALL.replace("angle_deg", 'support = "sprung"\nangle_deg').replace(
    "thickness_m", "support_mass_kg = 0.5\nsupport_stiffness_N_m = 1e6\nthickness_m"
)
TWO = BALL.replace("thickness_m = 0.03", 'shape = "sphere"\nradius_m = 0.01\nmass_kg = 0.02')
THIN = ROD.replace("radius_m = 0.005\nlength", "radius_m = 0.0001\nlength")
VIBRATES = ROD.replace("angle_deg", "modes = 2\nangle_deg")
LUDWIK, JOHNSON, VOCE = (
    '{ law = "ludwik", K_Pa = %s, n = %s }',
    '{ law = "johnson-cook", B_Pa = %s, n = 0.3 }',
    '{ law = "voce", Q_Pa = %s, b = %s }',
)
QUANTITY = "{ value = %s, std = %s }"
BODIES = ("[target]", "[strikers.NAME]")

ACTS = {
    ("", "name"): (BALL, '"other"'),
    ("", "format"): (BALL, '"recording-set/1"'),
    ("", "description"): (BALL, '"a drop"'),
    ("", "source"): (BALL, '"a paper"'),
    ("", "licence"): (BALL, '"CC0"'),
    ("", "gravity_m_s2"): (BALL, "300"),
    ("[target]", "material"): (BALL, '"iron"'),
    **{(body, name): (BALL, value) for body in BODIES
       for name, value in (("E_Pa", "1e11"), ("nu", "0.25"), ("Sy_Pa", "2e8"),
                           ("density_kg_m3", "3000"))},
    ("[target]", "rigid"): (BARE.replace("[target]\nE_Pa = 2.0e11\nnu = 0.3", "[target]"), "true"),
    ("[target]", "hardness_Pa"): (BARE, "9e8"),
    ("[target]", "thickness_m"): (BALL, "0.002"),
    ("[target]", "support_mass_kg"): (SPRUNG, "0.1"),
    ("[target]", "support_stiffness_N_m"): (SPRUNG, "1e8"),
    ("[target]", "shape"): (TWO.replace('shape = "sphere"\nradius_m = 0.01\nmass_kg = 0.02', ""),
                            '"sphere"\nradius_m = 0.01'),
    ("[target]", "radius_m"): (TWO, "0.02"),
    ("[target]", "mass_kg"): (TWO, "0.001"),
    ("[target]", "law"): (BALL, '"elastic"'),
    ("[target.hardening]", "law"): (
        BARE, LUDWIK % ("5e8", "0.3"), '{ law = "swift", K_Pa = 5e8, n = 0.3 }',
    ),
    ("[target.hardening]", "K_Pa"): (BARE, LUDWIK % ("5e8", "0.3"), LUDWIK % ("6e8", "0.3")),
    ("[target.hardening]", "B_Pa"): (BARE, JOHNSON % "5e8", JOHNSON % "6e8"),
    ("[target.hardening]", "Q_Pa"): (BARE, VOCE % ("2e8", "9.0"), VOCE % ("3e8", "9.0")),
    ("[target.hardening]", "n"): (BARE, LUDWIK % ("5e8", "0.3"), LUDWIK % ("5e8", "0.2")),
    ("[target.hardening]", "b"): (BARE, VOCE % ("2e8", "9.0"), VOCE % ("2e8", "5.0")),
    ("[strikers.NAME]", "material"): (BALL, '"steel"'),
    ("[strikers.NAME]", "rigid"): (BALL.replace("""
tip_radius_m = 0.005
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 1.7e9""", "\ntip_radius_m = 0.005"), "true"),
    ("[strikers.NAME]", "hardness_Pa"): (BALL.replace("Sy_Pa = 1.7e9\n", ""), "8e8"),
    ("[strikers.NAME]", "shape"): (BALL, '"rod"\nradius_m = 0.005\nlength_m = 0.1\nmass_kg = 0.06'),
    ("[strikers.NAME]", "tip_radius_m"): (BALL, "0.004"),
    ("[strikers.NAME]", "mass_kg"): (BALL, "0.002"),
    ("[strikers.NAME]", "radius_m"): (ROD, "0.008"),
    ("[strikers.NAME]", "length_m"): (ROD, "0.2"),
    ("[strikers.NAME]", "tip_flat_radius_m"): (BALL, "0.0003"),
    ("[strikers.NAME]", "inertia_kg_m2"): (ROD, "1e-4"),
    ("[friction]", "coefficient"): (BALL, "0.2"),
    ("[impact]", "angle_deg"): (BALL, "30"),
    ("[impact]", "impact_speed_m_s"): (BALL, "2.0"),
    ("[impact]", "drop_height_m"): (BALL.replace("impact_speed_m_s = 1.0\n", ""), "0.1", "0.2"),
    ("[impact]", "approach_tangential_m_s"): (UPRIGHT, "0.3"),
    ("[impact]", "approach_spin_rad_s"): (BALL, "100.0"),
    ("[impact]", "laws"): (BALL, '["hertz"]'),
    ("[impact]", "modes"): (ROD, "3"),
    ("[impact]", "loss_factor"): (VIBRATES, "0.05"),
    ("[impact]", "support"): (BALL, '"plate"'),
    ("[impact]", "support_damping_N_s_m"): (SPRUNG, "3000.0"),
    ("[impact]", "support_radius_m"): (ON_ROD, "0.02"),
    ("[impact]", "finite_tip"): (THIN, "true"),
    ("[impact]", "repeats"): (BALL, "2"),
    ("[impact]", "flight_s"): (VIBRATES, "0.0"),
    ("[impact]", "max_steps"): (BALL, "12"),
    ("[impact]", "max_contacts"): (VIBRATES, "1"),
    ("[sweep]", "impact_speed_m_s"): (BALL, "[1.0, 2.0]"),
    ("[sweep]", "drop_height_m"): (BALL, "[0.1, 0.2]"),
    ("[sweep]", "angle_deg"): (BALL, "[30.0, 80.0]"),
    ("[sweep]", "friction"): (BALL, "[0.05, 0.2]"),
    ("[sweep]", "mass_kg"): (BALL, "[0.001, 0.002]"),
    ("[sweep]", "approach_tangential_m_s"): (UPRIGHT, "[0.1, 0.2]"),
    ("[sweep]", "approach_spin_rad_s"): (BALL, "[10.0, 20.0]"),
}  # fmt: skip
OIL = BALL + '[environment]\nfluid = "oil"\n'
HOT = BALL.replace("angle_deg", "temperature_K = 600.0\nangle_deg").replace(
    "[target]", "[target]\nmelting_K = 1790.0"
)
EDGED = ROD.replace("radius_m = 0.005\nlength", "radius_m = 0.0006\nlength").replace(
    "[impact]",
    '[strikers.other]\nshape = "sphere"\nradius_m = 0.001\nmass_kg = 1e-4\nE_Pa = 2e11\n'
    'nu = 0.3\n[impact]\nstriker = "ball"\n',
)
DROPPED = BALL.replace("impact_speed_m_s = 1.0", "drop_height_m = 0.3")
FALLS = DROPPED + "[sweep]\ndrop_height_m = [0.1, 0.3]\nmass_kg = [0.001, 0.002]\n"
LIGHT = DROPPED.replace("0.005", "0.02").replace("density_kg_m3 = 7800", "mass_kg = 0.0027")
STICKS = BALL.replace("coefficient = 0.1", "coefficient = 0.4")
BEAD = """
[target]
E_Pa = 2e9
nu = 0.3
density_kg_m3 = 1000
[strikers.ball]
shape = "sphere"
tip_radius_m = 1e-6
E_Pa = 2e9
nu = 0.3
mass_kg = 4e-15
[impact]
impact_speed_m_s = 10.0
laws = ["fitted"]
"""
MEETS = {
    "thermal-softening": HOT, "rod-longitudinal-waves": ROD, "rod-flexural-vibration": ROD,
    "truncated-tip": EDGED, "adhesion": BEAD, "squeeze-film": OIL, "impact-speed-loss": FALLS,
    "air-drag": LIGHT, "tangential-compliance": STICKS,
}  # fmt: skip
"""Where a mechanism acts; elsewhere than on an oblique ball."""


def _with_mechanism(mechanism, text, count=None):
    numbers = [f"{p.name} = {float(p.value(0.6))!r}" for p in mechanism.parameters[:count]]
    return "\n".join([text, f"[mechanisms.{mechanism.name}]", *numbers, ""])


def _moving(mechanism, parameter):
    text = _with_mechanism(mechanism, MEETS.get(mechanism.name, BALL))
    return text, *(repr(float(parameter.value(place))) for place in (0.3, 0.65))


ACTS |= {
    (f"[mechanisms.{m.name}]", p.name): _moving(m, p) for m in MECHANISMS for p in m.parameters
}
READ = {
    **{(b, "Ra_m"): (BALL + "[mechanisms.roughness]\n", "1e-6", "3e-6") for b in BODIES},
    ("[target]", "layer_thickness_m"): (BALL + "[mechanisms.hardened-layer]\n", "1e-4", "4e-4"),
    **{place: (HOT + "[mechanisms.thermal-softening]\n", *two) for place, two in (
        (("[target]", "cp_J_kgK"), ("400", "900")), (("[target]", "melting_K"), ("900", "1800")),
        (("[impact]", "temperature_K"), ("600", "700")),
        (("[environment]", "temperature_K"), ("293", "350")))},
    ("[environment]", "fluid"): (LIGHT + "[mechanisms.air-drag]\n", '"air"', '"oil"'),
    **{("[environment]", name): (LIGHT + "[mechanisms.air-drag]\n", *two)
       for name, two in (("density_kg_m3", ("1.0", "1.3")), ("pressure_Pa", ("5e4", "1e5")),
                         ("viscosity_Pa_s", ("1e-5", "1e-3")))},
}  # fmt: skip
"""What a mechanism alone reads, and with which it acts."""
REFUSED = {
    ("", "noise"): "{ restitution = 0.01 }",
    **{(body, name): value for body in BODIES
       for name, value in (("Ra_m", "1e-6"), ("cp_J_kgK", "460"), ("melting_K", "1800"))},
    ("", "gauge"): "{ permanent_depth_m = 0.02 }",
    ("", "dent_edge"): '"rim"',
    ("[target]", "layer_thickness_m"): "1e-4",
    ("[environment]", "fluid"): '"air"',
    ("[environment]", "viscosity_Pa_s"): "1.8e-5",
    ("[environment]", "density_kg_m3"): "1.2",
    ("[environment]", "pressure_Pa"): "1e5",
    ("[environment]", "temperature_K"): "293",
    ("[impact]", "temperature_K"): "400",
}  # fmt: skip
ONE = {("[impact]", "striker"), *((body, "flow_curve") for body in BODIES)}
"""One choice alone; and what a test of its own looks at, with a file beside."""
_TEXTS = ("name", "format", "description", "source", "licence", "material")
TWIN = "[strikers.NAME.hardening]"


def told(content, tmp_path):
    setup = setup_of(content, source=str(tmp_path / "ball.toml"))
    found = blow_of(setup, [law_named(name) for name in setup.laws[:1]])
    swept = setup.swept(found.laws[0]).to_csv(tmp_path / "s.csv") if setup.sweep.count else None
    text = (tmp_path / "s.csv").read_text() if setup.sweep.count else str(swept)
    return found.name, found.table(exact=True), found.checks(), setup.about, len(found.rows), text


def beside(place):
    """Set-ups without a key, or with another value of it, and with it."""
    base, *values = ACTS[place]
    if place[0].endswith(".hardening]"):
        base = base.replace("[strikers", "Sy_Pa = 3e8\n[strikers").replace(
            'laws = ["fitted"]\n', ""
        )
        place = ("[target]", "hardening")
    before = tomllib.loads(base) if len(values) == 1 else with_key(base, *place, values[0])
    if place[1] == "rigid":
        before = tomllib.loads(BALL)
    return before, with_key(base, *place, values[-1])


@pytest.mark.parametrize("key", keys_of("impact"), ids=lambda k: f"{k.table}{k.name}")
def test_a_key_of_an_impact_acts_or_is_refused(key, tmp_path):
    place = (key.table, key.name)
    if place in ONE or key.table == TWIN:
        return
    if place in REFUSED:
        table = "[noise]" if key.name == "dent_edge" else key.table
        with pytest.raises(InputErrors) as caught:
            setup_of(with_key(BALL, table, key.name, REFUSED[place]), source="a.toml")
        assert "does nothing here" in str(caught.value)
        assert "dentscope diagnose" in str(caught.value)
        return
    before, after = beside(place)
    assert told(before, tmp_path) != told(after, tmp_path)


@pytest.mark.parametrize("place", READ, ids="".join)
def test_a_key_that_only_a_mechanism_reads_acts_with_it(place, tmp_path):
    base, *values = READ[place]
    found = []
    for value in values:
        try:
            found.append(told(with_key(base, *place, value), tmp_path))
        except InputErrors as error:
            found.append(str(error))
    assert found[0] != found[1]


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_a_mechanism_is_told_with_its_effect_or_refused_where_it_cannot_act(mechanism, tmp_path):
    text = _with_mechanism(mechanism, MEETS.get(mechanism.name, BALL))
    lines = told(tomllib.loads(text), tmp_path)[2]
    assert any(line.startswith(f"{mechanism.name} ({mechanism.title}): ") for line in lines)
    out = _with_mechanism(mechanism, BALL).replace(
        f"{mechanism.parameters[0].name} = ", f"{mechanism.parameters[0].name} = -1e9  # "
    )
    with pytest.raises(InputErrors) as caught:
        setup_of(tomllib.loads(out), source="a.toml")
    assert f"mechanisms.{mechanism.name}.{mechanism.parameters[0].name}" in str(caught.value)
    assert f"[{mechanism.parameters[0].unit}]" in str(caught.value)
    for other in (BALL, ROD, BEAD):
        # what needs several heights or strikers is refused before any scene
        setup = setup_of(tomllib.loads(_with_mechanism(mechanism, other, 1)), source="a.toml")
        plain = setup.plain(law_named("fitted"))
        if setup.asked.idle([plain]):
            try:
                setup.check_laws([law_named("fitted")])
            except InputErrors as refused:
                lines = str(refused).splitlines()
            else:  # it acts at other speeds
                lines = told(setup.content, tmp_path)[2]
            words = f"mechanisms.{mechanism.name}: ", f"{mechanism.name} changes nothing here: "
            assert any(said in line for line in lines for said in words)


UNCERTAIN = [
    k for k in keys_of("impact")
    if k.allowed.startswith("a quantity") and (k.table, k.name) in ACTS
    and k.table != "[environment]"
]  # fmt: skip


@pytest.mark.parametrize("key", UNCERTAIN, ids=lambda k: f"{k.table}{k.name}")
def test_the_standard_deviation_of_a_key_widens_the_band(key):
    base, *values = ACTS[key.table, key.name]
    at = values[-1]
    exact, unsure = (
        setup_of(with_key(base, key.table, key.name, value), source="a.toml")
        for value in (at, QUANTITY % (at, 0.2 * float(at)))
    )
    law = law_named("fitted")
    before, after = blow_of(exact, [law]), blow_of(unsure, [law])
    sharp, wide = before.bands["fitted"], after.bands["fitted"]
    part = "Sy_Pa" if key.name == "hardness_Pa" else key.name
    (new,) = (p for p in wide.parts if p.rpartition(".")[2] == part)
    if not any(wide.parts[new].values()):
        # it acts in a check alone, and that is said
        assert any(new in line and "changes nothing" in line for line in after.rules())
        return
    assert sum(x * x for x in wide.parts[new].values()) > sum(
        x * x for x in sharp.parts.get(new, {}).values()
    )


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('[target]\nlaw = "table"', "law.json"),
        ('[target]\nlaw = "measured-restitution"', "diagnose"),
        ("[target]\nsupport_mass_kg = 1.0", 'impact.support = "sprung"'),
        ("[target]\nsupport_stiffness_N_m = 1.0", 'impact.support = "sprung"'),
        ("[impact]\nsupport_damping_N_s_m = 1.0", 'impact.support = "sprung"'),
        ("[impact]\nloss_factor = 0.1", "impact.modes"),
        ("[impact]\nmodes = 2", "of a rod"),
        ("[impact]\nfinite_tip = true", "of a rod"),
        ("[strikers.NAME]\nlength_m = 0.1", "of a rod"),
        ("[target]\nrate = { law = 'overstress' }", "dentscope case"),
    ],
)
def test_what_acts_beside_another_key_alone_names_it(line, words):
    table, rest = line.split("\n")
    name, value = rest.split(" = ", 1)
    with pytest.raises(InputError) as caught:
        setup_of(with_key(BALL, table, name, value), source="a.toml")
    assert words in str(caught.value)
    assert name in str(caught.value)


@pytest.mark.parametrize("key", keys_of("impact"), ids=lambda k: f"{k.table}{k.name}")
def test_a_key_of_an_impact_acts_on_what_a_discrete_element_code_gets(key, tmp_path):
    """Or stands among what these parameters leave aside; texts for people are no number."""
    place = (key.table, key.name)
    if place in ONE | REFUSED.keys() or key.table == TWIN or key.name in _TEXTS:
        return
    told = []
    for content in beside(place):
        file = tmp_path / "ball.toml"
        file.write_text(tomlkit.dumps(content))
        try:
            ball = read_ball(file)
            # the set-up holds every key, and what is around a mechanism most
            given = ball._replace(setup=None, asked=ball.asked.constants)
            told.append(repr((given, asdict(ball.pair))))
        except InputError as error:
            told.append(str(error))
    refused = "a rod" in told[0] or "a second sphere" in told[0]
    assert told[0] != told[1] or refused


@cache
def read_by_reductions():
    folder = Path(inspect.getfile(dentscope.reduce)).parent
    return {
        node.attr
        for file in folder.rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load)
    }


@pytest.mark.parametrize(
    "words", [w for w, c in COMMANDS.items() if not hasattr(c, "list_commands")], ids=" ".join
)
def test_a_command_reads_every_option(words):
    command = COMMANDS[words]
    work = inspect.unwrap(command.callback)
    tree = ast.parse(textwrap.dedent(inspect.getsource(work)))
    read = {
        node.id for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
    }  # fmt: skip
    known = set(inspect.signature(command.callback).parameters)
    if words[0] == "reduce":
        read |= read_by_reductions() | set(Row.model_fields)  # the row: a column of trials.csv each
    assert [p.name for p in command.params if p.name in known - read] == []


@pytest.mark.parametrize(
    ("line", "option"),
    [
        ("impact --new ball --law hertz", "--law"),
        ("impact --new ball --exact", "--exact"),
        ("case --new --picture", "--picture"),
        ("inverse --new --out some", "--out"),
        ("fit --judge some --only hardening", "--only"),
        ("fit some --judge some", "CAMPAIGNS"),
        ("verify --list --quick", "--quick"),
        ("verify --list --only patch", "--only"),
        ("campaign run --scheduler tcp://nowhere:1 --workers 2", "--workers"),
    ],
)
def test_what_does_nothing_beside_another_option_is_refused(line, option, errs):
    (told,) = errs(*line.split()).splitlines()
    assert f"{option}: does nothing" in told


USES = (
    ("impact ball.toml --law fitted --exact", "impact ball.toml --law hertz --exact"),
    ("impact ball.toml --law fitted --exact", "impact ball.toml --law fitted"),
    ("impact --new ball new.toml", "impact --new rod new.toml"),
    ("case --new new.toml", "case --new other.toml"),
    ("inverse --new new.toml", "inverse --new other.toml"),
    ("inverse inverse.toml --out one", "inverse inverse.toml --out two"),
    ("laws compare case.toml --law hertz", "laws compare case.toml --law fitted"),
    ("laws compare case.toml --law hertz", "laws compare case.toml --law hertz --out two"),
    ("laws show hertz", "laws show fitted"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 2"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 1 --mass 1e-3"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 1 --law thornton"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 1 --out two"),
    ("export law fitted", "export law compact"),
    ("keys case", "keys inverse"),
    ("materials steel-1010-hot-rolled", "materials steel-1018-hot-rolled"),
    ("recordings new one", "recordings new one --rod"),
    ("recordings check kharaz-2001-oblique", "recordings check thesis-chapter-4"),
    ("recordings audit kharaz-2001-oblique", "recordings audit kharaz-2001-oblique --all"),
    ("examples --to one", "examples --to two"),
)
"""Two uses that differ in an option or an argument, of the commands that are quick."""


@pytest.mark.parametrize(("one", "other"), USES, ids=lambda line: line)
def test_an_option_changes_what_is_printed_or_written(one, other, tmp_path, monkeypatch, capsys):
    told = []
    for number, line in enumerate((one, other)):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "ball.toml").write_text(template("ball").partition("[sweep]")[0])
        (folder / "case.toml").write_text(CASE)
        (folder / "inverse.toml").write_text(INVERSE)
        monkeypatch.chdir(folder)
        assert run(line.split()) == 0
        files = {
            str(p.relative_to(folder)): p.read_bytes()
            for p in folder.rglob("*") if p.is_file() and p.suffix != ".h5"
        }  # fmt: skip
        told.append((capsys.readouterr().out, files))
    assert told[0] != told[1]
