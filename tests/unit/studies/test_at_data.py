"""Draws from the posterior at a set, and both recordings fitted together."""

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
from dentscope.studies import at_data

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


def test_draws_go_on_where_they_stopped(tmp_path, monkeypatch) -> None:
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
