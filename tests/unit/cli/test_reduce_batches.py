"""Several raw files in one call: folders, a list with options of each, one page of pictures."""

import json

import numpy as np
import pytest
from dentscope.cli import run

T = np.arange(0.0, 0.03, 1e-4)


def pulse(path, *, gain=1.0):
    value = gain * 800.0 * np.sin(np.pi * np.clip((T - 0.01) / 4e-3, 0.0, 1.0))
    value = value + gain * np.random.default_rng(1).normal(0.0, 1.0, T.size)
    rows = [f"{t:.4f},{v:.4f}" for t, v in zip(T, value, strict=True)]
    path.write_text("\n".join(["time_s,force_N", *rows]))


def peak(out, name):
    return json.loads((out / f"{name}-table.json").read_text())["values"]["peak_force_N"]["value"]


def test_a_folder_is_reduced_file_by_file_onto_one_page(tmp_path, errs, capsys):
    raw, out = tmp_path / "raw", tmp_path / "out"
    raw.mkdir()
    for name in ("b10", "b9"):
        pulse(raw / f"{name}.csv")
    (raw / "flat.csv").write_text("time_s,force_N\n" + "".join(f"{t:.4f},0\n" for t in T))
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


def test_an_option_that_was_not_typed_leaves_the_choice_to_the_file(tmp_path):
    """One column of samples; drop heights by their name, in the third."""
    pulse(tmp_path / "whole.csv")
    rows = (tmp_path / "whole.csv").read_text().splitlines()
    (tmp_path / "a.csv").write_text("\n".join(row.split(",")[1] for row in rows))
    out = ["--out", str(tmp_path)]
    given = ["reduce", "table", str(tmp_path / "a.csv"), "--holds", "force", "--rate-hz", "1e4"]
    assert run([*given, *out]) == 0
    assert peak(tmp_path, "a") == pytest.approx(800.0, rel=0.01)
    (tmp_path / "b.csv").write_text(
        "Nr;Ball;Fallh\u00f6he (cm);1 (cm)\n1;a;50;32\n2;b;50;31\n", "utf-8"
    )
    assert run(["reduce", "table", str(tmp_path / "b.csv"), "--holds", "rebounds", *out]) == 0
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
