"""A named flow of the metal, taken back to the finite elements."""

from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import InputError, Material, Pair
from dentscope.discrepancy import MECHANISMS
from dentscope.discrepancy.comparison.forward import Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.inference.fit import fit
from dentscope.recordings import read
from dentscope.start.closing import close, closed_lines, write_closed
from dentscope.start.metal_press import _clock, _flowing
from dentscope.studies.proof.generators import truth
from dentscope.studies.proof.generators.folder import write_set

STEEL = Material(E=200e9, nu=0.3, Sy=300e6)
HARD = Material(E=200e9, nu=0.3, Sy=2e9)


def test_the_inferred_constants_are_those_of_ludwik_and_of_cowper_and_symonds():
    constants = {
        "work-hardening": {"hardening_ratio": 0.8, "hardening_exponent": 0.4},
        "strain-rate-hardening": {
            "rise_at_1000_per_s": 1.5, "rate_exponent": 0.2, "strength_kept": 0.5,
        },
    }  # fmt: skip
    stated = Pair(HARD, STEEL, 5e-3)
    pair = _flowing(stated, stated, constants)
    assert pair.sphere is HARD
    # Tabor's strain of a contact of a/R = 0.1
    assert pair.flat.flow.curve(0.02) == pytest.approx(300e6 * (1.0 + 0.8 * 0.02**0.4), rel=1e-4)
    rate = pair.flat.flow.rate
    assert rate.law == "cowper-symonds"
    assert (1000.0 / rate.reference) ** (1.0 / rate.number) == pytest.approx(1.5)


def test_the_clock_stops_where_the_striker_does():
    depth, speed = np.array(_clock(0.02, 3.0)).T
    assert depth[0] == 0.0
    assert depth[-1] == 0.02
    assert speed[0] == 3.0
    assert np.all(np.diff(speed) <= 0.0)
    # a linear force: half the energy is left at 1/sqrt(2) of the depth
    assert np.interp(0.02 / np.sqrt(2.0), depth, speed) == pytest.approx(
        3.0 / np.sqrt(2.0), rel=0.02
    )


def named(folder, name):
    """What `close` asks of a verdict, without the nulls and rivals that it does not."""
    problem = problem_of(read(folder))
    base = fit(Simulator(problem), ())
    best = fit(Simulator(problem), ([m for m in MECHANISMS if m.name == name]), start=base)
    return verdict_of(best, problem=problem, base=base)


def verdict_of(best, **ranking):
    return SimpleNamespace(name="set", best=best, ranking=SimpleNamespace(**ranking),
                           choice=SimpleNamespace(members=(best,)))  # fmt: skip


@pytest.mark.fe
def test_a_metal_that_hardens_goes_back_to_the_finite_elements(tmp_path):
    """Recordings of the proof's own generator: Voce's law in a row of yielding springs."""
    case = truth.draw(np.random.default_rng([21, 23]), "single", name="work-hardening")
    write_set(case, tmp_path / "set", name="set")
    verdict = named(tmp_path / "set", "work-hardening")
    closed = close(verdict, accuracy=fem.Accuracy.smoke())
    assert len(closed.rows) == len(verdict.ranking.problem.cells)
    # constants from the slower conditions say more of the fastest than no mechanism does
    out = {which: closed.miss(which, kept_out=True) for which in ("baseline", "closed_form")}
    assert out["closed_form"] < 0.7 * out["baseline"]
    # Tabor's strain stands for the strains of the elements: to the closed form's error and smoke's
    for row in closed.rows:
        near = 0.05 if row.observable == "restitution" else 0.12
        assert row.finite_elements == pytest.approx(row.closed_form, abs=near), row
    told = "\n".join(closed_lines(closed))
    assert "kept out: baseline" in told
    csv, law = write_closed(closed, tmp_path)
    assert len(csv.read_text().splitlines()) == len(closed.rows) + 1
    assert law.name == "law.json"


def test_what_the_finite_elements_do_not_carry_is_refused():
    best = SimpleNamespace(mechanisms=(SimpleNamespace(name="tilt"),), names=("tilt",))
    with pytest.raises(InputError, match="names tilt"):
        close(verdict_of(best, problem=None))
