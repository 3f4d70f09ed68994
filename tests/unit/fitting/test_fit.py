"""The closed form, the recovery of planted coefficients, and the command that fits."""

import json
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.campaigns.designs import design_named
from dentscope.cli import fit as fit_command
from dentscope.cli.app import run
from dentscope.core import InputError, Material, Pair
from dentscope.core.flow import Flow, swift
from dentscope.core.tables import markdown
from dentscope.fitting import table
from dentscope.fitting.coefficients import write_coefficients
from dentscope.fitting.fit import fit_tables
from dentscope.fitting.form import START
from dentscope.fitting.hardening import fit_hardening, hardening_records, judge_hardening
from dentscope.fitting.prediction import Errors, predict
from dentscope.fitting.refit import refit
from dentscope.fitting.table import ResidualTable, Table, is_held_out, read_sources, tables_of
from dentscope.models import LAWS, DomainWarning, critical_depth
from dentscope.models.closed_form import COEFFICIENTS
from dentscope.models.coefficients import laws_from, read_coefficients
from dentscope.models.fitted import closed_form_law
from dentscope.models.hardening import hardening_law
from dentscope.studies.closed_form.page import (
    BEGIN,
    END,
    JUDGED_BEGIN,
    JUDGED_END,
    judged_section,
    published_section,
    update_page,
)
from made_files import put

CONTENT = read_coefficients()


def pair_of(E_s, E_f, Sy_min, ratio, nu_s=0.3, nu_f=0.3):
    s, f = (Sy_min, Sy_min / ratio) if ratio < 1.0 else (Sy_min * ratio, Sy_min)
    return Pair(Material(E=E_s, nu=nu_s, Sy=s), Material(E=E_f, nu=nu_f, Sy=f), 1e-3)


def random_pairs(count, seed):
    u = np.random.default_rng(seed).random((count, 6))
    return [
        pair_of(
            50e9 * 6.0**a, 50e9 * 6.0**b, 50e6 * 22.0**c, 0.05 * 400.0**d, 0.1 + 0.35 * e,
            0.1 + 0.35 * f,
        )
        for a, b, c, d, e, f in u
    ]  # fmt: skip


@pytest.fixture(scope="module", params=["compact", "fitted"])
def law(request):
    return replace(LAWS[request.param], limits={})


def test_small_load_is_hertz_with_the_elastic_share(law):
    for pair in random_pairs(300, seed=1):
        d = min(0.1 * critical_depth(pair), 1e-5 * pair.R)
        hertz = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R) * d**1.5
        assert float(law.loading(pair, d)) == pytest.approx(hertz, rel=1e-3)
        assert float(law.contact_radius(pair, d)) == pytest.approx(math.sqrt(pair.R * d), rel=1e-3)
        assert float(law.share(pair, d)) == pytest.approx(pair.elastic_share, abs=0.002)
        assert sum(law.residual(pair, d)) == pytest.approx(0.0, abs=1e-3 * d)


def test_rigid_bodies_take_no_share(law):
    rigid = Material(E=math.nan, nu=math.nan, rigid=True)
    soft = Material(E=200e9, nu=0.3, Sy=3e8)
    d = np.geomspace(1e-8, 4e-5, 20)
    assert law.share(Pair(soft, rigid, 1e-3), d) == pytest.approx(np.ones(20), abs=1e-6)
    assert law.share(Pair(rigid, soft, 1e-3), d) == pytest.approx(np.zeros(20), abs=1e-6)


def test_two_like_bodies_share_alike_at_first_yield(law):
    """By symmetry: at small strain a sphere and a flat differ only by their curvature."""
    pair = pair_of(2e11, 2e11, 1e8, 1.0)
    assert float(law.share(pair, 2.0 * critical_depth(pair))) == pytest.approx(0.5, abs=0.02)


