"""Pictures: rig and dent to scale, words and units on every axis, no empty panel."""

import warnings
from functools import cache

import made_blows
import numpy as np
import pytest
from dentscope.dynamics.files.sweep import SweepTable
from dentscope.dynamics.report import draw
from dentscope.dynamics.report.crater import surfaces_left
from dentscope.dynamics.report.picture import picture
from dentscope.dynamics.report.rig_shape import rig_shape
from dentscope.fitting.crater_shape import Left, crater_shape
from dentscope.models import LAWS
from dentscope.models.base import DomainWarning
from dentscope.start import impact
from made_blows import setup

blow = cache(made_blows.blow)

BALL = made_blows.BALL.replace("7870", "7870\nthickness_m = 0.004").replace("= 1.0", "= 3.0")
EQUAL = BALL.replace("1.7e9", "3.05e8")
KINDS = {
    "ball": (BALL, 6, ["flat"]),
    "both keep a dent": (EQUAL, 6, ["flat", "sphere"]),
    "elastic": (BALL.replace("Sy_Pa = 3.05e8\n", "").replace("Sy_Pa = 1.7e9\n", ""), 5, []),
    "rigid ball": (BALL.replace("E_Pa = 2.0e11\nnu = 0.3\nSy_Pa = 1.7e9", "rigid = true"), 6,
                   ["flat"]),
    "second sphere": (BALL.replace("thickness_m = 0.004",
                                   'shape = "sphere"\nradius_m = 0.01\nmass_kg = 0.03296'), 6,
                      ["flat"]),
    "seat": (BALL.replace("thickness_m = 0.004", 'shape = "sphere"\nradius_m = -0.012'), 6,
             ["flat"]),
    "rod": (BALL.replace('shape = "sphere"', 'shape = "rod"\nradius_m = 0.005\nlength_m = 0.1\n'
                         'mass_kg = 0.06') + "angle_deg = 45\n[friction]\ncoefficient = 0.2\n", 9,
            ["flat"]),
}  # fmt: skip
THIN = KINDS["rod"][0].replace("\nradius_m = 0.005", "\nradius_m = 0.001")


@pytest.mark.parametrize(("text", "panels", "left"), KINDS.values(), ids=KINDS)
def test_every_panel_has_words_and_something_in_it(text, panels, left):
    found = blow(text)
    made = picture(found)
    assert len(made.axes) == panels
    for axis in made.axes:
        assert "[" in axis.get_xlabel()
        assert "[" in axis.get_ylabel()
        assert axis.get_lines() or axis.patches
    rig, crater = made.axes[:2]
    assert rig.get_title().startswith("to scale\n")
    assert rig.get_aspect() == 1.0
    assert ("times too large" in crater.get_title()) == bool(left)
    scene, impact = found.setup.scene(LAWS["fitted"]), found["fitted"]
    surfaces = surfaces_left(scene, impact, found.bands["fitted"].std)
    assert [s.body for s in surfaces] == left
    for s in surfaces:
        stays = impact.residual_flat_m if s.body == "flat" else impact.residual_sphere_m
        assert s.height.min() == pytest.approx(-stays, rel=1e-3)
        assert s.shaped


def test_a_law_by_which_the_blow_did_not_end_is_no_result():
    """Ten steps are too few by the second law too; neither has a number, a crater or a band."""
    found = blow(BALL + "max_steps = 10\n", "fitted", "hertz")
    assert found.table() == [("restitution", "unfinished", "unfinished"),
                             ("largest mean pressure [MPa]", "", "")]  # fmt: skip
    assert found.checks() == found.rules() == []
    assert np.isnan([found["fitted"].restitution, found["fitted"].peak_force_N]).all()
    assert all(np.isnan(row["restitution"]) and row["restitution_std"] == ""
               for row in found.written())  # fmt: skip
    made = picture(found)
    assert not any(axis.get_title().startswith("left by") for axis in made.axes)
    assert [text.get_text() for text in made.axes[1].get_legend().texts] == [
        "fitted: did not end", "hertz: did not end"
    ]  # fmt: skip


