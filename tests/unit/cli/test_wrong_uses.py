"""More than a hundred wrong uses: each one line on standard error and exit code 2, no traceback."""

from pathlib import Path

import pytest
from dentscope.cli import run
from dentscope.core.inputs.templates import CASE, INVERSE, template
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
    (tmp_path / "half-set").mkdir()
    (tmp_path / "half-set" / "set.toml").write_text('format = "recording-set/1"\n')


LINES = """
nonsense
Impact
--nonsense
-x
impact
impact ball.toml extra
impact --law
impact absent.toml
impact folder
impact words.txt
impact broken.toml
impact bytes.toml
impact empty.toml
impact case.toml
impact rod.toml
impact ball.toml --law nonsense
impact ball.toml --law hertz --law Hertz
impact ball.toml --law kogut-etsion+
impact ball.toml --out words.txt
impact ball.toml --out words.txt/below
impact ball.toml --outt build
impact --new
impact --new cube
impact --new ball ball.toml
impact --new ball words.txt/ball.toml
case
case absent.toml
case folder
case words.csv
case broken.toml
case bytes.toml
case empty.toml
case ball.toml
case case.toml --out words.txt
case case.toml --level smoke
case --new case.toml
inverse absent.toml
inverse folder
inverse broken.toml
inverse empty.toml
inverse ball.toml
inverse rod.toml --out words.txt
inverse
inverse --new rod.toml
laws nonsense
laws show
laws show nonsense
laws show kogut-etsion+nonsense
laws show wang
laws compare
laws compare absent.toml
laws compare folder
laws compare empty.toml
laws compare ball.toml
laws compare case.toml --law nonsense
laws compare case.toml --law kelvin-voigt
laws compare case.toml --out words.txt
laws list extra
diagnose
diagnose absent
diagnose folder
diagnose half-set
diagnose words.txt
diagnose kharaz-2001-oblique --out words.txt
diagnose kharaz-2001-oblique --seed many
diagnose kharaz-2001-oblique --law hertz
diagnose kharaz-2001-oblique --seed 1.5
diagnose kharaz-2001-oblique --seed -1
diagnose kharaz-2001-oblique --assume drag
diagnose kharaz-2001-oblique liquidmetal-bounces
recordings nonsense
recordings check
recordings check absent
recordings check folder
recordings check half-set
recordings check words.txt
recordings audit absent
recordings audit half-set
recordings list absent
recordings list words.txt
recordings new
recordings new half-set
recordings new words.txt
recordings new words.txt/below
recordings fetch nonsense
recordings fetch --catalogue absent.toml
recordings fetch --out words.txt
reduce nonsense
reduce table --holds force
reduce sound folder
reduce video
reduce video words.mp4
reduce video words.mp4 --frame-rate-hz fast --pixel-m 1e-4
reduce video words.mp4 --frame-rate-hz -5 --pixel-m 1e-4
reduce tip words.png
reduce tip words.png --pixel-m 0
reduce mocap words.csv --shape cube
reduce sound words.wav --out words.txt
reduce table words.csv --holds rebounds --into words.txt
campaign nonsense
campaign run --design huge
campaign run --workers 0
campaign run --workers some
campaign run --retry all
campaign run --out words.txt
campaign status --design huge
campaign show
campaign show zz
campaign show 0
campaign export --data absent.h5
campaign export --data words.h5
campaign export --to table.xls
campaign export --to folder
campaign publish --design huge
campaign publish --design smoke --out folder
campaign refine zz
campaign repair --out absent
fit absent.h5
fit words.h5
fit folder
fit --out words.txt
fit --judge absent
fit --judge words.txt
export law --out words.txt
export dem ball.toml --law nonsense
examples --to words.txt
examples extra
keys nonsense
doctor extra
version extra
verify --only nonsense
proof nonsense
proof run --list nonsense
figures --chapter 9
figures --fields 9.9
figures --out words.txt
verify --folder words.txt
verify --report folder
proof sample words.txt
proof sample new --kind nonsense
proof sample new --seed -1
proof sample new --count 0
proof run --most 0
proof score --out words.txt
"""
SEVERAL = ("empty.toml", "case.toml", "rod.toml", "ball.toml", "folder", "half-set", "drag")
"""Files of another kind, and words of a list: a line a mistake."""
USES = [line.split() for line in LINES.strip().splitlines()]
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
