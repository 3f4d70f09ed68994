"""A perfectly plastic sphere on a rigid flat, against the published fits of finite elements."""

from __future__ import annotations

import math
import warnings

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....core.arrays import Array, Mask
from ....core.material import Material, Pair
from ....models.published.hardness import jackson_green_2007
from ....models.published.jackson_green import JACKSON_GREEN
from ..bench import Bench, Effort
from ..curves import smoothed
from ..pairs import RIGID, R
from ..result import Cell, Measurement, Result, Table

_STEEL = Material(E=200e9, nu=0.32, Sy=619e6)
_DEEPEST = 0.05
_AT = (2.0, 6.0, 20.0, 50.0, 110.0, 200.0, 400.0)


def run(bench: Bench) -> Result:
    """Solve one flattening and compare force and contact radius over depth."""
    pair = Pair(sphere=_STEEL, flat=RIGID, R=R)
    accuracy = fem.Accuracy.smoke() if bench.effort is Effort.QUICK else fem.Accuracy.quick()
    depths = fem.geometric_depths(pair.first_yield, _DEEPEST, 70)
    solved = bench.solve(Case("published-flattening", fem.ContactProblem(pair, depths), accuracy))
    delta = solved["delta"]
    force, a = (np.exp(smoothed(delta, np.log(solved[n]))) for n in ("force", "radius"))
    w = delta / (pair.first_yield * R)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        jg_force = JACKSON_GREEN.loading(pair, delta)
        jg_a = JACKSON_GREEN.contact_radius(pair, delta)
    ke_force, ke_a, ke_w = _kogut_etsion(pair, delta)
    jg = (w > 1.9) & (a / R < 0.41)
    ke = (ke_w > 1.0) & (ke_w < 110.0)
    rows: list[tuple[Cell, ...]] = []
    for x in _AT:
        if x < w[-1]:
            k = int(np.argmin(np.abs(w - x)))
            rows.append(
                (f"{w[k]:.1f}", f"{a[k] / R:.4f}", f"{force[k]:.4g}",
                 *(f"{100.0 * (force[k] / f[k] - 1.0):+.1f} %" for f in (jg_force, ke_force)),
                 *(f"{100.0 * (a[k] / f[k] - 1.0):+.1f} %" for f in (jg_a, ke_a)))
            )  # fmt: skip
    H = force / (math.pi * a**2) / _STEEL.Sy
    plastic = a / R > 0.1
    later = float(np.abs(H[plastic] / jackson_green_2007(a[plastic] / R) - 1.0).mean())
    return Result(
        title="Published flattening",
        about=(
            "A perfectly plastic sphere of E = 200 GPa, nu = 0.32, Sy = 619 MPa on a rigid flat, "
            f"level `{accuracy.level}`, to Delta/R = {_DEEPEST:g}, against the fits of Jackson "
            "and Green and of Kogut and Etsion to their finite elements (ANSYS), each in its "
            "range: a/R up to 0.41, and 1 to 110 times Kogut and Etsion's critical interference "
            "(H = 2.8 Sy, K = 0.454 + 0.41 nu). Ripple smoothed out."
        ),
        measurements=(
            _measured("F against Jackson and Green", force / jg_force, jg, 4.0,
                      "J. Tribol. 127 (2005) 343, Eqs. 1.20-1.22; the fit is stated to 3.5 %"),
            _measured("a against Jackson and Green", a / jg_a, jg, 4.0,
                      "the same"),
            _measured("F against Kogut and Etsion", force / ke_force, ke, 5.0,
                      "J. Appl. Mech. 69 (2002) 657"),
            _measured("a against Kogut and Etsion", a / ke_a, ke, 5.0,
                      "the same"),
            Measurement("H against Jackson's later finite elements (1.15), a/R above 0.1, mean",
                        100.0 * later, "%", None, 5.0, "Eq. 1.15, Proc. IMechE J 223 (2009)"),
        ),
        tables=(
            Table("Differences, ours over theirs",
                  ("delta/delta_c", "a/R", "F [N]", "F, JG", "F, KE", "a, JG", "a, KE"),
                  tuple(rows)),
        ),
    )  # fmt: skip


def _measured(what: str, ratio: Array, where: Mask, mark: float, source: str) -> Measurement:
    value = float(np.abs(ratio[where] - 1.0).mean()) if where.any() else math.nan
    return Measurement(f"{what}, mean absolute difference", 100.0 * value, "%", None, mark, source)


def _kogut_etsion(pair: Pair, delta: Array) -> tuple[Array, Array, Array]:
    """Force, contact radius and interference over their critical one; power laws to 6 and 110."""
    nu, S = pair.sphere.nu, pair.sphere.Sy
    critical = (math.pi * (0.454 + 0.41 * nu) * 2.8 * S / (2.0 * pair.E_reduced)) ** 2 * R
    w = delta / critical
    F_c = 4.0 / 3.0 * pair.E_reduced * math.sqrt(R) * critical**1.5
    A_c = math.pi * R * critical
    force = F_c * np.where(w < 6.0, 1.03 * w**1.425, 1.40 * w**1.263)
    area = A_c * np.where(w < 6.0, 0.93 * w**1.136, 0.94 * w**1.146)
    return force, np.sqrt(area / math.pi), w