def test_heights_are_stretched_as_the_title_says():
    crater = picture(blow(BALL)).axes[1]
    (times,) = (float(w) for w in crater.get_title().split() if w.replace(".", "").isdigit())
    # micrometres up, millimetres or micrometres along
    along = 1e-3 if "[mm]" in crater.get_xlabel() else 1e-6
    assert crater.get_aspect() == pytest.approx(times * 1e-6 / along)


def test_a_crater_has_the_band_of_its_depth_and_none_without_errors():
    found = blow(BALL)
    scene, impact = found.setup.scene(LAWS["fitted"]), found["fitted"]
    (sure,), (band,) = (
        surfaces_left(scene, impact, std) for std in (None, found.bands["fitted"].std)
    )
    middle = len(band.height) // 2
    assert not sure.std.any()
    assert band.std[middle] >= found.bands["fitted"].std("residual_flat_m")
    assert np.array_equal(sure.height, band.height)
    peak = impact.spot.imprints[0].peak
    kept = Left(sure.radius, peak, impact.residual_sphere_m, impact.residual_flat_m)
    shape = crater_shape(scene.pair, kept, "flat")
    assert -sure.height[middle:] / impact.residual_flat_m == pytest.approx(-shape.height)


def test_a_scar_is_as_long_as_its_walls_reach():
    found = blow(KINDS["rod"][0])
    scene, impact = found.setup.scene(LAWS["fitted"]), found["fitted"]
    (scar,) = surfaces_left(scene, impact, None)
    mark = max(impact.spot.imprints, key=lambda one: one.peak)
    wall = np.array([mark.first, mark.last]) - mark.deepest
    inside = scar.place[scar.height < 0.0]
    assert wall[0] < inside[0] < 0.0 < inside[-1] < wall[1]
    assert inside[-1] - inside[0] > 1.6 * scar.radius


def test_a_tip_that_ends_at_its_edge_has_a_depth_and_no_shape():
    text = KINDS["rod"][0].replace("angle_deg = 45", "angle_deg = 90").replace(
        "mass_kg = 0.06", "mass_kg = 0.06\ntip_flat_radius_m = 1e-4"
    )  # fmt: skip
    found = blow(text)
    (left,) = surfaces_left(found.setup.scene(LAWS["fitted"]), found["fitted"], None)
    assert not left.shaped
    assert left.height == pytest.approx(-found["fitted"].residual_flat_m)
    (label,) = picture(found).axes[1].get_legend_handles_labels()[1]
    assert label.endswith("its shape is not known")


