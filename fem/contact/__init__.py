"""Contact of the two deforming surfaces by node-weighted (mortar) gaps.

The surface of the weaker body is the slave side, the other's the master side: the other way round,
steps fail and take twice the iterations. For the gap both are smoothed to C1 curves. The gap at a
slave point is vertical, g = z_sphere(r) - z_flat(r) at equal current r.

The gap of slave node A is the mean G_A = int N_A g dA / int N_A dA over the reference area
2 pi R dR, its pressure p_A = max(0, -eps_A G_A), so the sum of the pressures is the vertical force
exactly. The force of a point acts normal to the master curve; on each body it goes to the two nodes
of the straight segment, as the elements' own functions have it: a uniform pressure then gives both
bodies the loads of a uniform pressure, whatever the size of their elements, which the weights of
the smooth curves would not. The tangent is therefore not symmetric.
Friction, off unless asked for, holds the surfaces by tractions along them (`friction`).
"""

from __future__ import annotations

from .forces import ContactState, Triplets, contact_forces
from .friction import Grip, take_hold
from .surfaces import POINTS, Surfaces

__all__ = ["POINTS", "ContactState", "Grip", "Surfaces", "Triplets", "contact_forces", "take_hold"]
