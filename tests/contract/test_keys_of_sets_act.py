"""Every key of a set, a case or an inverse file acts: on what is told, compared or solved."""

import copy
import math
import tomllib
import warnings
from contextlib import redirect_stdout
from dataclasses import asdict
from functools import cache
from io import StringIO

import numpy as np
import pytest
import tomlkit
from dentscope.cli import run
from dentscope.cli.case import tell_unused
from dentscope.cli.shared.keys import keys_of
from dentscope.core import InputError
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.experiments.next_experiment import _options
from dentscope.discrepancy.experiments.session import takes
from dentscope.discrepancy.rank import baseline_situations
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.recordings import read
from dentscope.start.case_file import read_case, read_pair
from made_files import put, with_key

ROD = """
format = "recording-set/1"
name = "rods"
[target]
E_Pa = { value = 2.0e11, std = 4e9 }
nu = 0.3
Sy_Pa = { value = 3.05e8, std = 3e7 }
density_kg_m3 = 7870
thickness_m = 0.03
[strikers.ball]
shape = "rod"
tip_radius_m = 0.0088
radius_m = 0.0088
length_m = 0.3
mass_kg = 0.567
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = { value = 1.7e9, std = 1e8 }
density_kg_m3 = 7800
[friction]
coefficient = { value = 0.15, std = 0.05 }
[environment]
[noise]
restitution = 0.01
permanent_depth_m = 1e-6
dent_diameter_m = 1e-5
"""
ROD_TRIALS = """trial,striker,angle_deg,drop_height_m,restitution,permanent_depth_m,dent_diameter_m
1,ball,90,0.05,0.53,4.9e-5,1.9e-3
2,ball,60,0.20,0.46,8.5e-5,2.5e-3
3,ball,60,0.45,0.42,1.2e-4,3.0e-3
"""
BALL = (
    ROD.replace('shape = "rod"', 'shape = "sphere"').replace('"rods"', '"balls"')
    .replace("length_m = 0.3\n", "").replace("radius_m = 0.0088\nmass_kg = 0.567\n", "")
)  # fmt: skip
HIDDEN = ROD.replace("Sy_Pa = { value = 1.7e9, std = 1e8 }", "Sy_Pa = { value = 1e8, std = 1e7 }")
TRIALS_OF_A_BALL = """trial,striker,angle_deg,impact_speed_m_s,restitution,permanent_depth_m
1,ball,90,1.0,0.53,1.4e-5
2,ball,60,4.0,0.40,4.5e-5
3,ball,90,8.0,0.33,8.2e-5
"""
ON_A_FLAT = BALL.replace('"balls"', '"normal balls"').replace("thickness_m = 0.03\n", "")
ON_A_BALL = ON_A_FLAT.replace("[target]", '[target]\nshape = "sphere"\nradius_m = 0.02')
BARE = ROD.replace("Sy_Pa = { value = 3.05e8, std = 3e7 }\n", "")
RIG = f"{ROD}[rig]\nloads_N = [20.0, 5e4]\n[rig.minutes]\nstrike = 5.0\n"
BARE_STRIKER = ROD.replace("Sy_Pa = { value = 1.7e9, std = 1e8 }\n", "")

