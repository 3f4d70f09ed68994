"""A law from its table, and quasi-static presses: errors held, Hertz, an impact come again."""

import math
import warnings

import numpy as np
import pytest
from dentscope.core import InputError, Material, Pair
from dentscope.dynamics import Approach, Settings, Striker, scene_of, strike
from dentscope.dynamics.force import factor
from dentscope.dynamics.press import dent_radius, pressed
from dentscope.dynamics.scene import CREEP, Press
from dentscope.dynamics.tabulated.cells import cell_at, cells_of, column_in
from dentscope.dynamics.tabulated.law_table import ERROR, tabulated
from dentscope.models import LAWS
from dentscope.models.base import DomainWarning, Kernels, PublishedLaw
from dentscope.models.kernel import BRANCH_SIGNATURE
from dentscope.models.published.hertz import HERTZ
from dentscope.models.published.jackson_green import JACKSON_GREEN
from made_scenes import IRON, STEEL, on_iron
from numba import njit

PAIR = Pair(STEEL, IRON, 0.0088)


def quiet(answer, *given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DomainWarning)
        return answer(*given)


def recovers_by_a_power(law, pair):
    way, apart = np.array([0.25, 0.5, 0.75]), []
    for peak in pair.R * np.array([1e-3, 1e-2, 1e-1]):
        left = float(np.sum(quiet(law.residual, pair, peak)))
        force = quiet(law.unloading, pair, left + way * (peak - left), np.full(3, peak))
        apart.append(np.ptp(np.log(force / quiet(law.loading, pair, peak)) / np.log(way)))
    return max(apart) < 1e-3


@pytest.mark.parametrize("name", list(LAWS))
@pytest.mark.parametrize("flat", [IRON, Material(E=70e9, nu=0.33, Sy=1900e6)])
def test_the_stated_error_holds_where_it_was_not_checked(name: str, flat: Material) -> None:
    law, pair = LAWS[name], Pair(STEEL, flat, 0.003)
    table = tabulated(law)
    depth = pair.R * 10.0 ** np.random.default_rng(5).uniform(-8.5, -0.5, 4000)
    if not recovers_by_a_power(law, pair):
        with pytest.raises(InputError, match="otherwise than by a power"):
            table.loading(pair, depth)
        return
    for answer in ("loading", "contact_radius"):
        ours, theirs = (quiet(getattr(x, answer), pair, depth) for x in (table, law))
        assert np.abs(ours / theirs - 1.0).max() < 2.0 * ERROR
    ours, theirs = (np.array(x.residual(pair, depth)) for x in (table, law))
    assert (np.abs(ours - theirs) / depth).max() < 2.0 * ERROR
    part, peak = 0.9 * depth, quiet(law.loading, pair, depth)
    ours, theirs = table.unloading(pair, part, depth), law.unloading(pair, part, depth)
    # near full plasticity the recovery is short: an error of the residual depth counts for more
    way = np.maximum(depth - np.array(law.residual(pair, depth)).sum(axis=0), 1e-12) / depth
    assert (np.abs(ours - theirs) / peak * way).max() < 6.0 * ERROR


def test_a_jump_of_a_published_law_stays_where_it_is() -> None:
    # w = 1.9 is the border of Jackson and Green (1.18 and 1.20)
    border = 1.9 * JACKSON_GREEN.parameters(PAIR)[8]
    depths = border * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    ours, theirs = (
        tabulated(JACKSON_GREEN).loading(PAIR, depths),
        JACKSON_GREEN.loading(PAIR, depths),
    )
    assert abs(theirs[1] / theirs[0] - 1.0) > 1e-3
    assert ours == pytest.approx(theirs, rel=2.0 * ERROR)


def test_an_impact_by_table_ends_as_by_the_law() -> None:
    for angle in (90.0, 45.0):
        leans = Approach(1.0, math.radians(angle))
        found = [
            strike(on_iron(law, approach=leans), Settings(tolerance=1e-10))
            for law in (JACKSON_GREEN, tabulated(JACKSON_GREEN))
        ]
        for name in ("restitution", "residual_flat_m", "contact_time_s", "peak_force_N"):
            assert getattr(found[1], name) == pytest.approx(getattr(found[0], name), rel=1e-7)


def test_open_contacts_and_the_power_below_the_range() -> None:
    table = tabulated(HERTZ)
    assert table.loading(PAIR, [-1e-6, 0.0]).tolist() == [0.0, 0.0]
    shallow = 1e-11 * PAIR.R
    assert table.loading(PAIR, [shallow]) == pytest.approx(HERTZ.loading(PAIR, [shallow]), rel=1e-7)
    with pytest.raises(InputError, match="not a number"):
        table.loading(PAIR, [math.nan])


