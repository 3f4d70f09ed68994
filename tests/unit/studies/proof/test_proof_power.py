"""Detection and right name against size, on cases that can be counted by hand."""

import json

from dentscope.studies.proof import page, power
from dentscope.studies.proof.case import Case


def case(name, size, verdict, *, kind="single"):
    truth = {"kind": kind, "mechanisms": ["tilt"], "sizes": [size], "effects": [],
             "bench": "b", "family": "cavity"}  # fmt: skip
    return Case(name, truth, verdict, {"cpu_s": 1.0, "message": ""})


RIGHT = {"verdict": "missing-physics", "mechanisms": ["tilt"]}
WRONG = {"verdict": "missing-physics", "mechanisms": ["roughness"]}
CASES = [
    case("a", 3.0, {"verdict": "adequate"}), case("b", 12.0, {"verdict": "undetermined"}),
    case("c", 14.0, WRONG), case("d", 20.0, RIGHT), case("e", 90.0, RIGHT),
    # only sets with one effect have a size of their own
    case("f", 12.0, RIGHT, kind="pair"), case("g", float("nan"), RIGHT),
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
