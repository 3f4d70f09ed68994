"""Base law two: a row of elastic-plastic springs on which the axisymmetric contact is laid out.

The method of dimensionality reduction maps an axisymmetric contact exactly onto a row of
independent springs of stiffness E' per length (Popov and Hess, Method of Dimensionality Reduction
in Contact Mechanics and Friction, Springer 2015, chapter 3). Here each spring also yields: at the
place x of a contact of half-width a it carries at most 2 H sqrt(a^2 - x^2), the image of a uniform
pressure H. Pile-up widens the profile as the dent grows. History, unloading and residual depth
follow from the springs; there is no unloading law.

The coefficients for all pairs alike were fitted to the same finite-element curves as those of
`cavity`, and leave about as much (residual depth below W = 30: 30 %).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

N_SPRINGS = 64
PLACE = ((np.arange(N_SPRINGS) + 0.5) / N_SPRINGS) ** 2
"""Places of the springs over the edge of the row: fine where first contact is made."""

# W = (peak / R) (E'/Sy)^2: profile 1 + WIDE x/(1+x), x = (W/W_WIDE)^S_WIDE;
# pressure limit over Sy from LOW to HIGH over W_HARD, less FALL a/R
COEFFICIENTS = np.array([1.744, 457.7, 0.8543, 0.6734, 2.810, 17.10, 0.1176])


@njit(cache=True)
def spread(W, c):
    """Profile widening (a^2 = spread R depth) of a dent of plasticity index W."""
    x = (W / c[1]) ** c[2]
    return 1.0 + c[0] * x / (1.0 + x)


@njit(cache=True)
def limit(W, a_R, c):
    """Pressure limit over yield strength."""
    x = W / c[5]
    return (c[3] + (c[4] - c[3]) * x / (1.0 + x)) * max(1.0 - c[6] * a_R, 0.3)


@njit(cache=True)
def press(depth, peak, edge, E, R, Y, c, place, plastic, force):
    """Move the row of springs to `depth`; return the force, the half-width and the plastic work.

    - `depth`, `peak`: present and largest depth [m].
    - `edge`: largest half-width of the row [m]; `place` holds fractions of it.
    - `E`, `R`, `Y`: reduced modulus [Pa], radius [m], strength of the flat [Pa].
    - `c`: coefficients.
    - `place`, `plastic`, `force`: (n,) place over `edge`, ((i + 1/2)/n)^2; plastic shortening [m];
      force per length [N/m]. The last two are written.
    """
    W = peak / R * (E / Y) ** 2
    wide = spread(W, c) * R
    a2_peak = wide * peak
    h = limit(W, math.sqrt(a2_peak) / R, c) * Y
    total = 0.0
    half = 0.0
    n = len(place)
    a2 = wide * depth if depth > 0.0 else 0.0
    work = 0.0
    for i in range(n):
        root = (i + 0.5) / n
        x = place[i] * edge
        dx = 2.0 * root / n * edge
        u = depth - x * x / wide
        q = E * (u - plastic[i])
        if q <= 0.0:
            force[i] = 0.0
            continue
        b2 = a2 - x * x
        cap = 2.0 * h * math.sqrt(b2) if b2 > 0.0 else 0.0
        if peak <= depth and q > cap:
            work += cap * (q - cap) / E * dx
            plastic[i] = u - cap / E
            q = cap
        force[i] = q
        total += q * dx
        half = x
    return 2.0 * total, half, 2.0 * work