def test_a_recovery_that_is_no_power_is_refused() -> None:
    @njit(BRANCH_SIGNATURE, _nrt=False)
    def bent(par, depth, peak):
        return par[10] * depth * (0.5 * math.sqrt(depth) + 0.5 * depth / math.sqrt(peak))

    own = HERTZ.kernels
    law = PublishedLaw(
        name="bent", title="", source="", equations="", standing=HERTZ.standing,
        domain=HERTZ.domain, own=Kernels(own.loading, own.radius, bent, own.residual),
    )  # fmt: skip
    assert not recovers_by_a_power(law, PAIR)
    with pytest.raises(InputError, match="allowed: a force that falls as a power of the depth"):
        tabulated(law).loading(PAIR, [1e-6, 2e-6])


def test_cells_are_halved_until_kinks_and_jumps_are_narrow() -> None:
    def broken(x):
        return np.stack([np.abs(x - 0.123), np.where(x < 0.777, np.sin(x), 2.0)], axis=1)

    table = cells_of(broken, 0.0, 1.0, tolerance=1e-9)
    assert table.error.max() <= 1e-9

    def column_at(vector, at, column, x):
        return column_in(vector, at, cell_at(vector, at, x), column, x)

    places = np.random.default_rng(1).uniform(0.0, 1.0, 2000)
    for column in (0, 1):
        found = [column_at(table.vector, 0, column, x) for x in places]
        assert np.abs(found - broken(places)[:, column]).max() < 2e-9
    # beyond the range straight on
    assert column_at(table.vector, 0, 0, 1.5) == pytest.approx(1.377, abs=1e-8)
    assert column_at(table.vector, 0, 0, -0.5) == pytest.approx(0.623, abs=1e-8)


@pytest.mark.parametrize("x", [math.inf, -math.inf, math.nan, 1e300])
def test_no_place_is_looked_for_outside_a_table(x) -> None:
    """A whole number that cannot hold the place pointed outside the table: a crash now and then."""
    table = cells_of(lambda x: np.stack([np.sin(x)], axis=1), 0.0, 3.0, tolerance=1e-9)
    assert 0 <= cell_at(table.vector, 0, x) <= table.count + 1
    found = factor(np.ones(5 * 7), 0, x)
    assert found == 1.0 or (math.isnan(x) and math.isnan(found))


PLATE = Material(E=200e9, nu=0.3, Sy=350e6)
BALL = Material(E=210e9, nu=0.3, Sy=2e9)
LOADS = np.array([100.0, 400.0, 3000.0])


def scene(law="fitted", *, plate=PLATE, **given):
    return scene_of(
        LAWS[law], sphere=BALL, flat=plate, striker=Striker(mass=4e-3, tip_radius=5e-3),
        **{"approach": CREEP, **given},
    )  # fmt: skip


def test_elastic_press_is_hertz():
    found = pressed([scene("hertz", press=Press(load)) for load in LOADS])
    pair = scene("hertz").pair
    expected = (0.75 * LOADS / pair.E_reduced) ** (2.0 / 3.0) / pair.R ** (1.0 / 3.0)
    assert found.depth == pytest.approx(expected, rel=1e-9)
    assert found.recovered == pytest.approx(expected, rel=1e-9)
    assert found.radius == pytest.approx(np.sqrt(pair.R * expected), rel=1e-9)


def test_load_depth_and_what_stays_are_the_laws():
    found = pressed([scene(press=Press(load)) for load in LOADS])
    law, pair = LAWS["fitted"], Pair(BALL, PLATE, 5e-3)
    assert law.loading(pair, found.depth) == pytest.approx(LOADS, rel=1e-9)
    assert found.flat == pytest.approx(law.residual(pair, found.depth)[1], rel=1e-9)
    assert found.depth == pytest.approx(found.recovered + found.sphere + found.flat, rel=1e-12)


def test_press_to_the_peak_of_an_impact_leaves_its_dent():
    struck = scene(approach=Approach(2.0))
    impact = strike(struck)
    found = pressed([scene(press=Press(impact.peak_force_N))])
    assert found.depth[0] == pytest.approx(impact.peak_depth_m, rel=1e-6)
    assert found.flat[0] == pytest.approx(impact.residual_flat_m, rel=1e-6)
    wide = dent_radius([struck], np.array([impact.peak_depth_m]))
    assert found.radius == pytest.approx(wide, rel=1e-6)


def test_load_is_a_number_above_nothing():
    with pytest.raises(InputError, match="load_N: -1"):
        Press(-1.0)
