"""The drag curve of a sphere against other people's numbers."""

import math

import pytest
from dentscope.core.drag import HIGHEST_REYNOLDS, air, drag_coefficient, drag_force
from numba import njit

CURVES = {
    # computed by the library fluids (C. Bell) with its own code for the same table
    1e-6: {0.002: 12000.1875, 0.5: 51.538273834491875, 50.0: 1.5742657203722197,
           500.0: 0.5549240285782678, 2500.0: 0.40817983162668914, 4e4: 0.4639066546786017,
           7.5e4: 0.49399935325010037, 3.4e5: 0.4631617396760497},
    # Navier-Stokes, steady: B. Fornberg, J. Fluid Mech. 190 (1988); unsteady: T. A. Johnson,
    # V. C. Patel, J. Fluid Mech. 378 (1999)
    0.01: {100.0: 1.085, 300.0: 0.656},
    # measured: Lapple and Shepherd (1940), the table of Perry's handbook
    0.06: {0.1: 240.0, 1.0: 26.5, 10.0: 4.1, 100.0: 1.07, 1e3: 0.46, 3e3: 0.40, 1e4: 0.405,
           3e4: 0.47, 1e5: 0.48},
}  # fmt: skip


@pytest.mark.parametrize(
    ("within", "reynolds", "theirs"),
    [(w, *row) for w, rows in CURVES.items() for row in rows.items()],
)
def test_the_curve_is_that_of_others(within, reynolds, theirs):
    assert drag_coefficient(reynolds) == pytest.approx(theirs, rel=within)


def test_oseen_at_creeping_flow():
    # C. W. Oseen (1910): C_D = 24/Re (1 + 3 Re/16)
    reynolds = 0.02
    oseen = 24.0 / reynolds * (1.0 + 3.0 * reynolds / 16.0)
    assert drag_coefficient(reynolds) == pytest.approx(oseen, rel=2e-3)
    v, d, mu = 1e-4, 1e-4, 1e-3
    assert drag_force(v, d, 1000.0, mu) == pytest.approx(3 * math.pi * mu * d * v, rel=3e-3)


def test_pieces_meet_and_force_is_odd():
    for edge in (0.01, 20.0, 260.0, 1.5e3, 1.2e4, 4.4e4, HIGHEST_REYNOLDS, 1e6):
        below, above = drag_coefficient(edge * (1 - 1e-9)), drag_coefficient(edge * (1 + 1e-9))
        assert below == pytest.approx(above, rel=0.015)
    assert drag_force(0.0, 0.04, 1.2, 1.8e-5) == 0.0
    assert drag_force(-3.0, 0.04, 1.2, 1.8e-5) == -drag_force(3.0, 0.04, 1.2, 1.8e-5)


def test_air_of_the_standard_atmosphere():
    # U.S. Standard Atmosphere 1976, tables at sea level and at 5 km (255.676 K, 54048 Pa)
    assert air(288.15, 101325.0) == pytest.approx((1.2250, 1.7894e-5), rel=1e-4)
    assert air(255.676, 54048.0) == pytest.approx((0.73643, 1.6282e-5), rel=1e-4)


def test_compiled_code_may_call_it():
    compiled = njit(lambda v: drag_force(v, 0.04, 1.2, 1.8e-5))
    assert compiled(3.0) == pytest.approx(drag_force(3.0, 0.04, 1.2, 1.8e-5), rel=1e-12)
