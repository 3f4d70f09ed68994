"""Stage impact: a sphere or a round-ended rod striking a flat."""

from __future__ import annotations

from .batch import impacts
from .beam import Modes, rod_modes
from .columns import Impacts
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
from .inverse import Inferred, Measured, infer
from .result import Impact
from .scene import (
    Approach,
    FlowStress,
    ForceTransform,
    Friction,
    Instrument,
    Profiles,
    RateFree,
    Scene,
    Striker,
    Support,
    scene_of,
)
from .surface import Imprint, Spot
from .tabulated.law_table import tabulated

__all__ = [
    "Approach",
    "FlowStress",
    "ForceTransform",
    "Friction",
    "Impact",
    "Impacts",
    "Imprint",
    "Inferred",
    "Instrument",
    "Measured",
    "Modes",
    "Profiles",
    "RateFree",
    "Scene",
    "Settings",
    "Spot",
    "Striker",
    "Support",
    "Trace",
    "arrays_of",
    "impacts",
    "infer",
    "rod_modes",
    "scene_of",
    "strike",
    "strike_batch",
    "strike_many",
    "strike_rows",
    "tabulated",
    "traced",
]
