"""A solved pair as a law, the law of one's own metal, and files of laws."""

import json
from pathlib import Path

import numpy as np
import pytest
from dentscope.campaigns import read_curves
from dentscope.core import InputError, Material, Pair
from dentscope.core.flow import Flow, ludwik
from dentscope.models import LAWS, DomainWarning, critical_depth, law_named
from dentscope.models.anchored import anchored
from dentscope.models.coefficients import COEFFICIENTS_FILE
from dentscope.models.table import LoadingCurve, PairTable, Turns, table_law
from dentscope.models.table_file import write_table
from dentscope.start.blows import impact
from made_cases import table_of
from made_files import put

PART = Path(__file__).resolve().parents[3] / "data" / "campaign" / "thesis-1.h5"


@pytest.fixture(scope="module")
def solved():
    record = next(r for r in read_curves(PART) if 0.9 < r.case.pair.Sy_ratio < 1.2)
    return record, table_of(record, error=0.004)


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


STEEL = Material(E=200e9, nu=0.3, Sy=400e6)
PAIR = Pair(STEEL.with_(Sy=2e9), STEEL, 0.01)
DEPTH = np.geomspace(1e-6, 1e-4, 7)


@pytest.fixture
def fitted(tmp_path):
    content = json.loads(COEFFICIENTS_FILE.read_text())
    first = next(iter(content["coefficients"].values()))
    first["value"] *= 1.1
    return put(tmp_path / "fitted.json", json.dumps(content))


@pytest.mark.parametrize("kind", ["compact", "fitted", "hardening"])
def test_the_shipped_file_is_the_shipped_law(kind):
    law = law_named(f"{COEFFICIENTS_FILE}:{kind}")
    assert np.array_equal(law.loading(PAIR, DEPTH), LAWS[kind].loading(PAIR, DEPTH))
    assert law.name == f"{COEFFICIENTS_FILE}:{kind}"


def test_ones_own_fit_is_another_law(fitted):
    found = law_named(str(fitted)).loading(PAIR, DEPTH)
    assert np.all(found > 0.0)
    assert not np.array_equal(found, LAWS["fitted"].loading(PAIR, DEPTH))


def test_ones_own_fit_is_exported_and_compared(fitted, tmp_path, prints):
    prints("export", "law", fitted, "--out", tmp_path / "own")
    prints("export", "law", "fitted", "--out", tmp_path / "shipped")
    own, shipped = (
        (tmp_path / name / "dentscope_contact.c").read_text() for name in ("own", "shipped")
    )
    assert own != shipped
    assert str(fitted) in prints("laws", "show", fitted).replace("\n", "")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c.pop("uncertainty"), "damaged"),
        (lambda c: c["coefficients"].popitem(), "every coefficient"),
        (lambda c: c.update(format="dentscope-coefficients/3"), "format"),
        (lambda c: c["correction"].update(weights="x"), "damaged"),
    ],
)
def test_a_damaged_fit_is_one_line(fitted, change, words):
    content = json.loads(fitted.read_text())
    change(content)
    fitted.write_text(json.dumps(content))
    with pytest.raises(InputError, match=words) as caught:
        law_named(str(fitted))
    assert "\n" not in str(caught.value)
    assert str(fitted) in str(caught.value)


def test_an_unknown_law_of_a_file_lists_the_known(fitted):
    with pytest.raises(InputError, match="compact, fitted, hardening"):
        law_named(f"{fitted}:other")


FITTED, HARDENING = LAWS["fitted"], LAWS["hardening"]
BALL = Material(E=200e9, nu=0.3, Sy=1.5e9)
R = 5e-3
ANCHORED_DEPTH = R * np.geomspace(1e-6, 0.08, 40)


def hardens(factor: float) -> Pair:
    curve = ludwik(Sy=factor * 250e6, K=factor * 300e6, n=0.35)
    flat = Material(E=70e9, nu=0.33, Sy=curve.strength, flow=Flow(curve))
    return Pair(BALL, flat, R)


def sheet(factor: float) -> Pair:
    curve = hardens(factor).flat.flow.curve
    return Pair(BALL, Material(E=70e9, nu=0.33, Sy=curve(0.002)), R)


LAW = anchored(FITTED, HARDENING, at=hardens(1.0), stated=sheet(1.0), hardens=True)


def answers(law, pair):
    left = sum(law.residual(pair, ANCHORED_DEPTH))
    half = law.unloading(pair, 0.5 * (left + ANCHORED_DEPTH), ANCHORED_DEPTH)
    return np.stack(
        [law.loading(pair, ANCHORED_DEPTH), law.contact_radius(pair, ANCHORED_DEPTH), half]
    ), left


def test_at_the_stated_numbers_it_is_what_is_known_of_them():
    own, dent = answers(LAW, sheet(1.0))
    known, left = answers(HARDENING, hardens(1.0))
    assert own == pytest.approx(known, rel=2e-3)
    assert dent == pytest.approx(left, rel=2e-3, abs=1e-4 * R)
    assert not np.allclose(own, answers(FITTED, sheet(1.0))[0], rtol=0.05)


@pytest.mark.parametrize("factor", [0.85, 1.15])
def test_beside_them_it_follows_a_stronger_metal(factor):
    own, dent = answers(LAW, sheet(factor))
    known, left = answers(HARDENING, hardens(factor))
    assert own == pytest.approx(known, rel=0.02)
    assert dent / ANCHORED_DEPTH == pytest.approx(left / ANCHORED_DEPTH, abs=0.01)


def test_far_from_them_force_and_radius_rise_and_no_cycle_gains_energy():
    for factor in (0.1, 10.0):
        pair = sheet(factor)
        force, radius = LAW.loading(pair, ANCHORED_DEPTH), LAW.contact_radius(pair, ANCHORED_DEPTH)
        assert np.all(np.diff(force) > 0.0)
        assert np.all(np.diff(radius) > 0.0)
        for peak in ANCHORED_DEPTH[::8]:
            d = np.linspace(0.0, peak, 400)
            out = np.trapezoid(LAW.unloading(pair, d, np.full_like(d, peak)), d)
            assert out <= 1.002 * np.trapezoid(LAW.loading(pair, d), d)


def test_its_error_is_the_anchors_own():
    depth = np.array([1e-4])
    own = LAW.uncertainty(sheet(1.0), depth)
    assert own.force == pytest.approx(HARDENING.uncertainty(hardens(1.0), depth).force)


def test_the_metal_of_a_stronger_piece_has_its_whole_curve_scaled():
    metal = LAW.metal(sheet(1.2))
    assert metal.flat.flow.curve(0.05) == pytest.approx(1.2 * hardens(1.0).flat.flow.curve(0.05))
    assert metal.sphere is sheet(1.2).sphere


def test_a_law_of_another_metal_is_another_law_though_all_its_words_are_alike():
    other = anchored(FITTED, HARDENING, at=hardens(1.5), stated=sheet(1.5), hardens=True)
    assert (other.name, other.title, other.source) == (LAW.name, LAW.title, LAW.source)
    assert other != LAW
    assert len({LAW, other}) == 2