def test_no_step_and_no_kink_over_the_strength_ratio(law):
    def bend(n):
        """Largest change of the slope from interval to interval, over the largest slope."""
        flat = Material(E=2e11, nu=0.4, Sy=3e8)
        spheres = [Material(E=2e11, nu=0.3, Sy=s) for s in np.geomspace(6e7, 1.5e9, n)]
        pairs = [Pair(sphere, flat, 1e-3) for sphere in spheres]
        force = np.array([float(law.loading(p, 2e-5)) for p in pairs])
        share = np.array([float(law.share(p, 2e-5)) for p in pairs])
        slopes = [np.diff(values) for values in (force, share)]
        return np.array([np.abs(np.diff(s)).max() / np.abs(s).max() for s in slopes])

    # over a kink the slope jumps however close the points are; over a smooth curve the change
    # halves with the spacing
    assert bend(801) == pytest.approx(0.5 * bend(401), rel=0.05)


def test_force_rises_everywhere_in_the_domain(law):
    for pair in random_pairs(300, seed=7):
        last = 0.1 * pair.R
        d = np.geomspace(1e-4 * min(critical_depth(pair), last), last, 100)
        force = law.loading(pair, d)
        assert np.all(np.isfinite(force))
        assert np.all(np.diff(force) > 0.0)
        s, f = law.residual(pair, d)
        assert np.all((s >= 0.0) & (f >= 0.0) & (s + f < d))
        assert np.all((law.share(pair, d) >= 0.0) & (law.share(pair, d) <= 1.0))


NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)


def work_of_loading(law, pair, peak):
    """By four Gauss points in ln(depth) on each of 80 panels; what lies below 1e-9 is no work."""
    low = math.log(1e-9)
    at = np.concatenate([low - low * (k + 0.5 * (NODES + 1.0)) / 80 for k in range(80)])
    d = peak * np.exp(at)
    return float(np.sum(np.tile(-low / 160 * WEIGHTS, 80) * d * law.loading(pair, d)))


def restitution(law, pair, peak):
    """From the energies of one cycle; a power law of exponent N gives back F d/(N + 1)."""
    left = sum(float(x) for x in law.residual(pair, peak))
    given = float(law.loading(pair, peak)) * (peak - left)
    given /= float(law.unloading_exponent(pair, peak)) + 1.0
    return math.sqrt(given / work_of_loading(law, pair, peak))


@pytest.mark.parametrize("soft", [70e9, 1e9])
@pytest.mark.parametrize("weak_one", ["sphere", "flat"])
def test_what_does_not_yield_returns_all_that_it_took(law, soft, weak_one):
    """At finite strain too: depths up to those of 60 m/s with the soft body of 1 GPa."""
    bodies = [Material(E=soft, nu=0.4), Material(E=200e9, nu=0.3)]
    pair = Pair(*(bodies if weak_one == "sphere" else bodies[::-1]), 1e-2)
    for D in (1e-4, 1e-3, 1e-2, 0.1, 0.18):
        assert restitution(law, pair, D * pair.R) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("around", [1.0, 10.0])
def test_no_cycle_creates_energy_in_the_domain_and_far_around_it(law, around):
    """Sy* 0.1-10 and E'/S 25-3300, and ten times beyond either end; most where yield begins."""
    deepest = 0.18 if around == 1.0 else 1.0
    for a, b, c, d, e, f, g in np.random.default_rng(17).random((400, 7)):
        moduli, nus = (50e9 * 6.0**c, 50e9 * 6.0**d), (0.1 + 0.35 * e, 0.1 + 0.35 * f)
        ratio = 0.1 / around * (100.0 * around**2) ** a
        stiffness = 25.0 / around * (132.0 * around**2) ** b
        modulus = pair_of(*moduli, 1e8, ratio, *nus).E_reduced
        pair = pair_of(*moduli, modulus / stiffness, ratio, *nus)
        peak = min(critical_depth(pair) * 10.0 ** (3.0 * g - 1.0), deepest * pair.R)
        assert restitution(law, pair, peak) <= 1.0 + 1e-9


