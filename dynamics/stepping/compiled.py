"""The compiled integrator: one impact after another through the same scalar kernels."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import int64, njit, types

from ...core.arrays import Array
from ...models.kernel import BRANCH, LOADING, SPLIT, VECTOR
from .. import surface as su
from ..force import DAMPING, N_BRANCH, RADIATION
from . import layout as at
from .advance import advance
from .bundle import bundled
from .change import bound, change, part, rest, sinks
from .events import rubbing
from .flight import N_FAST
from .land import AGAIN, NONE
from .layout import MATRIX, PLAIN, WORK_TUPLE, Given, Model, Work
from .record import begin, finish, note, note_flight
from .step import STAGES
from .touch import refresh, touch

# fmt: off
_LANES = 16
"""The state is filled up to a multiple of this: loops over it then leave no rest to do singly."""
# limit: impacts of one compiled call, which Ctrl-C has to wait for [-]: a second where they
# vibrate
_AT_ONCE = 200
_MODES = types.Array(types.float64, 3, "C")
_FLAGS, _PLACES = types.Array(types.boolean, 1, "C"), types.Array(int64, 1, "C")


@njit(cache=True, **PLAIN)
def walk(m, w):
    """Integrate one impact from first touch to where nothing can bring the tip back."""
    now, tally = w.now, w.tally
    begin(m, w)
    touch(m, w)
    rubs = rubbing(m)
    while tally[at.ENDING] == at.GOING:
        if now[at.FRESH] > 0.0:
            refresh(m, w)
            note(m, w)
        if now[at.MODE] == 0.0 and rubs:
            tally[at.STUCK] = 1.0
        if tally[at.STEPS] >= m.body[at.MAX_STEPS]:
            tally[at.ENDING] = at.STEP_BUDGET
            if sinks(m, w):
                rest(m, w)
            break
        event = advance(m, w)
        if event == AGAIN:
            continue
        if event != at.PART:
            note(m, w)
        if event == NONE:
            continue
        if event != at.PART:
            change(m, w, event)
            if (event == at.RETURNED and bound(m)) or (event == at.TURN and sinks(m, w)):
                rest(m, w)
            continue
        part(m, w)
        if tally[at.ENDING] == at.GOING:
            note_flight(m, w, w.z[at.TIME])
            touch(m, w)
    finish(m, w)


def many_impacts(
    kernels: tuple[Any, ...], given: Given, out: Array, *, left: Array | None = None,
    history: Array | None = None,
) -> int:
    """Integrate row after row of `given.body`; fill `out` with OBSERVABLES and COUNTS.

    The surfaces that the impacts leave go into the rows of `left`, as far as there are any, states
    of the motion into those of `history`; returned is how many of the latter the last impact took.
    """
    n, body = given.omega.shape[1], given.body
    left = np.zeros((0, su.N_SURFACE)) if left is None else left
    history = np.zeros((0, len(at.HISTORY))) if history is None else history
    waves = (given.force[:, DAMPING] != 0.0) | (given.force[:, RADIATION] != 0.0)
    moves = np.isfinite(body[:, at.S_MASS]) | (body[:, at.S_PLATE] != 0.0)
    tailed = moves | waves | (n > 0)
    used = at.N_RIGID + 2 * n + at.N_TAIL * tailed + np.isfinite(body[:, at.COMPLIANCE])
    rows = np.zeros(1)
    for size in np.unique(-(-used // _LANES) * _LANES):
        own = np.flatnonzero(-(-used // _LANES) * _LANES == size)
        work = _work_of(int(size), n, history)
        for first in range(0, len(own), _AT_ONCE):
            some = own[first : first + _AT_ONCE]
            _impacts(*kernels, *given, work, tailed, used, some, out, left, rows)
    return int(rows[0])


def _work_of(size: int, n: int, history: Array) -> Work:
    """Return room for an impact with a state of length `size` and n modes."""
    vectors = (
        *5 * (size,), size, N_BRANCH, su.N_SURFACE, *3 * (at.N_SEEN,), *2 * (at.N_EVENTS,),
        at.N_NOW, at.N_SCALES, at.N_TALLY, su.N_IMPRINT, at.N_OUT, at.N_SUMS)
    rest = (
        np.zeros((STAGES + 1, size)), np.zeros((N_FAST, n)), history,
        np.zeros(at.N_EVENTS, np.bool_))
    return Work._make([*(np.zeros(count) for count in vectors), *rest])


@njit(cache=True, **PLAIN)
def _sum_up(m, w):
    """Fill the model's sums."""
    sums, body = m.sums, m.body
    for k in range(at.PER_MASS):
        sums[k] = 0.0
    for k in range(len(m.omega)):
        sums[at.S_XX] += m.psi[0, k] ** 2
        sums[at.S_XY] += m.psi[0, k] * m.psi[1, k]
        sums[at.S_XP] += m.psi[0, k] * m.psi[2, k]
    sums[at.PER_MASS], sums[at.PER_INERTIA] = 1.0 / body[at.MASS], 1.0 / body[at.INERTIA]


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, MATRIX, MATRIX, MATRIX, MATRIX, MATRIX,
               MATRIX, _MODES, WORK_TUPLE, _FLAGS, _PLACES, _PLACES, MATRIX, MATRIX, VECTOR),
    cache=True, nogil=True, _nrt=False, no_cfunc_wrapper=True,
)
def _impacts(loading, radius, unloading, residual, par, force, factors, body, surface,
             omega, psi, work, tailed, used, own, out, left, rows):
    """Integrate the impacts `own`, all of which have a state of one length."""
    w = bundled(work)
    sums, kept = work.sums, work.surface
    for i in own:
        m = bundled(Model(
            loading, radius, unloading, residual, par[min(i, len(par) - 1)],
            force[min(i, len(force) - 1)], factors[min(i, len(factors) - 1)], body[i],
            omega[min(i, len(omega) - 1)], psi[min(i, len(psi) - 1)], sums))
        _sum_up(m, w)
        sums[at.HAS_TAIL], sums[at.SIZE] = 1.0 if tailed[i] else 0.0, float(used[i])
        first = min(i, len(surface) - 1)
        for j in range(len(kept)):
            kept[j] = surface[first, j]
        walk(m, w)
        for j in range(at.N_OUT):
            out[i, j] = work.out[j]
        if i < len(left):
            for j in range(len(kept)):
                left[i, j] = kept[j]
        rows[0] = work.tally[at.ROWS]
