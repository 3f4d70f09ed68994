"""`dentscope case`: what it writes, and how it answers mistakes."""

import json
from pathlib import Path

import dentscope as ds
import matplotlib.image as mpimg
import meshio
import numpy as np
import pytest
import tomlkit
from dentscope.campaigns import read_curves
from dentscope.cli.case import tell_unused
from dentscope.core import InputError
from dentscope.core.inputs.templates import template
from dentscope.models import law_named
from dentscope.start.ball_file import read_ball
from dentscope.start.case_file import read_case, read_pair
from dentscope.start.measured import brinell, loading_work
from made_files import changed, put, rows_of

GOOD = {
    "radius_m": 0.002,
    "sphere": {"E_Pa": 200e9, "nu": 0.3, "Sy_Pa": 900e6},
    "flat": {"E_Pa": 200e9, "nu": 0.3, "Sy_Pa": 300e6},
    "load": {"max_delta_over_R": 3e-4, "unload_from": [3e-4]},
    "accuracy": {"level": "smoke"},
}
RATE = {"law": "cowper-symonds", "D_1_s": 6500, "q": 4}
CURVED = {"E_Pa": 70e9, "nu": 0.33, "Sy_Pa": None, "flow_curve": "curve.csv", "rate": RATE}
HARD = changed(GOOD, {"flat": CURVED, "load": {"unload_from": None, "speed_m_s": 2.0}})
SWIFT = {"law": "swift", "K_Pa": 600e6, "n": 0.2}
WRITTEN = {"flow_curve": None, "Sy_Pa": 276e6, "hardening": SWIFT}
NONE = {"E_Pa": None, "nu": None, "Sy_Pa": None}
CURVE = "plastic_strain,stress_Pa\n0,276e6\n0.01,300e6\n0.1,350e6\n"


def case_of(tmp_path, content, changes=None, curve=CURVE):
    """A file of a case with these changes, and a flow curve beside it."""
    put(tmp_path / "curve.csv", curve)
    return put(tmp_path / "case.toml", tomlkit.dumps(changed(content, changes or {})))


