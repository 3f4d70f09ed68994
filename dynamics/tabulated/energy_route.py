"""Normal impacts of a rigid striker on a rigid support without time steps: by work alone.

Where nothing vibrates, slides or is damped, the depth is a function of the energy: the striker
turns where the work of loading W(d) has used up its energy, and leaves with what the recovery
gives back. With E = m v^2/2 and gravity's share of the way,

    W(d_m) = E + m g d_m,        m v_r^2 / 2 = W_u(d_m) - m g (d_m - d_r)
    t_c = sqrt(m/2) int_0^d_m dx / sqrt(W(d_m) - W(x) - m g (d_m - x))

and likewise for the recovery. The integrals are singular at the turning point like the root of the
depth left to go; quadrature over that root takes the singularity away. Of one pair all of them
depend on the peak depth only, gravity apart, which enters as a series in rho = m g d_m / W: so they
stand in a table over ln W, and an impact is one look-up.
"""

from __future__ import annotations

import math

import numpy as np
from numba import float64, njit, types

from ...core.arrays import Array
from ...core.material import Pair
from ...models.base import ContactLaw
from ...models.kernel import VECTOR
from ..rules import RULES
from ..scene import ForceTransform, Scene
from ..surface import Spot
from .cells import cell_at, column_at, column_in
from .energy_table import (
    DEEPEST,
    DEPTH,
    FLAT,
    FORCE,
    LOADING_TIME,
    RECOVERY_TIME,
    RETURNED,
    SPHERE,
    TERMS,
    energy_table,
)

GRAVITY_LIMIT = RULES.gravity_limit
"""Largest work of gravity over the work of a branch; the series is cut after its fourth power."""

NAMES = (
    "restitution", "kinetic_restitution", "energetic_restitution", "residual_sphere_m",
    "residual_flat_m", "peak_depth_m", "contact_time_s", "loading_time_s", "peak_force_N",
    "normal_impulse_Ns", "contact_work_J", "rebound_speed_m_s",
)  # fmt: skip
"""What the route computes, in the order of its columns."""

_SERIES = (1.0, 1.0 / 2.0, 3.0 / 8.0, 5.0 / 16.0, 35.0 / 128.0)


def why_not(scene: Scene) -> str:
    """Say why the work alone does not settle this impact; empty if it does.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> from dentscope.dynamics import Approach, Striker, scene_of
    >>> from dentscope.models import LAWS
    >>> steel = Material(E=200e9, nu=0.3, Sy=760e6)
    >>> why_not(scene_of(LAWS["hertz"], sphere=steel, flat=steel,
    ...                  striker=Striker(mass=0.01, tip_radius=0.005),
    ...                  approach=Approach(1.0, tangential=0.5)))
    'tangential motion'
    """
    upright = math.isclose(scene.approach.angle, math.pi / 2.0, abs_tol=1e-12)
    support = scene.support
    reasons = {
        "a leaning rod": scene.striker.length > 0.0 and not upright,
        "tangential motion": scene.approach.tangential != 0.0,
        "spin": scene.approach.spin != 0.0,
        "vibration": len(scene.modes.frequencies) > 0,
        "a support that moves": math.isfinite(support.mass) or support.plate_mobility > 0.0,
        "a changed normal force": scene.force != ForceTransform(),
        "a flat on the tip": scene.striker.tip_flat_radius > 0.0,
        "a flow stress of its own": bool(scene.flow),
        "an earlier blow": scene.spot != Spot(),
    }
    return next((reason for reason, holds in reasons.items() if holds), "")


def energy_impacts(
    law: ContactLaw, pair: Pair, mass: Array, speed: Array, *, gravity: float
) -> Array:
    """Return normal impacts of one pair: masses and speeds of the striker, (n,) [kg, m/s].

    The columns are `NAMES`, shape (n, len(NAMES)); a row of nan where the route does not answer:
    deeper than `DEEPEST` or than the law's table, gravity [m/s^2] above its limit, or no rebound.
    """
    out = np.full((len(speed), len(NAMES)), np.nan)
    table = energy_table(law, pair)
    if table.count:
        end = math.exp(column_at(table.vector, 0, DEPTH, table.high))
        _impacts(
            table.vector, np.ascontiguousarray(mass, float), np.ascontiguousarray(speed, float),
            gravity, min(DEEPEST * pair.R, end), out,
        )  # fmt: skip
    return out


@njit(cache=True, _nrt=False)
def _time(table, cell, column, y, rho):
    """Time of a branch over its way at constant speed; gravity as a series in rho."""
    sum_, power, k = column_in(table, 0, cell, column, y), rho, 1
    while power > 1e-11 and k < TERMS:
        sum_ += _SERIES[k] * power * column_in(table, 0, cell, column + k, y)
        power *= rho
        k += 1
    return sum_


@njit(
    types.void(VECTOR, VECTOR, VECTOR, float64, float64, float64[:, ::1]),
    cache=True, _nrt=False, error_model="numpy",
)  # fmt: skip
def _impacts(table, mass, speed, gravity, deepest, out):
    for i in range(len(speed)):
        m, v = mass[i], speed[i]
        energy, weight = 0.5 * m * v * v, m * gravity
        work, y, cell = energy, math.log(energy), 0
        depth = 0.0
        for _ in range(40):
            cell = cell_at(table, 0, y)
            depth = math.exp(column_in(table, 0, cell, DEPTH, y))
            # a peak depth grows about as the 0.45th power of the work
            off = energy + weight * depth - work
            if abs(off) <= 1e-13 * work:
                break
            work += off / (1.0 - 0.45 * weight * depth / work)
            y = math.log(work)
        force = math.exp(column_in(table, 0, cell, FORCE, y))
        returned = column_in(table, 0, cell, RETURNED, y) * work
        sphere = max(column_in(table, 0, cell, SPHERE, y), 0.0) * depth
        flat = max(column_in(table, 0, cell, FLAT, y), 0.0) * depth
        way = depth - sphere - flat
        left = returned - weight * way
        rho, rho_back = weight * depth / work, weight * way / returned
        if not (rho <= GRAVITY_LIMIT and rho_back <= GRAVITY_LIMIT and depth <= deepest):
            out[i, :] = np.nan
            continue
        t_in = math.sqrt(0.5 * m / work) * depth * _time(table, cell, LOADING_TIME, y, rho)
        t_out = math.sqrt(0.5 * m / returned) * way
        t_out *= _time(table, cell, RECOVERY_TIME, y, rho_back)
        v_out = math.sqrt(2.0 * left / m)
        p_in, p_out = m * v + weight * t_in, m * v_out + weight * t_out
        out[i, 0], out[i, 1], out[i, 2] = v_out / v, p_out / p_in, math.sqrt(returned / work)
        out[i, 3], out[i, 4], out[i, 5] = sphere, flat, depth
        out[i, 6], out[i, 7], out[i, 8] = t_in + t_out, t_in, force
        out[i, 9], out[i, 10], out[i, 11] = p_in + p_out, work - returned, v_out
