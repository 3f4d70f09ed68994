"""Seals, seeds, lists, scores and page of the proof; the diagnosis is replaced by a stand-in."""

import hashlib
import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.studies.proof import apart, calibrated, lists, page, power, run, score, seal
from dentscope.studies.proof.case import Case, interval, open_run
from dentscope.studies.proof.lists import Entry


@pytest.fixture
def sealed(tmp_path):
    for place in ("sets/set-0000", "truths", "verdicts"):
        (tmp_path / place).mkdir(parents=True)
    (tmp_path / "sets/set-0000/trials.csv").write_text("trial\n")
    truth = {"kind": "null", "mechanisms": [], "effects": [], "sizes": [], "salt": "s"}
    (tmp_path / "truths/set-0000.json").write_text(json.dumps(truth))
    (tmp_path / "verdicts/set-0000.json").write_text(json.dumps({"verdict": "adequate"}))
    ledger = seal.Ledger(tmp_path / "ledger.jsonl")
    ledger.add(
        event="truth", set="set-0000",
        truth=seal.digest_of(tmp_path / "truths/set-0000.json"),
        recordings=seal.digest_of(tmp_path / "sets/set-0000"),
    )  # fmt: skip
    ledger.add(
        event="verdict", set="set-0000", cpu_s=1.0, message="",
        verdict=seal.digest_of(tmp_path / "verdicts/set-0000.json"),
    )  # fmt: skip
    return tmp_path


def test_whole_run_opens(sealed):
    (case,) = open_run(sealed)
    assert case.said == "adequate"
    # a second opening is as good as the first
    assert open_run(sealed)[0].said == "adequate"


@pytest.mark.parametrize(
    "path", ["truths/set-0000.json", "verdicts/set-0000.json", "sets/set-0000/trials.csv"]
)
def test_changed_file_breaks_the_seal(sealed, path):
    (sealed / path).write_text((sealed / path).read_text() + " ")
    with pytest.raises(seal.SealBroken, match="not"):
        open_run(sealed)


@pytest.mark.parametrize("change", ["drop", "swap", "edit", "cut"])
def test_changed_ledger_breaks_the_chain(sealed, change):
    path = sealed / "ledger.jsonl"
    one, two = path.read_text().splitlines()
    text = {
        "drop": two, "swap": two + "\n" + one, "edit": one.replace("set-0000", "set-0001", 1),
        "cut": one + "\n" + two[:20],
    }[change]  # fmt: skip
    path.write_text(text + "\n")
    with pytest.raises(seal.SealBroken):
        open_run(sealed)


def test_several_writers_leave_the_chain_whole(tmp_path):
    path = tmp_path / "ledger.jsonl"
    with ThreadPoolExecutor(4) as threads:
        list(threads.map(lambda k: seal.Ledger(path).add(event="e", set=str(k)), range(60)))
    assert sorted(int(e["set"]) for e in seal.Ledger(path).events()) == list(range(60))


def test_verdict_after_opening_is_refused(sealed):
    ledger = seal.Ledger(sealed / "ledger.jsonl")
    open_run(sealed)
    ledger.add(**(ledger.of("verdict")["set-0000"] | {"cpu_s": 2.0}))
    with pytest.raises(seal.SealBroken, match="more than once"):
        open_run(sealed)


def test_tree_hash_sees_the_tool_and_not_the_proof(tmp_path):
    for name in ("core/__init__.py", "discrepancy/__init__.py", "studies/proof/__init__.py",
                 "data/coefficients/fitted.json", "docs/x.md"):  # fmt: skip
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("1")
    first = seal.tree_hash(tmp_path)
    changes = {
        "studies/proof/__init__.py": True,
        "docs/x.md": True,
        "core/__init__.py": False,
        "data/coefficients/fitted.json": False,
    }
    for name, same in changes.items():
        before = seal.tree_hash(tmp_path)
        (tmp_path / name).write_text("2" + name)
        assert (seal.tree_hash(tmp_path) == before) is same, name
    assert seal.tree_hash(tmp_path) != first


