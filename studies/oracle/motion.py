"""The oracle's equations of motion, in their plain form (corrected 4.6, 4.7)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...core.arrays import Array
from ...dynamics import force as fo
from ...dynamics import surface as su
from ...dynamics.scene import Scene
from ...dynamics.stepping import layout as c

LOADING, UNLOADING, FLIGHT = "loading", "unloading", "flight"

# Places in the oracle's own state: position and angle of the body, rates, support, integrals.
X, Y, TH, VX, VY, OM, W, WR, U, PN, PT, WN, WT, WS, WD, PA = range(16)
Q = 16


@dataclass(slots=True)
class Contact:
    """What changes from phase to phase."""

    phase: str
    sign: float
    offset: float
    surface: Array
    branch: Array = field(default_factory=lambda: np.zeros(fo.N_BRANCH))
    approaching: bool = True
    peak_radius: float = 0.0
    receding: bool = False
    side: float = 0.0


class Motion:
    """Equations of motion of one scene: Coulomb's friction with or without a spring, a support.

    Raises `ValueError`: the scene ploughs, damps, radiates or stands on a plate, or its friction
    falls with speed.
    """

    def __init__(self, scene: Scene, a: c.Given) -> None:
        b, f = a.body, a.force
        if any((b[c.PLOUGH], b[c.S_PLATE], f[fo.DAMPING], f[fo.RADIATION])) or (
            b[c.MU_STATIC] != b[c.MU]
        ):
            raise ValueError("the oracle knows elastic-plastic contact and Coulomb's friction")
        self.a = a
        self.loading, self.radius, self.unloading, self.residual = scene.law.kernels
        # As Python: handing a kernel to compiled code costs far more than these few lines do.
        self.on_loading = fo.static_loading.py_func
        self.on_unloading = fo.static_unloading.py_func
        self.m, self.inertia = float(a.body[c.MASS]), float(a.body[c.INERTIA])
        self.cos0, self.sin0 = float(a.body[c.HALF_COS]), float(a.body[c.HALF_SIN])
        self.theta = math.atan2(self.sin0, self.cos0)
        self.tip = float(a.body[c.TIP])
        self.n = len(a.omega)
        self.mu = float(a.body[c.MU])
        self.spring = float(a.body[c.COMPLIANCE])
        self.compliant = math.isfinite(self.spring)

    def lever(self, z: Array) -> tuple[float, float]:
        """Vector from the centre of mass to the contact point, r_T - r_C."""
        turned, kept = math.sin(z[TH]), math.cos(z[TH])
        return (
            -self.cos0 * kept + self.sin0 * turned,
            -self.sin0 * kept - self.cos0 * turned - self.tip,
        )

    def motion(self, z: Array) -> tuple[float, float, float]:
        """Penetration, its rate, and the sliding velocity."""
        rx, ry = self.lever(z)
        height = z[Y] + (ry + self.sin0 + self.tip)
        vx, vy = z[VX] - z[OM] * ry, z[VY] + z[OM] * rx
        if self.n:
            q, p = z[Q : Q + self.n], z[Q + self.n : Q + 2 * self.n]
            height += float(self.a.psi[1] @ q)
            vx += float(self.a.psi[0] @ p)
            vy += float(self.a.psi[1] @ p)
        return -height - z[W], -vy - z[WR], vx

    def place(self, z: Array) -> tuple[float, float]:
        """Tangential position of the tip's centre, from first touch, and its speed."""
        rx, ry = self.lever(z)
        x, speed = z[X] + rx + self.cos0, z[VX] - z[OM] * (ry + self.tip)
        if self.n:
            x += float(self.a.psi[2] @ z[Q : Q + self.n])
            speed += float(self.a.psi[2] @ z[Q + self.n : Q + 2 * self.n])
        return float(x), float(speed)

    def pressed(self, z: Array, k: Contact) -> tuple[float, float, float]:
        """Depth of the law, its rate, and the slope of the metal that the touch stands on."""
        depth, rate, _ = self.motion(z)
        x, speed = self.place(z)
        low, slope = su.height(k.surface, k.surface[su.STANDING], k.surface[su.BEGIN] + x)
        return depth - k.offset - low, rate - slope * speed, slope

    def clearance(self, z: Array, surface: Array) -> float:
        """Distance of the tip from all that is remembered of the surface."""
        low, _ = su.height(surface, surface[su.COUNT], surface[su.BEGIN] + self.place(z)[0])
        return float(surface[su.TIP_FLAT] + low - self.motion(z)[0])

    def normal(self, z: Array, k: Contact) -> tuple[float, float]:
        """Normal force and the rate of penetration."""
        if k.phase == FLIGHT:
            return 0.0, self.motion(z)[1]
        a = self.a
        d, rate, _ = self.pressed(z, k)
        if k.phase == LOADING:
            f = self.on_loading(self.loading, a.par, a.force, a.factors, d)
        else:
            f = self.on_unloading(self.unloading, a.par, k.branch, d)
        return max(f, 0.0), rate

    def radius_now(self, depth: float, k: Contact) -> float:
        """Contact radius: the law's on loading, about the residual depth as Hertz's else."""
        if k.phase == UNLOADING:
            rest = k.branch[1] + k.branch[2]
            return k.peak_radius * math.sqrt(max(depth - rest, 0.0) / (k.branch[0] - rest))
        return self.pressed_radius(depth)

    def pressed_radius(self, depth: float) -> float:
        """Contact radius on loading, with the flat and the edge of the tip."""
        if depth <= 0.0:
            return 0.0
        flat = float(self.a.force[fo.FLAT])
        x = depth + flat**2 / (2.0 * self.a.force[fo.RADIUS])
        a = max(flat, float(self.radius(self.a.par, x, x)))
        return float(min(a, self.a.force[fo.EDGE]))

    def stiffness(self, z: Array, k: Contact) -> float:
        """Tangential stiffness k_t = s 2 E' a [N/m] (Mindlin 1949)."""
        depth = self.pressed(z, k)[0]
        return float(self.spring * 2.0 * self.a.force[fo.MODULUS] * self.radius_now(depth, k))

    def limit(self, z: Array, k: Contact) -> float:
        """Largest tangential force while the contact slides [N]."""
        return self.mu * self.normal(z, k)[0]

    def slip(self, z: Array, k: Contact, ahead: float) -> float:
        """Speed at which the surfaces slip: the bodies' less the spring's [m/s].

        The spring follows the friction limit, whose rate is a difference along the motion.
        """
        v = self.motion(z)[2]
        depth = self.pressed(z, k)[0] + ahead * self.normal(z, k)[1]
        rate = self.derivative(z, k)
        first, second = z, z + ahead * rate
        # Look back where looking ahead would leave this stretch of the force.
        if k.phase == UNLOADING and depth < k.branch[1] + k.branch[2]:
            first, second = z - 2.0 * ahead * rate, z - ahead * rate
        stiff, later = self.stiffness(first, k), self.stiffness(second, k)
        if stiff <= 0.0 or later <= 0.0:
            return k.sign * abs(v)
        if k.receding:
            change = self.limit(second, k) / later - self.limit(first, k) / stiff
            return v - k.sign * change / ahead
        grows = self.limit(second, k) - self.limit(first, k)
        if k.phase == LOADING:
            # a jump of the force is no rate
            grows = min(grows, self.limit(z, k) - self.limit(z - ahead * rate, k))
        return v - k.sign * grows / (ahead * stiff)

    def held(self, z: Array, k: Contact) -> float:
        """Force of the tangential spring on the striker [N]."""
        return float(z[-1] * self.stiffness(z, k) if k.receding else z[-1])

    def tangential(self, z: Array, k: Contact, f: float) -> tuple[float, float, float]:
        """Force that would hold the contact point, and both parts of its free acceleration."""
        rx, ry = self.lever(z)
        psi, omega = self.a.psi, self.a.omega
        tt = 1.0 / self.m + ry * ry / self.inertia + float(psi[0] @ psi[0])
        tn = rx * (-ry) / self.inertia + float(psi[0] @ psi[1])
        _, _, slope = self.pressed(z, k)
        across = 1.0 / self.m + ry * (ry + self.tip) / self.inertia + float(psi[0] @ psi[2])
        tn += slope * across
        free = -(z[OM] ** 2) * rx
        if self.n:
            q, p = z[Q : Q + self.n], z[Q + self.n : Q + 2 * self.n]
            free -= float(psi[0] @ (omega**2 * q + self.a.body[c.LOSS] * omega * p))
        return -(tn * f + free) / tt, tn * f + free, tt

    def forces(self, z: Array, k: Contact) -> tuple[float, float, float]:
        """Normal and tangential force on the striker, and the rate of penetration."""
        f, rate = self.normal(z, k)
        if k.phase == FLIGHT:
            return 0.0, 0.0, rate
        if k.sign == 0.0:
            return f, self.held(z, k) if self.compliant else self.tangential(z, k, f)[0], rate
        return f, -k.sign * self.limit(z, k), rate

    def derivative(self, z: Array, k: Contact) -> Array:
        """Newton and Euler: m a = F_f i + (F_n - m g) j, I alpha = (r_T - r_C) x F."""
        f, ft, rate = self.forces(z, k)
        rx, ry = self.lever(z)
        b = self.a.body
        # a leaning surface pushes aside as well, through the tip's centre
        aside = f * self.pressed(z, k)[2] if k.phase != FLIGHT else 0.0
        d = np.zeros_like(z)
        d[X], d[Y], d[TH] = z[VX], z[VY], z[OM]
        d[VX], d[VY] = (ft + aside) / self.m, f / self.m - b[c.GRAVITY]
        d[PA] = rx * f - ry * ft - (ry + self.tip) * aside
        d[OM] = d[PA] / self.inertia
        if math.isfinite(b[c.S_MASS]):
            d[W] = z[WR]
            d[WR] = (f - b[c.S_STIFF] * z[W] - b[c.S_DAMP] * z[WR]) / b[c.S_MASS]
            d[WS] = f * z[WR]
        slide = self.motion(z)[2]
        d[U], d[PN], d[PT], d[WN], d[WT] = slide, f, ft + aside, f * rate, -ft * slide
        if k.phase == FLIGHT:
            d[U] = 0.0  # slip is counted in contact
        if self.n:
            q, p = z[Q : Q + self.n], z[Q + self.n : Q + 2 * self.n]
            omega, psi = self.a.omega, self.a.psi
            d[Q : Q + self.n] = p
            d[Q + self.n : Q + 2 * self.n] = (
                psi[0] * ft + psi[1] * f + psi[2] * aside - omega * (omega * q + b[c.LOSS] * p)
            )
            d[WD] = b[c.LOSS] * float(omega @ p**2)
        if self.compliant and k.sign == 0.0 and k.phase != FLIGHT:
            # The spring: its force while the area grows, its deformation while it shrinks.
            d[-1] = -slide if k.receding else -self.stiffness(z, k) * slide
        return d

    def sign_from_rest(self, z: Array, k: Contact, small: float) -> float:
        """Sign of the sliding that follows rest; 0 when friction holds."""
        f = max(self.normal(z, k)[0], small)
        need, pull, _ = self.tangential(z, k, f)
        return 0.0 if abs(need) <= self.mu * f else math.copysign(1.0, pull)

    def sign_at_touch(self, z: Array, k: Contact, ahead: float) -> float:
        """Sign of sliding as a contact that gives way sideways begins; 0 when it sticks."""
        k.sign = 1.0
        later = z + ahead * self.derivative(z, k)
        k.sign = math.copysign(1.0, self.motion(later)[2])
        return k.sign if k.sign * self.slip(later, k, 1e-3 * ahead) > 0.0 else 0.0

    def settle(self, z: Array, k: Contact) -> None:
        """Let the contact rest; its spring keeps the friction that it slid with."""
        force, stiff = self.forces(z, k)[1], self.stiffness(z, k)
        z[-1] = force if not k.receding else (force / stiff if stiff > 0.0 else 0.0)
        k.sign = 0.0
