"""`dentscope campaign`: one table in both formats; what is said where a run is stopped."""

import numpy as np
import pandas
import pytest
from dentscope import campaigns
from dentscope.campaigns import DESIGNS, Design, Store
from dentscope.campaigns.run import Status, Step
from dentscope.cli import run
from dentscope.core.output import in_use
from dentscope.fem import Curve
from made_cases import case_of, solution_of


@pytest.fixture
def stored(tmp_path):
    columns = {
        name: [1.0 / (k + 3) * (i + 1) for i in range(4)]
        for k, name in enumerate(Curve.__dataclass_fields__)
    }
    arrays = {name: np.array(column) for name, column in columns.items()}
    Store(tmp_path).put(case_of(), solution_of(case_of(), **arrays))
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
