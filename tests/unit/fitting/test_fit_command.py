"""`dentscope fit` as a user meets it: sources, page and coefficients in step, wrong input."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.campaigns.designs import design_named
from dentscope.cli import fit as fit_command
from dentscope.cli.app import run
from dentscope.core import InputError
from dentscope.core.flow import Flow, swift
from dentscope.core.tables import markdown
from dentscope.fitting import table
from dentscope.fitting.prediction import Errors
from dentscope.fitting.refit import refit
from dentscope.fitting.table import is_held_out, read_sources, tables_of
from dentscope.models.coefficients import read_coefficients
from dentscope.studies.closed_form.page import (
    BEGIN,
    END,
    JUDGED_BEGIN,
    JUDGED_END,
    judged_section,
    published_section,
    update_page,
)

PAGE = Path(__file__).resolve().parents[3] / "docs" / "closed-form.md"


def test_publishing_outside_a_checkout_is_one_line(monkeypatch, capsys):
    """An installed package does not write into itself."""
    monkeypatch.setattr(fit_command.studies, "present", lambda: False)
    for line in (["fit", "--publish"], ["fit", "--judge", "data/challenge", "--publish"]):
        assert run(line) == 2
        told = capsys.readouterr()
        assert "`dentscope fit --publish` belongs to the workshop" in told.err
        assert len(told.err.splitlines()) == 1


def test_page_shows_the_coefficients_in_use():
    content = read_coefficients()
    text = PAGE.read_text(encoding="utf-8")
    shown = text[text.index(BEGIN) : text.index(END) + len(END)]
    assert shown == published_section(content)


def test_page_keeps_what_stands_around_the_coefficients(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BEGIN}\nold\n{END}\nafter\n")
    content = read_coefficients()
    update_page(page, published_section(content))
    update_page(page, published_section(content))
    text = page.read_text()
    assert text.startswith("before\n")
    assert text.endswith("\nafter\n")
    assert "old" not in text
    assert text.count(BEGIN) == 1


def test_the_law_in_use_is_judged_on_cases_that_no_fit_reads(tmp_path, monkeypatch, prints, errs):
    """The validation part stands in for a challenge: its errors are those that a fit reports."""
    page = tmp_path / "page.md"
    page.write_text(f"before\n{JUDGED_BEGIN}\nold\n{JUDGED_END}\nafter\n")
    monkeypatch.setattr(fit_command, "_PAGE", page)
    part = PAGE.parents[1] / "data" / "campaign" / "validation-2-1.h5"
    assert "48 pairs" in prints("fit", "--judge", part, "--publish")
    text = page.read_text()
    assert "48 pairs, drawn from a seed of their own." in text
    assert "| F [%] |" in text
    assert "old" not in text
    assert text.endswith("\nafter\n")
    smoke = part.with_name("smoke-1.h5")
    told = errs("fit", "--judge", smoke)
    assert "no completed elastic-plastic case named validation or challenge" in told


def test_a_challenge_of_other_coefficients_is_called_so():
    content = read_coefficients()
    found = content["errors"]["fitted"]["left_out"]
    errors = [("fitted", Errors(**{k: tuple(v) for k, v in found.items()}))]
    names = [f"challenge-0123456789ab-{k:02}" for k in range(24)]
    assert "coefficients above" in judged_section(
        errors, names, "0123456789ab" + "0" * 52, within={}
    )
    assert "earlier coefficients" in judged_section(errors, names, "f" * 64, within={})


def test_markdown_table():
    assert markdown([["a", "b"], ["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |\n"


class Record:
    """What a table reads of a completed case."""

    def __init__(self, case):
        self.case, self.id, self.unloadings = case, case.id, ()
        one = np.linspace(1.0, 2.0, 5) * 1e-5
        self.curve = {k: one for k in ("delta", "force", "radius", "sphere", "flat")}
        self.curve["radius_last_node"] = one + 1e-7


def test_cases_of_low_resolution_count_only_without_finer_ones(tmp_path, monkeypatch):
    low, fine = design_named("smoke").make()[:3], design_named("space").make()[:2]
    monkeypatch.setattr(table, "read_curves", lambda _: [Record(case) for case in (*low, *fine)])
    assert tables_of(read_sources([tmp_path]))[0].names == tuple(case.name for case in fine)
    monkeypatch.setattr(table, "read_curves", lambda _: [Record(case) for case in low])
    assert len(tables_of(read_sources([tmp_path]))[0].pairs) == 3


def test_of_one_combination_the_case_that_unloads_counts(tmp_path, monkeypatch):
    again, other = (Record(case) for case in design_named("smoke").make()[:2])
    unloads = Record(again.case)
    d = np.linspace(2e-5, 1e-5, 9)
    back = {"delta": d, "force": (d - 1e-5) ** 1.5, "radius": np.full(9, 1e-5)}
    depth = 2e-5 / again.case.pair.R
    unloads.unloadings = (
        SimpleNamespace(depth=depth, residual_sphere=0.0, residual_flat=1e-5, curve=back),
    )
    for records in ([unloads, again, other], [again, other, unloads]):
        monkeypatch.setattr(table, "read_curves", lambda _, found=records: found)
        rows, turns = tables_of(read_sources([tmp_path]))
        assert (len(rows.pairs), turns.total.tolist()) == (2, [0.5])
        with pytest.raises(InputError, match=r"unload: 1 .*two or more, `unload_depths`"):
            refit([tmp_path])


def test_metals_that_harden_are_not_fitted(tmp_path, monkeypatch):
    plain, other = design_named("smoke").make()[:2]
    sphere = other.pair.sphere
    curve = swift(Sy=sphere.Sy, K=3.0 * sphere.Sy, n=0.2)
    pair = replace(other.pair, sphere=sphere.with_(flow=Flow(curve=curve)))
    hard = replace(other, problem=replace(other.problem, pair=pair))
    monkeypatch.setattr(table, "read_curves", lambda _: [Record(case) for case in (plain, hard)])
    assert tables_of(read_sources([tmp_path]))[0].names == (plain.name,)


@pytest.mark.parametrize(
    ("name", "kept"),
    [("space-000", False), ("space-127", False), ("space-128", True), ("space-255", True),
     ("validation-2-007", True), ("near-equal-200", False), ("space-odd", False)],
)  # fmt: skip
def test_the_second_half_of_the_space_judges_as_validation_does(name, kept):
    assert is_held_out(SimpleNamespace(case=SimpleNamespace(name=name))) is kept


def test_held_out_cases_are_not_fitted(tmp_path, monkeypatch):
    """A case of the validation design never reaches a fit, whatever file it lies in."""
    cases = (*design_named("validation").make()[:2], *design_named("smoke").make()[:3])
    monkeypatch.setattr(table, "read_curves", lambda _: [Record(case) for case in cases])
    fitted, _ = tables_of(read_sources([tmp_path]))
    judged, _ = tables_of(read_sources([tmp_path]), held_out=True)
    assert len(fitted.pairs) == 3
    assert len(judged.pairs) == 2
    assert not any(name.startswith("validation") for name in fitted.names)


def test_published_parts_are_known_as_campaigns():
    """What is no campaign is refused before the seconds that a reader takes to load."""
    folder = PAGE.parents[1] / "data" / "campaign"
    assert fit_command._files([folder]) == sorted(folder.glob("*.h5"))