CHANGED = {
    ("", "name"): (ROD, '"others"'),
    ("", "description"): (ROD, '"a drop"'),
    ("", "source"): (ROD, '"a paper"'),
    ("", "licence"): (ROD, '"CC0"'),
    ("", "gravity_m_s2"): (ROD, "9.0"),
    ("", "noise"): (
        ROD, "{ restitution = 0.02, permanent_depth_m = 1e-6, dent_diameter_m = 9e-6 }",
    ),
    ("", "gauge"): (ROD, "{ permanent_depth_m = 0.05 }"),
    ("", "dent_edge"): (ROD, '"rim"'),
    ("", "assume"): (ROD, '["half-space-waves"]'),
    **{(body, name): (base, value) for body in ("[target]", "[strikers.NAME]")
       for name, base, value in (("E_Pa", ROD, "1.0e11"), ("nu", ROD, "0.2"),
                                 ("Ra_m", BALL, "3e-6"))},
    ("[target]", "Sy_Pa"): (ROD, "2e8"),
    ("[target]", "density_kg_m3"): (ROD, "4000"),
    ("[target]", "material"): (BARE, '"aluminium-6061-t6"'),
    ("[target]", "hardness_Pa"): (BARE, "1.0e9", "1.2e9"),
    ("[target]", "cp_J_kgK"): (BALL, "200", "100"),
    ("[target]", "melting_K"): (BALL, "900", "500"),
    ("[target]", "thickness_m"): (BALL, "0.003"),
    ("[target]", "layer_thickness_m"): (ROD, "1e-4"),
    ("[target]", "support_mass_kg"): (ROD, "3.0"),
    ("[target]", "support_stiffness_N_m"): (ROD, "1e7"),
    ("[target]", "law"): (ROD, '"elastic"'),
    ("[target]", "shape"): (ON_A_FLAT, '"sphere"\nradius_m = 0.02'),
    ("[target]", "radius_m"): (ON_A_BALL, "-0.02"),
    ("[target]", "mass_kg"): (ON_A_BALL, "0.05"),
    ("[strikers.NAME]", "Sy_Pa"): (ROD, "4e8"),
    ("[strikers.NAME]", "density_kg_m3"): (ROD, "3000"),
    ("[strikers.NAME]", "material"): (BARE_STRIKER, '"aluminium-6061-t6"'),
    ("[strikers.NAME]", "hardness_Pa"): (BARE_STRIKER, "1.0e9", "1.2e9"),
    ("[strikers.NAME]", "cp_J_kgK"): (HIDDEN, "200", "100"),
    ("[strikers.NAME]", "melting_K"): (HIDDEN, "900", "500"),
    ("[strikers.NAME]", "shape"): (BALL, '"rod"\nlength_m = 0.1\nradius_m = 0.0088\nmass_kg = 0.1'),
    ("[strikers.NAME]", "tip_radius_m"): (ROD, "0.008"),
    ("[strikers.NAME]", "mass_kg"): (ROD, "0.5"),
    ("[strikers.NAME]", "radius_m"): (ROD, "0.0088", "0.0095"),
    ("[strikers.NAME]", "length_m"): (ROD, "0.35"),
    ("[strikers.NAME]", "tip_flat_radius_m"): (ROD, "1e-3"),
    ("[strikers.NAME]", "inertia_kg_m2"): (ROD, "2e-3"),
    ("[friction]", "coefficient"): (ROD, "0.3"),
    ("[environment]", "fluid"): (BALL, '"oil"'),
    ("[environment]", "viscosity_Pa_s"): (BALL, "0.01"),
    ("[environment]", "density_kg_m3"): (BALL, "6.0"),
    ("[environment]", "pressure_Pa"): (BALL, "5e5"),
    ("[environment]", "temperature_K"): (BALL, "330"),
    ("[rig]", "speeds_m_s"): (RIG, "[0.1, 9.0]"),
    ("[rig]", "angles_deg"): (RIG, "[20.0, 80.0]"),
    ("[rig]", "loads_N"): (f"{RIG}press = 5.0\n", "[20.0, 9e3]"),
    ("[rig]", "reads"): (RIG, '["contact_time_s"]'),
    ("[rig]", "repeats"): (RIG, "4"),
    ("[rig]", "session_minutes"): (RIG, "60.0"),
    **{("[rig.minutes]", name): (RIG, "33.0")
       for name in ("strike", "press", "change", "hardness", "weigh", "calliper", "instrument",
                    "build")},
}  # fmt: skip
METAL = ("E_Pa", "nu", "Sy_Pa")
REFUSED = {("[target]", "rigid"), ("[strikers.NAME]", "rigid")}
ONE = {("", "format")}
"""One choice alone."""
BESIDE = {("[target]", "flow_curve"), ("[strikers.NAME]", "flow_curve")}
"""Names of files, which tests of their own look at."""


def changed(text, *key):
    return tomlkit.dumps(with_key(text, *key))


def write(text, folder):
    folder.mkdir(exist_ok=True)
    (folder / "set.toml").write_text(text)
    trials = TRIALS_OF_A_BALL if 'balls"' in text else ROD_TRIALS
    normal = 'name = "normal balls"' in text
    (folder / "trials.csv").write_text(trials.replace(",60,", ",90,") if normal else trials)


