"""The stress update: the elastic strain at a material point after a step, and the stress.

Two updates are offered by number (`RADIAL`, `EXACT`). The radial return is first order in the step
when the strain path bends, and under a growing contact it bends everywhere. The exact update slides
along the yield circle (`slide`); its error is of second order.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from ...core.arrays import Array
from .flow import Law, at_point, circle_of, perfect
from .slide import RADIAL, Four, elastic_part, find_slide, is_directed, slid, slid_far, turned
from .tensor import log_strain, norm

Five = tuple[float, float, float, float, float] | Array
"""A deformation gradient, (rr, rz, zr, zz, tt)."""

# limit: stress over strength at which a point becomes plastic [-]: round-off would call converged
# points plastic again on unloading
MARGIN = 1.0 + 1e-10


class MaterialStep(NamedTuple):
    """One step of a material point.

    Parameters
    ----------
    F, F_old
        Deformation gradient now and at the last accepted step [-].
    b_old, e_old
        Elastic left Cauchy-Green tensor at the last accepted step, and the deviator of its
        logarithmic strain [-].
    radius
        sqrt(2/3) Sy / (2 G), radius of the yield circle at rest at J = 1 [-]; `inf` if elastic.
    rule
        `RADIAL` or `EXACT`.
    hard
        Whether the circle grows as `law` says; else it is perfectly plastic.
    law
        How.
    """

    F: Five
    F_old: Five
    b_old: Four
    e_old: Four
    radius: float
    rule: int
    hard: bool
    law: Law


class Updated(NamedTuple):
    """A material point after a step.

    Parameters
    ----------
    e, mean
        Deviator (rr, zz, rz, tt) and mean of the elastic strain.
    plastic
        1 if it flowed, else 0.
    slip
        Length of the plastic increment.
    worked
        Mean radius of the yield circle while it flowed.
    """

    e: Four
    mean: float
    plastic: int
    slip: float
    worked: float


@njit(cache=True)
def hardened(step, law, curve, strain, work):
    """The same step of a point that follows `law`, after a plastic strain and work."""
    here, radius = at_point(law, curve, strain, work)
    return MaterialStep(step.F, step.F_old, step.b_old, step.e_old, radius, step.rule, True, here)


@njit(cache=True)
def trial_of(step):
    """In-plane f = F F_old^-1 (rr, rz, zr, zz) and the trial b = f b_old f^T (rr, zz, rz, tt)."""
    F = step.F
    old = step.F_old
    b = step.b_old
    det = old[0] * old[3] - old[1] * old[2]
    i00 = old[3] / det
    i01 = -old[1] / det
    i10 = -old[2] / det
    i11 = old[0] / det
    f00 = F[0] * i00 + F[1] * i10
    f01 = F[0] * i01 + F[1] * i11
    f10 = F[2] * i00 + F[3] * i10
    f11 = F[2] * i01 + F[3] * i11
    ftt = F[4] / old[4]
    t00 = f00 * b[0] + f01 * b[2]
    t01 = f00 * b[2] + f01 * b[1]
    t10 = f10 * b[0] + f11 * b[2]
    t11 = f10 * b[2] + f11 * b[1]
    return (
        (f00, f01, f10, f11),
        (t00 * f00 + t01 * f01, t10 * f10 + t11 * f11, t00 * f10 + t01 * f11, ftt * ftt * b[3]),
    )


@njit(cache=True)
def _returned(step, f, a, size, radius):
    """Point from the trial point `a`, of length `size`, outside a circle that does not grow."""
    k = radius / size
    if step.rule == RADIAL:
        return k * a[0], k * a[1], k * a[2], k * a[3]
    r = turned(f, step.e_old)
    d = (a[0] - r[0], a[1] - r[1], a[2] - r[2], a[3] - r[3])
    if not is_directed(d, radius):
        return k * a[0], k * a[1], k * a[2], k * a[3]
    t = min(max(elastic_part(r, d, radius), 0.0), 1.0)
    rest = 1.0 - t
    return slid(
        (r[0] + t * d[0], r[1] + t * d[1], r[2] + t * d[2], r[3] + t * d[3]),
        (rest * d[0], rest * d[1], rest * d[2], rest * d[3]),
        radius,
    )


@njit(cache=True)
def returned(step, curve, f, a, size, radius):
    """Updated point from the trial point `a`, of length `size`, outside the yield circle.

    Returns
    -------
    tuple
        The point, the circle that it ends on, whether it slid there and the slide.
    """
    directed, slide = find_slide(step, f, a, radius)
    if not step.hard:
        return _returned(step, f, a, size, radius), perfect(radius, slide.length), directed, slide
    J = radius / step.radius
    if directed and slide.length == 0.0:
        return a, perfect(radius, 0.0), directed, slide
    if directed:
        circle = circle_of(step.law, curve, J, radius, (slide.n, slide.length, slide.c))
        return slid_far(slide, circle), circle, directed, slide
    circle = circle_of(step.law, curve, J, radius, (size, 0.0, 1.0))
    k = circle.end / size
    return (k * a[0], k * a[1], k * a[2], k * a[3]), circle, directed, slide


@njit(cache=True)
def elastic_deviator(step, curve):
    """Elastic deviatoric strain after a step, `Updated`.

    `curve` is the flow curve of a point that hardens, shape (3, n_rows); see `flow.Laws`.
    """
    f, b = trial_of(step)
    a, m = log_strain(b)
    size = norm(a)
    radius = step.radius * math.exp(3.0 * m)
    if size <= radius * MARGIN:
        return Updated(a, m, 0, 0.0, 0.0)
    if step.hard:
        q, circle, _, _ = returned(step, curve, f, a, size, radius)
        return Updated(q, m, 1, circle.flow, circle.worked)
    q = _returned(step, f, a, size, radius)
    slip = norm((a[0] - q[0], a[1] - q[1], a[2] - q[2], a[3] - q[3]))
    return Updated(q, m, 1, slip, norm(q))


@njit(cache=True)
def stress_of(F, G, e, P):
    """Write P = 2 G dev e F^-T into `P` (5,)."""
    g = 2.0 * G / (F[0] * F[3] - F[1] * F[2])
    P[0] = g * (e[0] * F[3] - e[2] * F[1])
    P[1] = g * (e[2] * F[0] - e[0] * F[2])
    P[2] = g * (e[2] * F[3] - e[1] * F[1])
    P[3] = g * (e[1] * F[0] - e[2] * F[2])
    P[4] = 2.0 * G * e[3] / F[4]


@njit(cache=True)
def deviatoric_pk1(step, curve, G, P):
    """Write the deviatoric first Piola-Kirchhoff stress into `P` (5,); return 1 if plastic."""
    done = elastic_deviator(step, curve)
    stress_of(step.F, G, done.e, P)
    return done.plastic
