"""What acts in each blow, a row a trial: bodies, settings, and every effect that is switched on."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...core.arrays import Array
from .benches import TOLERANCE, Rig
from .contact import Law, reduced

Factor = Callable[[Array, Array], Array]
"""Of the strength, from contact radius [m] and speed of approach [m/s], (n,) each."""

Rub = Callable[[Array, Array], Array]
"""Of the friction, from speed of sliding [m/s] and contact radius [m]: a factor, or a term."""


@dataclass
class Physics:
    """Rows of blows, SI, (n,) each unless said otherwise; effects are put in place.

    - `rig`, `law`: as stated, and what the metal's dents are like.
    - `R`, `E`, `Y`, `mass`, `inertia`, `mu`, `angle`, `speed`, `tangential`: true values; the
      tangential speed is along +x.
    - `strength`, `rub`, `plough`: factors of the strength, and factors and terms of the friction.
    - `flat`: radius of a flat on the tip [m], 0 for none.
    - `layer`: height of asperities [m], share of the nominal area that they bear on, share of the
      height that a dent keeps.
    - `damper`: form and number of a loss in the contact.
    - `dashpot`: force over a^2 and speed [Pa s/m], of waves that go off into the flat.
    - `plate`: speed of the plate over the force [m/(N s)].
    - `support`: mass, stiffness, damping; none if the mass is 0.
    - `slip`: tangential over Mindlin's stiffness; rigid if 0.
    - `flexible`, `loss`: whether rods vibrate, and their loss time [s].
    - `film`: loss of speed in a film, and its share on the way out.
    - `adhesion`: energy that parting takes [J].
    """

    rig: Rig
    law: Law
    R: Array
    E: Array
    Y: Array
    mass: Array
    inertia: Array
    mu: Array
    angle: Array
    speed: Array
    tangential: Array
    strength: list[Factor] = field(default_factory=list)
    rub: list[Rub] = field(default_factory=list)
    plough: list[Rub] = field(default_factory=list)
    flat: float = 0.0
    layer: tuple[float, float, float] = (0.0, 0.0, 0.0)
    damper: tuple[str, float] = ("", 0.0)
    dashpot: float = 0.0
    plate: float = 0.0
    support: tuple[float, float, float] = (0.0, 0.0, 0.0)
    slip: float = 0.0
    flexible: bool = False
    loss: float = 0.0
    film: tuple[Array, float] | None = None
    adhesion: Array | None = None

    def factor(self, a: Array, v: Array) -> Array:
        """Strength over that stated, of all that acts on it."""
        found = np.exp(-self.law.fall * a / self.R)
        for one in self.strength:
            found = found * one(a, v)
        return found


def physics_of(rig: Rig, law: Law, z: dict[str, float], release: Array | None = None) -> Physics:
    """Return the blows of a rig without effects.

    `rig`, `law`: the rig, and its metal; `z`: what differs from the sheet, in its standard
    deviations; `release`: (n,) factor on each trial's speed.
    """
    off = {k: TOLERANCE[k] * z.get(k, 0.0) for k in TOLERANCE}
    bodies = [rig.strikers[k] for k in rig.which]
    E = np.array(
        [reduced(b.metal.E, b.metal.nu, rig.flat.E, rig.flat.nu) * (1.0 + off["modulus"])
         for b in bodies]
    )  # fmt: skip
    speed = rig.speed * (1.0 + off["speed"]) * (1.0 if release is None else release)
    aslant = np.zeros(len(speed)) if rig.rods else -speed / np.tan(rig.angle)
    Y = min(rig.flat.Sy, rig.flat.E) * (1.0 + off["strength"])
    found = Physics(
        rig, law, R=np.array([b.tip_radius for b in bodies]) * (1.0 + off["tip"]), E=E,
        Y=np.full(len(E), Y), mass=np.array([b.mass for b in bodies]) * (1.0 + off["mass"]),
        inertia=np.array([b.inertia for b in bodies]) * (1.0 + off["mass"]),
        mu=np.full(len(E), rig.mu * (1.0 + off["friction"])),
        angle=rig.angle + off["angle"] * float(rig.rods and rig.oblique), speed=speed,
        tangential=np.where(np.abs(aslant) < 1e-9 * speed, 0.0, aslant),
    )  # fmt: skip
    if rig.curve is not None:
        strain, stress = rig.curve
        # Tabor's representative strain of a dent, 0.2 a/R
        found.strength.append(lambda a, v: np.interp(0.2 * a / found.R, strain, stress))
    return found


@dataclass(frozen=True)
class Bodies:
    """Linear bodies: (n, d) masses, directions of the normal and tangential motion of the contact.

    - `mass`, `normal`, `tangential`, `start`: (n, d) masses, the contact's velocities over those of
      each coordinate, and first velocities.
    - `stiff`: (n, d, d) stiffness, None for rigid ones.
    - `loss`: damping over stiffness [s].
    - `drag`: (n, d) damping of single coordinates [N s/m].
    - `rigid`: (n, 3, d) velocity along y and x of the rigid body's contact, and its spin, from all
      coordinates.
    - `most`: (n,) longest stable step [s].
    - `follow`: (n,) how long the bodies are watched after they part [s].
    """

    mass: Array
    normal: Array
    tangential: Array
    start: Array
    stiff: Array | None
    loss: float
    drag: Array
    rigid: Array
    most: Array
    follow: Array


_NODES = 16


def bodies_of(p: Physics) -> Bodies:
    """Return the coordinates of each blow: centre and spin, or the nodes of a bar or a beam.

    A straight rod is a bar of masses and springs along the fall. One aslant moves as a whole along
    its axis; across it, it is a row of masses whose curvature is that of finite differences. The
    support is one more mass below.
    """
    n = len(p.R)
    half = 0.5 * np.array([p.rig.strikers[k].length for k in p.rig.which])
    sin, cos = np.sin(p.angle), np.cos(p.angle)
    down, ahead = -half * (sin if p.rig.rods else 0.0) - p.R, -half * cos
    one, zero = np.ones(n), np.zeros(n)
    if not p.flexible:
        mass = np.stack([p.mass, p.mass, p.inertia], axis=1)
        normal = np.stack([one, zero, ahead if p.rig.rods else zero], axis=1)
        tangential = np.stack([zero, one, -down], axis=1)
        start = np.stack([-p.speed, p.tangential, zero], axis=1)
        rigid = np.stack([normal, tangential, np.tile([0.0, 0.0, 1.0], (n, 1))], axis=1)
        return _on_support(p, Bodies(mass, normal, tangential, start, None, 0.0, 0.0 * mass, rigid,
                                     np.full(n, np.inf), zero))  # fmt: skip
    k = _NODES
    metal = p.rig.strikers[0].metal
    area = math.pi * p.rig.strikers[0].radius ** 2
    second = area * p.rig.strikers[0].radius ** 2 / 4.0
    pitch = 2.0 * half / (k - 1)
    weight = np.full(k, 1.0)
    weight[[0, -1]] = 0.5
    lumps = p.mass[:, None] * weight / weight.sum()
    sound = math.sqrt(metal.E / metal.density)
    if not p.rig.oblique:
        change = np.diff(np.eye(k), axis=0)
        stiff = (metal.E * area / pitch)[:, None, None] * (change.T @ change)
        normal = np.tile(np.eye(k)[0], (n, 1))
        start = np.tile(-p.speed[:, None], (1, k))
        mean = lumps / p.mass[:, None]
        rigid = np.stack([mean, 0.0 * mean, 0.0 * mean], axis=1)
        return _on_support(p, Bodies(lumps, normal, 0.0 * normal, start, stiff, p.loss, 0.0 * lumps,
                                     rigid, 0.5 * pitch / sound, 12.0 * half / sound))  # fmt: skip
    # along the axis e = (cos, sin) as one, across it w = (-sin, cos) node by node; node 0 below
    place = np.linspace(-1.0, 1.0, k) * half[:, None]
    inertia = np.sum(lumps * place**2, axis=1)
    bend = np.diff(np.eye(k), 2, axis=0)
    stiff = np.zeros((n, k + 1, k + 1))
    stiff[:, 1:, 1:] = (metal.E * second / pitch**3)[:, None, None] * (bend.T @ bend)
    mass = np.concatenate([p.mass[:, None], lumps], axis=1)
    turn = np.zeros((n, k + 1))  # spin of the lower end
    turn[:, 1], turn[:, 2] = -1.0 / pitch, 1.0 / pitch
    lowest = np.eye(k + 1)[1]
    normal = cos[:, None] * lowest + sin[:, None] * np.eye(k + 1)[0]
    tangential = cos[:, None] * np.eye(k + 1)[0] - sin[:, None] * lowest + p.R[:, None] * turn
    start = np.concatenate([(-p.speed * sin)[:, None], np.tile((-p.speed * cos)[:, None], (1, k))],
                           axis=1)  # fmt: skip
    across, spin = np.zeros((n, k + 1)), np.zeros((n, k + 1))
    across[:, 1:], spin[:, 1:] = lumps / p.mass[:, None], lumps * place / inertia[:, None]
    along = np.tile(np.eye(k + 1)[0], (n, 1))
    up = sin[:, None] * along + cos[:, None] * across + ahead[:, None] * spin
    right = cos[:, None] * along - sin[:, None] * across - down[:, None] * spin
    rigid = np.stack([up, right, spin], axis=1)
    bending = sound * p.rig.strikers[0].radius / 2.0
    return _on_support(p, Bodies(mass, normal, tangential, start, stiff, p.loss, 0.0 * mass, rigid,
                                 0.2 * pitch**2 / bending, np.full(n, 1e-3)))  # fmt: skip


def _on_support(p: Physics, b: Bodies) -> Bodies:
    """The same with the flat as one more mass on a spring, if it is one."""
    mass, stiffness, damping = p.support
    if mass == 0.0:
        return b
    n, d = b.mass.shape

    def more(x: Array, value: float) -> Array:
        return np.concatenate([x, np.full((n, 1), value)], axis=1)

    stiff = np.zeros((n, d + 1, d + 1))
    if b.stiff is not None:
        stiff[:, :d, :d] = b.stiff
    stiff[:, d, d] = stiffness
    return Bodies(
        more(b.mass, mass), more(b.normal, -1.0), more(b.tangential, 0.0), more(b.start, 0.0),
        stiff, b.loss, more(b.drag, damping), np.pad(b.rigid, ((0, 0), (0, 0), (0, 1))), b.most,
        b.follow,
    )  # fmt: skip
