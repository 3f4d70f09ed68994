"""What every contact law and every joined pair of laws keeps, and anchors from outside."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.campaigns.cases.pairs import table_2_1
from dentscope.core import InputError, Material, Pair
from dentscope.models import LAWS, critical_depth
from dentscope.models.base import CLAUSES, unwarned
from dentscope.models.table import LoadingCurve, PairTable, Turns, table_law

# the clauses hold beyond the data that a law was fitted to, too
pytestmark = pytest.mark.filterwarnings("ignore::dentscope.models.base.DomainWarning")
STEEL = Material(E=200e9, nu=0.3, Sy=503e6)
SOFT = Material(E=71.7e9, nu=0.33, Sy=300e6)
PAIRS = {
    "flattening": Pair(SOFT, STEEL, 1e-3),
    "equal": Pair(STEEL, STEEL, 2e-2),
    "indentation": Pair(STEEL, SOFT, 1e-4),
}
DEEP = Pair(STEEL, Material(E=200e9, nu=0.3, Sy=30e6), 1e-3)
ELASTIC = Pair(Material(E=200e9, nu=0.3), Material(E=71.7e9, nu=0.33), 1e-3)


def sampled(pair):
    """A table as a solve gives it: sixty depths and eight unloadings, here of the fitted law."""
    law = replace(LAWS["fitted"], limits={})
    first = 0.3 * critical_depth(pair) if math.isfinite(pair.Sy_min) else 1e-7 * pair.R
    d = np.geomspace(first, 0.045 * pair.R, 60)
    turn = np.geomspace(2.0 * first / 0.3, 0.045 * pair.R, 8)
    left = np.array([law.residual(pair, x) for x in turn]).sum(axis=1)
    part = np.array([float(law.residual(pair, x)[0]) for x in turn]) / np.maximum(left, 1e-300)
    none = np.zeros_like(d)
    curve = LoadingCurve(
        d / pair.R, law.loading(pair, d) / (pair.E_reduced * pair.R**2),
        law.contact_radius(pair, d) / pair.R, law.share(pair, d), none, none, none,
    )  # fmt: skip
    turns = Turns(turn / pair.R, left / turn, part, law.unloading_exponent(pair, turn))
    return PairTable(pair, curve, turns)


TABLE = table_law([sampled(pair) for pair in (*PAIRS.values(), DEEP, ELASTIC)], name="table")
EVERY = {**LAWS, "table": TABLE}
every_law = pytest.mark.parametrize("law", EVERY.values(), ids=EVERY)
every_pair = pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)


def allowance(law, clause):
    return max((size for text, size in law.breaks if text.startswith(clause)), default=0.0) / 100.0


def depths(pair, n=200, last=0.04):
    return np.geomspace(0.05 * critical_depth(pair), last * pair.R, n)


@every_law
@every_pair
def test_open_contact_has_no_force(law, pair):
    assert law.loading(pair, [-1e-6, 0.0]) == pytest.approx([0.0, 0.0], abs=0.0)
    assert law.contact_radius(pair, [-1e-6, 0.0]) == pytest.approx([0.0, 0.0], abs=0.0)


@every_law
@every_pair
# no smooth law grows faster between two depths than with these powers of them
@pytest.mark.parametrize(("what", "power"), [("force", 2.5), ("radius", 1.5)])
def test_it_grows_without_steps_except_where_the_law_says_so(law, pair, what, power):
    d = depths(pair, n=20_000)
    value = law.loading(pair, d) if what == "force" else law.contact_radius(pair, d)
    assert np.all(np.isfinite(value))
    rise = value[1:] / value[:-1] - 1.0
    fall, step = -float(rise.min()), float(rise.max())
    assert fall <= allowance(law, f"{what} falls"), f"{what} falls: to be declared in breaks"
    smooth = (d[1] / d[0]) ** power - 1.0
    most = max(1.01 * allowance(law, f"{what} jumps"), smooth) + smooth
    assert step <= most, f"{what} jumps: to be declared in breaks"


@pytest.mark.parametrize(
    "law", [law for law in LAWS.values() if law.breaks], ids=lambda law: law.name
)
def test_a_declared_breach_is_real(law):
    """What a law declares is reached, within 30 %, by one of the pairs."""
    for clause in {next(c for c in CLAUSES if text.startswith(c)) for text, _ in law.breaks}:
        found = max(largest_breach(law, pair, clause) for pair in (*PAIRS.values(), DEEP))
        declared = allowance(law, clause)
        # how far from Hertz is told for the deepest contact, and measured at Delta/R = 0.01
        least = 0.1 if clause == "not Hertz" else 0.7
        told = f"breaks: {clause!r} is {100 * found:.1f} %, declared are {100 * declared:.1f} %"
        assert least * declared <= found <= 1.01 * declared, told


def largest_breach(law, pair, clause):
    d = depths(pair, n=20_000)
    if clause == "not Hertz":
        free = Pair(Material(E=200e9, nu=0.3), Material(E=71.7e9, nu=0.33), 1e-3)
        hertz = LAWS["hertz"].loading(free, 1e-5)
        return abs(float(law.loading(free, 1e-5) / hertz) - 1.0)
    if clause.startswith("residual"):
        left = sum(law.residual(pair, d)) / d
        return float(np.max(np.diff(left)))
    value = law.loading(pair, d) if clause.startswith("force") else law.contact_radius(pair, d)
    rise = value[1:] / value[:-1] - 1.0
    # what the law would have grown by between the two depths anyhow
    growth = (1.2 if clause.startswith("force") else 0.5) * (d[1] / d[0] - 1.0)
    return growth - float(rise.min()) if clause.endswith("falls") else float(rise.max()) - growth


@every_law
@every_pair
def test_unloading_starts_at_the_peak_and_ends_at_the_residual_depth(law, pair):
    peak = 0.01 * pair.R
    sphere, flat = law.residual(pair, peak)
    left = float(sphere + flat)
    assert 0.0 <= left < peak
    assert law.unloading(pair, peak, peak) == pytest.approx(law.loading(pair, peak), rel=1e-12)
    below = law.unloading(pair, [0.5 * left, left], peak)
    assert not below.any(), "unloading: exactly 0 at and below the residual depth"
    d = np.linspace(left, peak, 300)
    assert np.all(np.diff(law.unloading(pair, d, peak)) >= 0.0)


def creates_energy(law, pair, peak):
    """Over a cycle to a peak; in depth^(1/2), which suits the 3/2 powers."""
    left = float(sum(law.residual(pair, peak)))
    y = np.linspace(0.0, 1.0, 4001)
    d, back = peak * y**2, left + (peak - left) * y**2
    spent = np.trapezoid(law.loading(pair, d), d)
    return np.trapezoid(law.unloading(pair, back, peak), back) > spent * (1.0 + 1.5e-3)


@every_law
@every_pair
def test_no_cycle_creates_energy(law, pair):
    """From peaks below first yield to deep ones."""
    onset = critical_depth(pair)
    peaks = *onset * np.array([0.5, 1.02, 1.3, 2.0, 4.0, 8.0, 30.0]), 0.01 * pair.R
    assert [peak / onset for peak in peaks if creates_energy(law, pair, peak)] == []


@every_law
@every_pair
def test_lengths_and_stresses_scale(law, pair):
    def scaled(body):
        return Material(E=3.0 * body.E, nu=body.nu, Sy=3.0 * body.Sy)

    other = Pair(scaled(pair.sphere), scaled(pair.flat), 5.0 * pair.R)
    d = depths(pair, n=20)
    assert law.loading(other, 5.0 * d) == pytest.approx(75.0 * law.loading(pair, d), rel=1e-9)
    assert law.contact_radius(other, 5.0 * d) == pytest.approx(
        5.0 * law.contact_radius(pair, d), rel=1e-9
    )


@every_law
def test_without_yield_it_is_hertz(law):
    d = np.geomspace(1e-9, 1e-5, 10)
    # a table holds what an elastic body of finite strain does, as the finite elements have it
    allowed = LAWS["fitted"] if law is TABLE else law
    assert law.loading(ELASTIC, d) == pytest.approx(
        4.0 / 3.0 * ELASTIC.E_reduced * math.sqrt(ELASTIC.R) * d**1.5,
        rel=max(1e-9, allowance(allowed, "not Hertz")),
    )
    assert law.residual(ELASTIC, 1e-5) == pytest.approx((0.0, 0.0), abs=1e-12)


@every_law
def test_many_pairs_at_once_give_what_each_gives_alone(law):
    pairs = list(PAIRS.values())
    d = np.stack([depths(p, n=5) for p in pairs])
    together = law.loading(pairs, d)
    alone = np.stack([law.loading(p, row) for p, row in zip(pairs, d, strict=True)])
    assert np.array_equal(together, alone)


@every_law
def test_kernel_and_driver_are_one(law):
    pair = PAIRS["flattening"]
    par, d = law.parameters(pair), 3e-6
    assert law.kernels.loading(par, d) == float(law.loading(pair, d))
    assert law.kernels.unloading(par, 0.9 * d, d) == float(law.unloading(pair, 0.9 * d, d))


def test_a_depth_that_is_no_number_is_refused():
    with pytest.raises(InputError, match="depth"):
        LAWS["hertz"].loading(PAIRS["equal"], [1e-6, math.nan])


def test_jackson_green_joins_hertz_at_w_1_9_within_half_a_percent():
    pair = PAIRS["flattening"]
    onset = critical_depth(pair)
    below, above = LAWS["jackson-green"].loading(
        pair, [1.9 * onset * (1 - 1e-9), 1.9 * onset * 1.0000001]
    )
    assert 5e-4 < abs(float(above / below) - 1.0) < 7e-3


@pytest.mark.parametrize(
    ("number", "ratio", "radius_mm"),
    [(1, 0.1, 0.314), (1, 10.0, 0.317), (3, 1.0, 0.287), (4, 1.08, 0.254), (5, 10.0, 0.305)],
)
def test_the_thesis_model_gives_the_radii_of_its_figures(number, ratio, radius_mm):
    """Contact radius at Delta/R = 0.04, worked out in the equation audit for R = 1 mm."""
    a = LAWS["ghaednia"].contact_radius(table_2_1(number, ratio), 0.04e-3)
    assert float(a) * 1e3 == pytest.approx(radius_mm, abs=0.0016)


OPPOSITE = {name: PAIRS[name] for name in ("flattening", "indentation")}
# combinations that the thesis uses: chapter 3's updated models, 4.2.4's Ye-Komvopoulos
NAMED = (
    ("jackson-green-2007", "ghaednia"),
    ("kogut-etsion", "ghaednia"),
    ("kogut-komvopoulos", "ghaednia"),
    ("ye-komvopoulos", "jackson-green"),
)


@pytest.mark.parametrize("pair", OPPOSITE.values(), ids=OPPOSITE)
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


@pytest.mark.parametrize("pair", OPPOSITE.values(), ids=OPPOSITE)
@pytest.mark.parametrize(("loading", "other"), NAMED, ids="+".join)
def test_no_cycle_of_the_thesis_combinations_creates_energy(loading, other, pair):
    law, onset = LAWS[loading].with_unloading(LAWS[other]), critical_depth(pair)
    for times in (2.0, 8.0, 30.0, 110.0):
        assert not creates_energy(law, pair, times * onset), times


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
