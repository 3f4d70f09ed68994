"""docs/thesis/errata.md holds what is computed, and the printed forms fail where it says."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.models import LAWS
from dentscope.studies.thesis import as_printed
from dentscope.studies.thesis.contradictions import CONTRADICTIONS
from dentscope.studies.thesis.errata import text
from dentscope.studies.thesis.misprints import MISPRINTS

DOCS = Path(__file__).parents[4] / "docs"


def test_the_document_is_what_the_code_computes():
    """`python -m dentscope.studies.thesis.errata` writes it anew."""
    assert (DOCS / "thesis" / "errata.md").read_text("utf-8") == text()


def test_every_misprint_of_the_equation_list_has_an_erratum():
    theory = (DOCS / "theory.md").read_text("utf-8")
    rows = [line.split("|")[1] for line in theory.splitlines() if "corrected)" in line]
    known = " ".join(one.where for one in MISPRINTS)
    chapters = {"5": "5.5-5.13", "4": "4.", "3": "3.", "2": "2.", "1": "1."}
    for row in rows:
        number = row.split("(")[0].strip().split("-")[0]
        assert number in known or chapters[number[0]] in known


def test_numbers_of_the_equation_audit():
    """Each was worked out independently of this code."""
    assert as_printed.slip_line_2_36([0.1, 0.3]) == pytest.approx([226.0, 21.5], rel=3e-3)
    assert 1.0 / as_printed.stress_4_28(0.3) == pytest.approx(1.058, abs=1e-3)
    assert as_printed.hardness_4_30(327.0, 105.0) == pytest.approx(39.7, abs=0.05)
    assert as_printed.unloading_4_19(1.0, 110.0) == pytest.approx(0.86, abs=5e-3)
    assert as_printed.area_ratio_4_26(400.0) == pytest.approx(-0.41, abs=5e-3)
    assert as_printed.chi_2_32(14676.0, 10.0) < -50.0


def test_the_printed_alpha_has_the_wrong_sign():
    """+14.8, +1.96 and +0.76 at 20, 45 and 70 degrees, where the tables imply a negative one."""
    rod = {"mass": 0.4607, "inertia": 0.4607 * 0.3048**2 / 12, "length": 0.3048, "R": 0.0088}
    got = [
        as_printed.alpha_5_12(**rod, theta=math.radians(a), mu=mu)
        for a, mu in ((20, 0.2), (45, 0.13), (70, 0.1))
    ]
    assert got == pytest.approx([14.8, 1.96, 0.76], rel=0.02)


def test_the_letter_of_chapter_2_is_no_force():
    """Forces in newtons scale with R^2 at the same Delta/R; the printed ones do not."""
    soft, hard = Material(E=200e9, nu=0.3, Sy=200e6), Material(E=200e9, nu=0.3, Sy=4e9)
    small, large = Pair(soft, hard, 1e-3), Pair(soft, hard, 1e-2)
    d = np.array([1e-5])
    law = LAWS["ghaednia"]
    assert law.loading(large, 10 * d) / law.loading(small, d) == pytest.approx(100.0)
    printed = as_printed.ghaednia_force(large, 10 * d) / as_printed.ghaednia_force(small, d)
    assert abs(float(printed[0]) - 100.0) > 20.0


def test_each_contradiction_gives_numbers():
    assert all(any(c.isdigit() for c in one.show()) for one in CONTRADICTIONS)
