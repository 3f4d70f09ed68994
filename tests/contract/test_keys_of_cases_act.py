"""Every key of CASE.toml acts on solver, mass or what is told; of an inverse file on a number."""

import copy
import tomllib
from dataclasses import asdict

import pytest
import tomlkit
from dentscope.cli.case import tell_unused
from dentscope.cli.shared.keys import keys_of
from dentscope.start.case_file import read_case, read_pair
from made_files import put

CASE = {
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


def merged(table, more):
    found = {**table, **more}
    return {k: v for k, v in found.items() if v is not None}


def of_a_case(content, folder):
    (folder / "curve.csv").write_text("plastic_strain,stress_Pa\n0,3e8\n0.1,4e8\n1,5e8\n")
    file = put(folder / "CASE.toml", tomlkit.dumps(content))
    problem, accuracy = read_case(file)
    return repr(asdict(problem)), repr(accuracy), repr(read_pair(file)[0].ball_mass), file


@pytest.mark.parametrize("key", keys_of("case"), ids=lambda k: f"{k.table}{k.name}")
def test_a_key_of_a_case_acts(key, tmp_path, capsys):
    before, after = copy.deepcopy(CASE), copy.deepcopy(CASE)
    path = [*filter(None, key.table.strip("[]").split(".")), key.name]
    if path[0] in ("sphere", "flat"):
        given, value = OF_A_BODY[".".join(path[1:])]
        for content in (before, after):
            content[path[0]] = merged(content[path[0]], copy.deepcopy(given))
            if "rate" in given:
                content["load"]["speed_m_s"] = 2.0
        if path[1] in ("rigid", "flow_curve"):
            before = copy.deepcopy(CASE)
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
    told = []
    for content in (before, after):
        *solved, file = of_a_case(content, tmp_path)
        tell_unused(file)
        told.append((solved, capsys.readouterr().out))
    assert told[0] != told[1]


@pytest.mark.parametrize(
    "key", [k for k in keys_of("inverse") if k.name != "shape"], ids=lambda k: f"{k.table}{k.name}"
)
def test_a_key_of_an_inverse_acts(key, tmp_path, prints):
    told = []
    for changed in (False, True):
        content = copy.deepcopy(INVERSE)
        table = content["striker"] if key.table == "[striker]" else content["trial"][0]
        if changed:
            table[key.name] = OF_AN_INVERSE[key.name]
        file = put(tmp_path / "a.toml", tomlkit.dumps(content))
        assert tomllib.loads(file.read_text()) == content
        shown = prints("inverse", file, "--out", tmp_path / "out")
        told.append((shown, (tmp_path / "out" / "a-inverse.csv").read_text()))
    assert told[0] != told[1]
