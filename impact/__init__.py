"""Stage impact: a sphere or a round-ended rod striking a flat or a second sphere, or pressed on it.

The stage itself can be called: `dentscope.impact("ball", angle_deg=60)` is `blow` of the same.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

from .batch import impacts
from .beam import Modes, rod_modes
from .columns import Impacts
from .files.blow import Blow, blow
from .integrate import (
    Settings,
    Trace,
    arrays_of,
    strike,
    strike_batch,
    strike_many,
    strike_rows,
    traced,
)
from .inverse import Inferred, MeasuredScar, infer
from .press import Pressed, dent_radius, pressed
from .result import Impact
from .scene import (
    CREEP,
    Approach,
    FlowStress,
    ForceTransform,
    Friction,
    Instrument,
    Press,
    Scene,
    Striker,
    Support,
    scene_of,
)
from .surface import Imprint, Spot
from .tabulated.law_table import tabulated

__all__ = [
    "CREEP",
    "Approach",
    "Blow",
    "FlowStress",
    "ForceTransform",
    "Friction",
    "Impact",
    "Impacts",
    "Imprint",
    "Inferred",
    "Instrument",
    "MeasuredScar",
    "Modes",
    "Press",
    "Pressed",
    "Scene",
    "Settings",
    "Spot",
    "Striker",
    "Support",
    "Trace",
    "arrays_of",
    "blow",
    "dent_radius",
    "impacts",
    "infer",
    "pressed",
    "rod_modes",
    "scene_of",
    "strike",
    "strike_batch",
    "strike_many",
    "strike_rows",
    "tabulated",
    "traced",
]


class _Stage(ModuleType):
    """The stage, which can be called."""

    def __call__(self, *given: Any, **changes: Any) -> Blow | Impacts:
        """Simulate a blow, as `blow` does."""
        found: Blow | Impacts = blow(*given, **changes)
        return found


sys.modules[__name__].__class__ = _Stage
