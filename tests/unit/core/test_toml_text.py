"""TOML as Windows editors save it, and numbers that nobody knows."""

import pytest
from dentscope.core import InputError, InputErrors
from dentscope.core.inputs.toml_input import read_model, read_toml
from dentscope.core.rig import Mass
from dentscope.dynamics.files.sweep import SweepTable
from pydantic import TypeAdapter, ValidationError


def test_a_byte_order_mark_is_passed_over_and_utf_16_is_named(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text("a = 1\n", encoding="utf-8-sig")
    assert read_toml(path) == {"a": 1}
    path.write_text("a = 1\n", encoding="utf-16")
    with pytest.raises(InputError, match=r"UTF-16.*saved as UTF-8"):
        read_toml(path)


def test_long_names_are_cut_and_tables_beyond_number_are_refused_at_once(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text("k" * 100_000 + " = 1\n")
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
