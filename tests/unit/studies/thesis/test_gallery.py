"""The gallery's parts that need no long run."""

import warnings

import pytest
from dentscope.core import InputError
from dentscope.models import DomainWarning
from dentscope.studies.plot import Picture
from dentscope.studies.thesis.figures import chapter1, chapter2, gallery


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
