"""A blind test by others: sealed, answered by the diagnosis as the page says, opened, scored."""

import json
import re
import runpy
import shutil
import subprocess
from pathlib import Path

import pytest
from dentscope.cli import run
from dentscope.studies.challenge.answers import EXPLANATIONS

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs" / "blind-test.md").read_text(encoding="utf-8")
SHIPPED = ROOT / "data/recordings/leeb-steel-300hv"
HEAD = "set,name,probability\n"
SETS = ("series-01", "series-02")
SEAL = ["challenge", "seal", "blind", "acts.csv"]
SCORE = ["challenge", "score", "blind", "answers.csv"]
OPEN = [*SCORE, "--truths", "blind-truths.json"]


@pytest.fixture
def laboratory(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in SETS:
        (tmp_path / "blind/sets" / name).mkdir(parents=True)
        for file in ("set.toml", "trials.csv"):
            shutil.copy(SHIPPED / file, tmp_path / "blind/sets" / name)
    (tmp_path / "acts.csv").write_text(HEAD + "series-02,tilt+adhesion,1\nseries-01,baseline,1\n")
    return tmp_path


def test_sealed_answered_and_opened_as_the_page_says(laboratory, monkeypatch, prints) -> None:
    assert "2 sets, SHA-256" in prints(*SEAL)
    assert "tilt" not in (laboratory / "blind/seals.jsonl").read_text()
    monkeypatch.setattr(subprocess, "run", lambda command, check: run(command[1:]))
    code = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)[0]
    (laboratory / "method.py").write_text(code)
    runpy.run_path(str(laboratory / "method.py"))
    assert "keep the file" in prints(*SCORE)
    (front,) = (x for x in prints(*OPEN).splitlines() if "truth in front" in x)
    assert float(front.split()[3]) in (0.0, 0.5)  # two equal sets: one at most is right


def test_what_changed_after_the_seal_is_not_scored(laboratory, errs) -> None:
    run(SEAL)
    rows = "".join(f"{name},baseline,1\n" for name in SETS)
    (laboratory / "answers.csv").write_text(HEAD + rows)
    truths = laboratory / "blind-truths.json"
    kept = truths.read_text()
    records = json.loads(kept)
    records["series-02"]["mechanisms"] = ["tilt"]
    truths.write_text(json.dumps(records))
    assert "series-02: not the truth that was sealed" in errs(*OPEN)
    truths.write_text(kept)
    assert run(OPEN) == 0
    table = laboratory / "blind/sets/series-01/trials.csv"
    table.write_text(table.read_text() + "\n")
    assert "series-01: not the recordings that were sealed" in errs(*OPEN)
    assert "seal once" in errs(*SEAL)


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ("series-01,baseline,1\n", "1 sets without an answer: series-02"),
        ("series-01,baseline,1\nseries-03,tilt,1\n", "the first 'series-03'"),
        ("series-01,baseline,1\nseries-01,baseline,1\n", "baseline twice for series-01"),
        ("series-01,rubber,1\nseries-02,tilt,1\n", "row 2, column name: unknown name 'rubber'"),
        ("series-01,another pair,1\nseries-02,tilt,1\n", "series-01: another pair (allowed: one"),
        ("series-01,baseline,0.5\nseries-01,tilt,0.5\nseries-02,tilt,1\n", "baseline or tilt"),
    ],
)
def test_a_mistake_in_the_acts_is_one_line(laboratory, errs, rows, told) -> None:
    (laboratory / "acts.csv").write_text(HEAD + rows)
    assert told in errs(*SEAL)
    assert not (laboratory / "blind/seals.jsonl").exists()
    assert not (laboratory / "blind-truths.json").exists()


def test_every_act_of_the_page_has_a_name_that_can_be_answered() -> None:
    names = re.findall(r"^\| [^|]+ \| `([^`]+)` \|$", PAGE, flags=re.MULTILINE)
    assert len(names) == 10
    assert {part for name in names for part in name.split("+")} < set(EXPLANATIONS)