def test_lists_have_the_promised_numbers():
    entries = lists.full()
    kinds = [e.kind for e in entries]
    assert kinds.count("null") == 150
    assert kinds.count("outside") == 80
    assert kinds.count("pair") == 45
    assert kinds.count("single") == 15 * 19
    assert len(lists.small()) <= 12
    assert len({e.name for e in entries}) == len(entries)


def test_seed_follows_tree_and_number():
    a, b = Entry(3, "null"), Entry(4, "null")
    one = lists.seed_of("aa", a).random()
    assert one == lists.seed_of("aa", a).random()
    assert one != lists.seed_of("ab", a).random()
    assert one != lists.seed_of("aa", b).random()


def test_run_goes_on_where_it_stopped(tmp_path, monkeypatch):
    entries = [Entry(k, "null") for k in range(3)]
    monkeypatch.setitem(lists.LISTS, "small", lambda: entries)
    seen = []

    def stand_in(folder, out, limit_s):
        assert sorted(p.name for p in folder.iterdir()) == ["set.toml", "trials.csv"]
        assert not list(out.parent.rglob("truths"))
        seen.append(folder.name)
        out.mkdir()
        (out / "verdict.json").write_text(json.dumps({"verdict": "adequate"}))
        return apart.Answer(0, "", 1.0)

    monkeypatch.setattr(run, "answer", stand_in)
    monkeypatch.setattr(run, "tree_hash", lambda root: "ab" * 32)
    with ThreadPoolExecutor(2) as threads:
        assert len(list(run.carry_on(tmp_path, "small", threads, most=2))) == 2
        assert run.verdicts_of(tmp_path) == 2
        assert len(list(run.carry_on(tmp_path, "small", threads, at_once=2))) == 1
    assert sorted(seen) == ["set-0000", "set-0001", "set-0002"]
    cases = open_run(tmp_path)
    found = {s.name: s for s in score.scores(cases)}
    right, off = (
        found[f"false alarms on nulls, metal {m}"] for m in ("as the law", "3 to 8 % off")
    )
    assert right.hits + off.hits == 0
    assert right.of + off.of == 3
    assert {right.state, off.state} <= {"not shown", "no cases"}


def test_a_run_goes_on_with_its_own_plan_alone(tmp_path, monkeypatch):
    monkeypatch.setitem(lists.LISTS, "small", lambda: [Entry(k, "null") for k in range(2)])
    monkeypatch.setattr(run, "tree_hash", lambda root: "ab" * 32)
    monkeypatch.setattr(run, "answer", lambda *_: apart.Answer(1, "stand-in", 1.0))
    monkeypatch.setattr(run, "PLAN", tmp_path / "plan.md")
    ledger = seal.Ledger(tmp_path / "run" / "ledger.jsonl")

    def step(plan, most):
        run.PLAN.write_text(plan)
        with ThreadPoolExecutor(1) as threads:
            return len(list(run.carry_on(tmp_path / "run", "small", threads, most=most)))

    # before the first set a plan may still change; the last one counts
    assert (step("draft", 0), step("plan\n", 0)) == (0, 0)
    assert [e["event"] for e in ledger.events()] == ["plan", "begin", "plan"]
    assert step("plan\n", 1) == 1
    assert run.plan_of(ledger) == hashlib.sha256(b"plan\n").hexdigest()
    assert run.plan_of(ledger) == seal.digest_of(run.PLAN)
    with pytest.raises(InputError, match="the plan changed after the first set was drawn"):
        step("other", 1)
    # one put in later is not the plan
    ledger.add(event="plan", set="", plan="0" * 64)
    assert step("plan\n", 1) == 1


def case(name, kind, true, verdict, size=15.0):
    effects = [{"name": t, "form": "swadener", "numbers": {"length": 1e-4}} for t in true]
    truth = {
        "kind": kind, "mechanisms": list(true), "effects": effects, "sizes": [size] * len(true),
        "bench": "b", "family": "cavity",
    }  # fmt: skip
    return Case(name, truth, verdict, {"cpu_s": 1.0, "message": ""})


