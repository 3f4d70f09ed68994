"""Stage dynamics: a sphere or a rod striking a flat or a second sphere, or pressed on it."""

from __future__ import annotations

from .batch import impacts
from .beam import Modes, rod_modes
from .columns import Impacts
from .files.blow import Blow
from .integrate import (
    Settings,
    Trace,
    arrays_of,
    strike,
    strike_batch,
    strike_many,
    strike_rows,
    traced,
)  # fmt: skip
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
)  # fmt: skip
from .surface import Imprint, Spot
from .tabulated.law_table import tabulated

__all__ = [
    "CREEP", "Approach", "Blow", "FlowStress", "ForceTransform", "Friction", "Impact", "Impacts",
    "Imprint", "Inferred", "Instrument", "MeasuredScar", "Modes", "Press", "Pressed", "Scene",
    "Settings", "Spot", "Striker", "Support", "Trace", "arrays_of", "dent_radius", "impacts",
    "infer", "pressed", "rod_modes", "scene_of", "strike", "strike_batch", "strike_many",
    "strike_rows", "tabulated", "traced",
]  # fmt: skip
