"""Commands of recording sets, and sets made in memory that survive the way through files."""

import re
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli.recordings import app
from dentscope.core.observables import OBSERVABLES
from dentscope.core.rig import Quantity, StrikerTable, TargetTable
from dentscope.recordings import (
    CONDITIONS,
    MEASURED,
    RecordingSet,
    SetFile,
    Trials,
    read,
    write,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from made_processes import python
from typer.testing import CliRunner

DATA = Path(__file__).parents[3] / "data" / "recordings"


def run(*arguments):
    result = CliRunner().invoke(app, [str(a) for a in arguments])
    return result.output, result.exception


@pytest.mark.parametrize(("option", "count"), [([], 10), (["--rod"], 12)])
def test_template_is_a_set_to_fill_in(tmp_path, option, count):
    _, failure = run("new", tmp_path / "set", *option)
    assert failure is None
    header = (tmp_path / "set" / "trials.csv").read_text()
    assert ",restitution,permanent_depth_m,dent_diameter_m," in header
    _, failure = run("check", tmp_path / "set")
    lines = str(failure).splitlines()
    assert sum("to fill in" in line for line in lines) == count
    assert "no trial" in lines[-1]
    assert len(lines) == count + 1


def test_audit_prints_contradictions_and_all_checks_on_request():
    text, _ = run("audit", DATA / "thesis-chapter-5")
    assert "contradiction: mass of rod: 0.4607 kg stated" in text
    assert "friction" not in text
    text, _ = run("audit", DATA / "thesis-chapter-5", "--all")
    assert "consistent: friction of A20" in text


def test_list_names_every_set():
    text, _ = run("list", DATA)
    assert len(text.splitlines()) == len(list(DATA.glob("*/set.toml")))
    assert "thesis-chapter-3: 3 trials; restitution, permanent_depth_m" in text


numbers = st.floats(1e-6, 1.0, allow_nan=False)
moduli = st.floats(1e7, 1e11).map(lambda value: Quantity(value=value))
words = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=20).filter(
    lambda s: s != "?"  # asks to be filled in
)
names = st.text("abcdefgh 0123456789-_.", min_size=1, max_size=8).filter(
    lambda s: s == s.strip() and s not in (".", "..")
)


def test_list_goes_on_after_a_set_that_is_not_sound(tmp_path, errs, prints):

    assert "no set in it" in errs("recordings", "list", tmp_path)
    for name in ("a", "b"):
        write(read(DATA / "leeb-steel-300hv"), tmp_path / name)
    (tmp_path / "a" / "trials.csv").write_text("trial\n")
    first, second = prints("recordings", "list", tmp_path).splitlines()
    assert first.startswith("a: ")
    assert "row 1, column striker: missing" in first
    assert second.startswith("b: ")


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_any_sound_set_comes_back_from_its_files(data, tmp_path_factory):
    # known to its own size at the worst
    quantity = st.builds(
        lambda value, share: Quantity(value=value, std=share * value),
        numbers,
        st.just(0.0) | st.floats(1e-6, 1.0),
    )
    rod = StrikerTable(
        shape="rod",
        # a name close to a listed one, without what that would give, is refused as mistyped
        material=data.draw(words.map(lambda word: f"made up, {word}")),
        tip_radius_m=data.draw(quantity),
        mass_kg=data.draw(quantity),
        radius_m=data.draw(quantity),
        length_m=data.draw(quantity),
        E_Pa=data.draw(st.none() | moduli),
    )
    observable = data.draw(st.sampled_from([k for k in MEASURED if "impact" in OBSERVABLES[k].of]))
    striker = data.draw(names)
    setup = SetFile(
        format="recording-set/1",
        description=data.draw(words),
        target=TargetTable(E_Pa=data.draw(st.none() | moduli), law=data.draw(st.sampled_from(
            ["elastic-plastic", "table", "elastic", "measured-restitution"]))),
        strikers={striker: rod},
        noise={observable: data.draw(numbers)},
    )  # fmt: skip
    trial = data.draw(st.lists(names, min_size=1, max_size=4, unique=True))
    n = len(trial)
    # no dent is wider than the tip
    read_off = st.floats(1e-6, min(0.1, 2.0 * rod.tip_radius_m.value))
    values = data.draw(st.lists(read_off | st.just(np.nan), min_size=n, max_size=n))
    trials = Trials(
        trial=tuple(trial),
        striker=(striker,) * n,
        angle_deg=np.array(data.draw(st.lists(st.floats(0.1, 90), min_size=n, max_size=n))),
        drop_height_m=np.array(data.draw(st.lists(numbers, min_size=n, max_size=n))),
        # a restitution above 1 needs a reason
        note=("made up",) * n,
        observables={observable: np.array(values)},
    )
    folder = tmp_path_factory.mktemp("set")
    write(RecordingSet(setup, trials), folder)
    found = read(folder)
    assert found.setup == setup
    assert found.trials.trial == trials.trial
    np.testing.assert_array_equal(found.trials.angle_deg, trials.angle_deg)
    np.testing.assert_array_equal(found.trials.drop_height_m, trials.drop_height_m)
    np.testing.assert_array_equal(found.values(observable), trials.observables[observable])


def test_the_documentation_names_every_key_and_column_and_its_block_runs(monkeypatch):
    text = (DATA.parents[1] / "docs" / "recording-set.md").read_text(encoding="utf-8")
    for name in (*CONDITIONS, *MEASURED, *TargetTable.model_fields, *StrikerTable.model_fields):
        assert f"`{name}`" in text or f"`{name} =" in text, name
    (block,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    monkeypatch.chdir(DATA.parents[1])
    names = {}
    exec(compile(block, "recording-set.md", "exec"), names)
    assert names["found"].setup.strikers["rod"].mass_kg.value == 0.4607


def test_help_on_a_reduction_loads_nothing_that_reduces():
    listed = "import sys; from dentscope.reduce.kinds import KINDS, load_kind; "
    listed += "import dentscope.reduce.output.row; [load_kind(k) for k in KINDS]; "
    listed += "heavy = {'scipy', 'matplotlib', 'numba', 'skimage'} & set(sys.modules); "
    python("-c", listed + "assert not heavy, heavy", check=True)
