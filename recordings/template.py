"""A recording set to fill in: every key explained, what must be known marked, the rest left out."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from ..core.errors import InputError
from ..core.output import write_file
from .setup_file import FORMAT

Shape = Literal["rod", "sphere"]

_HEAD = f'''# "?" stands for what is to be filled in: a number, taken as exact, for example 2.0e11,
# or {{ value = 2.0e11, std = 4.0e9 }}. A key of a body that is not known can be deleted: it gets a
# wide prior that the report names. A line that begins with # says what else may stand here.
format = "{FORMAT}"
name = "NAME"
description = "what was dropped on what, and how it was measured"
source = "who measured it, where it is published"
licence = "who may use it"
gravity_m_s2 = 9.81

[target]                      # the flat
# material = "low-carbon steel"
E_Pa = "?"
nu = "?"
Sy_Pa = "?"                   # or flow_curve = "FILE.csv": plastic_strain, true_stress_Pa
density_kg_m3 = "?"
# thickness_m = 0.03
# hardness_Pa = 1.0e9
# Ra_m = 0.4e-6
# cp_J_kgK = 460
# melting_K = 1790
# layer_thickness_m = 1.0e-4
# support_mass_kg = 20
# support_stiffness_N_m = 1.0e9
# law = "elastic-plastic"     # or "table", "elastic", "measured-restitution"
'''

_STRIKER = {
    "rod": """
[strikers.NAME]
shape = "rod"
tip_radius_m = "?"
radius_m = "?"
length_m = "?"                # between the centres of the two tip spheres
mass_kg = "?"
""",
    "sphere": """
[strikers.NAME]
shape = "sphere"
tip_radius_m = "?"
mass_kg = "?"
""",
}

_COLUMNS = (
    "trial", "striker", "angle_deg", "drop_height_m", "restitution", "permanent_depth_m",
    "dent_diameter_m", "note",
)  # fmt: skip
_USUAL = {"rod": "rod", "sphere": "ball"}
_METAL = """# material = "stainless steel"
density_kg_m3 = "?"
E_Pa = "?"
nu = "?"
Sy_Pa = "?"
# tip_flat_radius_m = 1.0e-3
# inertia_kg_m2 = 4.0e-3
"""

_TAIL = """
[friction]
# coefficient = { value = 0.15, std = 0.05 }

[environment]
# fluid = "air"               # "vacuum" for none
# density_kg_m3 = 1.2
# viscosity_Pa_s = 1.8e-5
# pressure_Pa = 101325
# temperature_K = 293

[noise]                       # standard deviations of the columns of trials.csv
# restitution = 0.01
# permanent_depth_m = 1.0e-6
# dent_edge = "rim"           # where a dent's diameter was read: "contact" if left out
# NAME_relative where it is a fraction of the value
# impact_speed_relative = 0.005
# tip_height_m = 1.0e-5       # of traces
# frame_rate_hz = 80000
"""


def template_text(shape: Shape, name: str, strikers: Sequence[str] = ()) -> str:
    """Return set.toml with the values of all bodies to be filled in, and the set's name."""
    keys = [json.dumps(k, ensure_ascii=False) for k in strikers] or [_USUAL[shape]]
    bodies = "".join((_STRIKER[shape] + _METAL).replace("NAME", key) for key in keys)
    return _HEAD.replace('"NAME"', json.dumps(name, ensure_ascii=False)) + bodies + _TAIL


def refuse_a_set(folder: Path) -> None:
    """Refuse a folder that holds a set.toml or a trials.csv."""
    for name in ("set.toml", "trials.csv"):
        if (folder / name).exists():
            raise InputError(
                "there is one already", source=str(folder / name), allowed="a new folder"
            )


def write_template(folder: Path, *, shape: Shape) -> None:
    """Write set.toml, and trials.csv with its header line, into a folder that holds neither."""
    refuse_a_set(folder)
    write_file(folder / "set.toml", template_text(shape, folder.resolve().name))
    write_file(folder / "trials.csv", ",".join(_COLUMNS) + "\n")
