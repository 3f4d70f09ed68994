"""Where truths lie in their posteriors, on a problem small enough to know."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.studies import calibration
from dentscope.studies.proof.ranks import at_data_lines, rank_lines, uniformity
from scipy.stats import norm


def lines(shares: np.ndarray) -> list[dict]:
    return [
        {"mechanism": "tilt", "draw": k, "shares": {"tilt_deg": float(x), "target.Sy_Pa": 0.5}}
        for k, x in enumerate(shares)
    ]


def test_a_posterior_that_is_too_narrow_is_seen() -> None:
    """Where the stated spread is half of the true one, shares heap up at the ends."""
    z = np.random.default_rng(0).normal(size=200)
    right, narrow = (uniformity(lines(norm.cdf(times * z)))[0] for times in (1.0, 2.0))
    assert right[:3] == ("tilt", "tilt_deg", 200)
    assert right.inside == pytest.approx(0.9, abs=0.05)
    assert right.p > 0.05
    assert narrow.inside < 0.7
    assert narrow.corrected < 0.01
    assert any("`tilt_deg` of tilt" in x for x in rank_lines(lines(norm.cdf(2.0 * z))))


def test_sets_are_told_with_what_their_posteriors_hold() -> None:
    z = np.random.default_rng(0).normal(size=200)
    narrow = [x | {"set": "here"} for x in lines(norm.cdf(2.0 * z))]
    inside = uniformity(narrow)[0].inside
    assert f"here (tilt) `tilt_deg` {inside:.2f}*, `target.Sy_Pa` 1.00*" in at_data_lines(narrow)[0]


def test_correction_is_for_the_number_of_tests() -> None:
    """Two of each of two parameters."""
    shares = [(0.01 * k, 0.5 + 0.005 * k) for k in range(60)]
    rows = uniformity([
        {"mechanism": "tilt", "draw": k, "shares": {"tilt_deg": a, "target.Sy_Pa": b}}
        for k, (a, b) in enumerate(shares)
    ])  # fmt: skip
    assert [r.corrected for r in rows] == pytest.approx([min(4.0 * r.p, 1.0) for r in rows])
    assert rows[1].corrected < 0.01


def test_draws_go_on_where_they_stopped(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(calibration, "read", lambda place: place.name)
    monkeypatch.setattr(calibration, "problem_of", lambda read: read)
    monkeypatch.setattr(calibration, "Simulator", lambda problem: SimpleNamespace(problem=problem))
    monkeypatch.setattr(
        calibration, "ranks", lambda simulator, name, rng: {simulator.problem: rng.random()}
    )
    out = tmp_path / "ranks.jsonl"
    whole = list(calibration.drawn(tmp_path, out, 2))
    assert [(x["mechanism"], x["draw"]) for x in whole] == [
        (name, k) for name in calibration.BENCHES for k in (0, 1)
    ]
    out.write_text("".join(json.dumps(x) + "\n" for x in whole[:3]))
    assert list(calibration.drawn(tmp_path, out, 2)) == whole[3:]