def test_scores_count_what_they_say():
    right = {
        "verdict": "missing-physics", "mechanisms": ["size-effect"], "alternatives": [],
        "parameters": {"size_length_m": {"low": 0.5e-4, "high": 2e-4}},
        "improvement": {"held_out_baseline": 3.0, "held_out_extended": 1.0},
        "probabilities": {"size-effect": 0.99, "baseline": 0.01},
    }  # fmt: skip
    wrong = right | {"mechanisms": ["roughness"], "alternatives": [["size-effect"]]}
    wrong["verdict"] = "indistinguishable"
    cases = [
        case("a", "single", ["size-effect"], right, 30.0),
        case("b", "single", ["size-effect"], wrong),
        case("c", "single", ["size-effect"], {"verdict": "adequate"}),
        case("d", "null", [], {"verdict": "outside-library"}),
        case("e", "outside", [], right),
        case("f", "single", ["size-effect"], {}),
    ]
    found = {s.name: s for s in score.scores(cases)}
    assert (found["detected, size above 10"].hits, found["detected, size above 10"].of) == (2, 4)
    assert found["right name first, of those named"].hits == 1
    assert found["truth in the reported set"].hits == 2
    assert found["false alarms on nulls, metal as the law"].hits == 1
    assert found["false alarms on nulls, metal 3 to 8 % off"].of == 0
    assert found["forced name, outside the library"].hits == 1
    assert found["undetermined or failed"].hits == 1
    assert found["90 % intervals cover"].of == 1
    falls = found["rms of left-out trials falls by, median above size 20"]
    assert falls.value == pytest.approx(3.0)
    assert found["mean size of the set"].value == pytest.approx(1.5)
    table = score.confusion(cases)
    assert table["size-effect"] == {"size-effect": 1, "roughness": 1, "adequate": 1,
                                    "undetermined": 1}  # fmt: skip
    text = page.page(
        [page.summary(cases, which="full", tree="ab" * 32, date="2020-01-01", total=9)]
    )
    assert "| false alarms on nulls, metal as the law | 100.0 % (1 of 1) |" in text


def test_inclusion_is_counted_mechanism_by_mechanism():
    said = {"verdict": "adequate", "inclusion": {"size-effect": 0.9, "roughness": 0.1}}
    cases = [case("a", "single", ["size-effect"], said), case("b", "null", [], said)]
    low, high = calibrated.inclusion(cases)
    assert low[2:] == (0.1, 0, 2)
    assert high[2:] == (0.9, 1, 2)
    # 0.1 against 0 of 2 and 0.9 against 1 of 2
    assert calibrated.calibration_error(cases) == pytest.approx(0.5 * 0.1 + 0.5 * 0.4)


def can(kind, change="ball at some speed", striker="ball", **trial):
    given = {"change": change, "kind": kind, "trial": {"striker": striker, **trial}}
    found = case("a", "null", [], {"next_experiment": given})
    found.truth.update(strikers=["ball"], speeds=[0.5, 3.0], angles=[1.5708, 1.5708])
    return score.feasible(found)


def test_a_next_experiment_outside_the_rig_cannot_be_done():
    shot = {"speed_m_s": 2.0, "angle_deg": 90.0}
    assert can("trial", **shot)
    assert not can("trial", speed_m_s=12.0, angle_deg=90.0)
    assert not can("trial", striker="another", **shot)
    assert not can("trial", speed_m_s=2.0, angle_deg=45.0)
    assert can("build", "build a ball like ball with a radius of 18 mm", "another", **shot)
    assert not can("build", striker="another", **shot)
    assert can("noise", speed_m_s=99.0, angle_deg=90.0)
    assert can("weigh", speed_m_s=0.0, angle_deg=90.0)
    # a press needs a striker of the rig and a load of a bench
    assert can("press", load_N=880.0, repeats=3.0)
    assert not can("press", striker="another", load_N=880.0, repeats=3.0)
    assert not can("press", load_N=30e3, repeats=3.0)
    assert not can("press", load_N=1.0, repeats=3.0)


