"""A rigid sphere pressed into a perfectly plastic flat: slip-line theory and published results."""

from __future__ import annotations

import math

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....core.material import Material, Pair
from ....models.published import hardness
from ..bench import Bench, Effort
from ..curves import smoothed
from ..pairs import RIGID, R
from ..result import Cell, Measurement, Result, Table

# the material of Code_Aster's test SSNV506; E'/Sy = 4615
_STEEL = Material(E=210e9, nu=0.3, Sy=50e6)
_DEEPEST = 0.05
_AT = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3)  # a/R


def run(bench: Bench) -> Result:
    """Solve one deep indentation and compare mean pressure, contact radius and force."""
    pair = Pair(sphere=RIGID, flat=_STEEL, R=R)
    accuracy = fem.Accuracy.smoke() if bench.effort is Effort.QUICK else fem.Accuracy.quick()
    depths = fem.geometric_depths(20.0 * pair.first_yield, _DEEPEST, 70)
    solved = bench.solve(Case("published-indentation", fem.ContactProblem(pair, depths), accuracy))
    delta = solved["delta"]
    ln_f, ln_a = (smoothed(delta, np.log(solved[name])) for name in ("force", "radius"))
    a = np.exp(ln_a) / R
    H = np.exp(ln_f) / (math.pi * (a * R) ** 2) / _STEEL.Sy
    invariant = (a * R) ** 2 / (2.0 * R * delta)
    richmond = np.exp(ln_f) / (3.0 * math.pi * R * _STEEL.Sy * delta / 0.368)
    rows: list[tuple[Cell, ...]] = []
    off = []
    for x in _AT:
        if not a[0] < x < a[-1]:
            continue
        ours, c2, ratio = (float(np.interp(x, a, y)) for y in (H, invariant, richmond))
        slip = float(hardness.slip_line(x))
        off.append(ours / slip - 1.0)
        rows.append(
            (x, f"{ours:.3f}", f"{slip:.3f}", f"{hardness.yu_blanchard(x):.3f}",
             f"{hardness.alcala(x):.3f}", f"{c2:.3f}", f"{ratio:.3f}")
        )  # fmt: skip
    kk = float(hardness.kogut_komvopoulos(pair.E_reduced / _STEEL.Sy))
    light = (a > 0.1) & (a < 0.2)
    plateau, c2 = float(H[light].mean()), float(invariant[light].mean())
    return Result(
        title="Published indentation",
        about=(
            "A rigid sphere on a perfectly plastic flat, E = 210 GPa, nu = 0.3, Sy = 50 MPa "
            f"(Code_Aster's test SSNV506), level `{accuracy.level}`, to Delta/R = {_DEEPEST:g}; "
            "ripple smoothed out. H = F/(pi a^2), c^2 = a^2/(2 R Delta)."
        ),
        measurements=(
            Measurement("H against slip-line hardness, a/R 0.05 to 0.3, largest difference",
                        100.0 * float(np.abs(off).max()) if off else math.nan, "%", None, 8.0,
                        "Eq. 1.13, Jackson, Ghaednia, Pope 2015: plane-strain slip lines, "
                        "so an estimate for the axisymmetric case"),
            Measurement("H/Sy, mean over a/R 0.1 to 0.2", plateau, "", 2.61, 3.1,
                        "Ishlinskii 2.61 to Richmond, Morrison, Devenpeck (1974) 3.0, "
                        "Tabor's tests 2.8"),
            Measurement("H/Sy against Kogut and Komvopoulos, a/R 0.1 to 0.2",
                        100.0 * (plateau / kk - 1.0), "%", -8.0, 8.0,
                        "finite elements, J. Mater. Res. 19 (2004) 3641, Eq. 1.9"),
            Measurement("c^2 against Richmond's rigid-plastic solution, a/R 0.1 to 0.2",
                        100.0 * (c2 / (0.5 / 0.368) - 1.0), "%", -8.0, 8.0,
                        "Johnson, Contact Mechanics, section 6.4: Delta = 0.368 a^2/R; "
                        "reference of Code_Aster's test SSNV506"),
        ),
        tables=(
            Table(
                "Against a/R",
                ("a/R", "H/Sy", "slip-line (1.13)", "Yu and Blanchard (1.10)", "Alcala (1.11)",
                 "c^2 (1.359 by Richmond)", "F over SSNV506's reference"),
                tuple(rows),
            ),
        ),
        notes=(
            f"Kogut and Komvopoulos give one value for E'/Sy, here {kk:.3f}; their fit goes on "
            "growing with the logarithm of E'/Sy, past every rigid-plastic solution. Yu and "
            "Blanchard's and Alcala's curves are fits of their finite elements over a/R.",
        ),
    )  # fmt: skip
