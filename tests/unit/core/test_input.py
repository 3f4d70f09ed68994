"""Mistakes in input come as one line each; identities do not depend on how things are written."""

import math
import pickle

import pytest
from dentscope.core import Ending, InputError, InputErrors, Material, Outcome, Pair
from dentscope.core.inputs.toml_input import read_model
from dentscope.core.provenance import canonical_json, content_id
from dentscope.core.rig import MaterialTable


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
    path = tmp_path / "body.toml"
    path.write_text("E_Pa = -3\nnu = 0.7\nfoo = 2\n")
    with pytest.raises(InputErrors) as caught:
        read_model(path, MaterialTable)
    lines = str(caught.value).splitlines()
    assert len(lines) == 3
    assert all(line.startswith(str(path)) for line in lines)
    assert "unknown key" in lines[2]


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"a = ", b"a = 1\na = 2\n"])
def test_a_file_that_is_no_toml_is_one_line(tmp_path, content):
    path = tmp_path / "body.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_model(path, MaterialTable)
    assert len(str(caught.value).splitlines()) == 1


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
