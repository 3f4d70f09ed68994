"""For MuJoCo, Drake and YADE, and a formula of e.

Each program joins the numbers of two bodies in its own way; the lines give both bodies the same, so
that the contact has what the table says.

MuJoCo, Computation, solver parameters: with negative `solref` the acceleration of the contact is
-stiffness r - damping v, whatever masses and `solimp` are. Drake, compliant point contact:
k_1 k_2/(k_1 + k_2) and k x max(1 + d x', 0). YADE, LudingPM: S. Luding, Granular Matter 10 (2008)
235, Eqs. 6 to 8; its `reduced` numbers are those of two like bodies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from ...core.arrays import Array
from ...core.material import Pair
from ...models.base import ContactLaw
from ..batch import impacts
from ..mechanisms.asked import NONE_ASKED, Asked
from .collisions import DASHPOT, HUNT
from .discrete_elements import ExportedRow, Substitute, ball_scene

# limit: moment of inertia from which MuJoCo takes a body (mjMINVAL) [kg m^2]
_MUJOCO_LEAST = 1e-15


class BodiesMet(NamedTuple):
    """What the lines need beside the rows."""

    radius: float  # effective [m]
    mass: float  # effective [kg]
    friction: float  # [-]


_MUJOCO = """<!-- `python mujoco_drop.py` drops a ball at each speed and prints its restitution.
     Take the class of your impacts for both geoms. solref below 0: stiffness and damping over the
     effective mass. The contact lets go where it would pull. -->
<mujoco>
<option timestep="{step:.3e}" gravity="0 0 0" integrator="RK4"/>
<default>
{classes}
</default>
<worldbody>
{bodies}
</worldbody>
<keyframe><key qvel="{speeds}"/></keyframe>
</mujoco>
"""

_MUJOCO_DROP = """import mujoco

model = mujoco.MjModel.from_xml_path("mujoco.xml")
data = mujoco.MjData(model)
mujoco.mj_resetDataKeyframe(model, data, 0)
before = -data.qvel[2::6]
while data.time < {end:.3e}:
    mujoco.mj_step(model, data)
for speed, back in zip(before, data.qvel[2::6], strict=True):
    print(f"v = {{speed:g}} m/s: restitution {{back / speed:.4f}}")
"""


def mujoco_files(rows: Sequence[ExportedRow], contact: BodiesMet) -> dict[str, str]:
    """A model of MuJoCo with a ball for each speed, and the script that drops them."""
    classes, bodies, speeds, times = list[str](), list[str](), list[str](), list[float]()
    R = contact.radius
    for row in rows:
        s, name, x = row.named(DASHPOT.name), f"v{row.law.speed:g}", 4.0 * R * len(times)
        if s is None:
            classes.append(f"<!-- {row.without(DASHPOT.name)} -->")
            continue
        k, b = s.stiffness / contact.mass, s.damping / contact.mass
        classes += [
            f"<!-- {_told(row, s)} -->",
            f'<default class="{name}"><geom solref="{-k:.6e} {-b:.6e}" '
            f'solimp="0.9999 0.9999 0.001 0.5 2" friction="{contact.friction:g} 0 0"/></default>',
        ]
        bodies += [
            f'<geom class="{name}" type="box" size="{R:g} {R:g} {R:g}" pos="{x:g} 0 {-R:g}"/>',
            f'<body pos="{x:g} 0 {R:.12g}"><freejoint/><geom class="{name}" type="sphere" '
            f'size="{R:.12g}" mass="{contact.mass:.10g}"/></body>',
        ]
        speeds.append(f"0 0 {-row.law.speed:g} 0 0 0")
        times.append(s.blow.time)
    if not times:
        return {"mujoco.xml": "\n".join(classes) + "\n"}
    if 0.4 * contact.mass * R**2 < _MUJOCO_LEAST:
        classes.insert(0, "<!-- too light for MuJoCo in SI: give all in mm and mg -->")
    model = _MUJOCO.format(
        step=min(times) / 1000.0, classes="\n".join(classes), bodies="\n".join(bodies),
        speeds=" ".join(speeds),
    )  # fmt: skip
    return {"mujoco.xml": model, "mujoco_drop.py": _MUJOCO_DROP.format(end=1.5 * max(times))}


def drake_lines(rows: Sequence[ExportedRow], contact: BodiesMet) -> str:
    """Python for Drake's point contact, of both bodies."""
    mu = f"CoulombFriction({contact.friction:g}, {contact.friction:g})"
    lines = ["# pydrake.geometry; the same properties for both bodies."]
    for row in rows:
        s = row.named(HUNT.name)
        if s is None:
            lines.append(f"# {row.without(HUNT.name)}")
            continue
        # two bodies in series halve the stiffness, and keep one dissipation
        lines += [
            f"# {_told(row, s)}",
            f"AddContactMaterial(dissipation={s.damping:.6e}, point_stiffness="
            f"{2.0 * s.stiffness:.6e}, friction={mu}, properties=props)",
        ]
    return "\n".join(lines) + "\n"


