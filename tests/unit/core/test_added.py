"""What other packages add is found by its entry points; a package that fails is one line."""

import pickle
import tomllib
from dataclasses import replace
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from types import SimpleNamespace

import pytest
from dentscope.core import InputError
from dentscope.core.inputs import added
from dentscope.core.inputs.templates import template
from dentscope.core.inputs.toml_input import InputTable
from dentscope.discrepancy import Mechanism, Parameter
from dentscope.dynamics import strike
from dentscope.dynamics.files.setup import setup_of
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.dynamics.mechanisms.own import own_mechanisms, uncovered
from dentscope.dynamics.report.band import band_of
from dentscope.models import LAWS, law_named
from dentscope.reduce import kinds


class Options(InputTable):
    """Options of the toy."""


TOY_LAW = LAWS["johnson"]
TOY_READER = SimpleNamespace(
    ABOUT="two heights", Options=Options, reduce=lambda path, options: SimpleNamespace(
        known=lambda: path.read_text(encoding="utf-8")
    ),
)  # fmt: skip


class Toy(type(MECHANISMS[0])):
    name = "toy"
    title = "a toy"


class Brake(Mechanism):
    """Takes energy before the touch: v^2 - 2 w."""

    name = "brake"
    title = "something brakes the striker"
    equations = "v^2 -> v^2 - 2 w"
    parameters = (Parameter("work_J_kg", "J/kg", 1e-3, 2.0, "log", 0.0, "a magnet"),)

    def attach(self, scene, values, around):
        speed = (scene.approach.speed**2 - 2.0 * values["work_J_kg"]) ** 0.5
        return scene.with_(approach=replace(scene.approach, speed=speed))


@pytest.fixture
def packages(monkeypatch):
    """Installs a thing of this file, or of no file, under the name of an entry point."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent))

    def install(**points):
        found = EntryPoints(
            EntryPoint(name, value, f"dentscope.{group}") for group, (name, value) in points.items()
        )
        monkeypatch.setattr(added, "entry_points", found.select)

    return install


HERE = Path(__file__).stem


def test_a_law_of_another_package_is_found_by_its_name(packages, prints):
    packages(laws=("toy", f"{HERE}:TOY_LAW"))
    assert "Of other packages: toy." in prints("laws", "list")
    assert law_named("toy") is LAWS["toy"] is TOY_LAW
    with pytest.raises(InputError, match=r"'other'.*toy"):
        law_named("other")


def test_a_package_that_fails_is_one_line(packages):
    packages(laws=("toy", "no_such_package:LAW"))
    with pytest.raises(InputError, match=r"'toy' .* cannot be loaded") as caught:
        law_named("toy")
    assert "\n" not in str(caught.value)


def test_a_mechanism_of_another_package_is_tried_too(packages):
    packages(mechanisms=("toy", f"{HERE}:Toy"))
    [own] = own_mechanisms(())
    assert own.name == "toy"
    [note] = uncovered([own])
    assert "toy (a toy) is not of this package" in note
    assert "neither the calibration of the probabilities nor the blind proof" in note


def test_a_mechanism_of_another_package_acts_in_an_impact(packages):
    packages(mechanisms=("brakes", f"{HERE}:Brake"))
    content = tomllib.loads(template("ball")) | {"sweep": {}}
    content["impact"] = {"impact_speed_m_s": 2.0, "laws": ["fitted"]}
    brake = {"brake": {"work_J_kg": {"value": 1.5, "std": 0.1}}}
    setup = pickle.loads(pickle.dumps(setup_of(content | {"mechanisms": brake}, source="")))
    (law,) = map(law_named, setup.laws)
    braked = strike(setup.scene(law))
    slower = setup_of(content | {"impact": {"impact_speed_m_s": 1.0}}, source="").scene(law)
    assert braked.peak_depth_m == pytest.approx(strike(slower).peak_depth_m, rel=1e-9)
    assert band_of(setup, law).parts["mechanisms.brake.work_J_kg"]["peak_depth_m"] < 0.0
    for numbers, told in (
        (True, "mechanisms.brake.work_J_kg: missing"), ({"x": 1}, "mechanisms.brake.x: unknown"),
        ({"work_J_kg": 99}, "0.001 to 2"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=told):
            setup_of(content | {"mechanisms": {"brake": numbers}}, source="")
    with pytest.raises(InputError, match=r"mechanisms.break: unknown key; did you mean brake"):
        setup_of(content | {"mechanisms": {"break": True}}, source="")


@pytest.mark.parametrize("given", [MECHANISMS[0], [Toy(), Toy()], [3], 3])
def test_what_is_no_mechanism_or_bears_a_name_of_the_library_is_refused(packages, given):
    packages()
    with pytest.raises(InputError, match=r"is taken|3 \(allowed: each a discrepancy.Mechanism"):
        own_mechanisms(given)


def test_a_reader_of_another_package_reduces_or_is_told_with_the_file(packages, tmp_path):
    packages(readers=("toy", f"{HERE}:TOY_READER"))
    assert kinds.all_kinds()["toy"] == "two heights"
    (tmp_path / "raw.txt").write_text("1 0.64")
    assert kinds.load_kind("toy").run(tmp_path / "raw.txt", {}, source="") == "1 0.64"
    (tmp_path / "raw.txt").write_bytes(b"\xff")
    with pytest.raises(InputError, match=r"raw\.txt: its numbers cannot be reduced \(.*decode"):
        kinds.load_kind("toy").run(tmp_path / "raw.txt", {}, source="")


@pytest.mark.parametrize(
    ("reader", "said"),
    [("no_such_package", "cannot be loaded"), (f"{HERE}:TOY_LAW", "has no ABOUT")],
)
def test_a_reader_that_fails_is_one_line_and_the_others_still_work(packages, reader, said):
    packages(readers=("toy", reader))
    about = kinds.all_kinds()
    assert said in about["toy"]
    assert about["table"] == kinds.KINDS["table"]
    assert kinds.load_kind("table").name == "table"
    with pytest.raises(InputError, match=said):
        kinds.load_kind("toy")
