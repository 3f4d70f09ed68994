"""Single commands: `impact`, `campaign`, `laws`, `metal`, several files of `reduce`."""

import json
from pathlib import Path

import numpy as np
import pandas
import pytest
from dentscope import campaigns
from dentscope.campaigns import DESIGNS, Design, Store
from dentscope.campaigns.run import Status, Step
from dentscope.cli import run
from dentscope.cli.metal import tell_contradictions
from dentscope.core.errors import EXIT_NOT_CONVERGED
from dentscope.core.inputs.templates import KINDS, template
from dentscope.core.output import in_use
from dentscope.dynamics.files.setup import read_setup
from dentscope.fem import Curve
from dentscope.models import LAWS, UNAVAILABLE
from dentscope.start.comparison import LawRow
from made_cases import case_of, solution_of
from made_files import put, rows_of
from made_sets import made_set


@pytest.fixture
def stored(tmp_path):
    line = np.arange(1.0, 5.0)
    columns = {name: line / (k + 3) for k, name in enumerate(Curve.__dataclass_fields__)}
    Store(tmp_path).put(case_of(), solution_of(case_of(), **columns))
    return tmp_path, columns


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_the_table_holds_every_value(stored, suffix):
    folder, columns = stored
    path = folder / f"t.{suffix}"
    assert run(["campaign", "export", "--out", str(folder), "--to", str(path)]) == 0
    table = pandas.read_csv(path) if suffix == "csv" else pandas.read_parquet(path)
    assert list(table["case"]) == ["one"] * 4
    for name, values in columns.items():
        assert list(table[name]) == pytest.approx(values, rel=1e-12)


def test_another_format_is_refused(stored, errs):
    folder, _ = stored
    assert "'.xls'" in errs("campaign", "export", "--out", folder, "--to", folder / "t.xls")