_YADE = """# `yade -n -x yade_drop.py` drops a ball on a flat; restitutions are printed.
# A wall of YADE has no radius, which this law needs: the flat is a fixed sphere of the ball's. PhiF
# is of two radii a, b with 2 a b/(a + b) = {R:g} m, ks 2/7 of k1.
{told}
BLOWS = [  # speed [m/s], k1 and kp [N/m], PhiF [-], time step [s]
{blows}
]
for speed, k1, kp, PhiF, dt in BLOWS:
    O.reset()
    O.materials.append(
        LudingMat(
            density={density:.10g}, k1=k1, kp=kp, ks=k1 / 3.5, kc=0, PhiF=PhiF, G0=0,
            frictionAngle={angle:.6g},
        )
    )
    R = {R:.10g}
    O.bodies.append([utils.sphere((0, 0, -R), R, fixed=True), utils.sphere((0, 0, R), R)])
    O.bodies[1].state.vel = (0, 0, -speed)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_LudingMat_LudingMat_LudingPhys()],
            [Law2_ScGeom_LudingPhys_Basic()],
        ),
        NewtonIntegrator(damping=0),
    ]
    O.dt = dt
    O.run(3000, True)
    print(f"v = {{speed:g}} m/s: restitution {{O.bodies[1].state.vel[2] / speed:.4f}}")
"""


def yade_script(rows: Sequence[ExportedRow], contact: BodiesMet) -> str:
    """A script of YADE: the linear hysteretic law (Luding), dropped at each speed."""
    blows, told, R = [], [], contact.radius
    for row in rows:
        s = row.named("linear-hysteretic")
        assert s is not None  # it takes every restitution
        k1, k2 = s.stiffness, s.unloading
        phi = max(s.blow.depth * (1.0 - k1 / k2) / R, 0.0)
        told.append(f"# {_told(row, s)}")
        blows.append(
            f"    ({row.law.speed:g}, {k1:.6e}, {k2:.6e}, {phi:.6e}, {s.blow.time / 2000.0:.4e}),"
        )
    return _YADE.format(
        told="\n".join(told), blows="\n".join(blows), angle=math.atan(contact.friction), R=R,
        density=contact.mass / (4.0 / 3.0 * math.pi * R**3),
    )  # fmt: skip


def _told(row: ExportedRow, s: Substitute) -> str:
    return (
        f"{row.law.speed:g} m/s: {s.told(row.law)}; contact {s.blow.time:.2e} s: several tens of "
        "time steps"
    )


class Formula(NamedTuple):
    """e(v) = (1 + (v/v_0)^a)^(-b) between two speeds."""

    v0: float  # [m/s]
    a: float
    b: float
    first: float  # [m/s]
    last: float  # [m/s]
    missed: float  # largest difference of a restitution

    def __call__(self, speed: float) -> float:
        """Return the restitution."""
        return float((1.0 + (speed / self.v0) ** self.a) ** -self.b)


def formula_of(
    law: ContactLaw, pair: Pair, *, mass: float, speeds: Sequence[float], asked: Asked = NONE_ASKED
) -> Formula:
    """Fit the formula to a law's restitution between the first and the last speed [m/s].

    Around a single one it is a factor of three either way. `asked`: as of `substitutes`.
    """
    first, last = min(speeds), max(speeds)
    if last < 1.5 * first:
        first, last = first / 3.0, 3.0 * last
    v = np.geomspace(first, last, 25)
    scene = ball_scene(law, pair, mass=mass, speed=first)
    e = np.asarray(impacts(scene, speeds=v, asked=asked)["restitution"], dtype=float)

    known = np.log(v)
    middle = float(known[12])

    def of(x: Array) -> Array:
        # as logarithms: powers of small and large speeds overflow
        falls = np.logaddexp(0.0, np.exp(x[1]) * (known - x[0]))
        return np.asarray(np.exp(-np.exp(x[2]) * falls))

    # a flat curve leaves its constants free: they stay within what a number holds
    bounds = ([middle - 40.0, -5.0, -12.0], [middle + 40.0, 4.0, 5.0])
    fits = [
        least_squares(lambda x: of(x) - e, [start, 0.0, -1.0], bounds=bounds)
        for start in (middle - 4.0, middle, middle + 4.0)
    ]
    best = min(fits, key=lambda one: one.cost)
    v0, a, b = (float(x) for x in np.exp(best.x))
    return Formula(v0, a, b, first, last, float(np.max(np.abs(of(best.x) - e))))


def formula_lines(found: Formula) -> str:
    """The formula in words."""
    return (
        "e(v) = (1 + (v/v0)^a)^(-b)\n"
        f"v0 = {found.v0:.6g} m/s; a = {found.a:.6g}; b = {found.b:.6g}\n"
        f"from {found.first:g} to {found.last:g} m/s within {found.missed:.1e}\n"
    )
