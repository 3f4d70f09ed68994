"""More than a hundred wrong uses: each one line on standard error and exit code 2, no traceback."""

from pathlib import Path

import pytest
from dentscope.cli import run
from dentscope.core.inputs.templates import CASE, INVERSE, template
from made_files import put
from made_processes import python


@pytest.fixture(autouse=True)
def _folder_of_a_newcomer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    texts = {
        "ball.toml": template("ball").partition("[sweep]")[0],
        "case.toml": CASE,
        "rod.toml": INVERSE,
        "empty.toml": "",
        "broken.toml": "radius_m = = 1\n",
        "words.txt": "nothing to see\n",
        "words.csv": "nothing,to\nsee,here\n",
        "words.png": "no picture\n",
        "words.wav": "no sound\n",
        "words.mp4": "no clip\n",
        "words.h5": "no HDF5\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00\x01" * 20)
    (tmp_path / "folder").mkdir()
    put(tmp_path / "half-set" / "set.toml", 'format = "recording-set/1"\n')


COMMON = "absent.toml | folder | broken.toml | empty.toml"
LINES = {
    "": "nonsense | Impact | --nonsense | -x | doctor extra | version extra | keys nonsense",
    "impact": f"| {COMMON} | words.txt | bytes.toml | case.toml | rod.toml | ball.toml extra"
    "| --law | ball.toml --law nonsense | ball.toml --law hertz --law Hertz"
    "| ball.toml --outt build | ball.toml --law kogut-etsion+ | ball.toml --out words.txt"
    "| ball.toml --out words.txt/below | --new | --new cube | --new ball ball.toml"
    "| --new ball words.txt/ball.toml",
    "case": f"| {COMMON} | words.csv | bytes.toml | ball.toml | case.toml --out words.txt"
    "| case.toml --level smoke | --new case.toml",
    "inverse": f"| {COMMON} | ball.toml | rod.toml --out words.txt | --new rod.toml",
    "laws": "nonsense | show | show nonsense | show kogut-etsion+nonsense | show wang | list extra",
    "laws compare": "| absent.toml | folder | empty.toml | ball.toml | case.toml --law nonsense"
    "| case.toml --law kelvin-voigt | case.toml --out words.txt",
    "diagnose": "| absent | folder | half-set | words.txt",
    "diagnose kharaz-2001-oblique": "liquidmetal-bounces | --out words.txt | --seed many"
    "| --seed 1.5 | --seed -1 | --law hertz | --assume drag",
    "recordings": "nonsense | audit absent | audit half-set | list absent | list words.txt | new"
    "| new half-set | new words.txt | new words.txt/below | fetch nonsense"
    "| fetch --catalogue absent.toml | fetch --out words.txt",
    "recordings check": "| absent | folder | half-set | words.txt",
    "reduce": "nonsense | table --holds force | sound folder | video | video words.mp4"
    "| video words.mp4 --frame-rate-hz fast --pixel-m 1e-4"
    "| video words.mp4 --frame-rate-hz -5 --pixel-m 1e-4 | tip words.png"
    "| tip words.png --pixel-m 0 | mocap words.csv --shape cube | sound words.wav --out words.txt"
    "| table words.csv --holds rebounds --into words.txt",
    "campaign": "nonsense | run --design huge | run --workers 0 | run --workers some"
    "| run --retry all | run --out words.txt | status --design huge | show | show zz | show 0"
    "| export --data absent.h5 | export --data words.h5 | export --to table.xls"
    "| export --to folder | publish --design huge | publish --design smoke --out folder"
    "| refine zz | repair --out absent",
    "fit": "absent.h5 | words.h5 | folder | --out words.txt | --judge absent | --judge words.txt",
    "export": "law --out words.txt | dem ball.toml --law nonsense",
    "examples": "--to words.txt | extra",
    "figures": "--chapter 9 | --fields 9.9 | --out words.txt",
    "verify": "--only nonsense | --folder words.txt | --report folder",
    "proof": "nonsense | run --list nonsense | run --most 0 | sample words.txt"
    "| sample new --kind nonsense | sample new --seed -1 | sample new --count 0"
    "| score --out words.txt",
}
"""What follows a command, with nothing before the first bar: the command alone."""
SEVERAL = ("empty.toml", "case.toml", "rod.toml", "ball.toml", "folder", "half-set", "drag")
"""Files of another kind, and words of a list: a line a mistake."""
USES = [f"{command} {words}".split() for command, row in LINES.items() for words in row.split("|")]
SAID = {
    "impact --new ball ball.toml": "exists (allowed: a name that is free)",
    "impact --new cube": "no set-up 'cube' (allowed: ball, rod, oblique-ball)",
    "nonsense": "no command", "campaign run --design huge": "smoke",
    "campaign run --workers 0": "workers", "campaign run --retry all": "failed",
    "campaign show zz": "no case", "campaign export --data absent.h5": "no such file",
    "campaign publish --design smoke --out folder": "12 of 12 cases are missing",
    "campaign status --design huge": "smoke, survey", "figures --chapter 9": "4 and 5",
    "fit absent.h5": "absent.h5: no such file", "fit folder": "folder: no cases in it",
    "fit words.h5": "words.h5: not a campaign file", "verify --only nonsense": "first-yield",
    "impact": "line: SETUP: no file (allowed: a TOML with [target], [strikers.NAME]",
    "reduce table --holds force": "--list", "reduce sound folder": "no raw file",
    "impact absent.toml": "no such file", "impact ball.toml --law nonsense": "no law 'nonsense'",
    "laws compare case.toml --law kelvin-voigt": "leaves no dent",
    "laws show nonsense": "line: LAW: no law 'nonsense' (allowed: hertz, johnson",
    "export dem ball.toml --law nonsense": "line: --law: no law 'nonsense'",
    "laws show wang": "not offered",
}  # fmt: skip


def files() -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in Path().rglob("*") if path.is_file()}


def test_there_are_more_than_a_hundred():
    assert len({tuple(use) for use in USES}) == len(USES) > 100
    assert SAID.keys() <= {" ".join(use) for use in USES}


@pytest.mark.parametrize("use", USES, ids=" ".join)
def test_a_wrong_use_is_told_in_short(use: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    before = files()
    code = run(use)
    told = capsys.readouterr()
    assert files() == before
    assert code == 2, told.out
    lines = told.err.strip().splitlines()
    assert len(lines) == 1 or (use[-1] in SEVERAL and 1 < len(lines) <= 25)
    assert all(len(line) > 8 for line in lines)
    assert SAID.get(" ".join(use), "") in told.err
    assert "Traceback" not in told.out + told.err
    assert told.out == ""


def test_what_is_wrong_is_told_before_the_solver_is_loaded():
    # compiled kernels alone take seconds to load; a process of its own shows what was loaded
    quick = [line for line in USES if line[0] in ("figures", "verify", "proof", "fit")]
    quick += [["case", "empty.toml"], ["case", "broken.toml"], ["case", "ball.toml"]]
    said = (
        "import sys; from dentscope.cli import run\n"
        f"for line in {quick!r}:\n"
        "    assert run(line) == 2, line\n"
        "    assert not {'numba', 'scipy', 'dentscope.fem'} & set(sys.modules), line\n"
    )
    answer = python("-c", said)
    assert answer.returncode == 0, answer.stderr
