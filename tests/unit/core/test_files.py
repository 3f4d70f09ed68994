"""Files, rigs and origins: what is none, what is too large, mistakes in one line."""

import math
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core import InputError, InputErrors, Material, Pair, provenance, rendering
from dentscope.core.errors import Ending, Outcome
from dentscope.core.inputs.input_file import read_bytes
from dentscope.core.inputs.templates import template, write_new
from dentscope.core.inputs.toml_input import parse_model, read_model, read_toml
from dentscope.core.output import locked, write_file
from dentscope.core.processes.confined import confined
from dentscope.core.provenance import canonical_json, content_id
from dentscope.core.rig import Mass, MaterialTable, Rig, StrikerTable, material_keys
from dentscope.dynamics.files.bodies import bodies_of
from dentscope.dynamics.files.setup import SetupFile
from dentscope.dynamics.files.sweep import SweepTable
from dentscope.recordings import SetFile
from dentscope.start.case_file import CaseFile
from made_files import changed, put
from pydantic import TypeAdapter, ValidationError


def test_a_pipe_a_device_and_a_large_file_are_a_line_each(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="a pipe or a device, no file"):
        read_bytes(tmp_path / "pipe", most=10, allowed="a file")
    with pytest.raises(InputError, match="a pipe or a device, no file"):
        read_toml(Path("/dev/zero"))
    with (tmp_path / "large").open("wb") as file:
        file.truncate(10**12)
    with pytest.raises(InputError, match=r"1000000 MB .*up to 4 MB"):
        read_toml(tmp_path / "large")


BAD_TOML = {
    "nested": (b"a = " + b"[" * 5000, "nested too deep"),
    "digits": (b"a = " + b"9" * 5000, "too many digits"),
    "UTF-16": ("a = 1\n".encode("utf-16"), r"UTF-16.*saved as UTF-8"),
    "bytes": (b"\xff\xfe\x00", r"a\.toml"),
    "half a line": (b"a = ", r"a\.toml"),
    "a key twice": (b"a = 1\na = 2\n", r"a\.toml"),
}


@pytest.mark.parametrize("reads", [read_toml, lambda path: read_model(path, MaterialTable)])
@pytest.mark.parametrize(("content", "line"), BAD_TOML.values(), ids=BAD_TOML)
def test_a_file_that_is_no_toml_is_one_line(tmp_path, content, line, reads):
    (tmp_path / "a.toml").write_bytes(content)
    with pytest.raises(InputError, match=line) as caught:
        reads(tmp_path / "a.toml")
    assert len(str(caught.value).splitlines()) == 1


def test_a_hundred_thousand_bad_rows_are_twenty_lines_and_a_count(tmp_path, errs):
    folder = tmp_path / "set"
    assert run(["recordings", "new", str(folder), "--sphere"]) == 0
    head = (folder / "trials.csv").read_text().splitlines()[0]
    (folder / "trials.csv").write_text(head + "\n" + "\x1b[2J,ball,x,y,z,,\n" * 100_000)
    lines = errs("recordings", "check", folder).splitlines()
    assert len(lines) == 21
    assert lines[-1].startswith("... and ")
    assert not any("\x1b" in line for line in lines)


@pytest.mark.parametrize("name", ["a" * 300, "nul\0", "folder", "file/below"])
def test_what_cannot_be_written_is_a_line_and_leaves_nothing(tmp_path, name):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("kept")
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError) as caught:
        write_file(tmp_path / name, "text")
    assert "\n" not in str(caught.value)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_name_that_is_no_text_makes_a_file(tmp_path):
    file = tmp_path / os.fsdecode(b"k\xfc.toml")
    write_new(template("ball"), file, command="impact")
    assert read_toml(file)["target"]


def test_a_replaced_file_keeps_its_mode_and_a_link_its_target(tmp_path):
    (tmp_path / "a").write_text("old")
    (tmp_path / "a").chmod(0o600)
    (tmp_path / "link").symlink_to(tmp_path / "a")
    write_file(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "a").read_text() == "new"
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o600


def test_the_lock_of_a_folder_leaves_no_file(tmp_path):
    with locked(tmp_path / "set"):
        assert list(tmp_path.iterdir()) == []


