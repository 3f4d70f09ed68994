"""The closed form's limits and smoothness, and recovery of coefficients that were planted."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.fitting.fit import START, fit_tables
from dentscope.fitting.table import ResidualTable, Table
from dentscope.models import LAWS, Domain, critical_depth
from dentscope.models.fitted import NAMES, fitted_law, read_coefficients


def pair_of(E_s, E_f, Sy_min, ratio):
    s, f = (Sy_min, Sy_min / ratio) if ratio < 1.0 else (Sy_min * ratio, Sy_min)
    return Pair(Material(E=E_s, nu=0.3, Sy=s), Material(E=E_f, nu=0.3, Sy=f), 1e-3)


@pytest.fixture(scope="module")
def law():
    return LAWS["fitted"]


def test_small_load_is_hertz_with_the_elastic_share(law):
    for ratio in (0.01, 0.5, 1.0, 1.2, 30.0):
        pair = pair_of(71.7e9, 200e9, 3e8, ratio)
        d = 1e-3 * critical_depth(pair)
        hertz = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R) * d**1.5
        assert float(law.loading(pair, d)) == pytest.approx(hertz, rel=1e-3)
        assert float(law.contact_radius(pair, d)) == pytest.approx(math.sqrt(pair.R * d), rel=1e-3)
        assert float(law.share(pair, d)) == pytest.approx(pair.elastic_share, abs=0.002)


def test_rigid_bodies_take_no_share(law):
    rigid = Material(E=math.nan, nu=math.nan, rigid=True)
    soft = Material(E=200e9, nu=0.3, Sy=3e8)
    d = np.geomspace(1e-8, 4e-5, 20)
    assert law.share(Pair(soft, rigid, 1e-3), d) == pytest.approx(np.ones(20), abs=1e-6)
    assert law.share(Pair(rigid, soft, 1e-3), d) == pytest.approx(np.zeros(20), abs=1e-6)


def test_no_step_and_no_kink_over_the_strength_ratio(law):
    def bend(n):
        """Largest change of the slope from interval to interval, over the largest slope."""
        ratios = np.geomspace(0.2, 5.0, n)
        force = np.array([float(law.loading(pair_of(2e11, 2e11, 3e8, r), 2e-5)) for r in ratios])
        share = np.array([float(law.share(pair_of(2e11, 2e11, 3e8, r), 2e-5)) for r in ratios])
        slopes = [np.diff(values) for values in (force, share)]
        return np.array([np.abs(np.diff(s)).max() / np.abs(s).max() for s in slopes])

    # over a kink the slope jumps however close the points are; over a smooth curve the change
    # halves with the spacing
    assert bend(801) == pytest.approx(0.5 * bend(401), rel=0.05)


def test_force_rises_everywhere_in_the_domain(law):
    random = np.random.default_rng(7)
    for _ in range(200):
        pair = pair_of(
            random.uniform(50e9, 300e9),
            random.uniform(50e9, 300e9),
            random.uniform(50e6, 1100e6),
            10.0 ** random.uniform(-1.0, 1.0),
        )
        d = np.geomspace(1e-4 * critical_depth(pair), 0.04 * pair.R, 100)
        force = law.loading(pair, d)
        assert np.all(np.isfinite(force))
        assert np.all(np.diff(force) > 0.0)
        s, f = law.residual(pair, d)
        assert np.all((s >= 0.0) & (f >= 0.0) & (s + f < d))


def planted():
    """Tables made by the law itself with known coefficients and 0.3 % of noise."""
    truth = START | {"w1_indentation": 6.0, "q_flattening": 0.30, "t": 0.12, "g1": 1.5}
    law = fitted_law(truth, domain=Domain())
    random = np.random.default_rng(3)
    pairs, loading, unloading = [], [], []
    for number, (ratio, Sy) in enumerate(
        (r, s) for r in (0.1, 0.5, 0.8, 1.0, 1.2, 1.5, 3.0, 10.0) for s in (2e8, 6e8)
    ):
        pair = pair_of(100e9 + 2e10 * number, 200e9, Sy, ratio)
        pairs.append(pair)
        D = np.geomspace(0.3 * critical_depth(pair) / pair.R, 0.05, 30)
        noise = 1.0 + 0.003 * random.standard_normal((2, D.size))
        force = law.loading(pair, D * pair.R) / (pair.E_reduced * pair.R**2) * noise[0]
        radius = law.contact_radius(pair, D * pair.R) / pair.R * noise[1]
        one = np.ones_like(D)
        loading.append(
            (number * one, ratio * one, pair.E_reduced / pair.Sy_min * one,
             pair.elastic_share * one, D, D * pair.R / critical_depth(pair), force, radius,
             law.share(pair, D * pair.R))
        )  # fmt: skip
        s, f = law.residual(pair, D[5::4] * pair.R)
        one = np.ones_like(s)
        unloading.append(
            (number * one, ratio * one, one, D[5::4], one, (s + f) / (D[5::4] * pair.R),
             s / (s + f))
        )  # fmt: skip
    columns = [np.concatenate(c) for c in zip(*loading, strict=True)]
    rest = [np.concatenate(c) for c in zip(*unloading, strict=True)]
    table = Table(
        columns[0].astype(np.int64),
        *columns[1:],
        edge_seen=np.ones(columns[0].size, dtype=bool),
        pairs=tuple(pairs),
    )
    return truth, table, ResidualTable(rest[0].astype(np.int64), *rest[1:])


def test_planted_coefficients_come_back_within_their_errors(monkeypatch):
    from dentscope.fitting import fit

    monkeypatch.setattr(fit, "_cross_validate", lambda *_: None)
    truth, table, residuals = planted()
    found = fit_tables(table, residuals)
    assert found.outcome.completed
    # F and a at the level of the planted noise, whose mean absolute value is 0.24 %
    assert found.errors.force[0] < 0.004
    assert found.errors.radius[0] < 0.004
    off = [
        (value - truth[name]) / max(error, 1e-3 * abs(truth[name]) + 1e-4)
        for name, value, error in zip(NAMES, found.values, found.standard_errors, strict=True)
    ]
    assert np.mean(np.abs(off) < 3.0) >= 0.9


def test_rows_whose_contact_edge_was_not_seen_do_not_move_the_fit(monkeypatch):
    from dentscope.fitting import fit

    monkeypatch.setattr(fit, "_cross_validate", lambda *_: None)
    _, table, residuals = planted()
    hidden = np.zeros(table.D.size, dtype=bool)
    hidden[29::30] = True  # the deepest row of each case
    wrong = replace(table, radius=np.where(hidden, 0.9, 1.0) * table.radius, edge_seen=~hidden)
    right = replace(table, edge_seen=~hidden)
    assert fit_tables(wrong, residuals).values == pytest.approx(
        fit_tables(right, residuals).values, rel=1e-9
    )


def test_shipped_coefficients_say_where_they_come_from():
    content = read_coefficients()
    assert content is not None
    assert set(content["coefficients"]) == set(NAMES)
    assert all(entry["standard_error"] >= 0.0 for entry in content["coefficients"].values())
    assert len(content["provenance"]["campaign_sha256"]) == 64
    assert np.array(content["covariance"]).shape == (len(NAMES), len(NAMES))
