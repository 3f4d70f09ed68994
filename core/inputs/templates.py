"""Files to start from: complete, every key explained, and sound as they are.

They are text alone: a template is written without loading what reads it.
"""

from __future__ import annotations

from pathlib import Path
from shlex import quote

from ..errors import InputError
from ..output import write_file

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
        'drop_height_m = { from = 0.01, to = 1.0, count = 25, spacing = "log" }\n',
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
        "angle_deg = [30, 45, 60, 75, 90]\n",
    ),
    "oblique-ball": (
        "A steel ball that strikes a steel flat at an angle",
        _BALL,
        "[friction]\ncoefficient = 0.1\n\n",
        """impact_speed_m_s = 2.0        # normal part
angle_deg = 60                # between velocity and flat; gives the tangential speed
""",
        """angle_deg = { from = 10, to = 90, count = 17 }
friction = [0.05, 0.1, 0.2]
""",
    ),
}

KINDS = tuple(_TEXTS)
"""What there is a set-up for."""


def template(kind: str) -> str:
    """Return the text of a set-up, or refuse a kind that there is not."""
    if kind not in _TEXTS:
        raise InputError(
            f"no set-up {kind!r}", source="command line", key="--new", allowed=", ".join(KINDS)
        )
    title, striker, friction, impact, sweep = _TEXTS[kind]
    return (
        f"# {title}: dentscope impact {{name}}\n"
        "# A quantity is a number, or { value = ..., std = ... }; all in SI units.\n"
        f'name = "{kind}"\n\n'
        f"[target]                      # the flat\n{_METALS['target']}# thickness_m = 0.03\n\n"
        f"{striker}{_METALS['striker']}\n{friction}"
        f"[impact]\n{impact}{_OPTIONS}\n"
        f"[sweep]                       # every combination, into files NAME-sweep\n{sweep}"
    )


CASE = """\
# A hard steel ball on a softer steel flat: dentscope case {name}
radius_m = 0.005                # of the ball

[sphere]
E_Pa = 2.1e11                   # Young's modulus
nu = 0.3
Sy_Pa = 2.0e9                   # yield strength; left out: purely elastic
density_kg_m3 = 7800            # of the ball, for its speed at first yield
# rigid = true                  # instead of the three: does not deform at all

[flat]
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 3.0e8
# flow_curve = "curve.csv"      # columns plastic_strain and stress_Pa, instead of Sy_Pa

# [flat.hardening]              # the flow stress grows with plastic strain p
# law = "swift"                 # K (e0 + p)^n; or ludwik, voce, johnson-cook
# K_Pa = 7.0e8
# n = 0.22

# [flat.rate]                   # and with its rate; then load.speed_m_s is needed
# law = "cowper-symonds"        # times 1 + (rate/D)^(1/q); or johnson-cook, overstress
# D_1_s = 40.0
# q = 5.0

# [flat.heating]                # and falls with the heat of the deformation
# capacity_J_m3K = 3.6e6
# melting_rise_K = 1500.0

[load]
max_delta_over_R = 0.01         # largest approach over the ball's radius
unload_from = [0.001, 0.003, 0.01]  # approaches over R from which the ball is drawn back
# speed_m_s = 1.0               # of the approach; or [[0.0, 1.0], [0.01, 0.1]], Delta/R and speed

[accuracy]
level = "smoke"                 # minutes: smoke, quick, production; smoke is coarse
"""
"""CASE.toml, with its own name in it."""

INVERSE = """\
# Duration and mean force of an oblique blow from its scar: dentscope inverse {name}
[striker]                       # a rod with two round ends
tip_radius_m = 0.0088
radius_m = 0.0088               # of the shank
length_m = 0.3048               # between the centres of the two tip spheres
mass_kg = 0.567
# inertia_kg_m2 = 4.5e-3        # left out: of a rod of this size and mass

[[trial]]                       # as many as there are
trial = "T01"
angle_deg = 45                  # between the rod's axis and the flat
impact_speed_m_s = 2.18         # of the tip, along the flat's normal
friction_impulse_ratio = 0.13   # tangential over normal impulse
restitution = 0.49
permanent_depth_m = 26e-6
sliding_length_m = 1650e-6      # path of the touching point, not a scar less its width
# rebound_m_s = 1.07            # of the tip, where it was measured
"""
"""An inverse file, with its own name in it."""


def write_new(text: str, path: Path, *, command: str) -> str:
    """Write a file to start from; return what to do with it. One that exists is refused."""
    if path.exists():
        raise InputError("exists", source=str(path), allowed="a name that is free")
    write_file(path, text.replace("{name}", quote(path.name)))
    return f"{path}: change what differs, then: dentscope {command} {quote(str(path))}"
