"""Where truths lie in their posteriors; draws at a set, and both recordings fitted together."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.comparison.forward import Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.inference.derivatives import derivatives
from dentscope.discrepancy.inference.fit import fit
from dentscope.discrepancy.rank import sharpened_leading
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.recordings import read
from dentscope.recordings.shipped import FOLDER
from dentscope.studies import at_data, calibration
from dentscope.studies.proof.ranks import at_data_lines, rank_lines, uniformity
from scipy.stats import norm


def lines(shares: np.ndarray) -> list[dict]:
    return [
        {"mechanism": "tilt", "draw": k, "shares": {"tilt_deg": float(x), "target.Sy_Pa": 0.5}}
        for k, x in enumerate(shares)
    ]


def test_a_posterior_that_is_too_narrow_is_seen_and_told() -> None:
    """Where the stated spread is half of the true one, shares heap up at the ends."""
    z = np.random.default_rng(0).normal(size=200)
    shares = lines(norm.cdf(2.0 * z))
    right, narrow = (uniformity(some)[0] for some in (lines(norm.cdf(z)), shares))
    assert right[:3] == ("tilt", "tilt_deg", 200)
    assert right.inside == pytest.approx(0.9, abs=0.05)
    assert right.p > 0.05
    assert narrow.inside < 0.7
    assert narrow.corrected < 0.01
    assert any("`tilt_deg` of tilt" in x for x in rank_lines(shares))
    (told, *_) = at_data_lines([x | {"set": "here"} for x in shares])
    assert f"here (tilt) `tilt_deg` {narrow.inside:.2f}*, `target.Sy_Pa` 1.00*" in told


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


SET = "kharaz-2001-oblique"


@pytest.fixture(scope="module")
def simulator():
    return Simulator(problem_of(read(FOLDER / SET)))


@pytest.fixture(scope="module")
def leading(simulator):
    chosen = tuple(m for m in MECHANISMS if m.name in at_data.LEADING[SET])
    return sharpened_leading(simulator, [fit(simulator, chosen)], fit(simulator, ()))[0]


def test_two_recordings_have_half_the_noise(simulator) -> None:
    """But what errors of the form add, no repeat averages away."""
    z = np.zeros(simulator.problem.n_z)
    _, once = derivatives(simulator, (), {}, z)
    _, twice = derivatives(simulator.of(at_data.twice(simulator.problem)), (), {}, z)
    assert np.allclose(twice.noise, 0.5 * once.noise, rtol=1e-9)
    assert np.allclose(twice.J, once.J)


def test_draws_are_as_wide_as_the_posterior(simulator, leading) -> None:
    """The friction is known to a tenth of what the sheet leaves open; recordings follow it."""
    rng = np.random.default_rng(0)
    draws = [at_data.draw(simulator, leading, rng) for _ in range(40)]
    k = [n.name for n in simulator.problem.nuisances].index("friction.coefficient")
    z, spread = np.array([d.z[k] for d in draws]), np.sqrt(leading.covariance[k, k])
    assert np.mean(z) == pytest.approx(leading.z[k], abs=4.0 * spread / np.sqrt(len(z)))
    assert np.std(z) == pytest.approx(spread, rel=0.4)
    away = np.array([d.value - simulator.problem.cells.value for d in draws])
    sure = np.sqrt(np.diag(leading.linear.noise))
    assert 0.7 < np.sqrt(np.mean((away / sure) ** 2)) < 2.0
    shares = at_data.ranks(simulator, leading, rng)
    assert 0.0 < shares["tangential_stiffness_ratio"] < 1.0


def test_draws_at_a_set_go_on_where_they_stopped(tmp_path, monkeypatch) -> None:
    ranking = SimpleNamespace(
        problem=None, fits=[SimpleNamespace(names=n, name="+".join(n)) for n in LEADING.values()]
    )
    monkeypatch.setattr(at_data, "read", lambda place: place.name)
    problem = SimpleNamespace(wrong_numbers=())
    monkeypatch.setattr(at_data, "problem_of", lambda read: problem)
    monkeypatch.setattr(at_data, "rank", lambda simulator, mechanisms: ranking)
    monkeypatch.setattr(at_data, "with_pairs", lambda simulator, ranking: ranking)
    monkeypatch.setattr(at_data, "ranks", lambda simulator, found, rng: {"k": rng.random()})
    out = tmp_path / "ranks.jsonl"
    whole = list(at_data.lines(out, 2, LEADING))
    assert [(x["set"], x["draw"]) for x in whole] == [(n, k) for n in LEADING for k in (0, 1)]
    assert whole[-1]["mechanism"] == "strain-rate-hardening+rod-flexural-vibration"
    out.write_text("".join(json.dumps(x) + "\n" for x in whole[:3]))
    assert list(at_data.lines(out, 2, LEADING)) == whole[3:]


LEADING = at_data.LEADING
