"""`dentscope laws`: list, show, compare."""

import csv
from pathlib import Path

import pytest
from dentscope.models import LAWS, UNAVAILABLE
from dentscope.start.comparison import LawRow

CASE = Path(__file__).parents[3] / "examples" / "case_steel.toml"


def test_alone_they_are_listed(prints):
    assert "jackson-green" in prints("laws")


def test_list_names_every_law_and_marks_the_unverified(prints, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    text = prints("laws", "list")
    assert all(name in text for name in (*LAWS, *UNAVAILABLE))
    told = [law.standing.told for law in LAWS.values()]
    assert text.count("  unverified") == sum(t.startswith("unverified") for t in told)
    assert text.count("  verified") == sum(t.startswith("verified") for t in told)


def test_show_tells_source_standing_and_breaches(prints):
    text = prints("laws", "show", "kogut-etsion")
    assert "657" in text
    assert "unverified" in text
    assert "force jumps at w = 1: 3 %" in text
    assert "published.kogut_etsion" in text
    assert "jackson-green+ghaednia" in prints("laws", "show", "jackson-green+ghaednia")


def test_compare_writes_table_and_picture_for_the_users_pair(tmp_path, prints):
    command = ("laws", "compare", CASE, "--law", "hertz", "--law", "ghaednia")
    text = prints(*command, "--out", tmp_path)
    with (tmp_path / "curves.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert tuple(rows[0]) == LawRow._fields
    assert {row["law"] for row in rows} == {"hertz", "ghaednia"}
    last = rows[119]
    # (4/3) E' R^2 (Delta/R)^1.5 with 1/E' = (1 - 0.09)(1/210e9 + 1/200e9), R = 10 mm, 0.01
    assert float(last["force_N"]) == pytest.approx(15010.0, rel=1e-3)
    assert (tmp_path / "curves.png").stat().st_size > 20_000
    assert "regime: indentation" in text
    assert "off by more than 100 times in dent" in text
    assert "not in these laws: load.unload_from" in text
    assert "use: " in text
