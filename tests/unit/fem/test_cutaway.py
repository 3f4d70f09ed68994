"""The picture of both bodies in space."""

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.core.rendering import offscreen_available
from dentscope.fem.results.cutaway import draw_cutaway
from matplotlib.image import imread

PAIR = Pair(Material(E=200e9, nu=0.3, Sy=1e9), Material(E=200e9, nu=0.3, Sy=4e8), 1e-3)


@pytest.mark.fe
@pytest.mark.skipif(not offscreen_available(), reason="nothing renders here without a screen")
def test_the_cut_shows_both_bodies_and_their_stresses(tmp_path):
    problem = fem.ContactProblem(PAIR, (1e-4, 5e-4), snapshots=(5e-4,))
    solution = fem.solve(problem, accuracy=fem.Accuracy.smoke())
    extent = 2.5 * float(solution.loading.radius[-1])
    path = draw_cutaway(
        solution.snapshots[0], tmp_path / "cut.png", Sy_min=PAIR.Sy_min, extent=extent
    )
    image = imread(path)[..., :3]
    colour = image.max(axis=2) - image.min(axis=2)
    # the stressed cut, the grey skins and the white around them
    assert np.mean(colour > 0.5) > 0.1
    assert np.mean((colour < 0.1) & (image.max(axis=2) < 0.95)) > 0.05
    assert np.mean(image.min(axis=2) > 0.99) > 0.1
    # the scale: its words, its numbers and its colours, a blank between them
    drawn = image[860:].min(axis=(1, 2)) < 0.9
    assert np.count_nonzero(np.diff(drawn.astype(int)) == 1) == 3
