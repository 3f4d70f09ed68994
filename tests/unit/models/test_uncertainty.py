"""What the laws say of their own error, and which to use when."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import InputError, Material, Pair
from dentscope.core.flow import Flow, tabulated
from dentscope.dynamics.report.beside import beside_fitted
from dentscope.fitting import read_sources, tables_of
from dentscope.fitting.calibrate import misses, within
from dentscope.fitting.prediction import predict_by
from dentscope.models import LAWS, Uncertainty, critical_depth
from dentscope.models.choose import demand, objection, past_curves, strains_under
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


HARD, SOFT = Material(E=200e9, nu=0.3, Sy=2e9), Material(E=200e9, nu=0.3, Sy=300e6)
PAIRS = {
    "flattening": Pair(SOFT, HARD, 1e-2),
    "indentation": Pair(HARD, SOFT, 1e-2),
    "both bodies": Pair(SOFT, SOFT, 1e-2),
}


@pytest.mark.parametrize("regime", PAIRS)
def test_regime_follows_the_strengths(regime):
    need = demand(PAIRS[regime], 1e-4)
    assert need.regime == regime
    assert not objection(LAWS["fitted"], need)


def test_below_yield_everything_is_hertz():
    need = demand(PAIRS["flattening"], 1e-8)
    assert need.regime == "elastic"
    assert not any(objection(law, need) for law in LAWS.values())
    elastic = Pair(Material(E=1e11, nu=0.3), Material(E=1e11, nu=0.3), 1e-3)
    assert demand(elastic, 1e-4).w == 0.0


def test_a_law_for_the_other_body_is_objected_to():
    assert "indentation" in objection(LAWS["kogut-komvopoulos"], demand(PAIRS["flattening"], 1e-4))
    assert "flattening" in objection(LAWS["jackson-green"], demand(PAIRS["indentation"], 1e-4))
    assert "both" in objection(LAWS["jackson-green"], demand(PAIRS["both bodies"], 1e-4))


def test_a_law_beyond_its_contact_radius_is_objected_to():
    need = demand(PAIRS["flattening"], 1.5e-3)  # a/R about sqrt(0.3) = 0.55
    assert need.a_over_R == pytest.approx(math.sqrt(0.3))
    assert "0.41" in objection(LAWS["jackson-green"], need)


def test_a_flow_curve_that_ends_before_the_strains_under_the_contact_is_told():
    measured = Material(200e9, 0.3, 300e6, flow=Flow(tabulated([0.0, 0.134], [300e6, 400e6])))
    pair = Pair(measured, measured, 1e-2)
    # a/R = 0.4: 3 * 0.2 * 0.4 in the flat, a tenth of it in the ball
    assert strains_under(pair, 4e-3, (1e-5, 1e-4)) == pytest.approx((0.024, 0.24))
    told = "curve ends at a strain of 0.134, the contact reaches about 0.24: constant beyond"
    assert list(past_curves(pair, (0.024, 0.24))) == [f"the flat's flow {told}"]
    assert list(past_curves(PAIRS["both bodies"], (0.024, 0.24))) == []
    assert strains_under(pair, 4e-3, (0.0, 0.0)) == (0.0, 0.0)
