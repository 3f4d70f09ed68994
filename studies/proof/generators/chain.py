"""The striker as a chain of Timoshenko beam elements with lumped mass: no modes are computed.

Element stiffness of a shear-flexible beam in closed form (Przemieniecki, Theory of Matrix
Structural Analysis, 1968, section 5.6), axial and bending. Node 0 is the struck end; displacements
are along the axis (u), across it (w) and in rotation (f).
"""

from __future__ import annotations

from numba import njit


@njit(cache=True)
def elastic_forces(u, w, f, du, dw, df, length, EA, EI, GA, loss, fu, fw, ff):
    """Write the nodal forces of the chain into `fu`, `fw`, `ff`.

    - `u`, `w`, `f`, `du`, `dw`, `df`: (n,) displacements and their rates; the rate enters through
      `loss`.
    - `length`, `EA`, `EI`, `GA`: element length [m] and line stiffnesses [N, N m^2, N].
    - `loss`: time of stiffness-proportional damping [s].
    - `fu`, `fw`, `ff`: (n,) written.
    """
    n = len(u)
    shear = 12.0 * EI / (GA * length * length)
    k = EI / (length**3 * (1.0 + shear))
    ll = length * length
    for i in range(n):
        fu[i] = 0.0
        fw[i] = 0.0
        ff[i] = 0.0
    for i in range(n - 1):
        j = i + 1
        stretch = EA / length * ((u[j] - u[i]) + loss * (du[j] - du[i]))
        fu[i] += stretch
        fu[j] -= stretch
        a = w[i] + loss * dw[i]
        b = f[i] + loss * df[i]
        c = w[j] + loss * dw[j]
        d = f[j] + loss * df[j]
        cross = 12.0 * (a - c) + 6.0 * length * (b + d)
        fw[i] -= k * cross
        fw[j] += k * cross
        ff[i] -= k * (6.0 * length * (a - c) + (4.0 + shear) * ll * b + (2.0 - shear) * ll * d)
        ff[j] -= k * (6.0 * length * (a - c) + (2.0 - shear) * ll * b + (4.0 + shear) * ll * d)
