"""A fit's file is a law wherever a law is named; a damaged one is one line."""

import json

import numpy as np
import pytest
from dentscope.core import InputError, Material, Pair
from dentscope.models import LAWS, law_named
from dentscope.models.coefficients import COEFFICIENTS_FILE

STEEL = Material(E=200e9, nu=0.3, Sy=400e6)
PAIR = Pair(STEEL.with_(Sy=2e9), STEEL, 0.01)
DEPTH = np.geomspace(1e-6, 1e-4, 7)


@pytest.fixture
def fitted(tmp_path):
    content = json.loads(COEFFICIENTS_FILE.read_text())
    first = next(iter(content["coefficients"].values()))
    first["value"] *= 1.1
    path = tmp_path / "fitted.json"
    path.write_text(json.dumps(content))
    return path


@pytest.mark.parametrize("kind", ["compact", "fitted", "hardening"])
def test_the_shipped_file_is_the_shipped_law(kind):
    law = law_named(f"{COEFFICIENTS_FILE}:{kind}")
    assert np.array_equal(law.loading(PAIR, DEPTH), LAWS[kind].loading(PAIR, DEPTH))
    assert law.name == f"{COEFFICIENTS_FILE}:{kind}"


def test_ones_own_fit_is_another_law(fitted):
    found = law_named(str(fitted)).loading(PAIR, DEPTH)
    assert np.all(found > 0.0)
    assert not np.array_equal(found, LAWS["fitted"].loading(PAIR, DEPTH))


def test_ones_own_fit_is_exported_and_compared(fitted, tmp_path, prints):
    prints("export", "law", fitted, "--out", tmp_path / "own")
    prints("export", "law", "fitted", "--out", tmp_path / "shipped")
    own, shipped = (
        (tmp_path / name / "dentscope_contact.c").read_text() for name in ("own", "shipped")
    )
    assert own != shipped
    assert str(fitted) in prints("laws", "show", fitted).replace("\n", "")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c.pop("uncertainty"), "damaged"),
        (lambda c: c["coefficients"].popitem(), "every coefficient"),
        (lambda c: c.update(format="dentscope-coefficients/3"), "format"),
        (lambda c: c["correction"].update(weights="x"), "damaged"),
    ],
)
def test_a_damaged_fit_is_one_line(fitted, change, words):
    content = json.loads(fitted.read_text())
    change(content)
    fitted.write_text(json.dumps(content))
    with pytest.raises(InputError, match=words) as caught:
        law_named(str(fitted))
    assert "\n" not in str(caught.value)
    assert str(fitted) in str(caught.value)


def test_an_unknown_law_of_a_file_lists_the_known(fitted):
    with pytest.raises(InputError, match="compact, fitted, hardening"):
        law_named(f"{fitted}:other")
