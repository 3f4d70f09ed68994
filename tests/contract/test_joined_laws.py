"""A loading law with the residual depth and recovery of another: the clauses of both."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import InputError, Material, Pair
from dentscope.models import LAWS, critical_depth
from dentscope.models.base import unwarned

pytestmark = pytest.mark.filterwarnings("ignore::dentscope.models.base.DomainWarning")
STEEL = Material(E=200e9, nu=0.3, Sy=503e6)
SOFT = Material(E=71.7e9, nu=0.33, Sy=300e6)
PAIRS = {"flattening": Pair(SOFT, STEEL, 1e-3), "indentation": Pair(STEEL, SOFT, 1e-4)}
# combinations that the thesis uses: chapter 3's updated models, 4.2.4's Ye-Komvopoulos
NAMED = (
    ("jackson-green-2007", "ghaednia"),
    ("kogut-etsion", "ghaednia"),
    ("kogut-komvopoulos", "ghaednia"),
    ("ye-komvopoulos", "jackson-green"),
)


@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
@pytest.mark.parametrize("loading", LAWS)
def test_a_combination_unloads_from_its_peak_to_its_residual_depth(loading, pair):
    names = list(LAWS)
    # each law meets three others; all combinations at once would be compiled for two minutes
    for step in (1, 5, 11):
        other = names[(names.index(loading) + step) % len(names)]
        law = LAWS[loading].with_unloading(LAWS[other])
        for peak in (3.0 * critical_depth(pair), 0.01 * pair.R):
            left = float(sum(law.residual(pair, peak)))
            assert left == float(sum(LAWS[other].residual(pair, peak))), other
            assert 0.0 <= left < peak, other
            top = LAWS[loading].loading(pair, peak)
            assert law.loading(pair, peak) == top, other
            assert law.unloading(pair, peak, peak) == pytest.approx(top, rel=1e-12), other
            force = law.unloading(pair, np.linspace(left, peak, 60), peak)
            assert np.isfinite(force).all(), other
            assert np.all(np.diff(force) >= -1e-12 * float(top)), other
            if left > 0.0:
                assert law.unloading(pair, 0.9 * left, peak) == 0.0, other


@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
@pytest.mark.parametrize(("loading", "other"), NAMED, ids="+".join)
def test_no_cycle_of_the_thesis_combinations_creates_energy(loading, other, pair):
    law = LAWS[loading].with_unloading(LAWS[other])
    y = np.linspace(0.0, 1.0, 4001)
    for times in (2.0, 8.0, 30.0, 110.0):
        peak = times * critical_depth(pair)
        d = peak * y**2
        spent = np.trapezoid(law.loading(pair, d), d)
        left = float(sum(law.residual(pair, peak)))
        back = left + (peak - left) * y**2
        assert np.trapezoid(law.unloading(pair, back, peak), back) <= spent * (1.0 + 1.5e-3)


def test_a_law_of_ones_own_that_is_written_anew_under_its_name_is_joined_anew():
    # a notebook's cell, run twice: the second time with another law
    pair, depth = Pair(STEEL, SOFT, 1e-3), 2e-5
    for like in ("hertz", "jackson-green"):
        own = replace(LAWS[like], name="mine")
        joined = own.with_unloading(LAWS["hertz"]).loading(pair, depth)
        assert joined == LAWS[like].loading(pair, depth)


def test_depths_and_peaks_are_broadcast_and_a_peak_is_a_number():
    law, pair = LAWS["compact"], Pair(STEEL, SOFT, 1e-3)
    depths, peaks = np.array([[5e-6], [1e-5], [2e-5]]), np.array([1e-5, 4e-5])
    found = law.unloading(pair, depths, peaks)
    each = [[law.unloading(pair, d, p) for p in peaks] for d in depths[:, 0]]
    assert found == pytest.approx(np.array(each), rel=1e-14)
    with pytest.raises(InputError, match="a peak is not a number"):
        law.unloading(pair, depths, np.nan)


def test_a_depth_at_which_a_law_has_no_number_is_refused():
    iron = Material(E=200e9, nu=0.3, Sy=300e6)
    law, pair = LAWS["fitted"], Pair(iron.with_(Sy=750e6), iron, 1e-2)
    told = r"depth: 20 m, 2e\+03 radii: .* \(allowed: a part of the radius, 0.01 m\)"
    for asked in (law.loading, law.residual, law.hardness):
        with unwarned(), pytest.raises(InputError, match=told):
            asked(pair, [1e-5, 20.0])
    with pytest.raises(InputError, match=told):
        law.unloading(pair, 1e-5, 20.0)
