"""What the laws say of their own error, against finite elements that no fit has read."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import InputError, Material, Pair
from dentscope.dynamics.report.beside import beside_fitted
from dentscope.fitting import read_sources, tables_of
from dentscope.fitting.calibrate import misses, within
from dentscope.fitting.prediction import predict_by
from dentscope.models import LAWS, Uncertainty, critical_depth
from dentscope.models.closed_form import plastic_depth, small_radius_at
from dentscope.models.fitted import bodies_of
from dentscope.models.uncertainty import FEATURES, features_of

DATA = Path(__file__).resolve().parents[3] / "data"
PAIR = Pair(Material(E=71.7e9, nu=0.33, Sy=300e6), Material(E=200e9, nu=0.3, Sy=500e6), 1e-3)
OURS = pytest.mark.parametrize("name", ["compact", "fitted"])


@OURS
def test_unseen_pairs_lie_within_the_stated_deviations(name):
    """72 pairs of validation-2 and challenge, which no fit read: about 68 and 95 % of depths."""
    parts = [DATA / "campaign" / "validation-2-1.h5", DATA / "challenge" / "challenge-1.h5"]
    table, turns = tables_of(read_sources(parts), held_out=True)
    law = LAWS[name]
    numbers = law.numbers(table.bodies)
    found = misses(predict_by(numbers, table, turns), numbers, table, turns)
    assert len(table.pairs) == 72
    for quantity, (one, two) in within(law.calibration, found).items():
        assert one == pytest.approx(0.68, abs=0.13), quantity
        assert two == pytest.approx(0.95, abs=0.13), quantity


@OURS
def test_before_first_yield_the_laws_are_hertz_and_sure(name):
    sure = LAWS[name].uncertainty(PAIR, 0.3 * critical_depth(PAIR))
    assert float(sure.force) == pytest.approx(1e-3, rel=0.05)
    assert float(sure.given_back) == pytest.approx(1e-3, rel=0.2)


@OURS
def test_it_has_the_shape_of_the_depths_and_bounds(name):
    depths = np.geomspace(1e-9, 1e-4, 12).reshape(3, 4)
    found = LAWS[name].uncertainty(PAIR, depths)
    assert isinstance(found, Uncertainty)
    for size in found:
        assert size.shape == (3, 4)
        assert np.all((size >= 1e-3) & (size <= 1.001))


def test_another_law_is_off_by_what_parts_it_from_the_fitted_one():
    depth = 40.0 * critical_depth(PAIR)
    off = beside_fitted(LAWS["hertz"], PAIR, depth)
    too_stiff = math.log(
        float(LAWS["hertz"].loading(PAIR, depth) / LAWS["fitted"].loading(PAIR, depth))
    )
    assert float(off.force) == pytest.approx(too_stiff, rel=1e-3)
    assert off.force > 10.0 * LAWS["fitted"].uncertainty(PAIR, depth).force
    near = beside_fitted(LAWS["hertz"], PAIR, 0.3 * critical_depth(PAIR))
    assert near.force < 3e-3
    assert near.dent < 1.5


@pytest.mark.filterwarnings("ignore::dentscope.models.base.DomainWarning")
def test_elastic_and_rigid_pairs_have_one_too():
    steel, rigid = Material(E=200e9, nu=0.3), Material(E=math.nan, nu=math.nan, rigid=True)
    for pair in (Pair(steel, steel, 1e-3), Pair(PAIR.sphere, rigid, 1e-3)):
        ours = LAWS["fitted"].uncertainty(pair, [0.0, 1e-6])
        theirs = beside_fitted(LAWS["jackson-green"], pair, [0.0, 1e-6])
        assert all(np.all(np.isfinite(size)) for size in (*ours, *theirs))


def test_features_by_hand():
    """Sy* = e^0.2: half as close as equal strengths; a/R = a_t e^0.25: half taken over."""
    found = LAWS["fitted"].numbers(bodies_of([PAIR]))
    numbers = type(found)(*(float(np.ravel(x)[0]) for x in found))
    y = plastic_depth(numbers.W * 0.01)
    small = small_radius_at(0.01, y, numbers)
    even = numbers._replace(L=0.2, L_C=0.05, x_s=0.72, W=math.exp(12.4), a_t=1.0)
    found = dict(zip(FEATURES, features_of(even, 0.01), strict=True))
    assert found["equal"] == pytest.approx(0.5)
    assert found["unlike"] == pytest.approx(0.5)
    assert found["elastic_share"] == pytest.approx(1.0)
    assert found["stiffness"] == pytest.approx(1.0)
    turning = numbers._replace(L=0.7, a_t=small * math.exp(0.25))
    found = dict(zip(FEATURES, features_of(turning, 0.01), strict=True))
    assert found["taking_over"] == pytest.approx(0.25)
    assert (found["one"], math.exp(5.0 * found["depth"])) == pytest.approx((1.0, 1.0 + y))
    assert found["yield"] == pytest.approx(math.log(y / (1.0 + y)))


def test_a_published_law_states_none():
    with pytest.raises(InputError, match="hertz states no error"):
        LAWS["hertz"].uncertainty(PAIR, 1e-6)
