"""What the designs promise: counts, ranges, depths, unloadings, and that no pair is shared."""

import itertools
from pathlib import Path

import pytest
from dentscope import fem
from dentscope.campaigns import DESIGNS, design_named, distinct_cases
from dentscope.campaigns.cases.drawn import challenge_cases
from dentscope.campaigns.cases.pairs import RATIOS
from dentscope.campaigns.parts import opened_part, texts_of

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
    drawn = {str(c.groups) for c in cases["challenge"].values()}
    assert len(drawn) == 24
    assert not drawn & groups(cases["full"])
