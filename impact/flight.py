"""Free flight of the striker between two contacts, and where it touches again."""

from __future__ import annotations

import math

import numpy as np
from numba import boolean, float64, njit, types

from ..models.kernel import VECTOR
from .layout import (
    DEPTH,
    FLIGHT,
    GRAVITY,
    LOSS,
    MATRIX,
    N_RIGID,
    PHI,
    RATE,
    SPIN,
    SPOT_PEAK,
    SPOT_TIP,
    TIME,
    VX,
    VY,
    WORK_D,
    X,
    Y,
)
from .motion import crater, kinematics, tip_x


@njit(types.void(VECTOR, VECTOR, VECTOR, float64, VECTOR), cache=True, error_model="numpy")
def coast(body, z, omega, t, z_new):
    """Write the state after a flight of duration t: ballistic motion, free damped vibration."""
    n = len(omega)
    for j in range(len(z)):
        z_new[j] = z[j]
    z_new[X] += z[VX] * t
    z_new[Y] += z[VY] * t - 0.5 * body[GRAVITY] * t * t
    z_new[VY] -= body[GRAVITY] * t
    z_new[PHI] += z[SPIN] * t
    z_new[TIME] += t
    zeta = 0.5 * body[LOSS]
    root = math.sqrt(1.0 - zeta * zeta)
    for k in range(n):
        q, p, w = z[N_RIGID + k], z[N_RIGID + n + k], omega[k]
        fade = math.exp(-zeta * w * t)
        cosine, sine = math.cos(w * root * t), math.sin(w * root * t) / root
        z_new[N_RIGID + k] = fade * (q * (cosine + zeta * sine) + p / w * sine)
        z_new[N_RIGID + n + k] = fade * (p * (cosine - zeta * sine) - q * w * sine)
        energy = p * p + w * w * q * q
        left = z_new[N_RIGID + n + k] ** 2 + (w * z_new[N_RIGID + k]) ** 2
        z_new[WORK_D] += 0.5 * (energy - left)


@njit(float64(VECTOR, VECTOR, VECTOR, float64, MATRIX, VECTOR), cache=True, error_model="numpy")
def clearance(body, spot, z, centre, psi, seen):
    """How far the tip is from meeting the flat below it [m]; negative when it would be inside."""
    n = psi.shape[1]
    kinematics(body, z, psi, n, seen)
    return spot[SPOT_TIP] + crater(spot, centre + tip_x(body, z, psi, n)) - seen[DEPTH]


@njit(
    types.UniTuple(float64, 2)(
        VECTOR, VECTOR, VECTOR, MATRIX, float64, VECTOR, float64, float64, VECTOR, VECTOR
    ),
    cache=True,
    error_model="numpy",
)
def nearest(body, spot, omega, psi, centre, z, low, high, z_new, seen):
    """Return when, between `low` and `high`, the tip stops approaching, and its clearance then.

    It ends at once where the tip is inside. Overwrites `z_new`.
    """
    t, gap = high, 0.0
    for _ in range(40):
        t = 0.5 * (low + high)
        coast(body, z, omega, t, z_new)
        gap = clearance(body, spot, z_new, centre, psi, seen)
        if gap < 0.0 or high - low < 1e-6 * t:
            break
        if seen[RATE] > 0.0:
            low = t
        else:
            high = t
    return t, gap