def test_work_that_takes_too_much_memory_is_a_line():
    assert confined(np.ones, 10, source="book.xlsx").sum() == 10.0
    with pytest.raises(InputError, match="holds, or claims to hold, more than 1 GB"):
        confined(np.ones, 10**9, source="book.xlsx")


@pytest.mark.parametrize(
    ("keys", "word"),
    [
        ({"E": -1.0, "nu": 0.3}, "E_Pa"),
        ({"E": math.inf, "nu": 0.3}, "E_Pa"),
        ({"E": math.nan, "nu": 0.3}, "E_Pa"),
        ({"E": 2e11, "nu": 0.5}, "nu"),
        ({"E": 2e11, "nu": -0.1}, "nu"),
        ({"E": 2e11, "nu": 0.3, "Sy": 0.0}, "Sy_Pa"),
        ({"E": 2e11, "nu": 0.3, "Sy": math.nan}, "Sy_Pa"),
    ],
)
def test_impossible_material_names_the_key(keys, word):
    with pytest.raises(InputError, match=word):
        Material(**keys)


def test_two_rigid_bodies_are_refused():
    rigid = Material(E=math.nan, nu=math.nan, rigid=True)
    with pytest.raises(InputError, match="at most one rigid"):
        Pair(rigid, rigid, 1e-3)


def test_reduced_modulus_and_shares():
    steel, aluminium = Material(E=200e9, nu=0.3, Sy=1e9), Material(E=70e9, nu=0.33, Sy=3e8)
    pair = Pair(sphere=aluminium, flat=steel, R=1e-3)
    # Johnson, Contact Mechanics (1985), Eq. 4.2: compliances add up
    assert 1.0 / pair.E_reduced == pytest.approx((1 - 0.33**2) / 70e9 + (1 - 0.3**2) / 200e9)
    assert pair.elastic_share == pytest.approx(0.73669, abs=1e-5)
    assert pair.weaker is aluminium
    assert pair.Sy_ratio == pytest.approx(0.3)


def test_every_mistake_of_a_file_is_one_line(tmp_path):
    path = put(tmp_path / "body.toml", "E_Pa = -3\nnu = 0.7\nfoo = 2\n")
    with pytest.raises(InputErrors) as caught:
        read_model(path, MaterialTable)
    lines = str(caught.value).splitlines()
    assert len(lines) == 3
    assert all(line.startswith(str(path)) for line in lines)
    assert "unknown key" in lines[2]


def test_content_id_ignores_order_and_keeps_every_digit():
    assert content_id({"a": 0.1, "b": (1, 2)}) == content_id({"b": [1, 2], "a": 0.1})
    assert content_id({"a": 0.1}) != content_id({"a": 0.1 + 2e-17 * 8})
    assert canonical_json(0.5) == '"0x1.0000000000000p-1"'
    with pytest.raises(TypeError):
        canonical_json(object())


def test_outcome_reads_as_a_sentence():
    outcome = Outcome(Ending.TIME_LIMIT, "stopped after 3 s.", "Allow more.")
    assert str(outcome) == "time-limit: stopped after 3 s. Allow more."
    assert not outcome.completed


def test_mistakes_cross_to_another_process_one_by_one():
    one = InputError("-1 is negative", source="pair.toml", key="E_Pa", allowed="above 0")
    both = pickle.loads(pickle.dumps(InputErrors((one, InputError("no such law", key="law")))))
    assert str(both) == "pair.toml: E_Pa: -1 is negative (allowed: above 0)\nlaw: no such law"
    assert [error.key for error in both.errors] == ["E_Pa", "law"]


def test_a_byte_order_mark_is_passed_over(tmp_path):
    assert read_toml(put(tmp_path / "a.toml", "\ufeffa = 1\n")) == {"a": 1}


def test_long_names_are_cut_and_tables_beyond_number_are_refused_at_once(tmp_path):
    path = put(tmp_path / "a.toml", "k" * 100_000 + " = 1\n")
    with pytest.raises(InputErrors) as told:
        read_model(path, SweepTable)
    assert len(str(told.value)) < 1000
    path.write_text("".join(f"[a{k}.b.c]\n" for k in range(20_001)))
    with pytest.raises(InputError, match=r"20001 tables \(allowed: up to 20000\)"):
        read_toml(path)
    path.write_text("".join(f"a{k} = 1\n" for k in range(500)))
    with pytest.raises(InputErrors, match=r"a\.toml: 300 more mistakes"):
        read_model(path, SweepTable)


