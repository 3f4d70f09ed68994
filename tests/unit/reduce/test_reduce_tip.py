"""Tip radius from photographs rendered with a known one."""

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.measured import Measured
from dentscope.reduce.tip.kind import reduce
from dentscope.reduce.tip.options import Options
from dentscope.reduce.tip.reduction import reduce_tip
from dentscope.studies.synthetic.tip import TipTruth, photograph, random_tip

imsave = pytest.importorskip("skimage.io").imsave


@pytest.mark.parametrize("seed", [101, 102, 103, 104])
def test_radius_of_a_rods_tip(seed):
    truth = random_tip(seed)
    found = reduce_tip(photograph(truth))
    assert abs(found.radius.value - truth.radius) < 3.0 * found.radius.std
    assert found.radius.value == pytest.approx(truth.radius, rel=0.01)
    assert found.radius.std < 0.02 * truth.radius
    assert found.width.value == pytest.approx(2.0 * truth.half_width, abs=0.1)
    assert found.blur == pytest.approx(truth.blur, abs=0.25)


def test_blur_does_not_shrink_a_ball():
    # the half-level edge of a blurred disc lies sigma^2/(2 R) inside its own
    radius = 20.0
    for blur in (1.0, 3.0):
        truth = TipTruth(shape="sphere", radius=radius, blur=blur, noise=1.0, uneven=0.0,
                         rows=90, columns=90)  # fmt: skip
        found = reduce_tip(photograph(truth), shape="sphere")
        assert found.radius.value == pytest.approx(radius, abs=0.03)


def test_scale_and_its_error_reach_the_radius(tmp_path):
    truth = TipTruth(radius=140.0, half_width=110.0, noise=2.0)
    imsave(tmp_path / "tip.png", photograph(truth), check_contrast=False)
    found = reduce(tmp_path / "tip.png", Options(diameter_m=0.0176, diameter_m_std=1.76e-4))
    tip = found.striker["tip_radius_m"]
    assert tip.value == pytest.approx(140.0 / 220.0 * 0.0176, rel=0.005)
    assert 0.01 < tip.std / tip.value < 0.013
    found.draw(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 20_000


def test_a_tip_that_points_up_and_is_bright():
    picture = 255 - photograph(TipTruth(noise=2.0))[::-1]
    found = reduce_tip(np.ascontiguousarray(picture[::-1]), striker_is="bright")
    assert found.radius.value == pytest.approx(140.0, rel=0.005)


def test_a_worn_apex_is_named():
    found = reduce_tip(photograph(TipTruth(flat=22.0, noise=2.0)))
    assert any("flat" in note for note in found.notes)
    assert not any("flat" in n for n in reduce_tip(photograph(TipTruth(noise=2.0))).notes)


def test_uncertainty_is_honest():
    scores = []
    for seed in range(300, 309):
        truth = random_tip(seed)
        found = reduce_tip(photograph(truth))
        scores.append((found.radius.value - truth.radius) / found.radius.std)
    assert np.sum(np.abs(scores) < 2.0) >= 8
    assert 0.3 < np.std(scores) < 1.6


@pytest.mark.parametrize(
    ("picture", "line"),
    [
        (np.full((100, 100), 90, np.uint8), "no contrast"),
        (np.pad(np.zeros((5, 5), np.uint8), 50, constant_values=220), "25 pixels"),
        (
            np.pad(np.zeros((40, 40), np.uint8), 50, constant_values=220),
            "does not enter from above",
        ),
    ],
)
def test_pictures_without_a_tip_are_a_line(picture, line):
    with pytest.raises(InputError, match=line):
        reduce_tip(picture, scale=Measured(1e-5, 0.0))


def test_what_is_no_picture_is_a_line(tmp_path):
    (tmp_path / "a.png").write_bytes(b"no picture")
    for path, told in ((tmp_path / "a.png", "cannot be read as a picture"), (tmp_path, "a folder")):
        with pytest.raises(InputError, match=told):
            reduce(path, Options())
