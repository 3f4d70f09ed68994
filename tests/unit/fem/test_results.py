"""What a solve tells: its errors, curves freed of the ripple of the rings, both bodies in space."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.core.rendering import offscreen_available
from dentscope.fem.results.cutaway import draw_cutaway
from dentscope.fem.results.measure import Reading
from dentscope.fem.results.ripple import RippleTrack
from dentscope.fem.results.uncertainty import _mesh_errors
from matplotlib.image import imread

STEEL = Material(E=200e9, nu=0.3, Sy=500e6)
PAIR = Pair(STEEL, STEEL, R=1e-3)
LEVELS = [fem.Accuracy.production, fem.Accuracy.quick, fem.Accuracy.smoke]


def stated(level, pair=PAIR, over_onset=(1.0, 1e4)):
    problem = fem.ContactProblem(pair, (0.01,))
    delta = np.array(over_onset) * PAIR.first_yield * pair.R
    ones = dict.fromkeys(fem.Curve.__dataclass_fields__, np.ones_like(delta))
    curve = replace(fem.Curve(**ones), delta=delta, force=np.full_like(delta, 7.0))
    return fem.discretisation_uncertainty(curve, problem, level())


@pytest.mark.parametrize("level", LEVELS)
def test_at_a_knot_the_tables_number_times_the_value_is_stated(level):
    row = _mesh_errors()["levels"][level().level]["near-equal"]
    k = _mesh_errors()["depth_over_first_yield"].index(1.0)
    found = stated(level)
    assert found.force[0] == pytest.approx(7.0 * row["force"][k], rel=1e-9)
    assert found.sphere_share[0] == pytest.approx(row["sphere_share"][k], rel=1e-9)


@pytest.mark.parametrize(("ratio", "strengths"), [(0.71, "near-equal"), (1.6, "unlike")])
def test_bodies_that_yield_together_state_their_own(ratio, strengths):
    pair = Pair(replace(STEEL, Sy=500e6 * ratio), STEEL, R=1e-3)
    row = _mesh_errors()["levels"]["quick"][strengths]["sphere_share"]
    found = stated(fem.Accuracy.quick, pair, over_onset=(1e5,) * 2)
    assert found.sphere_share[0] == pytest.approx(row[-1], rel=1e-9)


def test_a_coarser_level_states_more():
    for finer, coarser in pairwise(map(stated, LEVELS)):
        # the steps, which are alike, have most of the force's error deep down
        assert (finer.force <= coarser.force).all()
        assert finer.force[0] < coarser.force[0]
        assert (finer.radius < coarser.radius).all()


def test_a_pair_that_never_yields_states_what_holds_below_first_yield():
    elastic = Pair(replace(STEEL, Sy=np.inf), replace(STEEL, Sy=np.inf), R=1e-3)
    unlike = replace(PAIR, sphere=replace(STEEL, Sy=5e9))
    shallow = stated(fem.Accuracy.quick, unlike, over_onset=(1e-3, 1e-2))
    assert stated(fem.Accuracy.quick, elastic).force == pytest.approx(shallow.force)


def test_settings_that_were_never_measured_are_refused():
    with pytest.raises(ValueError, match="measured are"):
        stated(lambda: fem.Accuracy.smoke().with_(level="my own"))


def test_the_table_is_of_the_present_numerics():
    assert _mesh_errors()["numerics_version"] == fem.NUMERICS_VERSION
    assert _mesh_errors()["format"] == fem.MESH_ERRORS_FORMAT


def path(n=120, *, ratio=1.035, ripple=0.003, share=0.5):
    """A force that bends and a radius, both with a part that repeats from ring to ring."""
    readings, truth = [], []
    for k in range(n):
        x = np.log(ratio) * k
        force, radius = np.exp(1.3 * x - 0.02 * x**2), np.exp(0.5 * x + 0.01 * np.sin(2 * x))
        place = np.log(radius) / np.log(1.025)
        turn = 2.0 * np.pi * place
        tooth = ripple * (np.sin(turn) + 0.4 * np.sin(2.0 * turn + 1.0))
        clean = Reading(
            delta=1e-4 * np.exp(x), force=force, radius=radius, radius_last_node=radius,
            sphere=share, flat=1.0 - share, force_defect=0.0, place=place,
        )  # fmt: skip
        truth.append(clean)
        readings.append(replace(clean, force=force * (1 + tooth), radius=radius * (1 - tooth / 2)))
    return readings, truth


def departures(smooth, truth, name):
    return np.array(
        [getattr(a, name) / getattr(b, name) - 1.0 for a, b in zip(smooth, truth, strict=True)]
    )


def test_the_ripple_goes_and_the_curve_stays():
    readings, truth = path()
    smooth = RippleTrack(readings).smooth(readings)
    before, after = (departures(r, truth, "force")[8:-8] for r in (readings, smooth))
    assert np.std(before) > 1e-3
    assert np.std(after) < 0.1 * np.std(before)
    assert np.abs(departures(smooth, truth, "radius")[8:-8]).max() < 2e-4
    assert np.abs(departures(smooth, truth, "force")).max() < 1e-3


def test_a_curve_without_ripple_is_left_alone():
    readings, truth = path(ripple=0.0)
    smooth = RippleTrack(readings).smooth(readings)
    assert np.abs(departures(smooth, truth, "force")).max() < 1e-5


@pytest.mark.parametrize("rings", [0.25, 0.48, 0.5, 0.52, 0.7, 0.95, 1.0])
def test_no_length_of_the_steps_upsets_the_curve(rings):
    """At half a ring or a whole one a step the ripple seems to stand still."""
    ratio = 1.025 ** (2.0 * rings)
    readings, truth = path(int(2.0 / np.log(ratio)), ratio=ratio)
    smooth = RippleTrack(readings).smooth(readings)
    raw = np.abs(departures(readings, truth, "force")).max()
    assert np.abs(departures(smooth, truth, "force")).max() < 1.3 * raw


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_the_share_of_a_rigid_body_stays_what_it_is(share):
    readings, _ = path(share=share)
    for reading in RippleTrack(readings).smooth(readings):
        assert reading.sphere == pytest.approx(share, abs=1e-12)
        assert reading.flat == pytest.approx(1.0 - share, abs=1e-12)


def test_few_steps_are_not_smoothed():
    readings, _ = path(20, ratio=1.3)
    assert RippleTrack(readings).smooth(readings) == readings


CUT = Pair(Material(E=200e9, nu=0.3, Sy=1e9), Material(E=200e9, nu=0.3, Sy=4e8), 1e-3)


@pytest.mark.fe
@pytest.mark.skipif(not offscreen_available(), reason="nothing renders here without a screen")
def test_the_cut_shows_both_bodies_and_their_stresses(tmp_path):
    problem = fem.ContactProblem(CUT, (1e-4, 5e-4), snapshots=(5e-4,))
    solution = fem.solve(problem, accuracy=fem.Accuracy.smoke())
    extent = 2.5 * float(solution.loading.radius[-1])
    path = draw_cutaway(
        solution.snapshots[0], tmp_path / "cut.png", Sy_min=CUT.Sy_min, extent=extent
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