@cache
def told(text, folder):
    write(text, folder)
    with redirect_stdout(StringIO()) as printed:
        assert run(["recordings", "check", str(folder)]) == 0
        assert run(["recordings", "audit", str(folder), "--all"]) == 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        problem = problem_of(read(folder))
        simulator = Simulator(problem)
        rest = Point(np.zeros(problem.n_z))
        numbers = [simulator.predict((), [rest])]
        situations = baseline_situations(problem)
        reasons = []
        for mechanism in MECHANISMS:
            reason = mechanism.ruled_out(situations)
            ranges = mechanism.ranges(situations)
            reasons.append((reason, str(ranges)))
            if not reason:
                middle = {p.name: float(p.value(0.5)) for p in ranges}
                one = Point(np.zeros(problem.n_z), {mechanism.name: middle})
                numbers.append(simulator.predict((mechanism,), [one]))
    unsure = [(n.name, n.at(0.0), n.at(1.0)) for n in problem.nuisances]
    able = [(o.proposal.change, o.proposal.minutes) for o in _options(simulator).options]
    able += [(what, takes(problem.bench, what)) for what in ("change", "build")]
    able.append(problem.bench.session_minutes)
    measured = problem.cells.value, problem.cells.std
    said = printed.getvalue(), reasons, unsure, problem.notes, str(problem.error.spreads)
    return (*said, numbers, measured, able)


def same(one, other):
    if isinstance(one, np.ndarray):
        return one.shape == other.shape and np.array_equal(one, other, equal_nan=True)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    nans = isinstance(one, float) and isinstance(other, float) and math.isnan(one)
    return one == other or (nans and math.isnan(other))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("set")


@pytest.mark.parametrize("key", keys_of("set"), ids=lambda k: f"{k.table}{k.name}")
def test_a_key_of_a_set_acts_or_is_refused(key, folder):
    place = (key.table, key.name)
    if place in ONE | BESIDE:
        return
    if place in REFUSED:
        bare = "\n".join(x for x in ROD.splitlines() if x.split(" ")[0] not in METAL)
        write(changed(bare, *place, "true"), folder)
        with pytest.raises(InputError, match="a body that gives way"):
            read(folder)
        return
    base, *values = CHANGED[place]
    table = "[noise]" if key.name == "dent_edge" else key.table
    before = base if len(values) == 1 else changed(base, table, key.name, values[0])
    after = changed(base, table, key.name, values[-1])
    found = [told(text, folder) for text in (before, after)]
    assert not same(*found)


SOLVED = {
    "radius_m": 0.005,
    "sphere": {"E_Pa": 2.1e11, "nu": 0.3, "Sy_Pa": 1.5e9, "density_kg_m3": 7800},
    "flat": {"E_Pa": 2e11, "nu": 0.3, "Sy_Pa": 3e8},
    "load": {"max_delta_over_R": 0.01},
}
LUDWIK = {"law": "ludwik", "K_Pa": 3e9, "n": 0.3}
COWPER = {"law": "cowper-symonds", "D_1_s": 40.0, "q": 5.0}
JOHNSON = {"law": "johnson-cook", "rate_0_1_s": 1.0, "C": 0.01}
OVER = {"law": "overstress", "rate_0_1_s": 1.0, "stress_Pa": 1e8, "m": 0.5}
HEAT = {"capacity_J_m3K": 3.6e6, "melting_rise_K": 1500.0, "exponent": 1.0, "fraction": 0.9}
NAMED = {"E_Pa": None, "nu": None, "Sy_Pa": None}
OF_A_BODY = {
    "material": (NAMED | {"material": "steel-1010-hot-rolled"}, "steel-1018-hot-rolled"),
    "E_Pa": ({}, 1e11), "nu": ({}, 0.2), "Sy_Pa": ({}, 4e8), "density_kg_m3": ({}, 5000),
    "rigid": (NAMED, True),
    "flow_curve": ({"Sy_Pa": None}, "curve.csv"),
    "hardening.law": ({"hardening": LUDWIK}, "swift"),
    "hardening.K_Pa": ({"hardening": LUDWIK}, 2e9),
    "hardening.B_Pa": ({"hardening": {"law": "johnson-cook", "B_Pa": 5e8, "n": 0.3}}, 4e8),
    "hardening.Q_Pa": ({"hardening": {"law": "voce", "Q_Pa": 2e8, "b": 9.0}}, 3e8),
    "hardening.n": ({"hardening": LUDWIK}, 0.2),
    "hardening.b": ({"hardening": {"law": "voce", "Q_Pa": 2e8, "b": 9.0}}, 5.0),
    "rate.law": ({"rate": COWPER}, JOHNSON), "rate.D_1_s": ({"rate": COWPER}, 80.0),
    "rate.q": ({"rate": COWPER}, 4.0), "rate.rate_0_1_s": ({"rate": JOHNSON}, 2.0),
    "rate.C": ({"rate": JOHNSON}, 0.02), "rate.m": ({"rate": OVER}, 0.3),
    "rate.stress_Pa": ({"rate": OVER}, 2e8),
    **{f"heating.{k}": ({"heating": HEAT}, 0.8 * x) for k, x in HEAT.items()},
}  # fmt: skip
OF_A_LOAD = {"max_delta_over_R": 0.02, "unload_from": [0.005], "speed_m_s": 2.0}

