"""The learner: what it is shown of a set, and how it is judged."""

import math
import zipfile
from pathlib import Path

import numpy as np
import pytest
from dentscope.recordings import read
from dentscope.studies.peers import learned

OPEN = Path(__file__).resolve().parents[3] / "data" / "blind-sets" / "open.zip"


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    folder = tmp_path_factory.mktemp("open")
    with zipfile.ZipFile(OPEN) as packed:
        packed.extractall(folder)
    return sorted((folder / "open" / "sets").iterdir())[0]


def test_without_the_readings_nothing_that_was_read_off_is_shown(opened):
    recordings = read(opened)
    sheet, whole = (learned.features(recordings, sheets=s) for s in (True, False))
    assert sheet.items() < whole.items()
    assert not [key for key in sheet if key.startswith(recordings.observed)]
    assert {f"{name} level" for name in recordings.observed} & set(whole)


def test_a_plastic_blow_is_at_its_hand_formula(opened):
    """Depth and contact time of a quarter period on the spring 2 pi R 2.8 Sy."""
    recordings = read(opened)
    flat, body = recordings.setup.target, recordings.strikers()[0]
    spring = 2.0 * math.pi * body.tip_radius_m.value * 2.8 * flat.Sy_Pa.value
    depth, time = (
        learned._by_hand(name, recordings, *(
            np.array([x]) for x in (2.0, body.tip_radius_m.value, body.mass_kg.value)
        ))
        for name in ("permanent_depth_m", "contact_time_s")
    )  # fmt: skip
    assert depth[0] == pytest.approx(2.0 * math.sqrt(body.mass_kg.value / spring))
    assert time[0] == pytest.approx(0.5 * math.pi * math.sqrt(body.mass_kg.value / spring))


def test_a_truth_that_was_never_seen_has_the_least_probability():
    front, ln_p = learned._scored([{"a": 0.75, "b": 0.25}, {"a": 1.0}], ["a", "c"])
    assert front == 0.5
    assert ln_p == pytest.approx(0.5 * (math.log(0.75) + math.log(0.002)))
