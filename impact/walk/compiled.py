"""The compiled integrator: one impact after another through the same scalar kernels."""

from __future__ import annotations

import numpy as np
from numba import njit, types

from ...models.kernel import VECTOR
from .. import surface as su
from ..force import BRANCH, DAMPING, LOADING, N_BRANCH, RADIATION, SPLIT
from . import layout as at
from .events import rubbing
from .flight import N_FAST
from .layout import MATRIX, MODEL, OBSERVABLES, WORK, Model, Work
from .motion import PLAIN, STAGES
from .phases import AGAIN, NONE, advance, change, part, refresh, touch
from .record import begin, finish, note, note_flight

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
    n = len(omega)
    waves = force[DAMPING] != 0.0 or force[RADIATION] != 0.0
    held = body[at.S_MASS] == np.inf and body[at.S_PLATE] == 0.0
    tail = n > 0 or waves or not held
    size = at.N_RIGID + 2 * n + (at.N_TAIL if tail else 0)
    size += 1 if body[at.COMPLIANCE] < np.inf else 0
    count = float(size)
    size = -(-size // _LANES) * _LANES
    sums = np.zeros(at.N_SUMS)
    for k in range(n):
        sums[at.S_XX] += psi[0, k] ** 2
        sums[at.S_XY] += psi[0, k] * psi[1, k]
        sums[at.S_XP] += psi[0, k] * psi[2, k]
    sums[at.PER_MASS], sums[at.PER_INERTIA] = 1.0 / body[at.MASS], 1.0 / body[at.INERTIA]
    sums[at.HAS_TAIL], sums[at.SIZE] = 1.0 if tail else 0.0, count
    m = Model(loading, radius, unloading, residual, par, force, factors, breaks, body, omega, psi,
              sums)
    w = Work(
        np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size),
        np.ones(size), np.zeros(N_BRANCH), surface, np.zeros(at.N_SEEN), np.zeros(at.N_SEEN),
        np.zeros(at.N_SEEN), np.zeros(at.N_EVENTS), np.zeros(at.N_EVENTS), np.zeros(at.N_NOW),
        np.zeros(at.N_SCALES), np.zeros(at.N_TALLY), np.zeros(su.N_IMPRINT), out,
        np.zeros((STAGES + 1, size)), np.zeros((N_FAST, n)), history,
        np.zeros(at.N_EVENTS, np.bool_))
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

    The surfaces stay as they are.
    """
    history, rows = np.zeros((0, len(at.HISTORY))), np.zeros(1)
    ours = np.zeros(su.N_SURFACE)
    for i in range(len(body)):
        ours[:] = surface[min(i, len(surface) - 1)]
        one_impact(loading, radius, unloading, residual, par[min(i, len(par) - 1)],
                   force[min(i, len(force) - 1)], factors[min(i, len(factors) - 1)], breaks,
                   body[i], ours, omega[min(i, len(omega) - 1)], psi[min(i, len(psi) - 1)], out[i],
                   history, rows)