def test_a_standard_deviation_of_more_than_a_hundred_values_is_refused():
    mass = TypeAdapter(Mass)
    assert mass.validate_python({"value": 1.0, "std": 100.0}).relative == 100.0
    with pytest.raises(ValidationError, match="at most 100 times the value"):
        mass.validate_python({"value": 1.0, "std": 1e300})


@pytest.mark.parametrize(
    ("name", "value"),
    [("impact_speed_m_s", 1e5), ("drop_height_m", 1e10), ("friction", 1e9), ("mass_kg", 1e-300)],
)
def test_a_sweep_has_the_ranges_of_a_single_impact(name, value):
    with pytest.raises(ValidationError):
        SweepTable.model_validate({name: [value]})
    assert SweepTable.model_validate({name: [1.0, 2.0]}).count == 2


BODIES = {
    "target": {"E_Pa": {"value": 2.0e11, "std": 4e9}, "nu": 0.3, "Sy_Pa": 3e8},
    "strikers": {
        "rod": {
            "shape": "rod", "tip_radius_m": 0.01, "radius_m": 0.008, "length_m": 0.3,
            "mass_kg": {"value": 0.5, "std": 0.01}, "E_Pa": 7e10, "nu": 0.33, "density_kg_m3": 2700,
        }
    },
}  # fmt: skip
FILES = {
    Rig: {},
    SetFile: {"format": "recording-set/1"},
    SetupFile: {"impact": {"impact_speed_m_s": 1.0}},
}
MISTAKES = {
    "strikers.rod.length_m": (None, "strikers.rod.length_m: missing"),
    "strikers.rod.mass_kg": (None, "strikers.rod.mass_kg: missing"),
    "strikers.rod.shape": ("cube", "strikers.rod.shape: 'cube'"),
    "strikers.rod.E_Pa": (-1.0, "strikers.rod.E_Pa: -1"),
    "strikers.rod.tip_flat_radius_m": (0.01, "tip_flat_radius_m: 0.01 .*below tip_radius"),
    "target.nu": (0.5, "target.nu: 0.5"),
    "target.density_kg_m3": ({"value": 7.8}, "target.density_kg_m3: 7.8 .*allowed: a number"),
    "target.E_Pa": ("steel", "target.E_Pa: 'steel'"),
    "target.Sy_Pa": ({"value": 3e8, "known": "well"}, 'target.Sy_Pa: .*known = "guess"'),
    "strikers.rod.Sy_Pa": ({"value": 3e8, "std": 1e7, "known": "guess"}, "std, not both"),
    "strikers.rod.mass": (1.0, "strikers.rod.mass: unknown key"),
    "noise": ({"restituton": 0.1}, "noise.restituton: unknown key"),
    "friction": ({"coefficient": -1.0}, "friction.coefficient: -1.0"),
    "environment": ({"temperature_K": 0.0}, "environment.temperature_K: 0.0"),
}


@pytest.mark.parametrize("model", FILES, ids=lambda m: m.__name__)
@pytest.mark.parametrize("place", MISTAKES)
def test_a_mistake_reads_the_same_in_every_file(model, place):
    value, line = MISTAKES[place]
    content = changed({**FILES[model], **BODIES}, {place: value})
    with pytest.raises(InputErrors, match=line) as caught:
        parse_model(content, model, source="a.toml")
    assert len(caught.value.errors) == 1


def test_a_rig_gives_the_bodies_of_a_scene():
    rig = parse_model(BODIES, Rig, source="a.toml")
    pair, rod = bodies_of(rig.numbers(), "rod")
    assert (pair.flat.E, pair.flat.Sy, pair.R) == (2.0e11, 3e8, 0.01)
    assert (pair.sphere.E, pair.sphere.Sy, pair.sphere.density) == (7e10, math.inf, 2700.0)
    # m (L^2/12 + r^2/4) by hand: 0.5 (0.0075 + 0.000016)
    assert rod.inertia == pytest.approx(0.003758, rel=1e-12)
    values = {"strikers.rod.mass_kg": 1.0, "target.E_Pa": 1e11, "strikers.rod.tip_radius_m": 0.02}
    pair, heavy = bodies_of(rig.numbers().with_(values), "rod")
    assert (pair.flat.E, pair.R, heavy.mass) == (1e11, 0.02, 1.0)
    assert heavy.inertia == pytest.approx(2.0 * rod.inertia, rel=1e-12)
    assert heavy.radius == rod.radius


