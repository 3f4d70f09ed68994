"""Simple rules and the learner, on numbers small enough to follow, scored against the truths."""

import json
import math
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.recordings import read
from dentscope.studies.peers import compare, learned, rules
from dentscope.studies.peers.fitted import Fitted, Tried
from dentscope.studies.peers.rules import ANOTHER_PAIR, RULES, Said, stacked
from dentscope.studies.proof import rivals
from dentscope.studies.proof.seal import Ledger, digest_of

CELLS = 20
BIC = RULES["BIC, 3 % floor"]


def tried(*pairs: Tried, **chi2: float) -> Fitted:
    """Explanations of two parameters with these chi2; `baseline` first, with none."""
    found = [
        Tried(name, 0 if name == "baseline" else 2, (10.0 * x, 0.0), (x, 0.0), -0.5 * x)
        for name, x in chi2.items()
    ]
    return Fitted(CELLS, tuple(found), pairs)


@pytest.mark.parametrize(
    ("chi2", "said"),
    [
        ({"baseline": 20.0, "a": 15.0}, Said("adequate")),
        # a name costs two parameters and the margin: 2 ln 20 + 10 = 16.0
        ({"baseline": 31.5, "a": 15.0}, Said("missing-physics", "a")),
        ({"baseline": 30.9, "a": 15.0}, Said("adequate")),
        ({"baseline": 90.0, "a": 40.0, "b": 15.0}, Said("missing-physics", "b")),
        # chi2 of 60 on 18 degrees
        ({"baseline": 900.0, "a": 60.0}, Said("outside-library")),
        ({"baseline": 60.0, "a": 59.0}, Said("outside-library")),
    ],
)
def test_the_rule_that_was_declared(chi2, said) -> None:
    assert BIC.says(tried(**chi2)) == said


def test_what_a_parameter_costs_and_which_noise_counts() -> None:
    some = tried(baseline=20.0, a=15.0)
    cost = RULES["AIC on noise"].costs(some)["a"]
    assert cost.total - cost.chi2 == 2.0 * 2
    cost = BIC.costs(some)["a"]
    assert cost.total - cost.chi2 == pytest.approx(2.0 * math.log(20.0))
    # ten times the chi2 without the floor: nothing fits
    assert RULES["AIC on noise"].says(some) == Said("outside-library")


@pytest.mark.parametrize(("chi2", "name"), [(15.0, "a+b"), (26.0, "a")])
def test_a_second_mechanism_has_to_win_over_the_first(chi2, name) -> None:
    # it costs two parameters more and the margin: 42 - 16.0 = 26.0
    both = Tried("a+b", 4, (math.nan, math.nan), (chi2, 0.0))
    some = tried(both, baseline=90.0, a=31.0 if chi2 < 20.0 else 25.0, b=60.0)
    assert RULES["BIC, 3 % floor, pairs"].says(some) == Said("missing-physics", name)


def test_what_is_not_fitted_keeps_its_share() -> None:
    odds = BIC.odds(tried(baseline=20.0, a=20.0 - 2.0 * math.log(20.0)))
    assert odds["baseline"] == pytest.approx(0.42)
    assert odds["a"] == pytest.approx(0.42)
    assert (odds["outside-library"], odds[ANOTHER_PAIR]) == pytest.approx((0.10, 0.06))
    # a leader that does not fit keeps a fifth
    assert BIC.odds(tried(baseline=200.0))["outside-library"] == pytest.approx(0.82)


def test_bayes_factors_weigh_the_priors() -> None:
    odds = RULES["Bayes factors"].odds(tried(baseline=15.0, a=15.0, b=15.0))
    assert odds["baseline"] / odds["a"] == pytest.approx(0.5 / 0.17)


def test_stacking_leaves_out_what_another_predicts_better_everywhere() -> None:
    logs = np.log([[0.5, 0.1, 0.5], [0.1, 0.5, 0.1], [0.09, 0.4, 0.09]])
    weight = stacked(logs, rounds=2000)
    assert weight[2] == pytest.approx(0.0, abs=1e-6)
    # d/dw of 2 ln(.1 + .4 w) + ln(.5 - .4 w) vanishes at w = 0.75
    assert weight[0] == pytest.approx(0.75, abs=1e-6)


