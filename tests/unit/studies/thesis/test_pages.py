"""Pages, tables and claims of the thesis: what is drawn and said of them can hold and can fail."""

import json
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.campaigns.cases.pairs import RATIOS
from dentscope.core import InputError
from dentscope.models import DomainWarning
from dentscope.studies.campaign import claims as claims
from dentscope.studies.campaign import trends as trends
from dentscope.studies.campaign.sweep import Sweep
from dentscope.studies.plot import Picture
from dentscope.studies.thesis.figures import chapter1, chapter2, fields, gallery, tables

LAW = SimpleNamespace(
    residual_flat_m=60e-6, sliding_length_m=60e-6, restitution=0.45, return_time_s=0.25e-3,
    mean_force_N=2500.0,
)  # fmt: skip


def said(angle, depth, sliding, e, duration, force):
    experiment = {
        "angle_deg": angle, "depth_m": -depth, "sliding_m": -sliding, "restitution": e,
    }  # fmt: skip
    scar = SimpleNamespace(duration=duration, mean_force=force)
    return tables._said(experiment, scar, [LAW])


def test_a_shallow_blow_that_slides_far_and_long_is_as_the_text_says():
    told = said(20.0, 22e-6, 1400e-6, 0.5, 4.3e-3, 79.0)
    assert told == "All 5 statements of the text hold."
    told = said(20.0, 22e-6, 100e-6, 0.5, 4.3e-3, 79.0)
    assert told.endswith("not: what was measured slid much farther (twice at least).")


def test_a_steep_blow_of_the_laws_own_force_is_not():
    told = said(70.0, 105e-6, 200e-6, 0.05, 0.1e-3, 17672.0)
    assert told == "All 4 statements of the text hold."
    told = said(70.0, 105e-6, 200e-6, 0.05, 0.1e-3, 2400.0)
    assert "not: its mean force is larger (the laws' 1.04 to 1.04 of it)" in told


def test_table_4_1_weighs_the_rod():
    cells = [cell for row in tables.properties("4.1").rows for cell in row]
    assert any("0.5673 kg" in cell for cell in cells)
    assert "760 MPa" in cells


def test_a_stored_field_is_read_and_judged(tmp_path):
    square = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]])
    np.savez_compressed(
        tmp_path / "figure-2-2.npz", corners=np.stack([square, square - [0.0, 0.1]]),
        sphere=np.array([True, False]), stress=np.array([1.0, 0.7]),
        plastic=np.array([0.02, 0.0]), origin=np.array(json.dumps({"a_over_R": 0.1})),
    )  # fmt: skip
    field = fields.read_field("2.2", folder=tmp_path)
    assert field is not None
    told = fields._yielded(field, 0.1)
    assert told == (
        "The sphere has yielded to 0.50 a sideways and 0.50 a deep, by up to 2 %; the flat has not "
        "yielded (at most 0.70 Sy_min)."
    )
    assert fields.read_field("2.4", folder=tmp_path) is None


def test_a_chapter_gets_its_page_and_the_index_names_it(tmp_path):
    drawn = gallery.build(tmp_path, chapters=["1"], root=tmp_path)
    assert [one.number for one in drawn] == ["1.2", "1.3"]
    page = (tmp_path / "chapter-1.md").read_text("utf-8")
    assert page.count("![") == 2
    index = (tmp_path / "README.md").read_text("utf-8")
    assert "[Chapter 1](chapter-1.md)" in index
    assert "| [Chapter 1](chapter-1.md) | 2 figures |" in index
    assert "Chapter 2" not in index


def test_hardness_figures_without_a_campaign(tmp_path):
    for picture in chapter1.pictures([]):
        assert picture.save(tmp_path).stat().st_size > 10_000
        assert "No finite-element campaign" in picture.note


def test_law_figures_of_chapter_2_are_all_there(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DomainWarning)
        pictures = chapter2.pictures([])
    figures = {one.number for one in pictures if isinstance(one, Picture)}
    assert figures == {f"2.{n}" for n in range(1, 22)}
    assert all(one.note.endswith(".") for one in pictures)


def test_an_unknown_chapter_is_refused(tmp_path):
    with pytest.raises(InputError, match="4 and 5"):
        gallery.build(tmp_path, chapters=["7"], root=tmp_path)


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
