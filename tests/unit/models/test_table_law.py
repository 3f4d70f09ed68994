"""A solved pair as a law: finite elements of the published data set, and the file between."""

import json
from pathlib import Path

import numpy as np
import pytest
from dentscope.campaigns import read_curves
from dentscope.core import InputError, Material, Pair
from dentscope.models import LAWS, DomainWarning, critical_depth, law_named
from dentscope.models.table import LoadingCurve, PairTable, Turns, energy_exponent, table_law
from dentscope.models.table_file import write_table
from dentscope.start.blows import impact

PART = Path(__file__).resolve().parents[3] / "data" / "campaign" / "thesis-1.h5"


@pytest.fixture(scope="module")
def solved():
    record = next(r for r in read_curves(PART) if 0.9 < r.case.pair.Sy_ratio < 1.2)
    pair, c = record.case.pair, record.curve
    few = np.full(len(c["delta"]), 0.004)
    rows = []
    for u in record.unloadings:
        total = u.residual_sphere + u.residual_flat
        exponent = energy_exponent(u.curve["delta"], u.curve["force"], total)
        rows.append((u.depth, total / u.depth / pair.R, u.residual_sphere / total, exponent))
    curve = LoadingCurve(
        c["delta"] / pair.R, c["force"] / (pair.E_reduced * pair.R**2), c["radius"] / pair.R,
        c["sphere"] / (c["sphere"] + c["flat"]), few, few, few,
    )  # fmt: skip
    return record, PairTable(pair, curve, Turns(*np.array(rows).T))


@pytest.fixture(scope="module")
def file(solved, tmp_path_factory):
    return write_table(solved[1], tmp_path_factory.mktemp("case") / "law.json")


def test_the_law_of_the_file_goes_through_the_finite_elements(solved, file):
    record, _ = solved
    pair, c = record.case.pair, record.curve
    law = law_named(str(file))
    late = c["delta"] > critical_depth(pair)
    d = c["delta"][late]
    for ours, theirs in (
        (law.loading(pair, d), c["force"][late]), (law.contact_radius(pair, d), c["radius"][late]),
    ):  # fmt: skip
        off = np.abs(ours / theirs - 1.0)
        assert np.mean(off) < 1e-3
        assert np.max(off) < 0.01  # two depths so close that only the mesh's ripple parts them
    for u in record.unloadings:
        left = u.residual_sphere + u.residual_flat
        sphere, flat = law.residual(pair, u.depth * pair.R)
        assert float(sphere + flat) == pytest.approx(left, rel=2e-3)
        assert float(sphere) == pytest.approx(u.residual_sphere, abs=5e-3 * left)
        x = u.curve["delta"]
        theirs = -np.trapezoid(u.curve["force"], x)
        grid = np.linspace(left, x[0], 400)
        ours = np.trapezoid(law.unloading(pair, grid, x[0]), grid)
        assert ours == pytest.approx(theirs, rel=0.02)  # the trapezoids of a dozen points


def test_below_first_yield_it_is_hertz_exactly(solved, file):
    pair = solved[0].case.pair
    d = np.geomspace(1e-3, 0.45, 9) * critical_depth(pair)
    law = law_named(str(file))
    assert law.loading(pair, d) == pytest.approx(LAWS["hertz"].loading(pair, d), rel=1e-12)
    assert sum(law.residual(pair, d)) == pytest.approx(np.zeros(9), abs=0.0)


def test_another_size_and_unit_of_stress_is_the_same_pair_and_another_metal_is_not(solved, file):
    pair, law = solved[0].case.pair, law_named(str(file.parent))
    s, f = (b.with_(E=2.0 * b.E, Sy=2.0 * b.Sy) for b in (pair.sphere, pair.flat))
    d = 30.0 * critical_depth(pair)
    larger = float(law.loading(Pair(s, f, 5.0 * pair.R), 5.0 * d))
    assert larger == pytest.approx(50.0 * float(law.loading(pair, d)), rel=1e-9)
    with pytest.raises(InputError, match=r"table is of another pair .*sphere E_Pa"):
        law.loading(Pair(pair.sphere.with_(Sy=1.1 * pair.sphere.Sy), pair.flat, pair.R), d)


def test_a_blow_of_its_own_pair_is_told_under_the_files_name(solved, file):
    """What the file does not say of rate and hardening would be another pair's: it is left out."""
    pair = solved[0].case.pair
    blow = impact(pair, law=str(file), speed=1.0, mass=7800.0 * 4.2 * pair.R**3)
    assert str(file) in repr(blow)
    assert any("strain rate about" in line for line in blow.checks())


def test_it_states_the_uncertainty_of_its_solve_and_its_end(solved, file):
    pair, law = solved[0].case.pair, law_named(str(file))
    assert float(law.uncertainty(pair, 1e-2 * pair.R).force) == pytest.approx(0.004)
    with pytest.warns(DomainWarning, match="beyond the table's"):
        law.loading(pair, 0.4 * pair.R)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"format": "x"}, "format: 'x'"),
        ({"sphere": {"E_Pa": 2e11}}, "sphere.nu: missing"),
        ({"loading": None}, "loading: missing"),
        ({"radius_m": "wide"}, "radius_m: 'wide'"),
        ({"radius_m": 10**400}, "radius_m: 1000"),
        ({"radius_m": True}, "radius_m: True"),
        ({"unloading": {"depth": [1], "left": [0], "part": [0], "exponent": []}}, "unequal length"),
        (
            {"unloading": {"depth": [1e-30], "left": [0], "part": [0], "exponent": [1]}},
            "unloading.depth: 1e-30 (allowed: beyond first yield",
        ),
    ],
)
def test_a_damaged_file_is_one_line(file, tmp_path, change, told):
    content = {**json.loads(file.read_text()), **change}
    (tmp_path / "law.json").write_text(json.dumps(content))
    with pytest.raises(InputError) as error:
        law_named(str(tmp_path / "law.json"))
    assert told in str(error.value)
    assert len(str(error.value).splitlines()) == 1
    with pytest.raises(InputError, match="no such file"):
        law_named(str(tmp_path / "absent.json"))


def test_an_elastic_pair_gives_back_all_that_it_took():
    body = Material(E=200e9, nu=0.3)
    pair = Pair(body, body, 1e-2)
    D = np.geomspace(1e-6, 1e-2, 40)
    none = np.zeros_like(D)
    curve = LoadingCurve(D, 4.0 / 3.0 * D**1.5, np.sqrt(D), 0.5 + none, none, none, none)
    law = table_law([PairTable(pair, curve, Turns(*np.zeros((4, 0))))], name="elastic")
    peak = 5e-3 * pair.R
    grid = np.linspace(0.0, peak, 4001)
    spent = np.trapezoid(law.loading(pair, grid), grid)
    assert np.trapezoid(law.unloading(pair, grid, peak), grid) == pytest.approx(spent, rel=1e-6)
