"""The mesh of the two bodies: rings about the first contact point, and layers that they form."""

from __future__ import annotations

from .bodies import Mesh, contact_mesh
from .layers import Layers, layers_of
from .rings import Zone, ladder_rings, outer_rings

__all__ = ["Layers", "Mesh", "Zone", "contact_mesh", "ladder_rings", "layers_of", "outer_rings"]
