"""The demonstration on the thesis's three oblique drops, with few draws."""

import math

import numpy as np
import pytest
from dentscope.core.material import Material
from dentscope.dynamics import Approach, Striker, scene_of, strike
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.models import LAWS
from dentscope.studies.thesis.demonstration import BENDING, RATE, demonstrate
from dentscope.studies.thesis.demonstration_report import draw, table
from dentscope.studies.thesis.later_touch import later_touch
from dentscope.studies.thesis.uncertain import RANGES, draw_rods

DRAWS = 12


@pytest.fixture(scope="module")
def found():
    return demonstrate(draws=DRAWS, screening=4)


def test_the_measurements_are_the_thesiss(found):
    # Tables 5.2-5.4, and 5.3 for what the length is
    assert found.measured.names == (
        "restitution", "permanent_depth_m", "friction_impulse_ratio", "scar_excess_m",
    )  # fmt: skip
    np.testing.assert_allclose(found.measured.angles, [20.0, 45.0, 70.0])
    np.testing.assert_allclose(found.measured.value[:, 3], [1400e-6, 1650e-6, 200e-6])
    assert (found.measured.std[:, 3] >= 100e-6).all()


def test_singles_pairs_and_triples_of_published_mechanisms_are_ranked(found):
    names = [row.name for row in found.ranked]
    tried = {one for name in names for one in name.split("+")} - {"baseline"}
    assert {RATE, BENDING, "tilt"} <= tried <= {m.name for m in MECHANISMS if m.literature}
    n = len(tried)
    # what holds another mechanism stands for both
    assert (
        len(names) == len(set(names)) == 1 + n + (math.comb(n, 2) - 1) + (math.comb(n, 3) - (n - 2))
    )
    misfits = [row.misfit for row in found.ranked]
    assert misfits == sorted(misfits)
    assert np.isfinite(misfits).all()


def test_bending_and_rate_against_an_independent_simulation(found):
    """Its 5-95 % bands [um, um, -]: bending, axial modes, memory, Cowper-Symonds; none is ours."""
    theirs = np.array(
        [
            [[12, 27], [-33, 192], [0.62, 0.69]],
            [[27, 58], [410, 722], [0.63, 0.71]],
            [[99, 199], [24, 100], [0.15, 0.52]],
        ]
    )
    row = next(r for r in found.shown if r.name == f"{RATE}+{BENDING}")
    low, high = row.band()
    for k, name in enumerate(("permanent_depth_m", "scar_excess_m", "restitution")):
        j = found.measured.names.index(name)
        scale = 1.0 if name == "restitution" else 1e6
        assert (scale * low[:, j] <= theirs[:, k, 1]).all(), name
        assert (scale * high[:, j] >= theirs[:, k, 0]).all(), name


def test_rank_follows_the_measurements(found):
    base = next(r for r in found.ranked if r.name == "baseline")
    both = next(r for r in found.ranked if r.name == f"{RATE}+{BENDING}")
    # the rigid, rate-free rod makes dents two and a half times too deep
    depth = found.measured.names.index("permanent_depth_m")
    assert np.all(base.z[:, depth] < -5.0)
    assert both.misfit < 0.3 * base.misfit


def test_table_and_picture_say_what_remains(found, tmp_path):
    lines = table(found)
    text = "\n".join(lines)
    assert "does not explain" in text
    assert "A later contact" in text
    for name in RANGES:
        assert name in text
    draw(found, tmp_path / "chapter5.png")
    assert (tmp_path / "chapter5.png").stat().st_size > 20_000


def test_draws_fill_their_ranges_and_repeat():
    rods = draw_rods(50, 3, seed=4)
    assert rods == draw_rods(50, 3, seed=4)
    mass = np.array([rod.mass for rod in rods])
    known = RANGES["mass [kg]"]
    # one draw in every fiftieth of the range
    np.testing.assert_array_equal(
        np.sort(((mass - known.low) / (known.high - known.low) * 50).astype(int)), np.arange(50)
    )
    # 1 + (r/D)^(1/q) at r = 1000/s
    for rod in rods[:5]:
        assert rod.hardening["rise_at_1000_per_s"] == pytest.approx(
            (1000.0 / rod.rate) ** (1.0 / rod.exponent)
        )


def test_an_upright_rod_falls_back_on_its_mark():
    steel = Material(E=200e9, nu=0.3, Sy=760e6, density=7800.0)
    iron = Material(E=200e9, nu=0.3, Sy=305e6, density=7870.0)
    rod = Striker(mass=0.5, tip_radius=0.0088, length=0.3, radius=0.0088)
    scene = scene_of(
        LAWS["fitted"], sphere=steel, flat=iron, striker=rod,
        approach=Approach(1.0, math.radians(89.9999)),
    )  # fmt: skip
    first = strike(scene)
    later = later_touch(scene)
    # thrown up at e v it is back after 2 e v / g with the same speed
    assert later.time == pytest.approx(2.0 * first.restitution / 9.81, abs=2e-4)
    assert later.speed == pytest.approx(first.restitution, rel=2e-2)
    assert later.overlaps
    assert math.isnan(later.other_first)
    assert later.second.residual_flat_m == pytest.approx(first.residual_flat_m, rel=0.05)
