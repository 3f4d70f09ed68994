"""Tuned numbers of the metals where they act, in cases that are worked out by hand."""

import math

import numpy as np
import pytest
from dentscope.core.flow import swift, voce
from dentscope.core.inputs.flow_curve import MeasuredFlow
from dentscope.core.rig import Quantity, TargetTable


def measured(strain, stress):
    none = np.full(len(strain), math.nan)
    return MeasuredFlow(np.array(strain), np.array(stress), none, none)


def test_rows_of_a_curve_within_an_eighth_of_a_decade_are_one() -> None:
    """A hundred rows over two decades become sixteen, and the first at no strain."""
    strain = np.geomspace(1.0001e-3, 0.0999, 1000)
    found = measured(strain, 3e8 + 1e9 * strain).curve(3e8)
    assert len(found.strain) == 1 + 16


def test_strains_below_a_ten_thousandth_are_one_row() -> None:
    strain = [1e-7, 1e-6, 1e-5, 0.9e-4, 3e-3, 0.1]
    found = measured(strain, [3e8, 3e8, 3e8, 3e8, 4e8, 5e8]).curve(3e8)
    assert found.strain[1] == pytest.approx(np.mean(strain[:4]))


def test_a_written_law_has_200_rows_from_a_millionth_to_ten() -> None:
    found = voce(Sy=3e8, Q=1e8, b=20.0)
    assert (len(found.strain), found.strain[0]) == (201, 0.0)
    assert found.strain[1] == pytest.approx(1e-6)
    assert found.strain[-1] == pytest.approx(10.0)


def test_a_strength_from_a_hardness_is_known_to_a_tenth_and_what_the_hardness_is() -> None:
    """Hardness over strength differs by a tenth between metals; unstated it is known to 11 %."""

    def relative(std):
        given = Quantity(value=3e9, std=std)
        return TargetTable(E_Pa=2e11, nu=0.3, hardness_Pa=given).strength.relative

    assert relative(3e8) == pytest.approx(math.hypot(0.1, 0.1))
    assert relative(0.0) == pytest.approx(math.hypot(0.11, 0.1))


def test_two_specimens_of_a_metal_differ_by_a_tenth() -> None:
    """Each by 7 %: the difference of two by 7 % times the root of 2."""
    from dentscope.dynamics.mechanisms.strength.strain_rate_hardening import rises_misfit

    found = rises_misfit(
        [(1000.0, 1.0)], np.array(math.expm1(0.07 * math.sqrt(2.0))), np.array(0.0)
    )
    assert float(found) == pytest.approx(1.0)


def test_a_first_strain_of_nothing_begins_as_steep_as_a_cubic_may() -> None:
    """e0 = (1000/1500)^(1/0.000558) is 3e-316, which has no inverse."""
    curve = swift(Sy=1000.0, K=1500.0, n=5.580983873792373e-4)
    rise = curve.stress[1] - curve.stress[0]
    assert curve.slope[0] == pytest.approx(3.0 * rise / curve.strain[1], rel=1e-9)
    assert np.isfinite(curve.slope).all()
