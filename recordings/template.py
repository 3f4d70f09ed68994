"""A recording set to fill in: every key explained, the optional ones commented out."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from ..core.errors import InputError
from ..core.output import write_file
from .columns import MEASURED
from .setup_file import FORMAT

_HEAD = f'''# A quantity is {{ value = ..., std = ... }}, or a plain number that is taken as exact.
# Leave out what you do not know; it gets a wide prior that the report names.
format = "{FORMAT}"
name = "NAME"
description = "what was dropped on what, and how it was measured"
source = "who measured it, where it is published"
licence = "who may use it"
gravity_m_s2 = 9.81

[target]                      # the flat
material = "low-carbon steel"
E_Pa = {{ value = 2.0e11, std = 4.0e9 }}
nu = 0.3
Sy_Pa = {{ value = 3.0e8, std = 1.5e7 }}
density_kg_m3 = 7850
# thickness_m = 0.03
# hardness_Pa = 1.0e9
# Ra_m = 0.4e-6
# cp_J_kgK = 460
# melting_K = 1790
# layer_thickness_m = 1.0e-4
# support_mass_kg = 20
# support_stiffness_N_m = 1.0e9
# law = "elastic-plastic"     # or "elastic", "measured-restitution"
'''

_STRIKER = {
    "rod": """
[strikers.rod]
shape = "rod"
tip_radius_m = {{ value = 9.0e-3, std = 1.0e-4 }}
radius_m = 9.0e-3
length_m = 0.300              # between the centres of the two tip spheres
mass_kg = {{ value = {mass:.4f}, std = 5.0e-4 }}
""",
    "sphere": """
[strikers.ball]
shape = "sphere"
tip_radius_m = {{ value = 9.0e-3, std = 1.0e-5 }}
mass_kg = {{ value = {mass:.5f}, std = 1.0e-5 }}
""",
}

_TAIL = """material = "stainless steel"
density_kg_m3 = 7800
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 7.5e8
# tip_flat_radius_m = 1.0e-3
# inertia_kg_m2 = 4.0e-3

[friction]
# coefficient = { value = 0.15, std = 0.05 }

[environment]
# fluid = "air"
# viscosity_Pa_s = 1.8e-5
# temperature_K = 293

[noise]                       # standard deviations of the columns of trials.csv
restitution = 0.01
permanent_depth_m = 1.0e-6
# NAME_relative where it is a fraction of the value
impact_speed_relative = 0.005
# tip_height_m = 1.0e-5       # of traces
# frame_rate_hz = 80000
"""

_MASS = {"rod": 0.6193, "sphere": 0.02382}


def write_template(folder: Path, *, shape: Literal["rod", "sphere"]) -> None:
    """Write set.toml and trials.csv into a folder.

    Raises
    ------
    InputError
        The folder already holds one of the two files.
    """
    for name in ("set.toml", "trials.csv"):
        if (folder / name).exists():
            raise InputError(
                "there is one already", source=str(folder / name), allowed="a new folder"
            )
    striker = _STRIKER[shape].format(mass=_MASS[shape])
    name, depth = ("rod", "95e-6") if shape == "rod" else ("ball", "19e-6")
    columns = ["trial", "striker", "angle_deg", "drop_height_m", *list(MEASURED)[:2], "note"]
    rows = [columns, ["T01", name, "90", "0.05", "0.5", depth, "an example row: replace it"]]
    text = "\n".join(",".join(row) for row in rows) + "\n"
    write_file(folder / "set.toml", _HEAD + striker + _TAIL)
    write_file(folder / "trials.csv", text)