def test_derivatives_agree_with_differences(law):
    pair = pair_of(71.7e9, 200e9, 3e8, 1.2, nu_s=0.33)
    d = np.array([1e-7, 2e-6, 3e-5])
    found = law.gradient(pair, d)
    h = 1e-6
    slope = (law.loading(pair, d * (1 + h)) - law.loading(pair, d * (1 - h))) / (2 * h * d)
    assert found["depth"] == pytest.approx(slope, rel=1e-7)
    for body, key in (("sphere", "s"), ("flat", "f")):
        material = getattr(pair, body)
        for name in ("E", "nu", "Sy"):
            value = getattr(material, name)
            up, down = (
                law.loading(
                    replace(pair, **{body: material.with_(**{name: value * (1 + sign * h)})}), d
                )
                for sign in (1, -1)
            )
            assert found[f"{name}_{key}"] == pytest.approx(
                (up - down) / (2 * h * value), rel=1e-4, abs=1e-9 * float(up.max()) / value / h
            )


def test_leaving_the_domain_names_the_bound():
    law = replace(LAWS["fitted"], limits={"Sy_ratio": (0.1, 10.0), "Delta_over_R": (0.0, 0.1)})
    words = "yield strength of the sphere over that of the flat"
    with pytest.warns(DomainWarning, match=rf"{words} \(Sy_ratio\) = 50 is outside 0.1 to 10"):
        law.loading(pair_of(2e11, 2e11, 3e8, 50.0), 1e-5)
    words = "approach over the radius"
    with pytest.warns(DomainWarning, match=rf"{words} \(Delta_over_R\) = 0.2 is outside 0 to 0.1"):
        law.loading(pair_of(2e11, 2e11, 3e8, 5.0), 2e-4)


def test_a_metal_that_hardens_is_told_that_the_law_does_not(law):
    hard = Material(E=2e11, nu=0.3, Sy=3e8, flow=Flow(curve=swift(Sy=3e8, K=9e8, n=0.2)))
    limited = replace(law, limits={"Sy_ratio": (0.1, 10.0)})
    with pytest.warns(DomainWarning, match="`hardening` follows a flow curve"):
        limited.loading(Pair(hard, Material(E=2e11, nu=0.3, Sy=6e8), 1e-3), 1e-5)


def planted():
    """Tables made by the form itself with known coefficients and 0.3 % of noise."""
    truth = START | {"h": 2.9, "k1": 1.7, "z": 0.25, "s0": 0.7, "f1": 0.12}
    random = np.random.default_rng(3)
    ratios = (0.1, 0.4, 0.7, 0.85, 1.0, 1.15, 1.4, 3.0, 10.0)
    pairs = [
        pair_of(80e9 + 1e10 * k, 200e9, Sy, r, nu_s=0.25 + 0.01 * (k % 10))
        for k, (r, Sy) in enumerate((r, s) for r in ratios for s in (8e7, 2.5e8, 8e8))
    ]
    who = {"pairs": tuple(pairs), "names": tuple(f"planted-{k}" for k in range(len(pairs)))}
    D = [np.geomspace(0.3 * critical_depth(p) / p.R, 0.12, 30) for p in pairs]
    turn = [d[6::6] for d in D]
    case, at = (np.repeat(np.arange(len(pairs)), [len(x) for x in xs]) for xs in (D, turn))
    D, turn = np.concatenate(D), np.concatenate(turn)
    onset = np.array([critical_depth(p) / p.R for p in pairs])
    one, two = np.ones_like(D), np.ones_like(turn)
    table = Table(case, D, D / onset[case], one, one, one, one.astype(bool), **who)
    turns = ResidualTable(at, turn, turn / onset[at], two, two, two, **who)
    p = predict([truth[name] for name in COEFFICIENTS], table, turns)
    noise = 1.0 + 0.003 * random.standard_normal((2, D.size))
    table = replace(table, force=p.force * noise[0], radius=p.radius * noise[1], share=p.share)
    turns = replace(
        turns, total=p.total, sphere_part=p.sphere / p.total, exponent=np.asarray(p.exponent)
    )
    return truth, table, turns