def test_what_is_not_stated_is_a_mistake_unless_something_stands_in():
    rig = parse_model(changed(BODIES, {"target.E_Pa": None}), Rig, source="a.toml")
    with pytest.raises(InputError, match=r"a\.toml: target\.E_Pa: missing"):
        bodies_of(rig.numbers(), "rod", source="a.toml")
    assert bodies_of(rig.numbers().assuming(E_Pa=1e11), "rod")[0].flat.E == 1e11


def test_a_case_takes_the_quantities_of_a_set():
    steel = {"E_Pa": {"value": 2.1e11, "std": 2e9}, "nu": 0.3}
    content = {"radius_m": 0.01, "sphere": steel, "flat": {"rigid": True},
               "load": {"max_delta_over_R": 0.01}}  # fmt: skip
    found = parse_model(content, CaseFile, source="CASE.toml")
    assert found.sphere.to_material("sphere") == Material(E=2.1e11, nu=0.3)
    assert found.flat.to_material("flat").rigid


@pytest.mark.parametrize(
    "body",
    [Material(E=2e11, nu=0.3, Sy=3e8), Material(E=7e10, nu=0.0), Material(0.0, 0.0, rigid=True)],
)
def test_keys_of_a_material_give_it_again(body):
    keys = material_keys(body)
    assert material_keys(MaterialTable.model_validate(keys).to_material()) == keys


def test_an_inertia_in_another_unit_is_a_mistake():
    """51 kg mm2 of a rod of 60 g and 100 mm by 10 mm; all of it at the ends it has 1.5e-4 kg m2."""
    rod = {"shape": "rod", "tip_radius_m": 0.005, "mass_kg": 0.06, "radius_m": 0.005,
           "length_m": 0.1}  # fmt: skip
    assert StrikerTable.model_validate(rod | {"inertia_kg_m2": 1.5e-4}).inertia == 1.5e-4
    with pytest.raises(ValueError, match=r"at most 0\.000726"):
        StrikerTable.model_validate(rod | {"inertia_kg_m2": 51.0})


def test_a_sphere_is_a_solid_ball():
    ball = StrikerTable.model_validate({"shape": "sphere", "tip_radius_m": 0.01, "mass_kg": 0.5})
    assert ball.inertia == pytest.approx(2e-5)
    assert ball.length == 0.0


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"tip_radius_m": None}, "tip_radius_m"),
        ({"tip_radius_m": -0.005}, "tip_radius_m"),
        ({"density_kg_m3": -1.0}, "density_kg_m3"),
        ({"density_kg_m3": None}, "mass_kg"),
    ],
)
def test_what_a_spheres_mass_follows_from_is_missed_in_one_line(changes, key) -> None:
    stated = {"shape": "sphere", "tip_radius_m": 0.005, "density_kg_m3": 7800.0}
    with pytest.raises(InputErrors) as failure:
        parse_model(changed(stated, changes), StrikerTable, source="ball.toml")
    assert [error.key for error in failure.value.errors] == [key]


def test_one_number_of_a_rig_is_replaced_and_the_rest_is_shared():
    stated = parse_model(BODIES, Rig, source="a.toml").numbers()
    assert stated.of["target.Sy_Pa"] == 3e8
    assert (stated.of["strikers.rod.length_m"], stated.of["gravity_m_s2"]) == (0.3, 9.81)
    other = stated.with_({"target.Sy_Pa": 4e8})
    assert {k: x for k, x in other.of.items() if x != stated.of[k]} == {"target.Sy_Pa": 4e8}
    assert stated.of["target.Sy_Pa"] == 3e8
    with pytest.raises(TypeError):
        stated.of["target.Sy_Pa"] = 1.0


