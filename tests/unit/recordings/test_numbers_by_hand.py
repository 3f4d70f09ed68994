"""Tuned numbers of the audit where they act, in balances that are worked out by hand."""

from __future__ import annotations

import pytest
from dentscope.recordings.checks.contact import _budget, _supply
from dentscope.recordings.checks.findings import Severity
from dentscope.recordings.checks.trial_view import TrialReading


@pytest.mark.parametrize(("std", "said"), [(0.024, "CONTRADICTION"), (0.026, "CONSISTENT")])
def test_a_dent_takes_055_of_its_work_at_the_least_and_four_deviations_contradict(
    std, said
) -> None:
    """0.55 of 2 J are 0.1 J more than was brought."""
    found = _supply("a", TrialReading(2.0, 0.0), TrialReading(1.0, std))
    assert found.severity is Severity[said]
    assert found.significance == pytest.approx(0.1 / std)


@pytest.mark.parametrize(("lost", "said"), [(2.9, "CAUTION"), (2.7, "CONSISTENT")])
def test_a_dent_explains_half_of_what_was_lost(lost, said) -> None:
    """1.1 of its work of 1 J at the most; half of what was lost is known to 0.15 J."""
    found = _budget("a", TrialReading(1.0, 0.0), TrialReading(lost, 0.3))
    assert found.severity is Severity[said]
    assert found.significance == pytest.approx((0.5 * lost - 1.1) / 0.15)
