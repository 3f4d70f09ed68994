"""How a contact begins, and how it looks after an event: variable, derivative, event values.

The independent variable changes where time is a bad one: the root of time after a touch, the rate
of penetration before the turning point, the root of the remaining depth before the parting.
"""

from __future__ import annotations

import math

import numpy as np
from numba import float64, njit

from .. import force as fo
from .. import surface as su
from . import layout as at
from .contact import place_of
from .events import event_values, first_mode, meet, slip_speed
from .layout import PLAIN
from .motion import derivative, pace_of

# fmt: off


@njit(cache=True, **PLAIN)
def touch(m, w):
    """Begin a contact at the present state."""
    now, tally, z = w.now, w.tally, w.z
    x, _ = place_of(m, z)
    meet(m, w, w.scales[at.ORIGIN] + x)
    tally[at.CONTACTS] += 1.0
    tally[at.T_TOUCH], tally[at.X_TOUCH] = z[at.TIME], x
    now[at.VARIABLE], now[at.AT], now[at.STEP] = at.BY_ROOT_TIME, 0.0, w.scales[at.FIRST_STEP]
    now[at.FRESH], now[at.RECHECK], now[at.TO_RATE] = 1.0, 0.0, 0.0
    rigid = len(m.omega) == 0
    level = w.surface[su.STANDING] == 0.0
    now[at.SIMPLE] = float64(rigid)
    now[at.TURNING] = float64(rigid and level and m.body[at.S_PLATE] == 0.0)
    if m.body[at.COMPLIANCE] < math.inf:
        z[at.SPRING], w.scale[at.SPRING] = 0.0, w.scales[at.SPRING_FORCE]
    now[at.MODE] = 1.0
    derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], w.seen)
    now[at.SIDE] = np.sign(w.seen[at.SLIDING])
    now[at.MODE] = first_mode(m, w)


@njit(cache=True, **PLAIN)
def grip(w):
    """Let a yielding contact rest; its spring keeps the friction that it slid with."""
    w.z[at.SPRING], w.now[at.MODE] = w.seen[at.TANGENTIAL], 0.0
    if w.branch[fo.RECEDING] > 0.0:
        stiff = w.seen[at.STIFFNESS]
        w.z[at.SPRING] = w.z[at.SPRING] / stiff if stiff > 0.0 else 0.0


@njit(cache=True, **PLAIN)
def refresh(m, w):
    """Look at the contact anew after an event: independent variable, derivative, event values."""
    now, branch, seen, z = w.now, w.branch, w.seen, w.z
    derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], seen)
    if now[at.RECHECK] > 0.0 and m.body[at.COMPLIANCE] < math.inf and now[at.MODE] != 0.0:
        slip = slip_speed(m, w, now[at.MODE], w.scales[at.AHEAD], z, w.stages[0], w.moved)
        if now[at.MODE] * slip < 0.0:
            grip(w)
            derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], seen)
    now[at.RECHECK] = 0.0
    rest = branch[1] + branch[2]
    leaving = now[at.PHASE] == at.UNLOAD and now[at.APPROACHING] == 0.0
    left = max(seen[at.DEPTH] - rest, 0.0)
    # by the depth only where it runs out of itself, not where the tip has just turned
    runs = seen[at.RATE] ** 2 > 0.3 * abs(seen[at.ACCELERATION]) * left
    if leaving and now[at.SIMPLE] > 0.0 and left < 0.6 * (branch[0] - rest) and runs:
        now[at.VARIABLE], now[at.AT] = at.BY_ROOT_DEPTH, math.sqrt(left)
        if now[at.STEP] > 0.0:
            # the rest at once where it is little
            now[at.STEP] = -now[at.AT] if left < 0.3 * (branch[0] - rest) else -0.4 * now[at.AT]
    elif leaving and now[at.SIMPLE] > 0.0 and seen[at.RATE] < 0.0:
        # not to the parting, where the force fades like a broken power
        if now[at.VARIABLE] == at.BY_TIME:
            now[at.STEP] = min(now[at.STEP], -0.6 * left / seen[at.RATE])
    if now[at.TO_RATE] > 0.0 or now[at.VARIABLE] == at.BY_RATE:
        now[at.VARIABLE], now[at.AT], now[at.TO_RATE] = at.BY_RATE, seen[at.RATE], 0.0
        now[at.STEP] = -seen[at.RATE]
        if not seen[at.ACCELERATION] < 0.0:
            now[at.VARIABLE], now[at.TURNING] = at.BY_TIME, 0.0
            now[at.STEP] = 1e-3 * w.scales[at.T_REF]
    if now[at.VARIABLE] != at.BY_TIME:
        pace = pace_of(int(now[at.VARIABLE]), now[at.AT], seen)
        for j in range(len(z)):
            w.stages[0, j] *= pace
    w.tally[at.EVALUATIONS] += 1.0
    now[at.FRESH] = 0.0
    if now[at.PHASE] == at.LOAD and seen[at.FORCE] > w.tally[at.TOP_FORCE]:
        w.tally[at.TOP_FORCE], w.tally[at.TOP_TIME] = seen[at.FORCE], z[at.TIME]
    event_values(m, w, z, seen, w.values)
    # What has just crossed zero, as well as an event is met, may fall through it within the first
    # step: a hair below zero it would have no crossing there.
    still = m.body[at.TOLERANCE] * w.scales[at.SPEED]
    for event in (at.TURN, at.RETURNED, at.REST, at.REVERSAL):
        if abs(w.values[event]) <= still:
            w.values[event] = 0.0