def test_a_strength_follows_from_the_hardness_and_a_rigid_body_has_no_number():
    hard = changed(BODIES, {"target": {"Sy_Pa": None, "hardness_Pa": 2.8e9}})
    found = parse_model(hard, Rig, source="a.toml").numbers()
    assert found.of["target.Sy_Pa"] == pytest.approx(1e9, rel=1e-12)
    rigid = parse_model({**BODIES, "target": {"rigid": True}}, Rig, source="a.toml").numbers()
    assert rigid.assuming(E_Pa=2e11, nu=0.3).material("target").rigid
    assert "target.E_Pa" not in rigid.assuming(E_Pa=2e11).of


def test_a_further_striker_is_of_the_metal_of_another():
    stated = parse_model(BODIES, Rig, source="a.toml").numbers()
    more = stated.with_striker("heavy", "rod", {**stated.striker("rod"), "mass_kg": 2.0})
    assert more.material("strikers.heavy") == stated.material("strikers.rod")
    assert bodies_of(more, "heavy")[1].mass == 2.0
    assert "strikers.heavy.mass_kg" not in stated.of


def test_a_sphere_may_have_its_radius_as_a_body_has():
    radius = {"value": 0.01, "std": 1e-4}
    balls = [
        StrikerTable.model_validate({"shape": "sphere", key: radius, "density_kg_m3": 7800})
        for key in ("tip_radius_m", "radius_m")
    ]
    assert balls[0] == balls[1]
    # two different numbers stay two: a lens
    lens = {"shape": "sphere", "tip_radius_m": 0.02, "radius_m": 0.01, "mass_kg": 0.1}
    assert StrikerTable.model_validate(lens).body_radius == 0.01


@pytest.mark.parametrize(
    ("place", "told"),
    [
        ("target.densty_kg_m3", r"did you mean density_kg_m3\?"),
        ("coefficient", r"it belongs in \[friction\]"),
        ("length_m", r"it belongs in \[strikers.NAME\]"),
    ],
)
def test_an_unknown_key_is_told_with_what_may_be_meant(place, told):
    with pytest.raises(InputErrors, match=f"unknown key; {told}"):
        parse_model(changed(BODIES, {place: 1.0}), Rig, source="a.toml")


def test_digest_of_a_file_is_the_published_one(tmp_path):
    path = tmp_path / "abc"
    path.write_bytes(b"abc")
    # FIPS 180-2, appendix B.1
    expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert provenance.file_digest(path) == expected


def test_environment_names_what_influences_numbers():
    found = provenance.environment()
    assert {"dentscope", "python", "numpy", "scipy", "gmsh", "commit"} <= set(found)
    assert found["python"] == sys.version.split()[0]


def test_an_edited_source_is_another_one(tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "__file__", str(tmp_path / "core" / "provenance.py"))
    (tmp_path / "fem").mkdir()
    sources = set()
    for text in ("a = 1\n", "a = 2\n", "a = 1\n"):
        (tmp_path / "fem" / "solve.py").write_text(text)
        sources.add(provenance._source())
    assert len(sources) == 2


def test_numbers_that_are_not_finite_have_an_identity():
    assert provenance.content_id(math.inf) != provenance.content_id(-math.inf)
    assert provenance.content_id(math.nan) == provenance.content_id(math.nan)


def test_rigid_partner_leaves_the_whole_approach_to_the_other_body():
    rigid = Material(E=math.nan, nu=math.nan, rigid=True)
    steel = Material(E=200e9, nu=0.3, Sy=1e9)
    assert Pair(steel, rigid, 1e-3).elastic_share == 1.0
    assert Pair(rigid, steel, 1e-3).elastic_share == 0.0
    assert Pair(rigid, steel, 1e-3).Sy_ratio == math.inf
    assert Pair(rigid, steel, 1e-3).weaker is steel


@pytest.mark.parametrize(("code", "expected"), [(0, True), (1, False), (-11, False)])
def test_a_crash_of_the_probe_is_a_no(monkeypatch, code, expected):
    monkeypatch.setattr(
        rendering.subprocess, "run", lambda *a, **k: subprocess.CompletedProcess(a, code)
    )
    assert rendering.offscreen_available.__wrapped__() is expected


def test_a_probe_that_hangs_is_a_no(monkeypatch):
    def hang(*arguments, **options):
        raise subprocess.TimeoutExpired("probe", options["timeout"])

    monkeypatch.setattr(rendering.subprocess, "run", hang)
    assert rendering.offscreen_available.__wrapped__() is False
