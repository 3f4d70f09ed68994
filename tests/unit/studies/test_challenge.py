"""The challenge and a blind test as a stranger meets them: sets, seals, answers, scores."""

import json
import math
import re
import runpy
import shutil
import subprocess
import zipfile
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import recordings
from dentscope.cli import run
from dentscope.core import InputErrors
from dentscope.dynamics import mechanisms
from dentscope.studies.challenge import answers, archive, ask, draw, loop, own
from dentscope.studies.challenge.answers import EXPLANATIONS
from dentscope.studies.challenge.score import marks, scores
from dentscope.studies.proof.generators.effects import EFFECTS, OUTSIDE
from dentscope.studies.proof.generators.folder import write_set
from dentscope.studies.proof.seal import digest_of
from dentscope.studies.third_world.sheet import write
from made_files import put

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs" / "challenge.md").read_text(encoding="utf-8")
HEAD = "set,name,probability\n"


@pytest.fixture(scope="module")
def challenge(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("stranger") / "challenge"
    counts = archive.get(folder)
    assert counts["open"] == 60
    before = archive.get(folder.with_name("before"), first=True)
    assert sum((*counts.values(), *before.values())) == len(archive.seals())
    assert f"has 60 sets with their truths, `challenge/sealed` {counts['sealed']} without" in PAGE
    return folder


def test_the_sets_are_whole_and_sealed_truths_are_nowhere(challenge) -> None:
    truths = [json.loads(p.read_text()) for p in (challenge / "open/truths").iterdir()]
    kinds = Counter(t["kind"] for t in truths)
    assert kinds == {"single": 38, "null": 12, "outside": 6, "pair": 4}
    assert {m for t in truths for m in t["mechanisms"]} == set(EFFECTS) < set(answers.MECHANISMS)
    assert {e["name"] for t in truths if t["kind"] == "outside" for e in t["effects"]} == {*OUTSIDE}
    assert not (challenge / "sealed" / "truths").exists()
    with zipfile.ZipFile(archive.DATA / "sealed.zip") as packed:
        assert {Path(name).name for name in packed.namelist()} == {"set.toml", "trials.csv"}
    assert sum(p.stat().st_size for p in archive.DATA.iterdir()) < 5e6
    for name in ("open-2001", "sealed-2001"):
        read = recordings.read(challenge / name.split("-")[0] / "sets" / name)
        assert read.setup.licence == "CC0-1.0"


def test_an_answer_has_the_names_of_the_program(challenge) -> None:
    told = (challenge / "names.txt").read_text().splitlines()
    assert told == list(answers.EXPLANATIONS)
    assert told[1:-2] == [m.name for m in mechanisms.MECHANISMS]


def test_who_has_a_truth_can_draw_its_set_again(tmp_path) -> None:
    seed = "5f" * 16
    truth = draw.drawn("single", "squeeze-film", seed)
    write_set(truth, tmp_path / "first", name="one")
    write_set(draw.redrawn(truth.record() | {"seed": seed}), tmp_path / "again", name="one")
    for file in ("set.toml", "trials.csv"):
        assert (tmp_path / "first" / file).read_text() == (tmp_path / "again" / file).read_text()


def test_a_strangers_method_is_scored_by_the_pages_instructions(
    challenge, tmp_path, monkeypatch, prints
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "challenge").symlink_to(challenge)
    code = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)[0]
    (tmp_path / "method.py").write_text(code)
    runpy.run_path(str(tmp_path / "method.py"))
    printed = prints("challenge", "score", "challenge/open", "answers.csv")
    (row,) = [line for line in PAGE.splitlines() if line.startswith("| these ten lines |")]
    told = told_in(printed)
    assert told == [cell.strip() for cell in row.split("|")[2:-1]], (
        f"docs/challenge.md: | these ten lines | {' | '.join(told)} |"
    )


def told_in(printed: str) -> list[str]:
    found = {}
    for line in printed.splitlines():
        if match := re.match(r"(\D+?) +(-?[\d.]+) +(-?[\d.]+) to (-?[\d.]+)", line):
            name, value, low, high = match.groups()
            found[name.strip()] = (float(value), float(low), float(high))
    cells = []
    for name, times, digits in COLUMNS:
        value, low, high = (f"{times * x:.{digits}f}" for x in found[name])
        cells.append(f"{value} ({low} to {high})")
    return cells


COLUMNS = (
    ("mean ln p of the truth", 1.0, 2), ("truth in front", 100.0, 0), ("named exactly", 100.0, 0),
    ("in the set", 100.0, 0), ("nulls named", 100.0, 0), ("said less true", 100.0, 0),
)  # fmt: skip