INVERSE = {
    "striker": {"tip_radius_m": 8.8e-3, "mass_kg": 0.5, "length_m": 0.3, "radius_m": 8.8e-3},
    "trial": [{
        "angle_deg": 60.0, "impact_speed_m_s": 1.0, "friction_impulse_ratio": 0.05,
        "restitution": 0.5, "permanent_depth_m": 1e-5, "sliding_length_m": 1e-3,
    }],
}  # fmt: skip
OF_AN_INVERSE = {
    "tip_radius_m": 8e-3, "mass_kg": 0.4, "length_m": 0.2, "radius_m": 7e-3, "inertia_kg_m2": 1e-3,
    "trial": "first", "angle_deg": 50.0, "impact_speed_m_s": 1.2, "rebound_m_s": 0.05,
    "friction_impulse_ratio": 0.06, "restitution": 0.55, "permanent_depth_m": 2e-5,
    "sliding_length_m": 2e-3,
}  # fmt: skip


def of_a_case(content, folder):
    (folder / "curve.csv").write_text("plastic_strain,stress_Pa\n0,3e8\n0.1,4e8\n1,5e8\n")
    file = put(folder / "SOLVED.toml", tomlkit.dumps(content))
    problem, accuracy = read_case(file)
    return repr(asdict(problem)), repr(accuracy), repr(read_pair(file)[0].ball_mass), file


@pytest.mark.parametrize("key", keys_of("case"), ids=lambda k: f"{k.table}{k.name}")
def test_a_key_of_a_case_acts(key, tmp_path, capsys):
    before, after = copy.deepcopy(SOLVED), copy.deepcopy(SOLVED)
    path = [*filter(None, key.table.strip("[]").split(".")), key.name]
    if path[0] in ("sphere", "flat"):
        given, value = OF_A_BODY[".".join(path[1:])]
        for content in (before, after):
            body = content[path[0]] | copy.deepcopy(given)
            content[path[0]] = {k: v for k, v in body.items() if v is not None}
            if "rate" in given:
                content["load"]["speed_m_s"] = 2.0
        if path[1] in ("rigid", "flow_curve"):
            before = copy.deepcopy(SOLVED)
        if path[1:] == ["rate", "law"]:
            path, value = path[:2], JOHNSON
    else:
        value = {
            "radius_m": 0.006, "coefficient": 0.2, "level": "smoke", **OF_A_LOAD,
        }[key.name]  # fmt: skip
    table = after
    for part in path[:-1]:
        table = table.setdefault(part, {})
    table[path[-1]] = value
    said = []
    for content in (before, after):
        *solved, file = of_a_case(content, tmp_path)
        tell_unused(file)
        said.append((solved, capsys.readouterr().out))
    assert said[0] != said[1]


@pytest.mark.parametrize(
    "key", [k for k in keys_of("inverse") if k.name != "shape"], ids=lambda k: f"{k.table}{k.name}"
)
def test_a_key_of_an_inverse_acts(key, tmp_path, prints):
    said = []
    for changed in (False, True):
        content = copy.deepcopy(INVERSE)
        table = content["striker"] if key.table == "[striker]" else content["trial"][0]
        if changed:
            table[key.name] = OF_AN_INVERSE[key.name]
        file = put(tmp_path / "a.toml", tomlkit.dumps(content))
        assert tomllib.loads(file.read_text()) == content
        shown = prints("inverse", file, "--out", tmp_path / "out")
        said.append((shown, (tmp_path / "out" / "a-inverse.csv").read_text()))
    assert said[0] != said[1]
