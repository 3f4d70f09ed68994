"""The table of materials: sound numbers, sources, what a file takes from it, tuned numbers."""

import math

import dentscope as ds
import made_blows
import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.core.flow import swift, voce
from dentscope.core.inputs.flow_curve import MeasuredFlow
from dentscope.core.inputs.materials import entry_named, filled, materials, sources
from dentscope.core.inputs.toml_input import parse_model
from dentscope.core.rig import BodyTable, MaterialTable, Quantity, Rig, TargetTable
from dentscope.dynamics.mechanisms.strength.strain_rate_hardening import rises_misfit
from dentscope.start.case_file import HardeningTable, RateTable
from made_files import put


def blow(name, tmp_path, prints):
    file = put(
        tmp_path / "ball.toml",
        f'[target]\nmaterial = "{name}"\n[strikers.ball]\nshape = "sphere"\n'
        'tip_radius_m = 0.003\nmaterial = "tungsten-carbide-6co"\n'
        '[impact]\ndrop_height_m = 1.0\nlaws = ["fitted"]\n',
    )
    return prints("impact", file, "--out", tmp_path / "out")


def test_materials_with_a_source_for_every_number():
    known, named = materials(), set(sources())
    assert len(known) >= 120
    used = {n["source"] for e in known.values() for n in (*e.numbers.values(), *e.laws.values())}
    assert used == named
    for entry in known.values():
        assert {"E_Pa", "nu", "density_kg_m3"} <= set(entry.numbers)
        assert {"Sy_Pa", "hardness_Pa"} & set(entry.numbers)
        for key, number in entry.numbers.items():
            assert 0.0 < number["std"] < 0.5 * number["value"], (entry.name, key)


@pytest.mark.parametrize("name", sorted(materials()))
def test_every_entry_makes_a_body_that_files_accept(name):
    body = parse_model({"material": name}, BodyTable, source="a file")
    assert body.E_Pa.value == materials()[name].numbers["E_Pa"]["value"]
    assert body.density_kg_m3.std > 0.0
    assert (body.Sy_Pa is None) != (body.hardness_Pa is None)
    for key, table in (("hardening", HardeningTable), ("rate", RateTable)):
        law = dict(materials()[name].laws.get(key, {}))
        if law:
            del law["source"]
            parse_model(law, table, source="a file")


CLASSES = {
    "carbon steel": ((195, 213), (0.28, 0.30), (7830, 7900)),
    "alloy steel": ((195, 213), (0.28, 0.33), (7800, 7900)),
    "stainless steel": ((186, 205), (0.27, 0.31), (7650, 8030)),
    "tool steel": ((200, 225), (0.28, 0.30), (7650, 8200)),
    "bearing steel": ((198, 213), (0.28, 0.31), (7600, 7880)),
    "cast iron": ((155, 185), (0.26, 0.29), (7000, 7300)),
    "iron": ((200, 215), (0.28, 0.30), (7800, 7900)),
    "aluminium": ((68, 75), (0.32, 0.34), (2640, 2850)),
    "copper": ((110, 155), (0.27, 0.36), (8200, 9000)),
    "brass": ((95, 115), (0.30, 0.36), (8300, 8800)),
    "bronze": ((95, 122), (0.30, 0.36), (7400, 9000)),
    "nickel": ((170, 215), (0.27, 0.33), (8100, 9000)),
    "titanium": ((102, 120), (0.30, 0.37), (4400, 4550)),
    "tungsten": ((300, 415), (0.27, 0.30), (16500, 19350)),
    "polymer": ((0.4, 4.5), (0.35, 0.47), (890, 2250)),
    "hard material": ((60, 660), (0.1, 0.32), (2150, 15700)),
}
"""Modulus [GPa], Poisson's ratio and density [kg/m3] of a class (bounds of Ashby's charts)."""


def test_every_entry_is_a_body_of_its_class():
    for entry in materials().values():
        E, nu, density, Sy, H = (
            entry.numbers.get(key, {"value": None})["value"]
            for key in ("E_Pa", "nu", "density_kg_m3", "Sy_Pa", "hardness_Pa")
        )
        for value, (least, most) in zip(
            (E / 1e9, nu, density), CLASSES.get(entry.kind, ()), strict=False
        ):
            assert least <= value <= most, (entry.name, value)
        # 2.5: Brinell's number over the yield strength of a metal that no longer hardens; 8: of
        # one that hardens from rest (Tabor 1951: 2.8 to 3.3 times the stress at 8 % strain)
        assert Sy is None or H is None or 2.5 < H / Sy < 8.0, entry.name
        # of soft annealed metals, to glassy polymers and glass
        assert 5e-5 < (Sy or H / 2.8) / E < 0.05, entry.name