@pytest.mark.fe
def test_a_case_writes_its_curve_and_fields_and_is_a_law(tmp_path, prints):
    file = case_of(tmp_path, GOOD, {"load.unload_from": [1.5e-4, 2.1e-4, 3e-4]})
    prints("case", file, "--out", tmp_path / "out")
    rows = rows_of(tmp_path / "out" / "curve.csv")
    assert {row["phase"] for row in rows} == {"load", "unload-1", "unload-2", "unload-3"}
    load = [row for row in rows if row["phase"] == "load"]
    assert float(load[-1]["delta_over_R"]) == pytest.approx(3e-4)
    # elastic start: Hertz's force at the first depth
    d = float(load[0]["delta_over_R"]) * 0.002
    hertz = 4.0 / 3.0 * (200e9 / 0.91 / 2.0) * np.sqrt(0.002) * d**1.5
    assert float(load[0]["force_N"]) == pytest.approx(hertz, rel=0.01)
    # the two solves differ, by no more than their coarse meshes explain
    for name in ("force_N", "contact_radius_m", "sphere_share", "hardness_over_Symin"):
        relative = [float(r[f"{name}_uncertainty"]) / float(r[name]) for r in load]
        assert 1e-5 < max(relative) < 0.15
    assert all(r["force_N_uncertainty"] == "" for r in rows if r["phase"] == "unload-1")
    (stored,) = read_curves(tmp_path / "out" / "result.h5")
    assert stored.curve["force"] == pytest.approx([float(r["force_N"]) for r in load], rel=1e-12)
    assert len(stored.unloadings) == 3
    law, pair = law_named(str(tmp_path / "out")), stored.case.pair
    depth = np.array([float(r["delta_over_R"]) for r in load]) * 0.002
    force = np.array([float(r["force_N"]) for r in load])
    assert law.loading(pair, depth[5:]) == pytest.approx(force[5:], rel=0.01)
    left = stored.unloadings[-1].residual_sphere + stored.unloadings[-1].residual_flat
    assert float(sum(law.residual(pair, 3e-4 * 0.002))) == pytest.approx(left, rel=0.01)
    assert stored.profiles["pressure"].shape[0] == 10
    fields = meshio.read(tmp_path / "out" / "fields-0.0003.vtu")
    flat = np.concatenate(fields.cell_data["body"]) == 1.0
    mises = np.concatenate(fields.cell_data["von_mises_Pa"])
    assert mises[flat].max() == pytest.approx(300e6, rel=0.02)
    assert mises[~flat].max() < 900e6
    told = json.loads((tmp_path / "out" / "measured.json").read_text())
    first, at, dent = told["first_yield"], told["pressed"], told["dents"][-1]
    # the curve is Hertz's up to first yield
    assert first["load"] == pytest.approx(np.interp(first["depth"], depth, force), rel=0.02)
    # 2.9 to 1.6 strengths: between first yield and full plasticity, Hertz's ratio at most
    mean = float(load[-1]["hardness_Pa"])
    assert at["mean_pressure"] == pytest.approx(mean)
    assert 1.0 < at["largest_pressure"] / mean < 1.5
    # what is neither dissipated nor stored comes back
    turned = next(r for r in rows if r["phase"] == "unload-3")
    assert dent["load"] == pytest.approx(float(turned["force_N"]))
    work = np.trapezoid(np.append(0.0, force), np.append(0.0, depth))
    lost = 1.0 - stored.curve["dissipated"][-1] / work
    assert dent["energy_returned"] == pytest.approx(lost, abs=0.03)
    surfaces = rows_of(tmp_path / "out" / "dent.csv")
    z = [float(r["z_m"]) for r in surfaces if r["body"] == "flat"]
    assert -z[0] == pytest.approx(dent["left_flat"])
    assert dent["rim_height"] == pytest.approx(max(z), abs=1e-3 * abs(z[0]))
    for name in ("fields-0.0003.png", "dent.png"):
        assert mpimg.imread(tmp_path / "out" / name).std() > 0.05


def read(*given, **asked):
    return read_case(case_of(*given, **asked))[0]


def test_a_flow_curve_a_rate_and_a_speed_reach_the_solver(tmp_path):
    problem = read(tmp_path, HARD)
    flat = problem.pair.flat
    assert flat.Sy == 276e6
    assert flat.flow.curve(0.01) == pytest.approx(300e6)
    assert (flat.flow.rate.law, flat.flow.rate.reference) == ("cowper-symonds", 6500.0)
    # 0.3 um at 2 m/s
    assert problem.clock.seconds(0.0, 1.5e-4) == pytest.approx(1.5e-7)
    slowing = read(tmp_path, HARD, {"load.speed_m_s": [[0.0, 2.0], [3e-4, 1.0]]})
    exact = 0.002 * 3e-4 * np.log(2.0)  # dt = d Delta/v, v linear
    assert slowing.clock.seconds(3e-4, 0.0) == pytest.approx(exact, rel=1e-12)
    assert slowing.clock.seconds(0.0, 6e-4) == pytest.approx(exact + 6e-7, rel=1e-12)
    written = read(tmp_path, HARD, {"flat": WRITTEN})
    assert written.pair.flat.flow.curve(0.1) == pytest.approx(
        600e6 * ((276 / 600) ** 5 + 0.1) ** 0.2, rel=1e-6
    )


