"""Quasi-static presses: the same law without motion, from the load to what stays.

The depth under the load follows from the loading curve, what stays and what springs back from the
unloading that begins there, as at the turning point of an impact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numba import float64, njit, types

from ..core.arrays import Array
from ..models.kernel import BRANCH, LOADING, SPLIT, VECTOR
from . import force as fo
from .integrate import Settings, arrays_of
from .scene import Scene
from .tabulated.law_table import DEEPEST, SHALLOWEST

# limit: relative step at which the depth of a load is found [-]: round-off
_CLOSE = 1e-12
# limit: rounds of that search at most [-]: bisection of a double takes 60
_MOST = 100
_VARIED = ("par", "force", "factors")


class Pressed(NamedTuple):
    """What presses end in, each of shape (n,) [m].

    `depth` is the approach under the largest load, at most R, whatever the load; `recovered`
    what it gives back; `sphere` and `flat` what stays in each body; `radius` the contact's at the
    largest load.
    """

    depth: Array
    recovered: Array
    sphere: Array
    flat: Array
    radius: Array


@njit(cache=True, _nrt=False, error_model="numpy")
def _depth(loading, par, force, factors, load):
    """Depth at which the loading carries a load, by regula falsi (Illinois) over logarithms."""
    R = force[fo.RADIUS]
    low, high = math.log(SHALLOWEST * R), math.log(DEEPEST * R)
    goal = math.log(load)
    at_low = math.log(max(fo.static_loading(loading, par, force, factors, math.exp(low)), 1e-300))
    at_high = math.log(fo.static_loading(loading, par, force, factors, math.exp(high)))
    f_low, f_high = at_low - goal, at_high - goal
    if f_low > 0.0 or f_high < 0.0:
        return math.exp(low if f_low > 0.0 else high)
    x, side = low, 0
    for _ in range(_MOST):
        x = (low * f_high - high * f_low) / (f_high - f_low)
        f = math.log(fo.static_loading(loading, par, force, factors, math.exp(x))) - goal
        if abs(f) < _CLOSE or high - low < _CLOSE:
            break
        if f > 0.0:
            high, f_high = x, f
            f_low *= 0.5 if side == 1 else 1.0
            side = 1
        else:
            low, f_low = x, f
            f_high *= 0.5 if side == -1 else 1.0
            side = -1
    return math.exp(x)


_MATRIX = types.Array(float64, 2, "C")


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, *3 * (_MATRIX,), VECTOR, VECTOR, _MATRIX),
    cache=True, _nrt=False, error_model="numpy",
)  # fmt: skip
def _press(loading, radius, unloading, residual, par, force, factors, load, branch, out):
    for i in range(len(load)):
        d = _depth(loading, par[i], force[i], factors[i], load[i])
        fo.set_peak(loading, unloading, residual, par[i], force[i], factors[i], d, branch)
        out[i, 0], out[i, 1] = d, d - branch[1] - branch[2]
        out[i, 2], out[i, 3] = branch[1], branch[2]
        out[i, 4] = fo.static_radius(radius, par[i], force[i], factors[i], d)


@njit(
    types.void(BRANCH, *3 * (_MATRIX,), VECTOR, VECTOR), cache=True, _nrt=False, error_model="numpy"
)
def _radii(radius, par, force, factors, depth, out):
    for i in range(len(depth)):
        out[i] = math.nan
        if depth[i] > 0.0:
            out[i] = fo.static_radius(radius, par[i], force[i], factors[i], depth[i])


def pressed(scenes: Sequence[Scene]) -> Pressed:
    """Press strikers on flats; all scenes have a `press` and laws with the same kernels.

    Friction between the bodies, which raises the load at a depth by less than 1 %, is left out as
    it is of an impact.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> from dentscope.dynamics import Striker, scene_of
    >>> from dentscope.dynamics.scene import CREEP, Press
    >>> from dentscope.models import LAWS
    >>> steel = Material(E=200e9, nu=0.3)
    >>> ball = scene_of(LAWS["hertz"], sphere=steel, flat=steel,
    ...                 striker=Striker(mass=0.004, tip_radius=0.005), approach=CREEP,
    ...                 press=Press(100.0))
    >>> found = pressed([ball])
    >>> round(float(found.depth[0]) * 1e6, 3), float(found.flat[0])
    (4.533, 0.0)
    """
    loads = np.array([_load(scene) for scene in scenes], dtype=float)
    out = np.empty((len(scenes), len(Pressed._fields)))
    for kernels, members, arrays in _groups(scenes):
        found = np.empty((len(members), out.shape[1]))
        _press(*kernels, *arrays, loads[members], np.zeros(fo.N_BRANCH), found)
        out[members] = found
    return Pressed(*out.T.copy())


def dent_radius(scenes: Sequence[Scene], peak: Array) -> Array:
    """Radius of the largest contact circle of scenes that reached these depths, shape (n,) [m].

    Where the metal's strength is another than the stated one, that of the pair of that strength;
    nan at a depth that is none.
    """
    out = np.empty(len(scenes))
    for (_, radius, _, _), members, arrays in _groups(scenes):
        found = np.empty(len(members))
        _radii(radius, *arrays, np.asarray(peak, dtype=float)[members], found)
        out[members] = found
    return out


def _load(scene: Scene) -> float:
    if scene.press is None:
        raise ValueError("a scene without a press")
    return scene.press.load


def _groups(scenes: Sequence[Scene]) -> Iterator[tuple[Any, list[int], list[Array]]]:
    """Yield kernels, places and stacked vectors of the scenes that can go together."""
    rows = [arrays_of(scene, Settings()) for scene in scenes]
    groups: dict[tuple[int, int], list[int]] = {}
    for i, a in enumerate(rows):
        groups.setdefault((len(a.factors), len(a.par)), []).append(i)
    for members in groups.values():
        stacked = [np.stack([getattr(rows[i], key) for i in members]) for key in _VARIED]
        yield tuple(scenes[members[0]].law.kernels), members, stacked