def test_a_stated_value_goes_first():
    stated = {"material": "aluminium-6061-t6", "E_Pa": 7.2e10, "hardness_Pa": 1.05e9}
    body = parse_model(stated, BodyTable, source="a file")
    assert body.E_Pa.value == 7.2e10
    assert body.E_Pa.std == 0.0
    assert body.Sy_Pa is None
    assert body.hardness_Pa.value == 1.05e9
    assert body.nu.value == 0.33


KNOWN = frozenset(BodyTable.model_fields)


@pytest.mark.parametrize(
    ("given", "known"),
    [({"material": "lead", "rigid": True}, KNOWN), ({"E_Pa": 1e9}, KNOWN),
     *(({"material": words}, KNOWN)
       for words in ("gouda", "float glass", "hard steel", "steel, 300 HV", "AISI 201")),
     ({"material": "tungsten-carbide", "E_Pa": 6e11, "nu": 0.2}, {"E_Pa", "nu", "density_kg_m3"})],
)  # fmt: skip
def test_rigid_bodies_descriptions_and_close_names_with_numbers_stay_as_they_are(given, known):
    assert filled(given, frozenset(known)) == given


def test_a_material_known_by_its_hardness_yields_alike_in_every_file_and_in_python():
    name = "steel-52100-hardened"
    Sy = entry_named(name).numbers["hardness_Pa"]["value"] / 2.8
    assert ds.material(name).Sy == pytest.approx(Sy)
    for table in (MaterialTable, BodyTable):
        assert table.model_validate({"material": name}).strength.value == pytest.approx(Sy)
    stated = MaterialTable.model_validate({"material": name, "Sy_Pa": 1e9})
    assert stated.strength.value == 1e9
    with pytest.raises(ValueError, match="hardness_Pa"):
        MaterialTable.model_validate({"material": name, "hardness_Pa": 8e9})


def test_a_sphere_of_a_known_material_has_its_mass():
    content = {
        "target": {"material": "aluminium-7075-t6"},
        "strikers": {
            "ball": {"shape": "sphere", "tip_radius_m": 5e-3, "material": "soda-lime-glass"}
        },
    }
    rig = parse_model(content, Rig, source="a file")
    assert rig.strikers["ball"].mass_kg.value == pytest.approx(2500 * 4 / 3 * 3.14159265 * 5e-3**3)


def test_from_python():
    metal = ds.material("copper-ofhc-annealed")
    assert (metal.E, metal.Sy, metal.density) == (129.8e9, 90e6, 8960.0)
    with pytest.raises(InputError, match="aluminium-6061-t6"):
        ds.material("aluminium-6061-t66")


@pytest.mark.parametrize(
    ("words", "name"),
    [("C26000", "brass-c260-half-hard"), ("1.4301", "steel-304-annealed"), ("SUS304", "steel-304l"),
     ("S355JR", "steel-s355"), ("EN AW-6082", "aluminium-6082-t6"), ("100Cr6", "steel-52100-"),
     ("stainless", "steel-17-4ph"), ("Teflon", "ptfe"), ("half hard Brass", "brass-c360")],
)  # fmt: skip
def test_any_word_of_name_designation_or_description_finds_it(words, name, prints):
    assert name in prints("materials", words)


def test_polymers_have_a_word_of_warning(tmp_path, prints):
    polymers = [entry for entry in materials().values() if entry.kind == "polymer"]
    assert len(polymers) > 5
    assert all("stiffer and stronger the faster" in entry.note for entry in polymers)
    assert f"ptfe: {materials()['ptfe'].note}" in blow("ptfe", tmp_path, prints)


def test_the_commands(prints, errs):
    assert "steel-1006\n" in prints("materials")
    told = prints("materials", "steel-1006")
    assert "350 +- 28 MPa: johnson-cook-1983." in told
    assert "Proc. 7th Int. Symp. Ballistics" in told
    assert 'In a file: material = "steel-1006"; ' in told
    assert "steel-1010-hot-rolled" in errs("materials", "steel-1106-hot-rolled")


def test_an_impact_of_two_named_materials():
    aluminium = {"E_Pa": 68.9e9, "nu": 0.33, "Sy_Pa": 276e6}
    steel = {"E_Pa": 200e9, "nu": 0.283, "density_kg_m3": 7670, "hardness_Pa": 7.4e9}
    named, stated = (
        made_blows.blow(made_blows.ball_setup(target=flat, ball=metal, radius=0.003).content)
        for flat, metal in (
            ({"material": "aluminium-6061-t6"}, {"material": "steel-440c-hardened"}),
            (aluminium, steel),
        )
    )
    assert named["fitted"].restitution == pytest.approx(stated["fitted"].restitution, rel=1e-9)


