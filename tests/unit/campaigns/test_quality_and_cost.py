"""Designs, a case's stored quality, and how well the time left is foreseen."""

import itertools
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import fem
from dentscope.campaigns import DESIGNS, Forecast, design_named, distinct_cases, quality_of
from dentscope.campaigns.case import _rounded
from dentscope.campaigns.cases.drawn import challenge_cases
from dentscope.campaigns.cases.pairs import RATIOS
from dentscope.campaigns.cost import pace_of_this_machine
from dentscope.campaigns.parts import opened_part, texts_of
from dentscope.campaigns.quality import largest_step, steps_not_in
from dentscope.cli.campaign_data import design_of
from dentscope.cli.campaign_progress import remarks
from dentscope.core.errors import InputError
from dentscope.core.inputs.templates import CASE
from dentscope.start.case_file import read_case
from made_cases import case_of


def curve(**changes):
    depth = np.geomspace(1e-8, 1e-4, 48)
    made = {"delta": depth, "force": depth**1.2, "radius": depth**0.55}
    half = dict.fromkeys(("sphere", "flat"), 0.5 * depth)
    return {**made, **half, "energy_defect": np.full(48, 1e-4), **changes}


def test_a_smooth_curve_has_no_step_and_one_bad_energy_balance_is_what_counts():
    found = quality_of(curve(), 1e-3)
    assert found.largest_step < 1e-9
    assert found.energy_defect == pytest.approx(1e-4)
    assert found.depth_reached == pytest.approx(0.1)
    defect = np.full(48, 1e-4)
    defect[7], defect[9] = -0.02, np.nan
    assert quality_of(curve(energy_defect=defect), 1e-3).energy_defect == pytest.approx(0.02)


@pytest.mark.parametrize("name", ["force", "radius"])
@pytest.mark.parametrize("height", [0.005, 0.03])
def test_a_step_reads_its_height_wherever_it_lies(name, height):
    smooth = curve()
    for k in range(4, 44):
        jump = np.where(np.arange(48) < k, 1.0, 1.0 + height)
        found = quality_of(curve(**{name: smooth[name] * jump}), 1e-3)
        assert getattr(found, f"{name}_step") == pytest.approx(height, rel=0.02)
        assert found.largest_step == getattr(found, f"{name}_step")


def test_a_step_that_the_finer_solve_shows_too_does_not_count():
    smooth, jump = curve(), np.where(np.arange(48) < 20, 1.0, 1.03)
    both = curve(force=smooth["force"] * jump)
    ripple = curve(force=smooth["force"] * jump, radius=smooth["radius"] * jump)
    force, radius, share = steps_not_in(ripple, both)
    assert force < 1e-9
    assert radius == pytest.approx(0.03, rel=0.02)
    assert share < 1e-9


def survey():
    return list(distinct_cases(DESIGNS["survey"]).values())


def played(cases, costs, *, workers):
    free, ended = [0.0] * workers, []
    for case, cost in zip(cases, costs, strict=True):
        k = int(np.argmin(free))
        free[k] += cost
        ended.append((free[k], case))
    return sorted(ended, key=lambda item: item[0]), max(free)


def test_time_left_is_learned_from_the_cases_that_ended():
    # a machine three times slower, where softness costs more than foreseen, and with scatter
    cases, draw = survey(), np.random.default_rng(3)
    truth = [
        114.0 * (c.pair.E_reduced / c.pair.Sy_min / 300.0) ** 0.8 * draw.lognormal(0.0, 0.2)
        for c in cases
    ]
    # the first case of each worker compiles
    truth[:2] = [t + 600.0 for t in truth[:2]]
    ended, whole = played(cases, truth, workers=2)
    forecast, off = Forecast(cases, workers=2), []
    for at, case in ended[:-1]:
        forecast.end(case, at)
        off.append((forecast.left_s(at) - (whole - at)) / whole)
    # after a sixth of the cases it is within a fifth of the whole run, and it ends well
    assert np.abs(off[10:]).max() < 0.2
    assert np.abs(off[50:]).max() < 0.05