@njit(
    boolean(VECTOR, VECTOR, VECTOR, MATRIX, float64, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True,
    error_model="numpy",
)
def fly(body, spot, omega, psi, centre, z, z_new, z_now, z_far, seen):
    """Follow a free flight to the next touch; write it into `z_new`; return whether there is one.

    The vibration is known in closed form: the tip is looked at twelve times in each period of
    the fastest mode, between two looks where it comes near the flat and turns, and no longer once
    no vibration can bring it back.
    """
    n = len(omega)
    step = 2.0 * math.pi / (12.0 * omega[n - 1])
    reach = 0.0
    for k in range(n):
        q, p = z[N_RIGID + k], z[N_RIGID + n + k] / omega[k]
        reach += abs(psi[1, k]) * math.sqrt(q * q + p * p)
    for j in range(N_RIGID):
        z_far[j] = z[j]
    for j in range(N_RIGID, len(z)):
        z_far[j] = 0.0
    # Rotation of each mode over one step, so that a look costs no sine.
    turn = np.empty((4, n))
    zeta = 0.5 * body[LOSS]
    root = math.sqrt(1.0 - zeta * zeta)
    for k in range(n):
        w = omega[k]
        fade = math.exp(-zeta * w * step)
        cosine, sine = math.cos(w * root * step), math.sin(w * root * step) / root
        turn[0, k], turn[1, k] = fade * (cosine + zeta * sine), fade * sine / w
        turn[2, k], turn[3, k] = -fade * w * sine, fade * (cosine - zeta * sine)
    for j in range(len(z)):
        z_now[j] = z[j]
    start, end = z[TIME], z[TIME] + body[FLIGHT]
    # The rim of the crater just left is no obstacle: the tip must first have come clear of it.
    # Without a crater it is at the parting, to round-off.
    g = clearance(body, spot, z, centre, psi, seen)
    clear = g >= -1e-9 * spot[SPOT_PEAK]
    g, rate = max(g, 0.0), seen[RATE]
    high = 0.0
    q, p = z_now[N_RIGID : N_RIGID + n], z_now[N_RIGID + n :]
    look, touched = 0, False
    while z_now[TIME] < end and not touched:
        look += 1
        t = look * step
        z_now[TIME] = start + t
        z_now[X] = z[X] + z[VX] * t
        z_now[Y] = z[Y] + z[VY] * t - 0.5 * body[GRAVITY] * t * t
        z_now[PHI] = z[PHI] + z[SPIN] * t
        for k in range(n):
            q0 = q[k]
            q[k] = turn[0, k] * q0 + turn[1, k] * p[k]
            p[k] = turn[2, k] * q0 + turn[3, k] * p[k]
        g_before, rate_before = g, rate
        g = clearance(body, spot, z_now, centre, psi, seen)
        rate = seen[RATE]
        touched, high = g < 0.0 and clear and rate > 0.0, t
        if clear and rate_before > 0.0 > rate:
            # Between the looks the tip came near and turned: a parabola tells how near.
            fall = 0.5 * rate_before * rate_before * step / (rate_before - rate)
            if g_before - fall < 0.01 * reach:
                high, gap = nearest(body, spot, omega, psi, centre, z, t - step, t, z_new, seen)
                touched = gap < 0.0
        clear = g >= 0.0 or (clear and touched)
        if look % 16 == 0 and not touched:
            z_far[X], z_far[Y], z_far[PHI] = z_now[X], z_now[Y], z_now[PHI]
            z_far[VY] = z[VY] - body[GRAVITY] * t
            kinematics(body, z_far, psi, n, seen)
            left = end - z_now[TIME]
            far = seen[DEPTH] + reach + 0.5 * body[GRAVITY] * left * left < spot[SPOT_TIP]
            if far and seen[RATE] < 0.0:
                return False
    if not touched:
        return False
    # The touch lies in (low, high]: false position on the exact motion. A flight shorter than a
    # look starts at the flat: its bracket starts where the tip is off it.
    low = (look - 1) * step
    coast(body, z, omega, low, z_new)
    g_low = clearance(body, spot, z_new, centre, psi, seen)
    if look == 1:
        low = high
        for _ in range(40):
            low *= 0.5
            coast(body, z, omega, low, z_new)
            g_low = clearance(body, spot, z_new, centre, psi, seen)
            if g_low > 0.0:
                break
            high = low
    g_low = max(g_low, 1e-300)
    coast(body, z, omega, high, z_new)
    g_high = clearance(body, spot, z_new, centre, psi, seen)
    side = 0
    for _ in range(100):
        t = (low * g_high - high * g_low) / (g_high - g_low)
        if not low < t < high:
            t = 0.5 * (low + high)
        coast(body, z, omega, t, z_new)
        g = clearance(body, spot, z_new, centre, psi, seen)
        if g < 0.0:
            high, g_high = t, g
            if side == -1:
                g_low *= 0.5
            side = -1
        else:
            low, g_low = t, max(g, 1e-300)
            if side == 1:
                g_high *= 0.5
            side = 1
        if high - low <= 1e-15 * (start + high) or g == 0.0:
            break
    return True
