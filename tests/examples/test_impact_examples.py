"""The impact examples run and show what they say."""

from __future__ import annotations

import runpy
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_oblique_rod() -> None:
    found = runpy.run_path(str(EXAMPLES / "ex03_impact_oblique.py"))["main"]()
    rigid, vibrating = found[0], found[10]
    assert rigid.contacts == 1
    # The bar's vibration brings several contacts and halves the dent (Stoianovici, Hurmuzlu 1996).
    assert vibrating.contacts > 1
    assert vibrating.residual_flat_m < 0.6 * rigid.residual_flat_m
    assert abs(vibrating.energy_residual) < 1e-6