WRONG = [
    ({"sphere": {"E_Pa": -1, "Sy_Pa": None}}, ["sphere.E_Pa", "-1"]),
    ({"flat.nu": 0.5}, ["flat.nu", "0.5"]),
    ({"flat.Sy_Pa": 0}, ["flat.Sy_Pa"]),
    ({"radius_m": 0}, ["radius_m"]),
    ({"radius_m": None}, ["radius_m", "missing"]),
    ({"radius_m": 20}, ["radius_m: 20", "20 mm would be 0.02"]),
    ({"load.max_delta_over_R": 3}, ["load.max_delta_over_R"]),
    ({"load.unload_from": [0.1]}, ["load.unload_from"]),
    # legal numbers that coordinates in double precision cannot carry
    ({"load": {"max_delta_over_R": 1e-12, "unload_from": None}},
     ["load.max_delta_over_R", "1e-07 to 0.5"]),
    ({"flat.Sy_Pa": 1e3}, ["Sy_Pa", "first yield at Delta/R = "]),
    ({"accuracy.level": "best"}, ["accuracy.level", "production"]),
    ({"flat.hardness": 3}, ["flat.hardness", "unknown key"]),
]  # fmt: skip
WRONG_FLOW = [
    ({"flat.rate.q": None}, ["flat.rate.q", "missing", "cowper-symonds"]),
    ({"flat.rate.C": 0.1}, ["flat.rate.C", "0.1", "D_1_s, q"]),
    ({"flat.rate.law": "fast"}, ["flat.rate.law", "fast"]),
    ({"load.speed_m_s": None}, ["case.toml", "load.speed_m_s", "missing"]),
    ({"load.speed_m_s": -2.0}, ["speed_m_s", "-2"]),
    ({"load.speed_m_s": [[0.1, 2], [0.0, 1]]}, ["speed_m_s", "[0, 1]"]),
    ({"flat.flow_curve": "other.csv"}, ["case.toml", "flat.flow_curve", "other.csv"]),
    ({"flat.Sy_Pa": 3e8}, ["flat.Sy_Pa", "2.76e+08"]),
    ({"flat.flow_curve": None}, ["flat.Sy_Pa", "missing"]),
    ({"flat.hardening": SWIFT}, ["flat.hardening", "flow_curve"]),
    ({"flat": {**WRITTEN, "hardening": {**SWIFT, "K_Pa": 200e6}}}, ["flat.hardening.K_Pa"]),
    ({"flat": {**WRITTEN, "hardening": {"law": "swift", "K_Pa": 600e6, "b": 2}}},
     ["flat.hardening.n", "missing"]),
    ({"flat": {"nu": None, "rigid": True}}, ["flat", "rigid"]),
]  # fmt: skip


@pytest.mark.parametrize(
    ("content", "changes", "words"),
    [*((GOOD, *row) for row in WRONG), *((HARD, *row) for row in WRONG_FLOW)],
)
def test_a_mistake_is_one_line_with_its_key(tmp_path, errs, content, changes, words):
    path = case_of(tmp_path, content, changes)
    message = errs("case", path, "--out", tmp_path / "out").strip()
    assert len(message.splitlines()) == 1, message
    for word in [str(path), *words]:
        assert word in message
    assert not (tmp_path / "out").exists()


def test_a_flow_curve_of_a_recording_set_is_one_of_a_case(tmp_path):
    as_a_set = read(tmp_path, HARD, curve=CURVE.replace("stress_Pa", "true_stress_Pa"))
    assert as_a_set.pair == read(tmp_path, HARD).pair


@pytest.mark.parametrize(
    ("curve", "words"),
    [
        ("plastic_strain,stress_Pa\n0.01,276e6\n0.1,3e8\n", ["0.01", "row 2"]),
        ("plastic_strain,stress_Pa\n0,276e6\n0.1,-3e8\n", ["-3e+08", "row 3", "stress_Pa"]),
        ("plastic_strain,stress_Pa,temperature_K\n0,276e6,293\n", ["temperature_K: unknown"]),
    ],
)
def test_a_mistake_in_a_flow_curve_names_its_row(tmp_path, curve, words):
    with pytest.raises(InputError) as caught:
        read(tmp_path, HARD, curve=curve)
    for word in ["curve.csv", *words]:
        assert word in str(caught.value)