SETS = [f"open-{k}" for k in range(2001, 2061)]
SURE = {name: f"{name},baseline,1\n" for name in SETS}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HEAD + "".join(list(SURE.values())[1:]), "1 sets without an answer: open-2001"),
        *((HEAD + "".join((SURE | {"open-2007": f"open-2007,{said}\n"}).values()), told)
          for said, told in (
              ("tilt,0.7", "probabilities of open-2007 add to 0.7"),
              ("tillt,1", "did you mean tilt?"), ("tilt+tilt,1", "unknown name"),
              ("tilt,-1", "from 0 to 1"), ("tilt,much", "finite number"))),
        (HEAD + "".join(SURE.values()) + "sealed-2001,tilt,1\n",
         "1 sets that are not there, the first 'sealed-2001'"),
        (HEAD + "".join(f"sealed-{k:03d},tilt,1\n" for k in range(1, 61)), "60 sets that are not"),
        (HEAD + "".join(SURE.values()) + SURE["open-2001"], "baseline twice for open-2001"),
        ("set,name\nopen-2001,tilt\n", "column probability: missing"),
        ("", "empty"),
        (None, "no such file"),
    ],
)  # fmt: skip
def test_a_mistake_in_the_answers_is_one_line(challenge, tmp_path, errs, text, told) -> None:
    path = tmp_path / "answers.csv"
    if text is not None:
        path.write_text(text)
    (line,) = errs("challenge", "score", challenge / "open", path).splitlines()
    assert told in line
    assert "answers.csv" in line


def test_other_mistakes(challenge, tmp_path, errs) -> None:
    path = put(tmp_path / "answers.csv", HEAD + "".join(SURE.values()))
    wrong = put(tmp_path / "wrong.json", '{"open-2001": {}}')
    for arguments, told in (
        (["get", str(challenge)], "there is one already"),
        (["score", str(challenge), str(path)], "no sets"),
        (["score", str(challenge / "open"), str(path), "--truths", str(wrong)], "not the truths"),
        (["score", str(challenge / "open"), str(path), "--truths", str(path)], "not valid JSON"),
    ):
        (line,) = errs("challenge", *arguments).splitlines()
        assert told in line


def test_sealed_sets_wait_for_their_truths(tmp_path, monkeypatch, errs, prints) -> None:
    """Drawn, packed, opened: a truth that is not the sealed one is refused before it is used."""
    work, data = tmp_path / "work", tmp_path / "data"
    for name, names in (("open-001", []), ("sealed-001", ["tilt"]), ("sealed-002", [])):
        for file in ("set.toml", "trials.csv"):
            path = work / "sets" / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(name)
        record = {"kind": "single", "mechanisms": names, "seed": name}
        (work / "truths").mkdir(exist_ok=True)
        (work / "truths" / f"{name}.json").write_text(json.dumps(record))
    draw.publish(work, data)
    (data / archive.TRUTHS).write_text("encrypted")
    draw.publish(work, data)
    assert f"{digest_of(data / archive.TRUTHS)}  truths.enc\n" in (data / "SHA256SUMS").read_text()
    monkeypatch.setattr(archive, "DATA", data)
    archive.seals.cache_clear()
    folder = tmp_path / "got"
    assert "sealed: 2 sets" in prints("challenge", "get", folder)
    path = tmp_path / "answers.csv"
    path.write_text(HEAD + "sealed-001,tilt,0.9\nsealed-001,baseline,0.1\nsealed-002,baseline,1\n")
    score = ["challenge", "score", str(folder / "sealed"), str(path)]
    assert "truths are sealed" in prints(*score)
    truths = work / "sealed-truths.json"
    assert f"{0.5 * math.log(0.9):.3f}" in prints(*score, "--truths", truths)
    found = json.loads(truths.read_text())
    assert set(found) == {"sealed-001", "sealed-002"}
    found["sealed-001"]["mechanisms"] = []
    truths.write_text(json.dumps(found))
    assert "sealed-001: not the truth that was sealed" in errs(*score, "--truths", truths)
    (data / "sealed.zip").write_bytes((data / "open.zip").read_bytes())
    assert "not what was published" in errs("challenge", "get", tmp_path / "again")
    archive.seals.cache_clear()


