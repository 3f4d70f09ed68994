"""The uncertainty that a solve states, from the table of mesh errors."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from dentscope import fem
from dentscope.core.material import Material, Pair
from dentscope.fem.results.uncertainty import _mesh_errors

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
