"""Force, contact radius and shares of the approach, read off a converged state.

The thesis's definitions (section 2.1): F is the reaction at the driven face, delta_s the
displacement of the sphere's pole relative to that face, delta_f the displacement of the flat's
surface on the axis, a the radius of the last node in contact. The contact radius that we use is
finer than the mesh: the opening gap beside the contact is fitted by
g = alpha s + beta s^(3/2), s = r - a, alpha, beta >= 0, which is the elastic (3/2) and the plastic
(kinked) shape in one, and a is its zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ..contact import ContactState
from ..discretise import Discretisation
from ..newton import Equilibrium
from ..rules import RULES


@dataclass(frozen=True)
class Reading:
    """One state's results with R = 1 and E' = 1."""

    delta: float
    force: float
    radius: float
    radius_last_node: float
    sphere: float
    flat: float
    force_defect: float
    place: float

    @property
    def share(self) -> float:
        """The sphere's part of the approach."""
        return self.sphere / (self.sphere + self.flat)


def read(grid: Discretisation, state: Equilibrium, delta: float) -> Reading:
    """Measure a converged state at approach `delta`."""
    x = grid.mesh.points + state.u.reshape(-1, 2)
    active = np.flatnonzero(state.contact.pressure > 0.0)
    last = float(x[grid.surfaces.slave[active[-1]], 0]) if len(active) else 0.0
    radius = edge_of_contact(state.contact, x[grid.surfaces.slave, 0])
    return Reading(
        delta=delta,
        force=state.reaction,
        radius=radius,
        radius_last_node=last,
        sphere=delta + float(state.u[2 * grid.surfaces.sphere[0] + 1]),
        flat=-float(state.u[2 * grid.surfaces.flat[0] + 1]),
        force_defect=(state.contact.force - state.reaction) / state.reaction
        if state.reaction
        else 0.0,
        place=_place(grid, x, radius),
    )


def _place(grid: Discretisation, x: Array, radius: float) -> float:
    """Where the edge of contact stands on the slave's surface, counted in fine rings."""
    slave = grid.surfaces.slave[1:]
    ring = np.log(np.hypot(*grid.mesh.points[slave].T) / grid.mesh.rings[-1])
    return float(np.interp(radius, x[slave, 0], ring) / np.log1p(grid.fine))


def edge_of_contact(contact: ContactState, slave_r: Array) -> float:
    """Radius at which the gap opens, from the shape of the gap just outside the contact.

    `slave_r` are current radii of the slave nodes, shape (n_slave,) [R].
    """
    active = np.flatnonzero(contact.pressure > 0.0)
    if len(active) == 0:
        return 0.0
    k = int(active[-1])
    # the element beyond the last active node is partly closed: the fit starts at the next one
    first = min(k + 1, len(contact.gap) - 1)
    r = contact.r[first : first + RULES.gap_edges].ravel()
    g = contact.gap[first : first + RULES.gap_edges].ravel()
    if len(r) < 6:
        return float("nan")  # the contact has grown out of the surface that was meshed to touch
    h = float(slave_r[min(k + 1, len(slave_r) - 1)] - slave_r[max(k - 1, 0)]) * 0.5
    edges = slave_r[k] + h * np.linspace(-1.0, 1.4, RULES.edge_candidates)
    misfit = _misfits(edges, r, g)
    best = int(misfit.argmin())
    if 0 < best < RULES.edge_candidates - 1:
        left, mid, right = misfit[best - 1 : best + 2]
        curvature = left - 2.0 * mid + right
        shift = 0.5 * (left - right) / curvature if curvature > 0.0 else 0.0
        return float(edges[best] + shift * (edges[1] - edges[0]))
    return float(edges[best])


def _misfits(edges: Array, r: Array, g: Array) -> Array:
    """Misfit of a gap that opens at each of the edges as alpha s + beta s^1.5, both positive."""
    s = np.maximum(r - edges[:, None], 0.0)
    # relative weights: the nearest points say most about where the gap opens
    weight = 1.0 / (s + s.max(axis=1, keepdims=True) * 0.1)
    one, other, y = s * weight, s**1.5 * weight, g * weight
    a, b, c = (np.sum(u * v, axis=1) for u, v in ((one, one), (one, other), (other, other)))
    p, q = np.sum(one * y, axis=1), np.sum(other * y, axis=1)
    det = a * c - b**2
    alpha, beta = (c * p - b * q) / det, (a * q - b * p) / det
    without = alpha < 0.0
    alone = ~without & (beta < 0.0)
    alpha, beta = (
        np.where(without, 0.0, np.where(alone, p / a, alpha)),
        np.where(without, q / c, np.where(alone, 0.0, beta)),
    )
    left = alpha[:, None] * one + beta[:, None] * other - y
    return np.asarray(np.sum(left**2, axis=1))