def line(truth, verdict, *names, odds=None, name="set", acting=3) -> dict:
    said = {"verdict": verdict, "names": [n.split("+") for n in names], "odds": odds or {}}
    return {"set": name, "truth": list(truth), "acting": acting, "source": "s",
            "said": {"diagnosis": said, "x": said},
            "seconds": {"diagnosis": 8.0, "rules": 2.0}}  # fmt: skip


def test_lines_are_counted_by_what_they_say_of_their_truth() -> None:
    lines = [
        line((), "adequate"), line((), "missing-physics", "a"),
        line(("a",), "missing-physics", "a"), line(("a",), "indistinguishable", "b", "a"),
        line(("a", "b"), "missing-physics", "b+a"),
        line(("outside-library",), "missing-physics", "a"),
        line(("outside-library",), "outside-library"),
    ]  # fmt: skip
    row = rivals.compare(lines)["rows"][1]
    assert (row["exact"], row["in_set"], row["null_alarmed"], row["forced"]) == (4, 5, 1, 1)


def test_the_probability_of_the_truth_and_what_separates_two() -> None:
    odds = {"baseline": 0.3, "b+a": 0.5, "another pair": 0.2}
    # of three acting mechanisms two pairs are left
    mark = rivals.mark_of(line(("a", "c"), "undetermined", odds=odds), "x")
    assert mark.ln_p == pytest.approx(math.log(0.1))
    assert mark.brier == pytest.approx(0.3**2 + 0.5**2 + 0.1**2 + 0.9**2)
    assert (mark.front, mark.said) == (0.0, 0.5)
    assert rivals.mark_of(line(("a", "b"), "undetermined", odds=odds), "x").front == 1.0
    assert rivals.mark_of(line(("d",), "undetermined"), "x").ln_p == math.log(0.002)

    lines = [line(("a",), "undetermined", name=str(k)) for k in range(10)]
    for k, one in enumerate(lines):
        sure = {"verdict": "undetermined", "names": [], "odds": {"a": 0.8, "baseline": 0.2}}
        one["said"] = one["said"] | {"diagnosis": sure} if k < 6 else one["said"]
    found = rivals.compare(lines)
    (row,) = found["rows"][1:]
    mean, low, high = row["front_less"]
    assert mean == pytest.approx(0.6)
    assert 0.2 < low < 0.4
    assert 0.8 < high < 1.0
    # six of six one way: 2/2^6
    assert row["mcnemar"] == pytest.approx(2.0 / 64.0)
    assert row["ln_p_less"][0] == pytest.approx(0.6 * math.log(0.8 / 0.002))
    low, high = found["rows"][0]["ranges"]
    assert low == (0.0, 0.3, 0.0, 0, 4)
    assert high == pytest.approx((0.8, 0.9, 0.8, 6, 6))
    assert any("| x | 60.0 (" in text for text in rivals.rival_lines(found))


def sealed_run(folder, count=3):
    ledger = Ledger(folder / "ledger.jsonl")
    for place in ("sets", "truths", "verdicts"):
        (folder / place).mkdir(parents=True)
    ledger.add(event="begin", set="", tree="ab", list="small")
    for k in reversed(range(count)):
        name, kind = f"set-{k}", "mass-error" if k == 1 else "single"
        (folder / "sets" / name).mkdir()
        (folder / "sets" / name / "trials.csv").write_text("trial\n")
        truth = {"kind": kind, "mechanisms": ["a"] * (k != 1)}
        (folder / "truths" / f"{name}.json").write_text(json.dumps(truth))
        said = {"verdict": "missing-physics", "mechanisms": ["a"], "probabilities": {"a": 0.9}}
        (folder / "verdicts" / f"{name}.json").write_text(json.dumps(said))
        digests = [digest_of(folder / p) for p in (f"truths/{name}.json", f"sets/{name}",
                                                   f"verdicts/{name}.json")]  # fmt: skip
        ledger.add(event="truth", set=name, truth=digests[0], recordings=digests[1])
        ledger.add(event="verdict", set=name, verdict=digests[2], cpu_s=7.5)
    return folder