def test_planted_coefficients_come_back_within_their_errors():
    truth, table, turns = planted()
    found = fit_tables(table, turns)
    assert found.outcome.completed
    # F and a at the level of the planted noise, whose mean absolute value is 0.24 %
    assert found.errors.force[0] < 0.003
    assert found.errors.radius[0] < 0.003
    off = [
        (value - truth[name]) / max(error, 1e-3 * abs(truth[name]) + 1e-4)
        for name, value, error in zip(
            COEFFICIENTS, found.values, found.standard_errors, strict=True
        )
    ]
    assert np.mean(np.abs(off) < 3.0) >= 0.9


def test_rows_whose_contact_edge_was_not_seen_do_not_move_the_fit():
    _, table, turns = planted()
    hidden = np.zeros(table.D.size, dtype=bool)
    hidden[29::30] = True  # the deepest row of each case
    wrong = replace(table, radius=np.where(hidden, 0.9, 1.0) * table.radius, edge_seen=~hidden)
    right = replace(table, edge_seen=~hidden)
    values = [fit_tables(t, turns).values for t in (wrong, right)]
    assert values[0] == pytest.approx(values[1], rel=1e-9)


def test_shipped_coefficients_say_where_they_come_from():
    assert tuple(CONTENT["coefficients"]) == COEFFICIENTS
    assert all(entry["standard_error"] >= 0.0 for entry in CONTENT["coefficients"].values())
    assert all(len(c["sha256"]) == 64 for c in CONTENT["provenance"]["campaigns"])
    assert np.array(CONTENT["covariance"]).shape == (len(COEFFICIENTS), len(COEFFICIENTS))


@pytest.mark.parametrize(
    ("other", "told"),
    [
        ({"format": "dentscope-coefficients/1"}, "dentscope fit"),
        ({"coefficients": {k: CONTENT["coefficients"][k] for k in COEFFICIENTS[1:]}},
         f"no {COEFFICIENTS[0]}"),
        ({"correction": CONTENT["correction"] | {"channels": ["g_a", "h"]}},
         r"correction\.channels: g_a, h \(allowed: fin, c, g_a, "),
    ],
)  # fmt: skip
def test_coefficients_of_an_older_form_are_refused_with_what_to_do(other, told):
    with pytest.raises(InputError, match=told):
        laws_from({**CONTENT, **other}, source="fitted.json")


def test_below_first_yield_and_far_from_the_data_the_laws_are_one():
    """The correction moves what follows first yield, over pairs like those of the data."""
    compact, fitted = (replace(LAWS[name], limits={}) for name in ("compact", "fitted"))
    inside = pair_of(150e9, 200e9, 3e8, 0.7)
    onset = critical_depth(inside)
    early, late = (
        float(fitted.loading(inside, d * onset) / compact.loading(inside, d * onset))
        for d in (0.4, 60.0)
    )
    assert early == pytest.approx(1.0, abs=1e-4)
    assert abs(late - 1.0) > 1e-3
    outside = pair_of(150e9, 200e9, 1e3, 0.7)
    d = np.geomspace(1e-8, 4e-5, 20)
    assert fitted.loading(outside, d) == pytest.approx(compact.loading(outside, d), rel=1e-3)


def test_the_written_file_reads_back_as_the_same_law(tmp_path):
    write_coefficients(CONTENT, tmp_path / "fitted.json")
    again = json.loads((tmp_path / "fitted.json").read_text())
    assert again == CONTENT
    values = {k: v["value"] for k, v in CONTENT["coefficients"].items()}
    compact, fitted = laws_from(again, source="x")
    assert compact.coefficients == fitted.coefficients == closed_form_law(values).coefficients
    assert np.array_equal(fitted.correction.weights, LAWS["fitted"].correction.weights)


