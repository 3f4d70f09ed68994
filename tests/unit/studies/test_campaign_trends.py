"""Each claim of chapter 2 can hold and can fail: planted sweeps over Sy*."""

import numpy as np
import pytest
from dentscope.campaigns.cases.pairs import RATIOS
from dentscope.studies.campaign import claims as claims
from dentscope.studies.campaign import trends as trends
from dentscope.studies.campaign.sweep import Sweep

RATIO = np.array(sorted(RATIOS))


def dent(place, width):
    return 0.1 * np.exp(-((np.log(RATIO / place) / width) ** 2))


def sweep(number=3, **changes):
    x = np.log(RATIO)
    fall = np.where(x < 0.0, 0.93 - 0.25 * np.exp(x / 0.08), 0.18 + 0.45 * np.exp(-x / 0.15))
    dip = (
        0.30
        + 0.01 / (1.0 + np.exp(-(x - 0.3) / 0.05))
        - 0.03 * np.exp(-(((x - np.log(1.07)) / 0.12) ** 2))
    )
    rise = 2.7 + 0.3 / (1.0 + np.exp(-x / 0.02)) + 1.5 * dent(1.4, 0.1)
    force = 1.0 - dent(1.0, 0.1)
    made = {"share": fall, "radius": dip, "pressure": rise, "force": force, **changes}
    return Sweep(number, RATIO, records=(), **made)  # fmt: skip


def verdict(words, made):
    [claim] = [row for row in claims.CLAIMS if words in row[1]]
    return claim[2](made)


@pytest.mark.parametrize(
    "words",
    [
        "starts near 0.9",
        "delta_s* is constant",
        "faster and faster",
        "most rapidly at Sy* = 1",
        "slower and slower",
        "a is constant (within ±1 %) up to",
        "a has its dip",
        "larger than in the flattening",
        "a is constant (within ±1 %) beyond",
        "nearly constant (within ±2 %) from",
        "rises most steeply",
        "cases 2 to 4",
        "F follows",
    ],
)
def test_a_sweep_as_the_text_describes_it_agrees(words):
    found = [row[2](sweep()) for row in claims.CLAIMS if words in row[1] and "(not" not in row[1]]
    assert all(good for good, _ in found), found


@pytest.mark.parametrize(
    ("words", "changes", "told"),
    [
        ("starts near 0.9", {"share": np.full(len(RATIO), 0.8)}, "0.800"),
        ("a has its dip", {"radius": 1.0 - dent(1.3, 0.2)}, "1.3"),
        ("a has its dip", {"radius": RATIO**0.1}, "no minimum"),
        ("most rapidly", {"share": 0.5 - 0.4 * np.tanh(np.log(RATIO / 1.12) / 0.02)}, "1.1"),
        ("cases 2 to 4", {"pressure": RATIO**0.01}, "no maximum"),
        ("F follows", {"force": 1.0 - dent(1.2, 0.1)}, "1.2"),
        ("delta_s* is constant", {"share": 0.9 * RATIO**-0.1}, "±"),
    ],
)  # fmt: skip
def test_another_sweep_contradicts_with_its_number(words, changes, told):
    good, note = verdict(words, sweep(**changes))
    assert not good
    assert told in note


def test_a_minimum_between_two_ratios_is_found_there():
    for place in (1.03, 1.07, 1.12):
        _, note = verdict("a has its dip", sweep(radius=1.0 + np.log(RATIO / place) ** 2))
        assert float(note.split()[2].rstrip(",")) == pytest.approx(place, abs=0.003)


def test_where_data_is_missing_nothing_is_said():
    few = Sweep(3, RATIO[[0, -1]], *(sweep().radius[[0, -1]] for _ in range(4)), records=())
    for _, claim, test in claims.CLAIMS[:-1]:
        if "starts near" not in claim:
            assert test(few) is None, claim
    assert trends.Trend("2.2", "claim", {}).verdict == "not computed"
    findings = {"a": (True, ""), "b": (False, "")}
    assert trends.Trend("2.2", "claim", findings).verdict == "partly"
