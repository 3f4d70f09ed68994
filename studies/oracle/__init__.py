"""The oracle: impacts by a library's integrator, to check the walk of `impact` against.

It shares with the walk the contact law's kernels and the surface, and no event rule. Slower by a
factor of some hundred; nothing but checks uses it.
"""

from __future__ import annotations

from .walk import oracle_impact

__all__ = ["oracle_impact"]
