"""Elastic contact against Hertz: force, contact radius, pressure, stresses on the axis."""

from __future__ import annotations

import math

import numpy as np

from .... import fem
from ....core.material import Pair
from ..bench import Bench
from ..pairs import R, axis_stresses, elastic_pair, hertz_force
from ..result import Measurement, Result, Table

_DEPTHS = (1e-6, 3e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3)
_LOOKED_AT = 1e-5
_JOHNSON = "Hertz (Johnson, Contact Mechanics, Eqs. 3.39-3.45, 4.22-4.24)"


def run(bench: Bench) -> Result:
    """Measure an elastic pair of equal bodies at production settings."""
    pair = elastic_pair()
    problem = fem.ContactProblem(pair, _DEPTHS, snapshots=(_LOOKED_AT,))
    solution = fem.solve(problem, accuracy=fem.Accuracy.production())
    c = solution.loading
    depth = c.delta / R
    force = c.force / np.array([hertz_force(pair, d) for d in c.delta])
    radius = c.radius / np.sqrt(R * c.delta)
    at = int(np.argmin(np.abs(depth - _LOOKED_AT)))
    # finite hemisphere and large strain: linear in a/R to leading order
    light = (depth > 5e-6) & (depth < 3e-4)
    slope, intercept = np.polyfit(np.sqrt(depth[light]), force[light] - 1.0, 1)
    snapshot = solution.snapshots[0]
    rms = _pressure_error(snapshot, pair)
    stresses, rows = _axis_error(snapshot, pair)
    return Result(
        title="Elastic contact: Hertz",
        about=(
            "Two elastic bodies of E = 200 GPa, nu = 0.3, production settings. F rises with a/R "
            "by the finite hemisphere and slope; its limit at a/R = 0 is the error of the "
            "discretisation."
        ),
        measurements=(
            _within("F - Hertz at Delta/R = 1e-5, raw", 100.0 * (force[at] - 1.0), 0.3),
            _within("F - Hertz extrapolated to a/R = 0", 100.0 * intercept, 0.3),
            Measurement("slope of F/F_Hertz over a/R", float(slope)),
            _within("a - Hertz at Delta/R = 1e-5", 100.0 * (radius[at] - 1.0), 0.3),
            Measurement("pressure, rms error over p_0, r/a 0.2 to 0.9", 100.0 * rms, "%", None, 0.3,
                        _JOHNSON),
            *stresses,
            Measurement("sphere's share of identical bodies, largest |delta_s* - 1/2| up to 1e-4",
                        float(np.abs(c.sphere_share[depth <= 1.01e-4] - 0.5).max()), "", None,
                        0.002, "symmetry (Eq. 2.3)"),
        ),
        tables=(
            Table(
                "Against Hertz",
                ("Delta/R", "F/F_Hertz", "a/a_Hertz", "last node/a_Hertz", "delta_s*"),
                tuple(
                    (f"{d:.0e}", f"{f:.5f}", f"{a:.5f}", f"{n:.4f}", f"{s:.5f}")
                    for d, f, a, n, s in zip(
                        depth, force, radius, c.radius_last_node / np.sqrt(R * c.delta),
                        c.sphere_share, strict=True,
                    )
                ),
            ),
            Table(
                "Stresses on the axis of the flat over p_0, Delta/R = 1e-5",
                ("z/a", "axial", "exact", "radial", "exact"),
                rows,
            ),
        ),
    )  # fmt: skip


def _within(what: str, percent: float, mark: float) -> Measurement:
    return Measurement(what, float(percent), "%", -mark, mark, _JOHNSON)


def _peak(pair: Pair) -> tuple[float, float]:
    a = math.sqrt(R * _LOOKED_AT * R)
    return a, 2.0 * pair.E_reduced * a / (math.pi * R)


def _pressure_error(snapshot: fem.Snapshot, pair: Pair) -> float:
    a, p0 = _peak(pair)
    x = snapshot.profile.sphere_r / a
    inside = (x > 0.2) & (x < 0.9)
    error = snapshot.profile.pressure[inside] / p0 - np.sqrt(1.0 - x[inside] ** 2)
    return float(np.sqrt(np.mean(error**2)))


def _axis_error(
    snapshot: fem.Snapshot, pair: Pair
) -> tuple[tuple[Measurement, ...], tuple[tuple[str, ...], ...]]:
    """Stresses in the flat's elements next to the axis, 0.1 a to 3 a deep."""
    a, p0 = _peak(pair)
    quads = snapshot.quads[snapshot.n_sphere_quads :]
    stress = snapshot.stress[snapshot.n_sphere_quads :] / p0
    centre = snapshot.points[quads].mean(axis=1) / a
    on_axis = (snapshot.points[quads][:, :, 0] == 0.0).any(axis=1)
    chosen = np.flatnonzero(on_axis & (-centre[:, 1] > 0.1) & (-centre[:, 1] < 3.0))
    chosen = chosen[np.argsort(-centre[chosen, 1])]
    z = -centre[chosen, 1]
    exact = np.array([axis_stresses(d, pair.flat.nu) for d in z])
    radial = 0.5 * (stress[chosen, 0] + stress[chosen, 3])
    axial = stress[chosen, 1]
    error = [float(np.sqrt(np.mean((x - y) ** 2))) * 100.0 for x, y in
             ((radial, exact[:, 0]), (axial, exact[:, 1]))]  # fmt: skip
    rows = tuple(
        (f"{z[k]:.3f}", f"{axial[k]:.4f}", f"{exact[k, 1]:.4f}",
         f"{radial[k]:.4f}", f"{exact[k, 0]:.4f}")
        for k in range(0, len(z), max(1, len(z) // 10))
    )  # fmt: skip
    return (
        Measurement("radial stress on the axis, rms error over p_0, z/a 0.1 to 3", error[0], "%",
                    None, 1.0, _JOHNSON),
        Measurement("axial stress on the axis, likewise", error[1], "%", None, 1.0, _JOHNSON),
    ), rows  # fmt: skip
