"""Tuned numbers of campaigns where they act, in cases that are worked out by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.campaigns.case import _rounded
from dentscope.campaigns.cost import Forecast
from dentscope.campaigns.quality import largest_step
from dentscope.cli.campaign_progress import remarks
from made_cases import case_of


@pytest.mark.parametrize(
    ("energy", "step", "said"),
    [(0.0049, 0.0099, ""), (0.0051, 0.0, "energy defect"), (0.0, 0.0101, "step of")],
)
def test_a_case_is_remarked_from_half_a_per_cent_of_energy_and_a_per_cent_of_a_step(
    energy, step, said
) -> None:
    quality = SimpleNamespace(energy_defect=energy, largest_step=step)
    told = remarks(SimpleNamespace(status="done", stale=False, quality=quality))
    assert (said in told) if said else (told == "")


def test_groups_are_one_to_twelve_digits() -> None:
    assert _rounded(1.0 + 4e-12) == 1.0
    assert _rounded(1.0 + 6e-12) > 1.0


def test_a_step_is_seen_from_eight_depths_on_by_what_a_cubic_over_seven_leaves() -> None:
    """A single step of 1 % shows two thirds of itself, which is made up for."""
    depth = np.geomspace(1e-5, 1e-2, 20)
    stepped = depth**1.5 * np.where(np.arange(20) < 10, 1.0, 1.01)
    assert largest_step(depth, stepped) == pytest.approx(0.01, rel=0.02)
    assert np.isnan(largest_step(depth[:7], stepped[:7]))
    assert largest_step(depth[:8], depth[:8]) == pytest.approx(0.0, abs=1e-9)


def test_a_case_under_way_still_takes_a_seventh_of_its_time_however_long_it_has() -> None:
    one = case_of()
    forecast = Forecast([one], workers=1)
    whole = forecast.cost_s(one)
    assert forecast.left_s(0.5 * whole) == pytest.approx(0.5 * whole)
    assert forecast.left_s(9.0 * whole) == pytest.approx(0.15 * whole)
