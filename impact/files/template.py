"""Set-ups to start from: complete, commented, and run as they are."""

from __future__ import annotations

from pathlib import Path

from ...core.errors import InputError
from ...core.output import write_file

_METALS = {
    "target": """E_Pa = 2.0e11                 # Young's modulus
nu = 0.3                      # Poisson's ratio
Sy_Pa = 3.05e8                # yield strength; left out: purely elastic
density_kg_m3 = 7870
""",
    "striker": """E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 1.7e9
density_kg_m3 = 7800
""",
}

_BALL = """[strikers.ball]
shape = "sphere"
tip_radius_m = 0.005
# mass_kg = 4.08e-3           # left out: radius and density give it
"""

_ROD = """[strikers.rod]
shape = "rod"                 # two round ends
tip_radius_m = 0.0088
radius_m = 0.0088             # of the shank
length_m = 0.3048             # between the centres of the two tip spheres
mass_kg = 0.567
"""

_OPTIONS = """# approach_spin_rad_s = 0.0    # counter-clockwise
# laws = ["fitted", "hertz"]   # left out: the fitted law and some published ones
# support = "plate"            # or "half-space", "sprung"; needs target.thickness_m
# repeats = 1                  # blows on the same spot
"""

_TEXTS = {
    "ball": (
        "A steel ball dropped on a steel flat",
        _BALL,
        "",
        "drop_height_m = 0.5           # or impact_speed_m_s\n",
        """[sweep]                       # every combination, into files NAME-sweep
drop_height_m = { from = 0.01, to = 1.0, count = 25, spacing = "log" }
""",
    ),
    "rod": (
        "A steel rod that meets the flat at an angle and bends",
        _ROD,
        "[friction]\ncoefficient = 0.13\n\n",
        """impact_speed_m_s = 1.0        # normal speed of the tip; or drop_height_m
angle_deg = 45                # between axis and flat; 90 is upright
modes = 10                    # vibrations of the rod, lowest first; 0 is rigid
loss_factor = 0.001           # their damping
""",
        """[sweep]                       # every combination, into files NAME-sweep
angle_deg = [30, 45, 60, 75, 90]
""",
    ),
    "oblique-ball": (
        "A steel ball that strikes a steel flat at an angle",
        _BALL,
        "[friction]\ncoefficient = 0.1\n\n",
        """impact_speed_m_s = 2.0        # normal part
angle_deg = 60                # between velocity and flat; gives the tangential speed
""",
        """[sweep]                       # every combination, into files NAME-sweep
angle_deg = { from = 10, to = 90, count = 17 }
friction = [0.05, 0.1, 0.2]
""",
    ),
}

KINDS = tuple(_TEXTS)
"""What there is a set-up for."""


def template(kind: str) -> str:
    """Return the text of a set-up.

    Raises
    ------
    InputError
        There is none of this kind.
    """
    if kind not in _TEXTS:
        raise InputError(
            f"no set-up {kind!r}", source="command line", key="--new", allowed=", ".join(KINDS)
        )
    title, striker, friction, impact, sweep = _TEXTS[kind]
    return (
        f"# {title}: dentscope impact {kind}.toml\n"
        "# A quantity is a number, or { value = ..., std = ... }; all in SI units.\n"
        f'name = "{kind}"\n\n'
        f"[target]                      # the flat\n{_METALS['target']}# thickness_m = 0.03\n\n"
        f"{striker}{_METALS['striker']}\n{friction}"
        f"[impact]\n{impact}{_OPTIONS}\n{sweep}"
    )


def write_template(kind: str, path: Path) -> None:
    """Write a set-up to fill in.

    Raises
    ------
    InputError
        There is none of this kind, or a file of this name exists.
    """
    text = template(kind)
    if path.exists():
        raise InputError("exists", source=str(path), allowed="a name that is free")
    write_file(path, text)