def test_cases_that_ended_before_tell_what_a_run_takes():
    cases = survey()
    known = [(case, 100.0) for case in cases[:32]]
    left = cases[32:]
    assert Forecast(left, workers=1, ended=known).left_s() == pytest.approx(3200.0, rel=0.1)
    assert Forecast(left, workers=4, ended=known).left_s() == pytest.approx(800.0, rel=0.1)
    assert Forecast([], workers=4).left_s() == 0.0
    # those of another resolution tell nothing
    other = [(replace(c, accuracy=fem.Accuracy.smoke()), 1.0) for c, _ in known]
    measured = Forecast(left, workers=1).left_s()
    assert Forecast(left, workers=1, ended=other).left_s() == pytest.approx(measured)


def test_a_slow_machine_is_foreseen_before_anything_ran():
    cases = survey()
    usual = Forecast(cases, workers=2).left_s()
    assert Forecast(cases, workers=2, pace=2.0).left_s() == pytest.approx(2.0 * usual)
    assert 0.1 < pace_of_this_machine() < 100.0


@pytest.mark.parametrize(
    ("energy", "step", "said"),
    [(0.0049, 0.0099, ""), (0.0051, 0.0, "energy defect"), (0.0, 0.0101, "step of")],
)
def test_a_case_is_remarked_from_half_a_per_cent_of_energy_and_a_per_cent_of_a_step(
    energy, step, said
) -> None:
    quality = SimpleNamespace(energy_defect=energy, largest_step=step)
    told = remarks(SimpleNamespace(status="done", stale=False, quality=quality))
    assert (said in told) if said else (told == "")


def test_groups_are_one_to_twelve_digits() -> None:
    assert _rounded(1.0 + 4e-12) == 1.0
    assert _rounded(1.0 + 6e-12) > 1.0


def test_a_step_is_seen_from_eight_depths_on_by_what_a_cubic_over_seven_leaves() -> None:
    """A single step of 1 % shows two thirds of itself, which is made up for."""
    depth = np.geomspace(1e-5, 1e-2, 20)
    stepped = depth**1.5 * np.where(np.arange(20) < 10, 1.0, 1.01)
    assert largest_step(depth, stepped) == pytest.approx(0.01, rel=0.02)
    assert np.isnan(largest_step(depth[:7], stepped[:7]))
    assert largest_step(depth[:8], depth[:8]) == pytest.approx(0.0, abs=1e-9)


def test_a_case_under_way_still_takes_a_seventh_of_its_time_however_long_it_has() -> None:
    one = case_of()
    forecast = Forecast([one], workers=1)
    whole = forecast.cost_s(one)
    assert forecast.left_s(0.5 * whole) == pytest.approx(0.5 * whole)
    assert forecast.left_s(9.0 * whole) == pytest.approx(0.15 * whole)


PUBLISHED = Path(__file__).parents[3] / "data" / "campaign"


@pytest.fixture(scope="module")
def cases():
    return {name: distinct_cases(DESIGNS[name]) for name in DESIGNS}


def groups(cases):
    return {str(case.groups) for case in cases.values()}


@pytest.mark.parametrize("part", sorted(PUBLISHED.glob("*.h5")), ids=lambda path: path.stem)
def test_what_is_published_is_its_design(monkeypatch, part):
    """Pairs, flow curves, depths, unloadings and settings: all are in the id of a case."""
    with opened_part(part) as file:
        monkeypatch.setattr(fem, "NUMERICS_VERSION", int(file.attrs["numerics_version"]))
        assert set(texts_of(file, "id")) == set(distinct_cases(design_named(file.attrs["design"])))