def test_a_run_that_is_stopped_says_how_to_go_on_and_shows_what_is_done(
    stored, monkeypatch, capsys
):
    folder, _ = stored
    cases = [record.case for record in Store(folder).read_all()]
    cases.append(case_of("two", Sy=4e8))
    monkeypatch.setitem(DESIGNS, "small", Design("small", "", lambda: tuple(cases)))

    def stop(*given, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(campaigns, "run_design", stop)
    with in_use(folder / "cases") as shared:
        assert not shared
        assert run(["campaign", "run", "--design", "small", "--out", str(folder)]) == 130
    shown = " ".join(capsys.readouterr().out.split())
    assert "another run computes here: a case may be computed twice; `--part 1/2`" in shown
    assert "2 cases, 1 done, 0 failed, 1 to compute" in shown
    assert "stopped; the same command goes on from here 1 done, 0 failed, 1 missing of 2" in shown
    assert (folder / "pictures" / "curves.png").exists()


def test_pictures_come_with_the_first_and_the_third_case(stored, monkeypatch, capsys):
    folder, _ = stored
    (case,) = (record.case for record in Store(folder).read_all())
    monkeypatch.setitem(DESIGNS, "small", Design("small", "", lambda: (case,)))

    def three(*given, report, **options):
        assert not (folder / "pictures" / "curves.png").exists()
        for done in (1, 2, 3):
            report(Step(case, True, "", 1.0, Status(9, done, 0)))
            assert (folder / "pictures" / "curves.png").exists()
        return Status(9, 3, 0)

    monkeypatch.setattr(campaigns, "run_design", three)
    run(["campaign", "run", "--design", "small", "--out", str(folder)])
    shown = " ".join(capsys.readouterr().out.split())
    assert "another run" not in shown
    assert "picture of the first case, of 9:" in shown
    assert "picture of 2 cases" not in shown
    assert "picture of 3 cases, of 9:" in shown


CASE = Path(__file__).parents[3] / "examples" / "case_steel.toml"


def test_list_names_every_law_and_marks_the_unverified(prints, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    text = prints("laws", "list")
    assert all(name in text for name in (*LAWS, *UNAVAILABLE))
    assert "jackson-green" in prints("laws")
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
    rows = rows_of(tmp_path / "curves.csv")
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


@pytest.mark.parametrize(("load", "told"), [("1000", False), ("1", True)])
def test_loads_in_kilonewtons_are_told(tmp_path, capsys, load, told):
    # 1 kN on a dent of 1.35 mm is 700 MPa, 2.8 times the strength; 1 N a thousandth of that
    found = made_set(
        tmp_path, target="Sy_Pa = 2.5e8\n", noise="dent_diameter_m = 5e-6\n", trial=["p"],
        angle_deg=[90], load_N=[load], dent_diameter_m=[1.35e-3],
    )  # fmt: skip
    tell_contradictions(found)
    assert ("contradiction: load of p" in capsys.readouterr().out) == told


T = np.arange(0.0, 0.03, 1e-4)


def pulse(path, *, gain=1.0):
    value = gain * 800.0 * np.sin(np.pi * np.clip((T - 0.01) / 4e-3, 0.0, 1.0))
    value = value + gain * np.random.default_rng(1).normal(0.0, 1.0, T.size)
    rows = [f"{t:.4f},{v:.4f}" for t, v in zip(T, value, strict=True)]
    put(path, "\n".join(["time_s,force_N", *rows]))


def peak(out, name):
    return json.loads((out / f"{name}-table.json").read_text())["values"]["peak_force_N"]["value"]


def test_a_folder_is_reduced_file_by_file_onto_one_page(tmp_path, errs, capsys):
    raw, out = tmp_path / "raw", tmp_path / "out"
    for name in ("b10", "b9"):
        pulse(raw / f"{name}.csv")
    put(raw / "flat.csv", "time_s,force_N\n" + "".join(f"{t:.4f},0\n" for t in T))
    assert run(["reduce", "table", str(raw), "--holds", "force", "--out", str(out)]) == 2
    told = capsys.readouterr()
    assert "2 of 3 files reduced" in told.out
    assert told.out.index("b9.csv") < told.out.index("b10.csv")
    assert "flat.csv" in told.err
    assert peak(out, "b9") == pytest.approx(800.0, rel=0.01)
    assert (out / "all-table.png").stat().st_size > 10_000
    # what all lack, once
    assert errs("reduce", "table", raw, "--out", out).count("--holds") == 1


def test_a_list_gives_each_file_its_own_options(tmp_path, prints):
    for name, gain in (("a", 1.0), ("b", 0.1)):
        pulse(tmp_path / f"{name}.csv", gain=gain)
    (tmp_path / "list.csv").write_text("file,gain,mass_kg\na.csv,2,\nb.csv,20,0.5\n")
    given = ["reduce", "table", "--list", str(tmp_path / "list.csv"), "--holds", "force"]
    assert "2 of 2 files reduced" in prints(*given, "--out", tmp_path / "out")
    assert [peak(tmp_path / "out", n) for n in "ab"] == pytest.approx([1600.0] * 2, rel=0.01)
    record = json.loads((tmp_path / "out/b-table.json").read_text())
    assert record["options"]["mass_kg"] == 0.5
    assert "speed_change_m_s" in record["values"]


def test_an_option_that_was_not_typed_leaves_the_choice_to_the_file(tmp_path, prints):
    """One column of samples; drop heights by their name, in the third."""
    pulse(tmp_path / "whole.csv")
    rows = (tmp_path / "whole.csv").read_text().splitlines()
    one = put(tmp_path / "a.csv", "\n".join(row.split(",")[1] for row in rows))
    out = ["--out", tmp_path]
    prints("reduce", "table", one, "--holds", "force", "--rate-hz", "1e4", *out)
    assert peak(tmp_path, "a") == pytest.approx(800.0, rel=0.01)
    other = put(tmp_path / "b.csv", "Nr;Ball;Fallh\u00f6he (cm);1 (cm)\n1;a;50;32\n2;b;50;31\n")
    prints("reduce", "table", other, "--holds", "rebounds", *out)
    values = json.loads((tmp_path / "b-table.json").read_text())["values"]
    (e,) = (v["value"] for k, v in values.items() if k.startswith("restitution"))
    assert e == pytest.approx(0.794, abs=0.002)


@pytest.mark.parametrize(
    ("text", "words"),
    [("file,gian\na.csv,2\n", "gian"), ("name\na.csv\n", "name"), ("gain\n2\n", "file"),
     ("file,gain\na.csv,-2\n", "row 2"), ("file,gain\nnone.csv,2\n", "none.csv")],
)  # fmt: skip
def test_a_wrong_list_is_told(tmp_path, errs, text, words):
    pulse(tmp_path / "a.csv")
    (tmp_path / "list.csv").write_text(text)
    given = ["reduce", "table", "--list", str(tmp_path / "list.csv"), "--holds", "force"]
    assert words in errs(*given, "--out", tmp_path / "out")


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
    rows = rows_of(tmp_path / "out" / f"{name}-sweep.csv")
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
        assert "nan" not in (out / f"{name}.csv").read_text()
        assert {row["restitution"] for row in rows_of(out / f"{name}.csv")} == {""}
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
