"""The uncertainty that a solve states, from the table of mesh errors."""

from dataclasses import replace

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
    row = _mesh_errors()["levels"][level().level]
    k = _mesh_errors()["depth_over_first_yield"].index(1.0)
    found = stated(level)
    assert found.force[0] == pytest.approx(7.0 * row["force"][k], rel=1e-9)
    assert found.sphere_share[0] == pytest.approx(row["sphere_share"][k], rel=1e-9)


def test_a_coarser_level_states_more():
    force = [stated(level).force for level in LEVELS]
    assert (force[0] < force[1]).all()
    assert (force[1] < force[2]).all()


def test_a_pair_that_never_yields_states_what_holds_below_first_yield():
    elastic = Pair(replace(STEEL, Sy=np.inf), replace(STEEL, Sy=np.inf), R=1e-3)
    shallow = stated(fem.Accuracy.quick, over_onset=(1e-3, 1e-2))
    assert stated(fem.Accuracy.quick, elastic).force == pytest.approx(shallow.force)


def test_settings_that_were_never_measured_are_refused():
    with pytest.raises(ValueError, match="measured are"):
        stated(lambda: fem.Accuracy.smoke().with_(level="my own"))


def test_the_table_is_of_the_present_numerics():
    assert _mesh_errors()["numerics_version"] == fem.NUMERICS_VERSION
    assert _mesh_errors()["format"] == fem.MESH_ERRORS_FORMAT