def test_a_folder_of_pairs_is_a_design(tmp_path):
    for name, flat in (("soft", "3.0e8"), ("hard", "5.0e8")):
        (tmp_path / f"{name}.toml").write_text(CASE.replace("Sy_Pa = 3.0e8", f"Sy_Pa = {flat}"))
    made = design_of(str(tmp_path))
    problem, accuracy = read_case(tmp_path / "hard.toml")
    hard, soft = made.make()
    assert (made.name, hard.name, soft.name) == (tmp_path.name, "hard", "soft")
    assert (hard.pair, hard.depths, hard.accuracy) == (problem.pair, problem.depths, accuracy)
    assert not hard.problem.snapshots
    assert list(distinct_cases(made)) == [hard.id, soft.id]
    assert design_of("smoke") is DESIGNS["smoke"]
    (tmp_path / "none").mkdir()
    with pytest.raises(InputError, match="no CASE"):
        design_of(str(tmp_path / "none"))


def test_the_full_design_has_more_combinations_than_the_thesis(cases):
    names = {c.name for c in cases["full"].values()}
    # the pair of chapter 3 is the only one that is solved twice, to two depths
    assert {"chapter-3", "chapter-3-to-2450"} <= names
    assert len(groups(cases["full"])) == len(cases["full"]) - 1 >= 432
    assert len(cases["space"]) >= 256
    # the thesis: at least 30 ratios of five cases, three of 27 sets
    assert len(set(RATIOS)) >= 30
    assert sum(0.9 <= r <= 1.7 for r in RATIOS) >= 15
    assert len(cases["thesis"]) >= 5 * 30 + 27 * 3 - 6


def test_validation_shares_no_pair_and_covers_the_hard_parts(cases):
    others = groups(cases["thesis"]) | groups(cases["space"])
    assert not groups(cases["validation"]) & others
    others |= groups(cases["validation"]) | groups(cases["near-equal"])
    assert not groups(cases["validation-2"]) & others
    for name in ("hardening", "plateau"):
        assert not set(cases[f"validation-{name}"]) & set(cases[name])
    pairs = [case.pair for case in cases["validation"].values()]
    assert len(pairs) >= 48
    assert sum(0.85 <= p.Sy_ratio <= 1.7 for p in pairs) >= 16
    assert sum(p.E_reduced / p.Sy_min < 60 for p in pairs) >= 8


def test_a_run_that_is_stopped_early_has_the_thesis_first(cases):
    names = [case.name for case in cases["full"].values()]
    order = [name.split("-")[0] for name in names]
    assert order.index("space") == 263
    assert order.index("validation") == 263 + 256
    assert names[:3] == ["figure-2.2", "figure-2.3", "figure-2.4"]
    # half of Table 2.1 leaves no gap larger than 0.15 in the steep part
    ratios = [c.pair.Sy_ratio for c in cases["thesis"].values() if c.name.startswith("table")]
    steep = sorted({round(r, 3) for r in ratios[: len(ratios) // 2] if 0.85 < r < 1.75})
    assert max(b - a for a, b in itertools.pairwise(steep)) < 0.151
    assert {0.1, 1.0, 10.0} <= {round(r, 6) for r in ratios[:45]}


@pytest.mark.parametrize(("name", "count"), [("thesis", 3), ("space", 4)])
def test_the_parts_of_a_design_are_the_design(name, count):
    parts = [distinct_cases(design_named(f"{name}-{k + 1}")) for k in range(count)]
    for one, other in itertools.combinations(parts, 2):
        assert not one.keys() & other.keys()
    together = list(itertools.chain.from_iterable(parts))
    assert together == list(distinct_cases(design_named(name)))


def test_a_challenge_follows_from_its_checksum_and_shares_no_pair(cases):
    digest = "0123456789abcdef" * 4
    one, other = challenge_cases(digest), challenge_cases(digest[1:])
    assert [c.id for c in one] == [c.id for c in challenge_cases(digest[:12])]
    assert len({c.id for c in (*one, *other)}) == 48
    assert all(c.name.split("-")[1] == digest[:12] for c in one)
    drawn = groups(cases["challenge"])
    assert len(drawn) == 24
    assert not drawn & groups(cases["full"])
