"""The units of length and stress change nothing but the units of the results."""

from __future__ import annotations

import numpy as np

from .... import fem
from ....campaigns.cases.pairs import pair_of
from ..bench import Bench
from ..result import Measurement, Result, Table

_SCALES = ((1.0, 1.0), (1e3, 1.0), (1.0, 1e-6), (7.0, 1e-3))


def run(bench: Bench) -> Result:
    """Solve one plastic pair with other radii and other units of stress."""
    curves = []
    depths = fem.geometric_depths(4e-5, 2e-3, 10)
    for length, stress in _SCALES:
        plain = pair_of(E_s=71.7, E_f=200.0, Sy_min=503.0, ratio=1.3, nu_s=0.33)
        pair = type(plain)(
            sphere=plain.sphere.with_(E=plain.sphere.E * stress, Sy=plain.sphere.Sy * stress),
            flat=plain.flat.with_(E=plain.flat.E * stress, Sy=plain.flat.Sy * stress),
            R=plain.R * length,
        )
        c = fem.solve(fem.ContactProblem(pair, depths), accuracy=fem.Accuracy.smoke()).loading
        curves.append(
            (c.force / (stress * length**2), c.radius / length, c.sphere_share, c.dissipated
             / (stress * length**3))
        )  # fmt: skip
    rows = []
    worst = 0.0
    for (length, stress), curve in zip(_SCALES[1:], curves[1:], strict=True):
        off = [
            float(np.abs(x - y).max() / np.abs(y).max())
            for x, y in zip(curve, curves[0], strict=True)
        ]
        worst = max(worst, *off)
        rows.append((f"{length:g}", f"{stress:g}", *(f"{x:.1e}" for x in off)))
    return Result(
        name="scale",
        title="Scale invariance",
        about=(
            "The same pair (Table 2.1, case 4, Sy* = 1.3) with the radius and the unit of stress "
            "changed, ten depths to Delta/R = 0.002; largest relative differences."
        ),
        measurements=(
            Measurement("largest relative difference of F, a, delta_s*, dissipated work", worst, "",
                        None, 1e-6, "dimensional analysis"),
        ),
        tables=(
            Table("Relative difference", ("R over 1 mm", "stress", "F", "a", "delta_s*", "work"),
                  tuple(rows)),
        ),
        notes=(
            "Round-off is amplified by the path: steps are accepted at a finite tolerance, so the "
            "difference is that tolerance and not 1e-16.",
        ),
    )  # fmt: skip
