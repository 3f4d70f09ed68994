"""The fitted law in the terms of discrete-element codes."""

from __future__ import annotations

import numpy as np

from ..core.material import Material, Pair
from .fitted import ClosedForm
from .kernel import critical_depth

_DEM_PAIRS = ((200.0, 200.0, 200.0), (71.7, 200.0, 300.0), (200.0, 200.0, 503.0))
_DEM_RATIOS = (0.1, 1.0, 10.0)
_DEM_DEPTHS = (0.001, 0.003, 0.01, 0.03)


def dem_table(law: ClosedForm) -> str:
    """What the simpler laws of discrete-element codes need to agree with this law, as CSV.

    Those laws carry neither two yielding bodies nor this loading curve, so the table gives what
    makes them agree at a largest approach: for Hertz with damping (LAMMPS `hertz/material`) the
    restitution from the energies of loading and unloading; for the linear hysteretic law of Luding
    (YADE `LudingMat`) the secant stiffnesses of loading (same energy) and of unloading.
    """
    head = (
        "# E [GPa], Sy [MPa], nu = 0.3; stiffnesses over E' R; e from the energies of one cycle",
        "E_s,E_f,Sy_s,Sy_f,Delta_over_R,delta_over_delta_c,F_over_E_R2,a_over_R,"
        "residual_over_Delta,k_loading,k_unloading,restitution",
    )
    lines = []
    for E_s, E_f, Sy in _DEM_PAIRS:
        for ratio in _DEM_RATIOS:
            s, f = (Sy, Sy / ratio) if ratio < 1.0 else (Sy * ratio, Sy)
            pair = Pair(Material(E_s * 1e9, 0.3, s * 1e6), Material(E_f * 1e9, 0.3, f * 1e6), 1.0)
            for D in _DEM_DEPTHS:
                x = np.linspace(0.0, D, 2001)
                spent = float(np.trapezoid(law.loading(pair, x), x))
                gained = float(np.trapezoid(law.unloading(pair, x, D), x))
                F = float(law.loading(pair, D))
                left = float(sum(law.residual(pair, D)))
                numbers = (
                    E_s, E_f, s, f, D, D / critical_depth(pair), F / pair.E_reduced,
                    float(law.contact_radius(pair, D)), left / D,
                    2.0 * spent / D**2 / pair.E_reduced,
                    F / (D - left) / pair.E_reduced, (gained / spent) ** 0.5,
                )  # fmt: skip
                lines.append(",".join(f"{x:.6g}" for x in numbers))
    return "\n".join((*head, *lines)) + "\n"
