"""The regression for metals that harden: what it finds is there, on pairs that it has not seen."""

from pathlib import Path

import numpy as np
import pytest
from dentscope.fitting.hardening import fit_hardening, hardening_records, judge_hardening
from dentscope.fitting.table import read_sources
from dentscope.models import LAWS
from dentscope.models.hardening import HardeningCorrection, hardening_law

DATA = Path(__file__).parents[3] / "data" / "campaign"
PARTS = sorted([*DATA.glob("*hardening-1.h5"), *DATA.glob("*plateau-1.h5")])
FITTED, HARDENING = LAWS["fitted"], LAWS["hardening"]


@pytest.fixture(scope="module")
def sources():
    return read_sources(PARTS)


def test_no_fit_reads_the_pairs_for_judging(sources):
    seen, kept = hardening_records(sources), hardening_records(sources, held_out=True)
    assert (len(seen), len(kept)) == (96 + 48, 24 + 24)
    assert all(r.case.name.startswith("validation") for r in kept)
    assert not {r.id for r in seen} & {r.id for r in kept}


def test_pairs_that_no_fit_read_are_within_what_is_stated(sources):
    errors, within = judge_hardening(HARDENING, hardening_records(sources, held_out=True))
    assert errors["force"][0] < 0.015
    assert errors["radius"][0] < 0.01
    for quantity, (one, two) in within.items():
        assert one == pytest.approx(0.68, abs=0.2), quantity
        assert two > 0.85, quantity


def test_a_few_pairs_are_enough_to_halve_the_error_of_the_equivalence_alone(sources):
    records = hardening_records(sources)
    found = fit_hardening(FITTED, records[::3])
    assert found.combinations == 48
    others = records[1::12]
    learned, _ = judge_hardening(hardening_law(FITTED, found.correction), others)
    none = HardeningCorrection(
        found.correction.low, found.correction.high, np.zeros_like(found.correction.weights),
        found.correction.spread,
    )  # fmt: skip
    alone, _ = judge_hardening(hardening_law(FITTED, none), others)
    assert learned["force"][0] < 0.75 * alone["force"][0]
    assert learned["radius"][0] < 0.6 * alone["radius"][0]
