"""Stage dynamics: a sphere or a rod striking a flat or a second sphere, or pressed on it."""

from __future__ import annotations

from .batch import impacts
from .beam import Modes, rod_modes
from .integrate import Settings, arrays_of, strike, strike_batch, strike_many, strike_rows, traced
from .press import dent_radius, pressed
from .result import Impact
from .scene import (
    CREEP,
    Approach,
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
    "CREEP", "Approach", "ForceTransform", "Friction", "Impact", "Imprint", "Instrument", "Modes",
    "Press", "Scene", "Settings", "Spot", "Striker", "Support", "arrays_of", "dent_radius",
    "impacts", "pressed", "rod_modes", "scene_of", "strike", "strike_batch", "strike_many",
    "strike_rows", "tabulated", "traced",
]  # fmt: skip