PAGE = Path(__file__).resolve().parents[3] / "docs" / "closed-form.md"


def test_publishing_outside_a_checkout_is_one_line(monkeypatch, capsys):
    """An installed package does not write into itself."""
    monkeypatch.setattr(fit_command.studies, "present", lambda: False)
    for line in (["fit", "--publish"], ["fit", "--judge", "data/challenge", "--publish"]):
        assert run(line) == 2
        told = capsys.readouterr()
        assert "`dentscope fit --publish` belongs to the workshop" in told.err
        assert len(told.err.splitlines()) == 1


def test_page_shows_the_coefficients_in_use():
    text = PAGE.read_text(encoding="utf-8")
    shown = text[text.index(BEGIN) : text.index(END) + len(END)]
    assert shown == published_section(CONTENT)


def test_page_keeps_what_stands_around_the_coefficients(tmp_path):
    page = put(tmp_path / "page.md", f"before\n{BEGIN}\nold\n{END}\nafter\n")
    update_page(page, published_section(CONTENT))
    update_page(page, published_section(CONTENT))
    text = page.read_text()
    assert text.startswith("before\n")
    assert text.endswith("\nafter\n")
    assert "old" not in text
    assert text.count(BEGIN) == 1


def test_the_law_in_use_is_judged_on_cases_that_no_fit_reads(tmp_path, monkeypatch, prints, errs):
    """The validation part stands in for a challenge: its errors are those that a fit reports."""
    page = put(tmp_path / "page.md", f"before\n{JUDGED_BEGIN}\nold\n{JUDGED_END}\nafter\n")
    monkeypatch.setattr(fit_command, "_PAGE", page)
    part = PAGE.parents[1] / "data" / "campaign" / "validation-2-1.h5"
    assert "48 pairs" in prints("fit", "--judge", part, "--publish")
    text = page.read_text()
    assert "48 pairs, drawn from a seed of their own." in text
    assert "| F [%] |" in text
    assert "old" not in text
    assert text.endswith("\nafter\n")
    smoke = part.with_name("smoke-1.h5")
    told = errs("fit", "--judge", smoke)
    assert "no completed elastic-plastic case named validation or challenge" in told


def test_a_challenge_of_other_coefficients_is_called_so():
    found = CONTENT["errors"]["fitted"]["left_out"]
    errors = [("fitted", Errors(**{k: tuple(v) for k, v in found.items()}))]
    names = [f"challenge-0123456789ab-{k:02}" for k in range(24)]
    assert "coefficients above" in judged_section(
        errors, names, "0123456789ab" + "0" * 52, within={}
    )
    assert "earlier coefficients" in judged_section(errors, names, "f" * 64, within={})


