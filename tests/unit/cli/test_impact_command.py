"""`dentscope impact`: templates run as they are, sweeps go to files, nothing is cut at 80."""

import csv

import pytest
from dentscope.cli import run
from dentscope.core.errors import EXIT_NOT_CONVERGED
from dentscope.core.inputs.templates import KINDS, template
from dentscope.dynamics.files.setup import read_setup


@pytest.mark.parametrize("kind", KINDS)
def test_a_template_runs_through_unchanged(kind, tmp_path, prints):
    name = f"{kind}-5.5mm"  # a point in a name is no ending
    file = tmp_path / f"{name}.toml"
    prints("impact", "--new", kind, file)
    printed = prints("impact", file, "--out", tmp_path / "out")
    table = [line for line in printed.splitlines() if line.startswith(" ")]
    assert max(len(line) for line in table) <= 80
    assert "…" not in printed
    assert "crater depth [um]" in printed
    heads = [line.split() for line in table if "fitted" in line]
    assert heads[0][0] == "fitted"
    for end in (".csv", ".h5", ".png", "-sweep.csv", "-sweep.png"):
        assert (tmp_path / "out" / f"{name}{end}").stat().st_size > 100
    with (tmp_path / "out" / f"{name}-sweep.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    setup = read_setup(file)
    assert len(rows) == setup.sweep.count * len(setup.laws)
    assert {row["outcome"] for row in rows} == {"completed"}
    # by whoever: a contact gives nothing back that it did not get
    assert all(float(row["energetic_restitution"]) < 1.0 + 1e-6 for row in rows)


def ball_with(folder, sweep, more=""):
    text = template("ball").partition("[sweep]")[0].replace("[impact]", f"[impact]\n{more}", 1)
    (folder / "ball.toml").write_text(f"{text}[sweep]\n{sweep}\n")
    return str(folder / "ball.toml")


def test_a_sweep_none_of_whose_blows_ends_says_so(tmp_path, capsys):
    file = ball_with(tmp_path, "angle_deg = [60.0, 70.0]", "max_steps = 10")
    out = tmp_path / "out"
    assert run(["impact", file, "--law", "fitted", "--out", str(out)]) == EXIT_NOT_CONVERGED
    told = capsys.readouterr().out
    assert "2 impacts of the sweep did not end: see the column outcome" in told
    for name in ("ball", "ball-sweep"):
        text = (out / f"{name}.csv").read_text()
        assert "nan" not in text
        assert {row["restitution"] for row in csv.DictReader(text.splitlines())} == {""}
    assert "changes nothing" not in told
    assert not (out / "ball-sweep.png").exists()


@pytest.mark.parametrize(
    ("sweep", "message"),
    [
        ("speeds = [1, 2]", "sweep.speeds: unknown key"),
        ("friction = 0.1", "sweep.friction"),
        ("friction = [0.1, -0.2]", "a number from 0 to 20"),
        ("angle_deg = { from = 10, to = 100, count = 3 }", "each above 0 and up to 90"),
        ("mass_kg = { from = 1, count = 3 }", "sweep.mass_kg: to: missing"),
        ("mass_kg = { from = 1, to = 2, count = 1 }", "count: 1 (allowed: greater than"),
        (
            "mass_kg = { from = 1, to = 2, cout = 4 }",
            "cout: unknown key; did you mean count? (allowed: from, to, c",
        ),
        ("angle_deg = [45]\napproach_tangential_m_s = [1]", "given beside angle_deg"),
        ('mass_kg = { from = 0, to = 1, count = 3, spacing = "log" }', "both ends above 0"),
        ("impact_speed_m_s = [1]\ndrop_height_m = [1]", "both speed and height"),
        ("friction = []", "a list of numbers, or"),
        ("target.thicknes_m = [1e-3]", "sweep.target.thicknes_m: unknown key; did you mean thick"),
        ("target.nu = [0.3, 0.7]", "sweep.target.nu: 0.7 (allowed: 0 <= nu < 0.5)"),
        ('strikers.ball.shape = ["rod"]', "sweep.strikers.ball.shape: ['rod'] (allowed: a list of"),
        ("target.nu = { from = 0, to = 0.4, count = 10001 }", "(allowed: up to 10000)"),
    ],
)
def test_a_bad_sweep_is_one_line(sweep, message, tmp_path, errs):
    told = errs("impact", ball_with(tmp_path, sweep))
    assert message in told
    assert len(told.strip().splitlines()) == 1


def test_what_a_sweep_leaves_as_it_is_is_told(tmp_path, prints):
    file = ball_with(tmp_path, "friction = [0.1, 0.2]\nmass_kg = [1e-3, 1e3]", "repeats = 2")
    told = prints("impact", file, "--law", "hertz", "--exact", "--out", tmp_path)
    assert "hertz: 2 of 4 impacts go so deep, to" in told
    assert "sweep.friction changes nothing here" in told
    assert "sweep.mass_kg" not in told
    assert "of first blows: impact.repeats = 2 acts above alone" in told
