"""A refit of frozen data reproduces the frozen coefficients."""

import os
import runpy
from pathlib import Path

import numpy as np
import pytest
from dentscope.fitting import fit_tables
from dentscope.fitting.prediction import predict
from dentscope.models.closed_form import COEFFICIENTS
from made_processes import python

_TOOLS = runpy.run_path(str(Path(__file__).with_name("regenerate_fit.py")))


@pytest.fixture(scope="module")
def refit():
    table, turns, frozen = _TOOLS["thawed"]()
    return fit_tables(table, turns), table, turns, frozen


def test_refit_of_frozen_rows_gives_the_coefficients_within_two_standard_errors(refit):
    found, _, _, frozen = refit
    assert found.outcome.completed
    for name, value in zip(COEFFICIENTS, found.values, strict=True):
        off = abs(value - frozen["coefficients"][name])
        assert off <= 2.0 * frozen["standard_errors"][name], name


def test_a_third_of_the_rows_gives_the_law_of_all_rows(refit):
    """Coefficients trade off against each other; what they say together may not move."""
    found, table, turns, frozen = refit
    whole = [frozen["coefficients_of_all_rows"][name] for name in COEFFICIENTS]
    ours, theirs = predict(found.values, table, turns), predict(whole, table, turns)
    assert np.mean(np.abs(ours.force / theirs.force - 1.0)) < 0.01
    assert np.mean(np.abs(ours.radius / theirs.radius - 1.0)) < 0.01
    assert np.mean(np.abs(ours.share - theirs.share)) < 0.01


SAME = """
import hashlib, runpy, sys
from dentscope.fitting import fit_tables
table, turns, _ = runpy.run_path(sys.argv[1])["thawed"]()
fit = fit_tables(table, turns, change=0.05)
print(hashlib.sha256(fit.values.tobytes() + fit.covariance.tobytes()).hexdigest())
"""


def test_the_fit_is_the_same_to_the_last_bit_whatever_threads_hashes_and_zone():
    place = str(Path(__file__).with_name("regenerate_fit.py"))
    found = set()
    for threads, seed, zone in (("1", "0", "UTC"), ("4", "7", "Asia/Tokyo")):
        own = {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads, "TZ": zone}
        environment = {**os.environ, **own, "PYTHONHASHSEED": seed}
        found.add(python("-c", SAME, place, check=True, env=environment).stdout)
    assert len(found) == 1