def test_scores_by_hand() -> None:
    said = {
        "a": {"tilt": 0.6, "baseline": 0.4},
        "b": {"tilt": 0.5, "roughness": 0.3, "adhesion": 0.15, "baseline": 0.05},
        "c": {"tilt": 0.8, "baseline": 0.2},
        "d": {"outside-library": 1.0},
    }
    truths = {"a": ("tilt",), "b": ("adhesion",), "c": (), "d": ("outside-library",)}
    found = {r.name: r for r in scores(said, truths)}
    p = [0.6, 0.15, 0.2, 1.0]
    assert found["mean ln p of the truth"].value == pytest.approx(np.mean(np.log(p)))
    brier = [2 * 0.4**2, 0.5**2 + 0.3**2 + 0.85**2 + 0.05**2, 2 * 0.8**2, 0.0]
    assert found["Brier"].value == pytest.approx(np.mean(brier))
    assert found["truth in front"].value == 0.5
    assert found["named exactly"].value == 0.5
    # of b the three most probable have 0.95, of c the two
    assert found["in the set"].value == 1.0
    assert found["nulls named"][1:] == (1.0, 1.0, 1.0)
    assert found["outside named"].value == 0.0
    assert found["said less true"].value == pytest.approx((0.6 + 0.5 + 0.8 + 1.0) / 4 - 0.5)
    assert (found["truth in front"].low, found["truth in front"].high) == (0.0, 1.0)
    # nobody is surer than the least probability allows
    (mark,) = marks({"a": {"baseline": 1.0}}, {"a": ("tilt", "roughness")})
    assert mark.ln_p == math.log(0.002)


def test_own_answers_go_on_where_they_were_stopped(challenge, tmp_path, monkeypatch) -> None:
    """By the names of the list, which has none for a wrong number of the sheet."""
    asked, sets = [], tmp_path / "part" / "sets"
    sets.mkdir(parents=True)
    for name in ("sealed-2001", "sealed-2002"):
        (sets / name).symlink_to(challenge / "sealed" / "sets" / name)
    wrong = {"wrong-input:target.Sy_Pa": 0.125, "tilt+wrong-input:target.Sy_Pa": 0.125}
    odds = {"tilt": 0.5, "baseline": 0.25, "adhesion": 1e-9} | wrong
    line = {"set": "sealed-2002", "odds": odds}
    (tmp_path / "diagnosis.jsonl").write_text(json.dumps(line) + "\n")
    monkeypatch.setattr(
        own, "diagnose", lambda found: asked.append(found.name) or SimpleNamespace(
            probabilities={"baseline": 1.0}
        ),
    )  # fmt: skip
    digest = own.answer(tmp_path / "part", tmp_path)
    assert asked == ["sealed-2001"]
    assert digest == digest_of(tmp_path / "diagnosis.csv")
    found = answers.read_answers(tmp_path / "diagnosis.csv", ["sealed-2001", "sealed-2002"])
    unlisted = {"outside-library": 0.125, "another pair": 0.125}
    assert found["sealed-2001"] == {"baseline": 1.0}
    assert found["sealed-2002"] == {"tilt": 0.5, "baseline": 0.25} | unlisted


@pytest.fixture(scope="module")
def game(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("asker") / "game"
    ask.deal(folder, folder.with_name("game-judge"), 2, seed=5)
    return folder


def asked(game: Path, name: str, text: str) -> list[list[str]]:
    rows = put(game.parent / "rows.csv", text)
    return ask.ask(game, game.with_name("game-judge"), name, rows)[0]


def test_a_random_asker_is_scored_by_the_page(game, monkeypatch, prints) -> None:
    monkeypatch.chdir(game.parent)
    code = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)[1]

    def bought(command: list[str], *, check: bool) -> None:
        *_, folder, name, rows = command
        assert check
        ask.ask(Path(folder), game.with_name("game-judge"), name, Path(rows))

    monkeypatch.setattr("subprocess.run", bought)
    exec(compile(code, "page", "exec"), {})
    told = prints("challenge", "score", "game", "answers.csv")
    assert re.search(r"trials bought\W+1\.000", told)
    # all names alike before and after
    assert re.search(r"nats a trial\W+0\.000", told)
    found = recordings.read(game / "sets" / "asked-001").trials
    assert (len(found), found.sessions.max()) == (25, 2.0)


