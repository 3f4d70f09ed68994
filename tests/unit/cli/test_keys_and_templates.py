"""Templates run as they are written; the reference of keys comes from the schemas, complete."""

import csv
import tomllib
from pathlib import Path

import pytest
from dentscope.cli import run
from dentscope.cli.shared.keys import FILES, keys_of
from dentscope.core.inputs.templates import CASE, INVERSE, KINDS, template


@pytest.mark.parametrize("kind", FILES)
def test_every_key_says_what_it_means_and_allows(kind):
    found = keys_of(kind)
    assert len(found) > 10
    for key in found:
        assert len(key.meaning) > 5, key
        assert key.allowed, key
    assert len({(k.table, k.name) for k in found}) == len(found)


def test_ranges_units_and_defaults_come_from_the_schema():
    found = {(k.table, k.name): k for k in keys_of("impact")}
    assert found["[target]", "E_Pa"].allowed == "a quantity from 1000 to 2e+12 [Pa]"
    assert found["[target]", "nu"].allowed == "a quantity 0 <= nu < 0.5"
    assert found["[impact]", "angle_deg"].allowed == "a number above 0 and up to 90 [degrees]"
    assert found["[impact]", "modes"].default == "default: 0"
    assert found["[strikers.NAME]", "tip_radius_m"].default == ""
    assert '"half-space"' in found["[impact]", "support"].allowed


@pytest.mark.parametrize(
    ("kind", "text"),
    [("case", CASE), ("inverse", INVERSE), *(("impact", template(kind)) for kind in KINDS)],
)
def test_a_template_uses_keys_that_there_are(kind, text):
    known = {k.name for k in keys_of(kind)} | {"value", "std", "from", "to", "count", "spacing"}
    # also what is commented out
    lines = [line.removeprefix("# ") for line in text.splitlines()]
    written = {line.split("=")[0].strip() for line in lines if " = " in line and line[0] != "#"}
    written = {name for name in written if name.replace("_", "").isalnum() and " " not in name}
    assert len(written) > 8
    assert written - known == set()


@pytest.mark.fe
def test_the_template_of_a_case_is_solved_as_it_is(tmp_path, prints):
    file = tmp_path / "mine.toml"
    assert f"dentscope case {file}" in prints("case", "--new", file)
    # the same pair, less deep: a test has seconds
    turns = [2e-4, 5e-4, 1e-3]
    text = file.read_text().replace("= 0.01  ", "= 0.001  ")
    text = text.replace("[0.001, 0.003, 0.01]  ", f"{turns}  ")
    assert tomllib.loads(text)["load"] == {"max_delta_over_R": 0.001, "unload_from": turns}
    file.write_text(text)
    assert run(["case", str(file), "--out", str(tmp_path / "out")]) == 0
    with (tmp_path / "out" / "curve.csv").open() as stream:
        load = [r for r in csv.DictReader(stream) if r["phase"] == "load"]
    # Hertz at the first depth, below yield: 4/3 E' sqrt(R) d^1.5
    reduced = 1.0 / (0.91 / 2.1e11 + 0.91 / 2.0e11)
    d = 0.005 * float(load[0]["delta_over_R"])
    hertz = 4.0 / 3.0 * reduced * (0.005 * d**3) ** 0.5
    assert float(load[0]["force_N"]) == pytest.approx(hertz, rel=0.01)
    assert (tmp_path / "out" / "law.json").exists()


def test_the_template_of_an_inverse_runs_as_it_is(tmp_path: Path, monkeypatch, errs, prints):
    monkeypatch.chdir(tmp_path)
    assert run(["inverse", "--new"]) == 0
    assert "T01" in prints("inverse", "inverse.toml")
    assert "exists" in errs("inverse", "--new")