def test_markdown_table():
    assert markdown([["a", "b"], ["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |\n"


class Record:
    """What a table reads of a completed case."""

    def __init__(self, case):
        self.case, self.id, self.unloadings = case, case.id, ()
        one = np.linspace(1.0, 2.0, 5) * 1e-5
        self.curve = {k: one for k in ("delta", "force", "radius", "sphere", "flat")}
        self.curve["radius_last_node"] = one + 1e-7


@pytest.fixture
def tables(tmp_path, monkeypatch):
    """The tables of records that a campaign would hold."""

    def of(*records, **more):
        monkeypatch.setattr(table, "read_curves", lambda _: list(records))
        return tables_of(read_sources([tmp_path]), **more)

    return of


def test_cases_of_low_resolution_count_only_without_finer_ones(tables):
    low, fine = (
        [Record(case) for case in design_named(name).make()[:n]]
        for name, n in (("smoke", 3), ("space", 2))
    )
    assert tables(*low, *fine)[0].names == tuple(r.case.name for r in fine)
    assert len(tables(*low)[0].pairs) == 3


def test_of_one_combination_the_case_that_unloads_counts(tables, tmp_path):
    again, other = (Record(case) for case in design_named("smoke").make()[:2])
    unloads = Record(again.case)
    d = np.linspace(2e-5, 1e-5, 9)
    back = {"delta": d, "force": (d - 1e-5) ** 1.5, "radius": np.full(9, 1e-5)}
    depth = 2e-5 / again.case.pair.R
    unloads.unloadings = (
        SimpleNamespace(depth=depth, residual_sphere=0.0, residual_flat=1e-5, curve=back),
    )
    for records in ([unloads, again, other], [again, other, unloads]):
        rows, turns = tables(*records)
        assert (len(rows.pairs), turns.total.tolist()) == (2, [0.5])
        with pytest.raises(InputError, match=r"unload: 1 .*two or more, `unload_depths`"):
            refit([tmp_path])


def test_metals_that_harden_are_not_fitted(tables):
    plain, other = design_named("smoke").make()[:2]
    sphere = other.pair.sphere
    curve = swift(Sy=sphere.Sy, K=3.0 * sphere.Sy, n=0.2)
    pair = replace(other.pair, sphere=sphere.with_(flow=Flow(curve=curve)))
    hard = replace(other, problem=replace(other.problem, pair=pair))
    assert tables(Record(plain), Record(hard))[0].names == (plain.name,)


@pytest.mark.parametrize(
    ("name", "kept"),
    [("space-000", False), ("space-127", False), ("space-128", True), ("space-255", True),
     ("validation-2-007", True), ("near-equal-200", False), ("space-odd", False)],
)  # fmt: skip
def test_the_second_half_of_the_space_judges_as_validation_does(name, kept):
    assert is_held_out(SimpleNamespace(case=SimpleNamespace(name=name))) is kept


def test_held_out_cases_are_not_fitted(tables):
    """A case of the validation design never reaches a fit, whatever file it lies in."""
    cases = (*design_named("validation").make()[:2], *design_named("smoke").make()[:3])
    (fitted, _), (judged, _) = (tables(*map(Record, cases), held_out=x) for x in (False, True))
    assert (len(fitted.pairs), len(judged.pairs)) == (3, 2)
    assert not any(name.startswith("validation") for name in fitted.names)


def test_published_parts_are_known_as_campaigns():
    """What is no campaign is refused before the seconds that a reader takes to load."""
    folder = PAGE.parents[1] / "data" / "campaign"
    assert fit_command._files([folder]) == sorted(folder.glob("*.h5"))


@pytest.fixture(scope="module")
def sources():
    data = PAGE.parents[1] / "data" / "campaign"
    return read_sources(sorted([*data.glob("*hardening-1.h5"), *data.glob("*plateau-1.h5")]))


def test_no_fit_reads_the_pairs_for_judging(sources):
    seen, kept = hardening_records(sources), hardening_records(sources, held_out=True)
    assert (len(seen), len(kept)) == (96 + 48, 24 + 24)
    assert all(r.case.name.startswith("validation") for r in kept)
    assert not {r.id for r in seen} & {r.id for r in kept}


def test_pairs_that_no_fit_read_are_within_what_is_stated(sources):
    kept = hardening_records(sources, held_out=True)
    errors, within = judge_hardening(LAWS["hardening"], kept)
    assert errors["force"][0] < 0.015
    assert errors["radius"][0] < 0.01
    for quantity, (one, two) in within.items():
        assert one == pytest.approx(0.68, abs=0.2), quantity
        assert two > 0.85, quantity


def test_a_few_pairs_are_enough_to_halve_the_error_of_the_equivalence_alone(sources):
    records = hardening_records(sources)
    found = fit_hardening(LAWS["fitted"], records[::3])
    assert found.combinations == 48
    none = replace(found.correction, weights=np.zeros_like(found.correction.weights))
    learned, alone = (
        judge_hardening(hardening_law(LAWS["fitted"], one), records[1::12])[0]
        for one in (found.correction, none)
    )
    assert learned["force"][0] < 0.75 * alone["force"][0]
    assert learned["radius"][0] < 0.6 * alone["radius"][0]
