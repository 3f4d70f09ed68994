"""The gallery's parts that need no long run, and LAMMPS's law where it is installed."""

import math
import warnings

import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.models import DomainWarning
from dentscope.studies.plot import Picture
from dentscope.studies.thesis.figures import chapter1, chapter2, gallery, outside


def test_hardness_figures_without_a_campaign(tmp_path):
    for picture in chapter1.pictures([]):
        assert picture.save(tmp_path).stat().st_size > 10_000
        compared = picture.number in ("1.2", "1.3")
        assert ("No finite-element campaign" in picture.note) == compared


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


def test_mdr_data_are_elastic_at_first_and_fall_like_a_plastic_impact():
    """e = 1 below yield, and a slope near Johnson's -1/4 deep in yield."""
    data = outside.reference()["mdr"]
    v, e = np.array(data["speed_m_s"]), np.array(data["restitution"])
    assert e[:3] == pytest.approx([1.0, 1.0, 1.0], abs=1e-5)
    assert np.all(np.diff(e[2:]) < 0.0)
    assert outside.slope(v, e) == pytest.approx(-0.28, abs=0.01)


def test_our_fitted_law_is_near_mdr_when_yield_dominates():
    """Two laws of different origin: within 15 % at 0.2 to 2 m/s, slopes within 0.08."""
    from dentscope.models import LAWS

    data = outside.reference()
    data["mdr"] = {
        "speed_m_s": data["mdr"]["speed_m_s"][5:9],
        "restitution": data["mdr"]["restitution"][5:9],
    }
    ours = outside.restitutions(LAWS["fitted"], data)
    theirs = np.array(data["mdr"]["restitution"])
    assert np.all(np.abs(ours / theirs - 1.0) < 0.15)
    v = np.array(data["mdr"]["speed_m_s"])
    assert abs(outside.slope(v, ours) - outside.slope(v, theirs)) < 0.08


def test_lammps_gives_the_stored_numbers_again():
    data = outside.reference()
    ball = data["ball"]
    try:
        e = outside.run_mdr(
            1.0, E=ball["E_Pa"], nu=ball["nu"], Sy=ball["Sy_Pa"],
            radius=ball["radius_m"], density=ball["density_kg_m3"],
        )  # fmt: skip
    except ImportError as missing:
        pytest.skip(f"LAMMPS is not installed: {missing}")
    stored = dict(zip(data["mdr"]["speed_m_s"], data["mdr"]["restitution"], strict=True))
    assert math.isfinite(e)
    assert e == pytest.approx(stored[1.0], rel=1e-3)
