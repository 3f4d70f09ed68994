"""Pictures of impacts: words and units on every axis, logarithms where values grow by a factor."""

import warnings

import numpy as np
import pytest
from dentscope.dynamics.files.sweep import SweepTable
from dentscope.dynamics.report import draw
from dentscope.models.base import DomainWarning
from dentscope.start import impact


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