def test_hardening_and_rate_are_those_of_the_same_kind_first(tmp_path, prints):
    """Half-hard brass hardens less than annealed brass, and than aluminium: the told -18 %."""
    lines = blow("brass-c260-half-hard", tmp_path, prints).splitlines()
    told = [line for line in lines if "others of its kind (brass, 1)" in line]
    assert len(told) == 2
    assert -6.0 < float(told[1].split("dent ")[1].split()[0]) < -1.0


def test_a_name_close_to_listed_ones_is_told_where_it_leaves_numbers_out(tmp_path, errs):
    """The name has the line, not the numbers that it would have given."""
    path = put(
        tmp_path / "typed.toml",
        '[target]\nmaterial = "steel-1016-hot-rolled"\n'
        '[strikers.ball]\nshape = "sphere"\nmaterial = "tungsten-carbide"\ntip_radius_m = 0.0025\n'
        "[impact]\ndrop_height_m = 0.5\n",
    )
    lines = errs("impact", path).splitlines()
    assert len(lines) == 2
    assert "target.material: 'steel-1016-hot-rolled' (allowed: steel-1" in lines[0]
    assert "strikers.ball.material: 'tungsten-carbide' (allowed: tungsten-carbide-6co" in lines[1]


@pytest.mark.parametrize("words", ["100Cr6", "1.3505", "52100", "AISI 52100", "suj2"])
def test_a_designation_of_one_entry_gives_what_its_name_does(words):
    assert filled({"material": words}, KNOWN) == filled({"material": "steel-52100-hardened"}, KNOWN)
    assert filled({"material": words, "nu": 0.28}, KNOWN)["nu"] == 0.28
    assert ds.material(words) == ds.material("steel-52100-hardened")


def test_a_designation_of_two_entries_is_told_with_both():
    with pytest.raises(InputError, match=r"'1\.4301' .*steel-304-annealed, steel-304-balls"):
        parse_model({"material": "1.4301"}, BodyTable, source="a file")


def measured(strain, stress):
    none = np.full(len(strain), math.nan)
    return MeasuredFlow(np.array(strain), np.array(stress), none, none)


def test_rows_of_a_curve_within_an_eighth_of_a_decade_are_one() -> None:
    """A hundred rows over two decades become sixteen, and the first at no strain."""
    strain = np.geomspace(1.0001e-3, 0.0999, 1000)
    found = measured(strain, 3e8 + 1e9 * strain).curve(3e8)
    assert len(found.strain) == 1 + 16


def test_strains_below_a_ten_thousandth_are_one_row() -> None:
    strain = [1e-7, 1e-6, 1e-5, 0.9e-4, 3e-3, 0.1]
    found = measured(strain, [3e8, 3e8, 3e8, 3e8, 4e8, 5e8]).curve(3e8)
    assert found.strain[1] == pytest.approx(np.mean(strain[:4]))


def test_a_written_law_has_200_rows_from_a_millionth_to_ten() -> None:
    found = voce(Sy=3e8, Q=1e8, b=20.0)
    assert (len(found.strain), found.strain[0]) == (201, 0.0)
    assert found.strain[1] == pytest.approx(1e-6)
    assert found.strain[-1] == pytest.approx(10.0)


def test_a_strength_from_a_hardness_is_known_to_a_tenth_and_what_the_hardness_is() -> None:
    """Hardness over strength differs by a tenth between metals; unstated it is known to 11 %."""

    def relative(std):
        given = Quantity(value=3e9, std=std)
        return TargetTable(E_Pa=2e11, nu=0.3, hardness_Pa=given).strength.relative

    assert relative(3e8) == pytest.approx(math.hypot(0.1, 0.1))
    assert relative(0.0) == pytest.approx(math.hypot(0.11, 0.1))


def test_two_specimens_of_a_metal_differ_by_a_tenth() -> None:
    """Each by 7 %: the difference of two by 7 % times the root of 2."""
    found = rises_misfit(
        [(1000.0, 1.0)], np.array(math.expm1(0.07 * math.sqrt(2.0))), np.array(0.0)
    )
    assert float(found) == pytest.approx(1.0)


def test_a_first_strain_of_nothing_begins_as_steep_as_a_cubic_may() -> None:
    """e0 = (1000/1500)^(1/0.000558) is 3e-316, which has no inverse."""
    curve = swift(Sy=1000.0, K=1500.0, n=5.580983873792373e-4)
    rise = curve.stress[1] - curve.stress[0]
    assert curve.slope[0] == pytest.approx(3.0 * rise / curve.strain[1], rel=1e-9)
    assert np.isfinite(curve.slope).all()
