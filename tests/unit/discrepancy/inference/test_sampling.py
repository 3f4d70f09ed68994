"""Sampled evidence where the algebra is exact: linear cells, an error of three sizes, a window."""

from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.inference.fit import fit, sharpened
from dentscope.discrepancy.inference.sampling import sampled_evidence

RISING = tuple(8.0 * (k - 3.5) for k in range(8))


@pytest.mark.parametrize("narrow", [False, True])
def test_it_is_that_of_the_algebra(toy, narrow) -> None:
    derivative = np.stack([np.ones(8), np.linspace(-2.0, 2.0, 8) ** 2], axis=1)
    data = 0.5 * np.array(RISING) + 1.5 * derivative[:, 1]
    one_sized = SimpleNamespace(freedom=np.ones(1), count=1, parts={}, rows={})
    simulator = toy.Simulator(toy.problem(data, derivative=derivative, error=one_sized))
    found = fit(simulator, (toy.Effect("rising", RISING),))
    assert len(found.mixture.parts) == 3
    if narrow:
        found = sharpened(simulator, found)
        assert found.grid.log_volume < 0.0
    sampled = sampled_evidence(simulator, found, np.random.default_rng(0))
    assert sampled == pytest.approx(found.log_evidence, abs=0.05)
