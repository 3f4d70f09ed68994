"""What must not matter: units of length and stress, and the contact's stiffness."""

from __future__ import annotations

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.pairs import pair_of
from ..bench import Bench
from ..curves import inner, smoothed
from ..result import Cell, Measurement, Result, Table

_SCALES = ((1.0, 1.0), (1e3, 1.0), (1.0, 1e-6), (7.0, 1e-3))
_FACTORS = (0.125, 0.25, 0.5, 1.0, 2.0)
_DEEPEST = 0.005


def scale(bench: Bench) -> Result:
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


def penalty(bench: Bench) -> Result:
    """Solve the equal-strength case with five contact stiffnesses on one mesh."""
    pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=1.0)
    depths = fem.geometric_depths(0.3 * pair.first_yield, _DEEPEST, 50)
    mesh, production = fem.Accuracy.smoke(), fem.Accuracy.production()
    # the same compliance of the contact as production's, whose elements are smaller
    same = production.penalty * mesh.fine / production.fine
    stiffnesses = [same * factor for factor in _FACTORS]
    curves = []
    for stiffness in stiffnesses:
        accuracy = mesh.with_(level=f"smoke, penalty {stiffness:g}", penalty=stiffness)
        s = bench.solve(Case("penalty", fem.ContactProblem(pair, depths), accuracy))
        kept = inner(s["delta"])
        curves.append(
            [smoothed(s["delta"], y)[kept] for y in (np.log(s["force"]), np.log(s["radius"]),
                                                     s.share)]
        )  # fmt: skip
    # the penetration, and with it the error, falls with 1/stiffness
    rigid = [2.0 * y - x for x, y in zip(curves[-2], curves[-1], strict=True)]
    rows: list[tuple[Cell, ...]] = []
    off: dict[float, list[float]] = {}
    for stiffness, curve in zip(stiffnesses, curves, strict=True):
        off[stiffness] = [float(np.abs(x - y).max()) for x, y in zip(curve, rigid, strict=True)]
        F, a, share = off[stiffness]
        rows.append((f"{stiffness:g}", f"{100.0 * F:.3f}", f"{100.0 * a:.3f}", f"{share:.5f}"))
    F, a, share = off[same]
    source = "limit of rigid contact"
    return Result(
        name="penalty",
        title="Contact stiffness",
        about=(
            f"Strengths 503 MPa, E = 200 GPa, level `smoke`, to Delta/R = {_DEEPEST:g}. "
            f"Production uses {production.penalty:g} E' over the edge length of its elements, "
            f"which is {same:g} on these; largest differences from the limit extrapolated from "
            "the two stiffest, ripple smoothed out."
        ),
        measurements=(
            Measurement("F, production's stiffness", 100.0 * F, "%", None, 0.25, source),
            Measurement("a, production's stiffness", 100.0 * a, "%", None, 0.5, source),
            Measurement("delta_s*, production's stiffness", share, "", None, 0.0025, source),
        ),
        tables=(
            Table("Largest difference",
                  ("stiffness [E'/h]", "F [%]", "a [%]", "delta_s*"), tuple(rows)),
        ),
    )  # fmt: skip
