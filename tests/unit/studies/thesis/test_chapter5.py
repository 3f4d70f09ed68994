"""The demonstration on the thesis's three oblique drops, at literature constants."""

import numpy as np
import pytest
from dentscope.discrepancy.mechanisms import MECHANISMS
from dentscope.studies.thesis.demonstration import demonstrate, table


@pytest.fixture(scope="module")
def found():
    return demonstrate()


def test_every_mechanism_that_leaning_rods_can_have_is_tried(found):
    tried = {name for row in found.rows for name in row.name.split("+")}
    published = {m.name for m in MECHANISMS if m.literature}
    assert {"strain-rate-hardening", "rod-flexural-vibration", "tilt"} <= tried - {"baseline"}
    assert tried - {"baseline"} <= published


def test_table_ranks_every_single_and_pair(found):
    names = [row.name for row in found.rows]
    singles = [n for n in names if "+" not in n and n != "baseline"]
    assert "baseline" in names
    assert len(names) == 1 + len(singles) + len(singles) * (len(singles) - 1) // 2
    misses = [row.miss for row in found.rows]
    assert misses == sorted(misses)
    assert np.isfinite(np.stack([row.predicted for row in found.rows])).all()
    assert any("What remains" in line for line in table(found))


def test_ranking_follows_the_angles(found):
    order = [row.name for row in found.rows]
    assert all(list(names) != order for names in found.permuted)