def test_a_speed_without_a_rate_is_told(tmp_path, capsys):
    tell_unused(case_of(tmp_path, GOOD, {"load.speed_m_s": 1.0}))
    assert "load.speed_m_s does nothing here: neither body has a rate" in capsys.readouterr().out
    tell_unused(case_of(tmp_path, GOOD, {"load.speed_m_s": 1.0, "flat.rate": RATE}))
    assert capsys.readouterr().out == ""


def test_a_set_up_of_an_impact_is_no_case(tmp_path):
    with pytest.raises(InputError, match="a set-up of `dentscope impact`") as refused:
        read_pair(put(tmp_path / "ball.toml", template("ball")))
    assert len(str(refused.value).splitlines()) == 1


@pytest.mark.parametrize("name", ["case_aluminium", "case_mild_steel_fast"])
def test_the_example_files_are_sound(name):
    problem, _ = read_case(Path(__file__).parents[3] / "examples" / f"{name}.toml")
    assert problem.pair.flat.flow.curve(0.1) > problem.pair.flat.Sy


def test_brinell_is_the_load_over_the_surface_of_the_dent():
    # ISO 6506: 3000 kgf, ball of 10 mm, dent of 4 mm: HB 229
    assert brinell(3000.0 * 9.80665, 10e-3, 4e-3) == pytest.approx(229.0, abs=0.5)
    assert np.isnan(brinell(1.0, 1e-3, 1e-3))


def test_the_work_of_a_loading_is_exact_for_hertz():
    d = np.geomspace(1e-6, 1e-4, 7)
    assert loading_work(d, d**1.5) == pytest.approx(0.4 * d**2.5, rel=1e-12)


def test_the_mass_of_the_ball_is_that_of_its_density(tmp_path):
    mass, weighed = 4.0 / 3.0 * np.pi * 0.002**3 * 7800.0, {"sphere.density_kg_m3": 7800}
    assert read_pair(case_of(tmp_path, GOOD, weighed))[0].ball_mass == pytest.approx(mass)
    assert np.isnan(read_pair(case_of(tmp_path, GOOD))[0].ball_mass)
    # one that does not deform weighs as much, for the programs that are given it too
    rigid = case_of(tmp_path, GOOD, {"sphere": {**NONE, "rigid": True, "density_kg_m3": 7800}})
    assert read_ball(rigid).mass == pytest.approx(mass)


@pytest.mark.fe
def test_a_pair_is_solved_without_a_file(tmp_path):
    """Beside the same numbers of a file; Hertz's force before anything yields."""
    soft = ds.Material(E=200e9, nu=0.3, Sy=5e9)
    pair = ds.Pair(ds.Material(E=200e9, nu=0.3), soft, 1e-2)
    found = ds.case(pair, level="smoke", max_delta_over_R=1e-3)
    last = found.rows()[-1]
    hertz = 4.0 / 3.0 * pair.E_reduced * 1e-2**2 * last["delta_over_R"] ** 1.5
    half = 2.5e6 * found.solution.loading.radius[-1]
    assert found.plot_fields().axes[0].get_xlim() == pytest.approx((-half, half))
    assert last["force_N"] == pytest.approx(hertz, rel=0.03)
    for wrong, key in (({"level": "fine"}, "level"), ({"friction": "0.1"}, "coefficient"),
                       ({"max_delta_over_R": "20 um"}, "max_delta_over_R"),
                       ({"unload_from": [0.4]}, "unload_from")):  # fmt: skip
        with pytest.raises(InputError, match=key):
            ds.case(pair, **wrong)


@pytest.mark.fe
def test_what_does_not_yield_gives_all_back_and_keeps_nothing():
    steel = ds.Material(E=200e9, nu=0.3)
    solved = ds.case(ds.Pair(steel, steel, 0.01), max_delta_over_R=3e-4, level="smoke")
    (dent,) = solved.measured.dents
    assert (dent.left_sphere, dent.left_flat, dent.rim_height) == (0.0, 0.0, 0.0)
    assert dent.energy_returned == pytest.approx(1.0, abs=1e-3)
    assert np.isnan(dent.brinell_by_contact)
