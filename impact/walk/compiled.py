"""The compiled integrator: one impact after another through the same scalar kernels."""

from __future__ import annotations

import numpy as np
from numba import int64, njit, types

from ...models.kernel import VECTOR
from .. import surface as su
from ..force import BRANCH, DAMPING, LOADING, N_BRANCH, RADIATION, SPLIT
from . import layout as at
from .advance import advance
from .change import change, part
from .events import rubbing
from .flight import N_FAST
from .land import AGAIN, NONE
from .layout import MATRIX, MODEL, OBSERVABLES, PLAIN, WORK, Model, Work
from .record import begin, finish, note, note_flight
from .step import STAGES
from .touch import refresh, touch

__all__ = ["OBSERVABLES", "many_impacts", "one_impact"]

# fmt: off
_LANES = 16
"""The state is filled up to a multiple of this: loops over it then leave no rest to do singly."""
_MODES = types.Array(types.float64, 3, "C")


@njit(types.void(MODEL, WORK), cache=True, **PLAIN)
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
            continue
        part(m, w)
        if tally[at.ENDING] == at.GOING:
            note_flight(m, w, w.z[at.TIME])
            touch(m, w)
    finish(m, w)


@njit(types.UniTuple(int64, 2)(VECTOR, VECTOR, int64), cache=True, _nrt=False)
def _size_of(force, body, n):
    """Length of the state with n modes, as laid out and as much of it as is in use."""
    waves = force[DAMPING] != 0.0 or force[RADIATION] != 0.0
    held = body[at.S_MASS] == np.inf and body[at.S_PLATE] == 0.0
    used = at.N_RIGID + 2 * n
    if n > 0 or waves or not held:
        used += at.N_TAIL
    if body[at.COMPLIANCE] < np.inf:
        used += 1
    return -(-used // _LANES) * _LANES, used


@njit(WORK(int64, int64, VECTOR, VECTOR, MATRIX), cache=True)
def _work_of(size, n, surface, out, history):
    """Return room for impacts with a state of length `size` and n modes."""
    return Work(
        np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size),
        np.ones(size), np.zeros(N_BRANCH), surface, np.zeros(at.N_SEEN), np.zeros(at.N_SEEN),
        np.zeros(at.N_SEEN), np.zeros(at.N_EVENTS), np.zeros(at.N_EVENTS), np.zeros(at.N_NOW),
        np.zeros(at.N_SCALES), np.zeros(at.N_TALLY), np.zeros(su.N_IMPRINT), out,
        np.zeros((STAGES + 1, size)), np.zeros((N_FAST, n)), history,
        np.zeros(at.N_EVENTS, np.bool_))


@njit(types.void(VECTOR, VECTOR, VECTOR, MATRIX, VECTOR), cache=True, _nrt=False)
def _sum_up(force, body, omega, psi, sums):
    """Fill the sums of a model."""
    n = len(omega)
    sums[:] = 0.0
    for k in range(n):
        sums[at.S_XX] += psi[0, k] ** 2
        sums[at.S_XY] += psi[0, k] * psi[1, k]
        sums[at.S_XP] += psi[0, k] * psi[2, k]
    sums[at.PER_MASS], sums[at.PER_INERTIA] = 1.0 / body[at.MASS], 1.0 / body[at.INERTIA]
    _, used = _size_of(force, body, n)
    springs = 1 if body[at.COMPLIANCE] < np.inf else 0
    sums[at.HAS_TAIL] = 1.0 if used - springs > at.N_RIGID + 2 * n else 0.0
    sums[at.SIZE] = float(used)


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR,
               VECTOR, MATRIX, VECTOR, MATRIX, VECTOR),
    cache=True, nogil=True,
)
def one_impact(loading, radius, unloading, residual, par, force, factors, breaks, body, surface,
               omega, psi, out, history, rows):
    """Integrate one impact; fill `out` with OBSERVABLES and COUNTS, update `surface`.

    As many rows of `history` are filled as there are; `rows` takes how many.
    """
    size, _ = _size_of(force, body, len(omega))
    sums = np.zeros(at.N_SUMS)
    _sum_up(force, body, omega, psi, sums)
    m = Model(loading, radius, unloading, residual, par, force, factors, breaks, body, omega, psi,
              sums)
    w = _work_of(size, len(omega), surface, out, history)
    walk(m, w)
    rows[0] = w.tally[at.ROWS]


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, MATRIX, MATRIX, MATRIX, VECTOR, MATRIX, MATRIX,
               MATRIX, _MODES, MATRIX),
    cache=True, nogil=True,
)
def many_impacts(loading, radius, unloading, residual, par, force, factors, breaks, body, surface,
                 omega, psi, out):
    """Integrate row after row; all but `breaks` and `body` hold one row or one per impact.

    The surfaces stay as they are. Room is made anew only where the state has another length.
    """
    n = omega.shape[1]
    sums = np.zeros(at.N_SUMS)
    w = _work_of(0, n, np.zeros(su.N_SURFACE), np.zeros(at.N_OUT), np.zeros((0, len(at.HISTORY))))
    for i in range(len(body)):
        f, modes = force[min(i, len(force) - 1)], omega[min(i, len(omega) - 1)]
        shapes = psi[min(i, len(psi) - 1)]
        size, _ = _size_of(f, body[i], n)
        if size != len(w.z):
            w = _work_of(size, n, w.surface, w.out, w.history)
        _sum_up(f, body[i], modes, shapes, sums)
        w.surface[:] = surface[min(i, len(surface) - 1)]
        walk(Model(loading, radius, unloading, residual, par[min(i, len(par) - 1)], f,
                   factors[min(i, len(factors) - 1)], breaks, body[i], modes, shapes, sums), w)
        out[i] = w.out