def test_the_first_place_counts_if_the_truth_shows_there_nearly_most():
    places = [["restitution", "impact speed", 10.0], ["restitution", "overall", 8.5],
              ["permanent_depth_m", "overall", 3.0]]  # fmt: skip

    def right(observable, covariate):
        said = {"located": [{"observable": observable, "covariate": covariate}]}
        found = case("a", "single", ["size-effect"], {"verdict": "adequate", **said})
        found.truth["places"] = places
        table = {s.name: s for s in score.scores([found])}
        return table["first place of the mismatch right, size above 10"].hits

    assert right("restitution", "impact speed") == 1
    assert right("restitution", "overall") == 1
    assert right("permanent_depth_m", "overall") == 0


def test_interval_is_clopper_and_pearsons():
    # 2 of 20: Newcombe, Stat. Med. 17 (1998) 857 uses the same method; table of Diem and Lentner
    low, high = interval(2, 20)
    assert low == pytest.approx(0.0123, abs=1e-4)
    assert high == pytest.approx(0.3170, abs=1e-4)


def test_state_needs_the_whole_interval():
    def hits(n, of, **marks):
        chosen = [case(str(k), "null", [], {}) for k in range(of)]
        return score.share("x", chosen, lambda c: int(c.name) < n, **marks).state

    assert hits(0, 100, most=0.05) == "met"
    assert hits(2, 100, most=0.05) == "not shown"
    assert hits(30, 100, most=0.05) == "missed"
    assert hits(100, 100, least=0.9) == "met"
    assert np.isnan(score.share("x", [], bool).value)


def tilted(name, size, verdict, kind="single"):
    found = case(name, kind, ["tilt"], verdict, size)
    found.truth["effects"] = []
    return found


TILT = {"verdict": "missing-physics", "mechanisms": ["tilt"]}
WRONG = {"verdict": "missing-physics", "mechanisms": ["roughness"]}
CASES = [
    tilted("a", 3.0, {"verdict": "adequate"}), tilted("b", 12.0, {"verdict": "undetermined"}),
    tilted("c", 14.0, WRONG), tilted("d", 20.0, TILT), tilted("e", 90.0, TILT),
    # only sets with one effect have a size of their own
    tilted("f", 12.0, TILT, "pair"), tilted("g", float("nan"), TILT),
]  # fmt: skip


def test_sets_are_counted_by_the_size_of_their_effect():
    found = power.by_size(power.shown(CASES))
    assert found == [
        (0.0, 5.0, 0, 0, 1), (10.0, 20.0, 1, 0, 2), (20.0, 40.0, 1, 1, 1),
        (40.0, float("inf"), 1, 1, 1),
    ]  # fmt: skip


def test_the_page_of_a_kept_run_has_plan_power_and_rules(tmp_path):
    sure = {"verdict": "missing-physics", "names": [["tilt"]], "odds": {"tilt": 0.9}}
    none = {"verdict": "adequate", "names": [], "odds": {"baseline": 0.84}}
    peers = [
        {"set": c.name, "truth": ["tilt"], "acting": 2, "source": "s",
         "said": {"diagnosis": sure, "BIC": none}, "seconds": {"diagnosis": 8.0, "rules": 2.0}}
        for c in CASES
    ]  # fmt: skip
    entry = page.summary(
        CASES, which="full", tree="ab" * 32, date="2020-01-01", total=7, peers=peers, plan="cd" * 32
    )
    runs = page.keep(entry, tmp_path / "runs.json")
    assert runs == [entry]
    kept = json.loads((tmp_path / "runs.json").read_text())
    page.publish(kept, tmp_path)
    text = (tmp_path / "proof.md").read_text()
    assert "The [plan](proof-plan.md), SHA-256 `cdcdcdcdcdcd`, was sealed" in text
    row = "| 10 to 20 | 2 | 0.50 (0.01 to 0.99) | 0.00 (0.00 to 0.84) |"
    assert row in (tmp_path / "proof-details.md").read_text()
    assert "| less | in front, points |" in text
    assert "| BIC | 100.0 (100.0 to 100.0) | 0.016 | 6.11 (6.11 to 6.11) |" in text
    assert "Primary mark, 4 points in front: met. 0.2 in mean ln p: met." in text
    assert "| false alarms on nulls | detected, size above 10 |" in text
    assert (tmp_path / "pictures" / power.PICTURE).stat().st_size > 10_000
