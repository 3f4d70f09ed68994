"""Figures 3.13 and 3.14: the thesis's "less than 10 % mean absolute error", for each mass reading.

Measured values are the four that the thesis prints: 42 and 118 um at 0.20 and 1.43 m, 0.56 and 0.49
at 0.2 and 1.3 m (text on figures 3.11 and 3.12).
"""

import pytest
from dentscope.models import law_named
from dentscope.studies.thesis import chapter3
from dentscope.studies.thesis.figures.chapter3 import MASSES, mean_deviation

UPDATED = [
    f"{name}+ghaednia" for name in ("jackson-green-2007", "kogut-etsion", "kogut-komvopoulos")
]


@pytest.fixture(scope="module")
def bench():
    return chapter3.bench()


@pytest.mark.parametrize("name", [*UPDATED, "ghaednia"])
@pytest.mark.parametrize("mass", [0.33, 0.345])
def test_statement_holds_with_the_mass_that_fits(bench, name, mass):
    law = law_named(name)
    for observable in ("residual_depth", "restitution"):
        assert mean_deviation(bench, law, mass=mass, observable=observable) < 0.10


@pytest.mark.parametrize("mass", MASSES)
def test_restitution_of_every_updated_law_holds_for_every_mass(bench, mass):
    for name in UPDATED:
        off = mean_deviation(bench, law_named(name), mass=mass, observable="restitution")
        assert off < 0.10


def test_dents_do_not_come_out_with_the_printed_mass_nor_with_that_of_the_size(bench):
    """11 to 12 % for the two laws that the thesis names, a third with 0.151 kg."""
    for name in UPDATED[:2]:
        printed = mean_deviation(bench, law_named(name), mass=0.255, observable="residual_depth")
        assert 0.10 < printed < 0.13
    for name in UPDATED:
        off = mean_deviation(bench, law_named(name), mass=0.151, observable="residual_depth")
        assert off > 0.28
