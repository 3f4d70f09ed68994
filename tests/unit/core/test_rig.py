"""A rig is read once: the same tables, the same bodies and the same mistakes in every file."""

import math

import pytest
from dentscope.core import InputError, Material
from dentscope.core.errors import InputErrors
from dentscope.core.inputs.toml_input import parse_model
from dentscope.core.rig import MaterialTable, Rig, StrikerTable, material_keys
from dentscope.dynamics.files.bodies import bodies_of
from dentscope.dynamics.files.setup import SetupFile
from dentscope.recordings import SetFile
from dentscope.start.case_file import CaseFile

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
    ("strikers", "rod", "length_m"): (None, "strikers.rod.length_m: missing"),
    ("strikers", "rod", "mass_kg"): (None, "strikers.rod.mass_kg: missing"),
    ("strikers", "rod", "shape"): ("cube", "strikers.rod.shape: 'cube'"),
    ("strikers", "rod", "E_Pa"): (-1.0, "strikers.rod.E_Pa: -1"),
    ("strikers", "rod", "tip_flat_radius_m"): (0.01, "tip_flat_radius_m: 0.01 .*below tip_radius"),
    ("target", "nu"): (0.5, "target.nu: 0.5"),
    ("target", "density_kg_m3"): ({"value": 7.8}, "target.density_kg_m3: 7.8 .*allowed: a number"),
    ("target", "E_Pa"): ("steel", "target.E_Pa: 'steel'"),
    ("target", "Sy_Pa"): ({"value": 3e8, "known": "well"}, 'target.Sy_Pa: .*known = "guess"'),
    ("strikers", "rod", "mass"): (1.0, "strikers.rod.mass: unknown key"),
    ("noise",): ({"restituton": 0.1}, "noise.restituton: unknown key"),
    ("friction",): ({"coefficient": -1.0}, "friction.coefficient: -1.0"),
    ("environment",): ({"temperature_K": 0.0}, "environment.temperature_K: 0.0"),
}


def changed(content, place, value):
    """A copy of nested tables with one key set, or left out where `value` is none."""
    first, *rest = place
    if rest:
        return {**content, first: changed(content[first], rest, value)}
    left = {k: v for k, v in content.items() if k != first}
    return left if value is None else {**left, first: value}


@pytest.mark.parametrize("model", FILES, ids=lambda m: m.__name__)
@pytest.mark.parametrize("place", MISTAKES, ids=".".join)
def test_a_mistake_reads_the_same_in_every_file(model, place):
    value, line = MISTAKES[place]
    content = changed({**FILES[model], **BODIES}, place, value)
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
    rig = parse_model(changed(BODIES, ("target", "E_Pa"), None), Rig, source="a.toml")
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
    ("changed", "key"),
    [
        ({"tip_radius_m": None}, "tip_radius_m"),
        ({"tip_radius_m": -0.005}, "tip_radius_m"),
        ({"density_kg_m3": -1.0}, "density_kg_m3"),
        ({"density_kg_m3": None}, "mass_kg"),
    ],
)
def test_what_a_spheres_mass_follows_from_is_missed_in_one_line(changed, key) -> None:
    stated = {"shape": "sphere", "tip_radius_m": 0.005, "density_kg_m3": 7800.0, **changed}
    given = {name: value for name, value in stated.items() if value is not None}
    with pytest.raises(InputErrors) as failure:
        parse_model(given, StrikerTable, source="ball.toml")
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
    hard = changed(changed(BODIES, ("target", "Sy_Pa"), None), ("target", "hardness_Pa"), 2.8e9)
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
        (("target", "densty_kg_m3"), r"did you mean density_kg_m3\?"),
        (("coefficient",), r"it belongs in \[friction\]"),
        (("length_m",), r"it belongs in \[strikers.NAME\]"),
    ],
)
def test_an_unknown_key_is_told_with_what_may_be_meant(place, told):
    with pytest.raises(InputErrors, match=f"unknown key; {told}"):
        parse_model(changed(BODIES, place, 1.0), Rig, source="a.toml")