def test_what_is_answered_hangs_on_secret_and_trial_alone(tmp_path) -> None:
    game, again = tmp_path / "one" / "game", tmp_path / "two" / "game"
    for place in (game, again):
        ask.deal(place, place.with_name("game-judge"), 2, seed=5)
    text = "striker,angle_deg,impact_speed_m_s\n{},{:g},{:g}\n"
    found = recordings.read(game / "sets" / "asked-002")
    first = found.trials
    row = text.format(first.striker[0], first.angle_deg[0], found.approach.normal[0])
    asked(again, "asked-002", text.format(first.striker[-1], first.angle_deg[-1],
                                          found.approach.normal[-1]))  # fmt: skip
    one, two = asked(game, "asked-002", row)[1], asked(again, "asked-002", row)[1]
    # the number of the trial apart
    assert one[4:] == two[4:]
    concealed = {n for pair in ask.truths(game.with_name("game-judge")).values() for n in pair}
    texts = "".join(p.read_text() for p in (game / "sets").rglob("*.*"))
    assert not any(name in texts for name in concealed)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("striker,impact_speed_m_s\nnobody,1\n", "no striker 'nobody'"),
        ("striker,impact_speed_m_s\n{0},99\n", "row 2, column impact_speed_m_s: 99"),
        ("striker,load_N\n{0},1e9\n", "column load_N"),
        ("striker,angle_deg\n{0},90\n", "a speed or a load"),
        ("striker,impact_speed_m_s\n" + "{0},1\n" * 11, "11 trials"),
        ("striker,truth\n{0},1\n", "truth"),
    ],
)
def test_what_cannot_be_asked_is_refused_and_not_bought(game, text, told) -> None:
    place = game / "sets" / "asked-001"
    before = (place / "trials.csv").read_bytes()
    with pytest.raises(InputErrors, match=told):
        asked(game, "asked-001", text.format(recordings.read(place).trials.striker[0]))
    assert (place / "trials.csv").read_bytes() == before


def test_a_wrong_strength_is_put_right_by_measuring_it_again(tmp_path) -> None:
    found = loop.entries()
    kinds = {"rate": 40, "strength": 20, "pair": 20, "wrong": 20, "nothing": 20}
    assert Counter(e.kind for e in found) == kinds
    entry = next(e for e in found if e.wrong == ("Sy_Pa", 0.6))
    truth = loop.drawn(1, entry)
    write(truth, tmp_path, name=entry.name)
    text = (tmp_path / "set.toml").read_text()
    wrong = loop.restated(text, "target.Sy_Pa", lambda x, std: (0.6 * x, 0.6 * std))
    (tmp_path / "set.toml").write_text(wrong)
    assert loop.right(entry, truth) == "wrong-input:target.Sy_Pa"
    stated = recordings.read(tmp_path).setup.target.Sy_Pa.value
    assert stated == pytest.approx(0.6 * truth.rig.flat.Sy, rel=1e-4)
    again = loop.measured_again(wrong, truth, "target.Sy_Pa", np.random.default_rng(0))
    (tmp_path / "set.toml").write_text(again)
    strength = recordings.read(tmp_path).setup.target.Sy_Pa
    assert abs(strength.value - truth.rig.flat.Sy) < 2.5 * strength.std
    assert strength.value > 1.2 * stated


BLIND_PAGE = (ROOT / "docs" / "blind-test.md").read_text(encoding="utf-8")
SHIPPED = ROOT / "data/recordings/leeb-steel-300hv"
SERIES = ("series-01", "series-02")
SEAL = ["challenge", "seal", "blind", "acts.csv"]
SCORE = ["challenge", "score", "blind", "answers.csv"]
OPEN = [*SCORE, "--truths", "blind-truths.json"]


@pytest.fixture
def laboratory(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in SERIES:
        (tmp_path / "blind/sets" / name).mkdir(parents=True)
        for file in ("set.toml", "trials.csv"):
            shutil.copy(SHIPPED / file, tmp_path / "blind/sets" / name)
    (tmp_path / "acts.csv").write_text(HEAD + "series-02,tilt+adhesion,1\nseries-01,baseline,1\n")
    return tmp_path


def test_sealed_answered_and_opened_as_the_page_says(laboratory, monkeypatch, prints) -> None:
    assert "2 sets, SHA-256" in prints(*SEAL)
    assert "tilt" not in (laboratory / "blind/seals.jsonl").read_text()
    monkeypatch.setattr(subprocess, "run", lambda command, check: run(command[1:]))
    code = re.findall(r"```python\n(.*?)```", BLIND_PAGE, flags=re.DOTALL)[0]
    (laboratory / "method.py").write_text(code)
    runpy.run_path(str(laboratory / "method.py"))
    assert "keep the file" in prints(*SCORE)
    (front,) = (x for x in prints(*OPEN).splitlines() if "truth in front" in x)
    assert float(front.split()[3]) in (0.0, 0.5)  # two equal sets: one at most is right


def test_what_changed_after_the_seal_is_not_scored(laboratory, errs) -> None:
    run(SEAL)
    rows = "".join(f"{name},baseline,1\n" for name in SERIES)
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
    names = re.findall(r"^\| [^|]+ \| `([^`]+)` \|$", BLIND_PAGE, flags=re.MULTILINE)
    assert len(names) == 10
    assert {part for name in names for part in name.split("+")} < set(EXPLANATIONS)
