"""Predicted scars against geometry, tables against the thesis, pages of docs/thesis."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.studies.thesis.figures import fields, gallery, scars, tables

R = 0.0088


def traced(path, height, left):
    """A trace as `scars.scar` reads it: path and height of the tip, and the residual depth."""
    columns = {"slip_m": np.asarray(path), "tip_height_m": np.asarray(height)}
    return SimpleNamespace(column=columns.__getitem__, impact=SimpleNamespace(residual_flat_m=left))


def test_a_tip_that_does_not_slide_leaves_a_round_dent():
    """Radius sqrt(2 R d) = 1.0276 mm of the imprint of 60 um, depth that of the law."""
    found = scars.scar(traced([0.0, 0.0, 0.0], [0.0, -60e-6, 0.0], 45e-6), R)
    assert found.deepest == pytest.approx(45e-6, rel=1e-3)
    assert 0.5 * found.width == pytest.approx(1.0276e-3, rel=0.01)
    assert found.sliding_length == pytest.approx(0.0, abs=3e-5)


def test_a_tip_that_slides_at_one_depth_leaves_a_groove_longer_by_the_path():
    path = np.linspace(0.0, 1.4e-3, 60)
    found = scars.scar(traced(path, np.full(60, -22e-6), 22e-6), R)
    assert found.sliding_length == pytest.approx(1.4e-3, abs=3e-5)
    # the thesis's own depth and length: it would be a groove 1.24 mm wide
    assert found.width == pytest.approx(2.0 * np.sqrt(2.0 * R * 22e-6), rel=0.02)


def test_table_5_2_comes_out_with_the_mass_that_fits():
    """67, 77 and 64 um and 0.42, 0.46 and 0.43 printed: within 6 and 8 %."""
    table = tables.comparison("5.2", 20.0)
    ours = {
        table.rows[k - 1][0]: row
        for k, row in enumerate(table.rows)
        if row[1] == "ours" and not row[0]
    }
    for law, dent, e in (("Ghaednia", 67, 0.42), ("Brake 2015", 77, 0.46),
                         ("Kogut-Komvopoulos", 64, 0.43)):  # fmt: skip
        assert float(ours[law][2]) == pytest.approx(-dent, rel=0.06)
        assert float(ours[law][4]) == pytest.approx(e, rel=0.08)
    lines = table.markdown.splitlines()
    assert len(lines) == 2 + len(table.rows)
    assert {line.count("|") for line in lines} == {len(table.header) + 1}


def test_table_4_1_weighs_the_rod():
    text = tables.properties("4.1").markdown
    assert "0.5673 kg" in text
    assert "760 MPa" in text


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