def test_a_sealed_run_is_not_diagnosed_again_and_goes_on(tmp_path, monkeypatch) -> None:
    folder = sealed_run(tmp_path / "run")
    asked = []
    monkeypatch.setattr(compare, "read", lambda place: asked.append(place.name))
    monkeypatch.setattr(compare, "fitted_of", lambda _: tried(baseline=60.0, a=15.0))
    monkeypatch.setattr(compare, "diagnose", lambda _: pytest.fail("diagnosed again"))
    monkeypatch.setattr(compare, "RULES", {"BIC": rules.RULES["BIC, 3 % floor"]})
    with ThreadPoolExecutor(1) as pool:
        first = list(compare.compared(folder, pool, most=1))
        with (folder / rivals.PEERS).open("a") as stream:
            stream.write('{"set": "set-0", "tru')  # cut short
        rest = list(compare.compared(folder, pool))
    # in the order of the run, without the set whose mass is wrong
    assert asked == ["set-2", "set-0"]
    assert [x[1:] for x in (*first, *rest)] == [(1, 1), (2, 2)]
    assert rest[0][0]["seconds"]["diagnosis"] == 7.5
    rows = rivals.compare(rivals.read_lines(folder))["rows"]
    assert [(r["name"], r["exact"]) for r in rows] == [("diagnosis", 2), ("BIC", 2)]
    (folder / "verdicts/set-0.json").write_text("{}")
    with pytest.raises(InputError, match="set-0: the verdict is not the one sealed"):
        compare.asked_of(folder)


def test_rules_whose_fits_fail_are_wrong_and_say_so(tmp_path, monkeypatch) -> None:
    def fails(_):
        raise np.linalg.LinAlgError("not positive definite")

    monkeypatch.setattr(compare, "read", lambda place: None)
    monkeypatch.setattr(compare, "fitted_of", fails)
    found = compare.line_of(compare.Asked(tmp_path / "s", ("a",), {}), "s")
    assert found["failed"] == "not positive definite"
    assert rivals.mark_of(found, "BIC on noise").exact == 0.0


OPEN = Path(__file__).resolve().parents[3] / "data" / "blind-sets" / "open.zip"


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    folder = tmp_path_factory.mktemp("open")
    with zipfile.ZipFile(OPEN) as packed:
        packed.extractall(folder)
    return sorted((folder / "open" / "sets").iterdir())[0]


def test_without_the_readings_nothing_that_was_read_off_is_shown(opened):
    recordings = read(opened)
    sheet, whole = (learned.features(recordings, sheets=s) for s in (True, False))
    assert sheet.items() < whole.items()
    assert not [key for key in sheet if key.startswith(recordings.observed)]
    assert {f"{name} level" for name in recordings.observed} & set(whole)


def test_a_plastic_blow_is_at_its_hand_formula(opened):
    """Depth and contact time of a quarter period on the spring 2 pi R 2.8 Sy."""
    recordings = read(opened)
    flat, body = recordings.setup.target, recordings.strikers()[0]
    spring = 2.0 * math.pi * body.tip_radius_m.value * 2.8 * flat.Sy_Pa.value
    depth, time = (
        learned._by_hand(name, recordings, *(
            np.array([x]) for x in (2.0, body.tip_radius_m.value, body.mass_kg.value)
        ))
        for name in ("permanent_depth_m", "contact_time_s")
    )  # fmt: skip
    assert depth[0] == pytest.approx(2.0 * math.sqrt(body.mass_kg.value / spring))
    assert time[0] == pytest.approx(0.5 * math.pi * math.sqrt(body.mass_kg.value / spring))


def test_a_truth_that_was_never_seen_has_the_least_probability():
    front, ln_p = learned._scored([{"a": 0.75, "b": 0.25}, {"a": 1.0}], ["a", "c"])
    assert front == 0.5
    assert ln_p == pytest.approx(0.5 * (math.log(0.75) + math.log(0.002)))
