"""Pages of docs/thesis, tables against the thesis, and what is said of them."""

import json
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.models import DomainWarning
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