@pytest.mark.parametrize("kind", ["ball", "second sphere", "seat", "rod"])
def test_outlines_touch_at_the_origin_and_nowhere_overlap(kind):
    rig = rig_shape(setup(KINDS[kind][0]), np.zeros(0), np.zeros(0))
    assert rig.striker[:, 1].min() == pytest.approx(0.0, abs=1e-5)
    beside = np.abs(rig.striker[:, 0]) < 4e-3
    top = rig.struck[: len(rig.struck) // 2] if kind == "seat" else rig.struck
    order = np.argsort(top[:, 0])
    below = np.interp(rig.striker[beside, 0], top[order, 0], top[order, 1])
    assert np.all(rig.striker[beside, 1] >= below - 1e-5)


def test_a_rod_that_leans_on_the_edge_of_its_round_end_is_told_and_drawn_so():
    found = blow(THIN)
    rig = rig_shape(found.setup, np.zeros(0), np.zeros(0))
    lowest = rig.striker[np.argmin(rig.striker[:, 1])]
    assert lowest == pytest.approx([0.0, 0.0], abs=1e-12)
    assert any("leans by 45 degrees" in line and "11.5" in line for line in found.checks())
    assert not any("leans" in line for line in blow(KINDS["rod"][0]).checks())


def test_a_crater_too_deep_to_stretch_is_to_scale():
    deep = BALL.replace("3.05e8", "1e7").replace("3.0\n", "3000.0\n")
    assert "to scale" in picture(blow(deep)).axes[1].get_title()


NOTHING_LEFT = {
    # a rigid ball of a nanometre and 0.7 kg in a metal of 15 kPa: no radius by the law
    "far outside a published law": ("ghaednia", {
        "target": {"E_Pa": 15465.0, "nu": 0.0, "Sy_Pa": 1000.0},
        "strikers": {
            "ball": {"rigid": True, "shape": "sphere", "tip_radius_m": 1e-9, "mass_kg": 0.714}
        },
        "impact": {"impact_speed_m_s": 10.0},
    }),
    # foam on a soft wall: what the law leaves is a rounding of its depth
    "no strength": ("fitted", {
        "target": {"E_Pa": 8276424211.288557, "nu": 0.0001991668653264816},
        "strikers": {"ball": {"E_Pa": 1808726.6053933802, "nu": 0.45, "shape": "sphere",
                              "tip_radius_m": 0.04815009983759883,
                              "mass_kg": 4.2259191954970964e-05}},
        "impact": {"impact_speed_m_s": 0.7026416751143729},
        "gravity_m_s2": 1.7289638053776538e-07,
    }),
}  # fmt: skip


@pytest.mark.parametrize(("law", "given"), NOTHING_LEFT.values(), ids=NOTHING_LEFT)
def test_what_leaves_nothing_to_draw_has_no_crater(law, given):
    found = made_blows.blow(given, law)
    assert law == "ghaednia" or found[law].residual_sphere_m > 0.0  # else it shows nothing
    assert surfaces_left(found.setup.scene(LAWS[law]), found[law], None) == []


@pytest.mark.parametrize(
    ("values", "scale"),
    [(np.geomspace(0.01, 1.0, 7), "log"), (np.linspace(0.01, 1.0, 7), "linear"),
     (np.geomspace(1.0, 2.0, 7), "linear"), ([0.5], "linear")],
)  # fmt: skip
def test_a_sweep_has_words_on_its_axes_and_no_empty_panel(values, scale):
    some = dict.fromkeys(draw.SWEPT[:4], np.ones(2 * len(values)))
    none = dict.fromkeys(draw.SWEPT[4:], np.zeros(2 * len(values)))
    swept = {"drop_height_m": list(values), "friction": [0.1, 0.2]}
    swept = swept if len(values) > 2 else {"drop_height_m": list(values)}
    made = draw.draw_sweep(swept, {"fitted": some | none})
    assert len(made.axes) == 4
    assert {a.get_xlabel() for a in made.axes} == {"drop height [m]"}
    (line,) = made.axes[0].get_lines()
    assert (line.get_marker() == "o") == (len(values) == 1)  # one point is seen
    assert {a.get_xscale() for a in made.axes} == {scale}
    if scale == "log":  # plain numbers, which do not overlap
        made.canvas.draw()
        ticks = [t.get_text() for t in made.axes[0].get_xticklabels(which="both") if t.get_text()]
        assert {"0.02", "0.05", "0.2"} < set(ticks)
        assert all(float(tick) for tick in ticks)
    assert made.get_suptitle() == ("friction [-] = 0.1" if len(values) > 2 else "")


def test_whatever_may_be_swept_has_words():
    assert set(draw.CONDITIONS) == set(SweepTable.model_fields)


def test_a_law_that_something_speaks_against_is_pale_in_every_panel():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DomainWarning)
        found = impact("ball", law=["fitted", "hertz"])
        made = found.plot()
    assert found.doubts == {"hertz": "elastic only"}
    fast = impact("ball", law="fitted", speed=300.0)  # its dent is deeper than half of the ball
    assert fast.doubts == {"fitted": "a/R of about 1.1 is beyond 0.6"}
    curves = made.axes[2:]  # below the rig and the dent
    assert curves[1].get_xlabel() == "time [us]"  # 0.03 ms: no tick has more than three digits
    assert curves[1].get_xlim()[1] > 20.0
    for axis in curves:
        ours, theirs = axis.get_lines()
        assert (ours.get_alpha(), theirs.get_alpha()) == (None, 0.5)
        # as in the picture of a sweep
        style = [(line.get_color(), line.get_linestyle()) for line in (ours, theirs)]
        assert style == [(x["color"], x["ls"]) for x in draw.looks(["fitted", "hertz"]).values()]
    assert curves[0].get_lines()[1].get_label() == "hertz: elastic only"
    every = [(look["color"], look["ls"]) for look in draw.looks(map(str, range(45))).values()]
    assert len(set(every)) == 45
