"""Which law to use when."""

import math

import pytest
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow, tabulated
from dentscope.models import LAWS
from dentscope.models.choose import demand, objection, past_curves, strains_under

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
