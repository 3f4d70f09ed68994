"""The reference integrator: scipy's DOP853 with its own event location, one phase after another.

Written from the equations of motion in their plain form (corrected 4.6, 4.7): it shares the
contact law's kernels with `compiled.py` and nothing of its dynamics. Slower by a factor of about
a hundred; it also gives the histories that the figures show.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from . import force as fo
from . import layout as c
from .events import reference_depth
from .integrate import Arrays, Settings, arrays_of, kernels_of, spot_row
from .result import Impact, impact_of
from .scene import Scene

Array = NDArray[np.float64]

HISTORY = (
    "time_s", "penetration_m", "normal_force_N", "tangential_force_N", "normal_velocity_m_s",
    "sliding_velocity_m_s", "tip_height_m", "slip_m", "angle_rad", "spin_rad_s",
)  # fmt: skip

LOADING, UNLOADING, FLIGHT = "loading", "unloading", "flight"


@dataclass(frozen=True, slots=True)
class Trace:
    """An impact with its history: (n, len(HISTORY)) rows, the columns of HISTORY."""

    impact: Impact
    history: Array

    def column(self, name: str) -> Array:
        """Return one column of the history by its name in `HISTORY`."""
        return np.asarray(self.history[:, HISTORY.index(name)])


# Places in the reference's own state: position and angle of the body, rates, support, integrals.
_X, _Y, _TH, _VX, _VY, _OM, _W, _WR, _U, _PN, _PT, _WN, _WT, _WS, _WD = range(15)
_Q = 15


@dataclass(slots=True)
class _Contact:
    """What changes from phase to phase."""

    phase: str
    sign: float
    offset: float
    local: float
    branch: Array = field(default_factory=lambda: np.zeros(fo.N_BRANCH))
    approaching: bool = True
    low: float = 0.0
    high: float = math.inf
    peak_radius: float = 0.0
    receding: bool = False
    side: float = 0.0

    def stretch(self, breaks: Array, depth: float) -> None:
        """Bound the loading curve to its smooth stretch around `depth`."""
        above = breaks[breaks > depth * (1.0 + 2e-13)]
        below = breaks[breaks <= depth * (1.0 + 2e-13)]
        self.low = float(below[-1]) * (1.0 + 1e-13) if len(below) else 0.0
        self.high = float(above[0]) * (1.0 - 1e-13) if len(above) else math.inf


class _Motion:
    """Equations of motion of one scene."""

    def __init__(self, scene: Scene, a: Arrays) -> None:
        self.a = a
        self.loading, self.radius, self.unloading, self.residual = kernels_of(scene.law)
        # As Python: handing a kernel to compiled code costs far more than these few lines do.
        self.on_loading = fo.static_loading.py_func
        self.on_unloading = fo.static_unloading.py_func
        self.m, self.inertia = float(a.body[c.MASS]), float(a.body[c.INERTIA])
        self.cos0, self.sin0 = float(a.body[c.HALF_COS]), float(a.body[c.HALF_SIN])
        self.theta = math.atan2(self.sin0, self.cos0)
        self.tip = float(a.body[c.TIP])
        self.n = len(a.omega)
        self.mu, self.mu_s = float(a.body[c.MU]), float(a.body[c.MU_STATIC])
        self.spring = float(a.body[c.COMPLIANCE])
        self.compliant = math.isfinite(self.spring)

    def lever(self, z: Array) -> tuple[float, float]:
        """Vector from the centre of mass to the contact point, r_T - r_C."""
        turned, kept = math.sin(z[_TH]), math.cos(z[_TH])
        return (
            -self.cos0 * kept + self.sin0 * turned,
            -self.sin0 * kept - self.cos0 * turned - self.tip,
        )

    def motion(self, z: Array) -> tuple[float, float, float]:
        """Penetration, its rate without a plate's, and the sliding velocity."""
        rx, ry = self.lever(z)
        height = z[_Y] + (ry + self.sin0 + self.tip)
        vx, vy = z[_VX] - z[_OM] * ry, z[_VY] + z[_OM] * rx
        if self.n:
            q, p = z[_Q : _Q + self.n], z[_Q + self.n : _Q + 2 * self.n]
            height += float(self.a.psi[1] @ q)
            vx += float(self.a.psi[0] @ p)
            vy += float(self.a.psi[1] @ p)
        return -height - z[_W], -vy - z[_WR], vx

    def place(self, z: Array) -> float:
        """Tangential position of the contact on the flat, from first touch."""
        rx, _ = self.lever(z)
        modal = float(self.a.psi[0] @ z[_Q : _Q + self.n]) if self.n else 0.0
        return float(z[_X] + rx + self.cos0 + modal)

    def normal(self, z: Array, k: _Contact) -> tuple[float, float, float]:
        """Normal force, ploughing coefficient and the true rate of penetration."""
        depth, rate, _ = self.motion(z)
        if k.phase == FLIGHT:
            return 0.0, 0.0, rate
        a, d = self.a, depth - k.offset
        if k.phase == LOADING:
            d = min(max(d, k.low), k.high)
            f = self.on_loading(self.loading, a.par, a.force, a.factors, d)
        else:
            f = self.on_unloading(self.unloading, a.par, k.branch, d)
        plough = 0.0
        if a.body[c.PLOUGH]:
            peak = max(d, k.branch[0]) if k.phase == UNLOADING else d
            radius = self.radius(a.par, d, peak) if d > 0.0 else 0.0
            plough = a.body[c.PLOUGH] * 4.0 / (3.0 * math.pi) * radius / self.tip
        if a.force[fo.RADIATION]:
            f += a.force[fo.RADIATION] * self.slope(d, k) ** 2 * rate
        f = max(f * (1.0 + a.force[fo.DAMPING] * rate), 0.0)
        return f, plough, rate - a.body[c.S_PLATE] * f

    def slope(self, d: float, k: _Contact) -> float:
        """Slope of the static force over the depth: waves take kappa (dF/dt)^2."""
        a = self.a
        if k.phase == LOADING:
            low, high = fo.loading_window.py_func(d, k.low, k.high)
            ends = [
                self.on_loading(self.loading, a.par, a.force, a.factors, x) for x in (low, high)
            ]
        else:
            low, high = fo.unloading_window.py_func(k.branch, d)
            ends = [self.on_unloading(self.unloading, a.par, k.branch, x) for x in (low, high)]
        return float((ends[1] - ends[0]) / (high - low)) if high > low else 0.0

    def radius_now(self, depth: float, k: _Contact) -> float:
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

    def stiffness(self, z: Array, k: _Contact) -> float:
        """Tangential stiffness k_t = s 2 E' a [N/m] (Mindlin 1949)."""
        depth = self.motion(z)[0] - k.offset
        return float(self.spring * 2.0 * self.a.force[fo.MODULUS] * self.radius_now(depth, k))

    def limit(self, z: Array, k: _Contact) -> float:
        """Largest tangential force while the contact slides [N]."""
        f, plough, _ = self.normal(z, k)
        mu = self.mu
        if self.mu_s != self.mu:
            v = abs(self.motion(z)[2])
            mu += (self.mu_s - mu) * math.exp(-v / self.a.body[c.MU_SPEED])
        return (mu + plough) * f

    def slip(self, z: Array, k: _Contact, ahead: float) -> float:
        """Speed at which the surfaces slip: the bodies' less the spring's [m/s].

        The spring follows the friction limit, whose rate is a difference along the motion.
        """
        v = self.motion(z)[2]
        depth = self.motion(z)[0] - k.offset + ahead * self.normal(z, k)[2]
        rate = self.derivative(z, k)
        first, second = z, z + ahead * rate
        # Look back where looking ahead would leave this stretch of the force.
        if k.phase == UNLOADING and depth < k.branch[1] + k.branch[2]:
            first, second = z - 2.0 * ahead * rate, z - ahead * rate
        elif k.phase == LOADING and depth > k.high:
            first, second = z - ahead * rate, z
        stiff, later = self.stiffness(first, k), self.stiffness(second, k)
        if stiff <= 0.0 or later <= 0.0:
            return k.sign * abs(v)
        if k.receding:
            change = self.limit(second, k) / later - self.limit(first, k) / stiff
            return v - k.sign * change / ahead
        return v - k.sign * (self.limit(second, k) - self.limit(first, k)) / (ahead * stiff)

    def held(self, z: Array, k: _Contact) -> float:
        """Force of the tangential spring on the striker [N]."""
        return float(z[-1] * self.stiffness(z, k) if k.receding else z[-1])

    def tangential(self, z: Array, k: _Contact, f: float) -> tuple[float, float, float]:
        """Force that would hold the contact point, and both parts of its free acceleration."""
        rx, ry = self.lever(z)
        psi, omega = self.a.psi, self.a.omega
        tt = 1.0 / self.m + ry * ry / self.inertia + float(psi[0] @ psi[0])
        tn = rx * (-ry) / self.inertia + float(psi[0] @ psi[1])
        free = -(z[_OM] ** 2) * rx
        if self.n:
            q, p = z[_Q : _Q + self.n], z[_Q + self.n : _Q + 2 * self.n]
            free -= float(psi[0] @ (omega**2 * q + self.a.body[c.LOSS] * omega * p))
        return -(tn * f + free) / tt, tn * f + free, tt

    def forces(self, z: Array, k: _Contact) -> tuple[float, float, float]:
        f, _, rate = self.normal(z, k)
        if k.phase == FLIGHT:
            return 0.0, 0.0, rate
        if k.sign == 0.0:
            return f, self.held(z, k) if self.compliant else self.tangential(z, k, f)[0], rate
        return f, -k.sign * self.limit(z, k), rate

    def derivative(self, z: Array, k: _Contact) -> Array:
        """Newton and Euler: m a = F_f i + (F_n - m g) j, I alpha = (r_T - r_C) x F."""
        f, ft, rate = self.forces(z, k)
        rx, ry = self.lever(z)
        b = self.a.body
        d = np.zeros_like(z)
        d[_X], d[_Y], d[_TH] = z[_VX], z[_VY], z[_OM]
        d[_VX], d[_VY] = ft / self.m, f / self.m - b[c.GRAVITY]
        d[_OM] = (rx * f - ry * ft) / self.inertia
        if math.isfinite(b[c.S_MASS]):
            d[_W] = z[_WR]
            d[_WR] = (f - b[c.S_STIFF] * z[_W] - b[c.S_DAMP] * z[_WR]) / b[c.S_MASS]
            d[_WS] = f * z[_WR]
        else:
            d[_W] = b[c.S_PLATE] * f
            d[_WS] = f * d[_W]
        slide = self.motion(z)[2]
        d[_U], d[_PN], d[_PT], d[_WN], d[_WT] = slide, f, ft, f * rate, -ft * slide
        if self.n:
            q, p = z[_Q : _Q + self.n], z[_Q + self.n : _Q + 2 * self.n]
            omega, psi = self.a.omega, self.a.psi
            d[_Q : _Q + self.n] = p
            d[_Q + self.n : _Q + 2 * self.n] = (
                psi[0] * ft + psi[1] * f - omega * (omega * q + b[c.LOSS] * p)
            )
            d[_WD] = b[c.LOSS] * float(omega @ p**2)
        if self.compliant and k.sign == 0.0 and k.phase != FLIGHT:
            # The spring: its force while the area grows, its deformation while it shrinks.
            d[-1] = -slide if k.receding else -self.stiffness(z, k) * slide
        return d

    def sign_from_rest(self, z: Array, k: _Contact, small: float) -> float:
        """Sign of the sliding that follows rest; 0 when friction holds."""
        f, plough, _ = self.normal(z, k)
        f = max(f, small)
        need, pull, _ = self.tangential(z, k, f)
        return 0.0 if abs(need) <= (self.mu_s + plough) * f else math.copysign(1.0, pull)

    def sign_at_touch(self, z: Array, k: _Contact, ahead: float) -> float:
        """Sign of sliding as a contact that gives way sideways begins; 0 when it sticks."""
        k.sign = 1.0
        later = z + ahead * self.derivative(z, k)
        k.sign = math.copysign(1.0, self.motion(later)[2])
        return k.sign if k.sign * self.slip(later, k, 1e-3 * ahead) > 0.0 else 0.0

    def settle(self, z: Array, k: _Contact) -> None:
        """Let the contact rest; its spring keeps the friction that it slid with."""
        force, stiff = self.forces(z, k)[1], self.stiffness(z, k)
        z[-1] = force if not k.receding else (force / stiff if stiff > 0.0 else 0.0)
        k.sign = 0.0


def reference_impact(scene: Scene, settings: Settings = Settings(), *, points: int = 0) -> Trace:  # noqa: B008
    """Integrate one impact with the library's integrator.

    Parameters
    ----------
    points
        Number of history rows in each phase; 0 for no history.
    """
    a = arrays_of(scene, settings)
    return _Walk(scene, a, settings, points).run()


class _Walk:
    """Goes from event to event."""

    def __init__(self, scene: Scene, a: Arrays, settings: Settings, points: int) -> None:
        self.motion, self.a, self.settings, self.points = _Motion(scene, a), a, settings, points
        self.spot = spot_row(scene.spot)
        self.rows: list[Array] = []
        self.centre0 = float(self.spot[c.SPOT_CENTRE]) if self.spot[c.SPOT_PEAK] > 0.0 else 0.0
        self.tip_flat = float(self.spot[c.SPOT_TIP])

    def run(self) -> Trace:
        mo, b = self.motion, self.a.body
        k = self.meet(self.centre0)
        z = np.zeros(_Q + 2 * mo.n + int(mo.compliant))
        z[_Y] = -(k.offset + (k.branch[1] + k.branch[2] if k.phase == UNLOADING else 0.0))
        z[_VX], z[_VY], z[_OM] = b[c.V_X], b[c.V_Y], b[c.V_SPIN]
        start = z.copy()
        _, self.v_n, v_t = mo.motion(z)
        reduced = 1.0 / (1.0 / mo.m + mo.cos0**2 / mo.inertia)
        self.d_ref = float(fo_reference(self, reduced))
        self.t_ref = self.d_ref / self.v_n
        self.small = 1e-7 * reduced * self.v_n / self.t_ref
        self.rubbing = mo.mu > 0.0 or mo.mu_s > 0.0 or b[c.PLOUGH] > 0.0
        k.sign = self.first_sign(z, k)
        k.side = self.side_of(z, k)
        out = np.full(c.N_OUT, np.nan)
        state = self.follow(z, k)
        self.fill(out, start, state, v_t)
        history = np.concatenate(self.rows) if self.rows else np.zeros((0, len(HISTORY)))
        return Trace(impact_of(out, self.spot), history)

    def first_sign(self, z: Array, k: _Contact) -> float:
        """Sign of sliding at a touch; 0 when the point rests and nothing moves it."""
        if self.motion.compliant:
            return self.motion.sign_at_touch(z, k, 1e-6 * self.t_ref)
        slide = self.motion.motion(z)[2]
        if abs(slide) > 1e-14 * self.v_n:
            return math.copysign(1.0, slide)
        return self.motion.sign_from_rest(z, k, self.small)

    def side_of(self, z: Array, k: _Contact) -> float:
        """Sign of the tangential motion just after a touch."""
        short = 1e-6 * self.t_ref
        later = z + short * self.motion.derivative(z, k)
        if self.motion.motion(later)[2] == 0.0:
            # a tip that comes straight down is set in motion by the force, which is still zero
            short = 1e-4 * self.t_ref
            later = z + short * self.motion.derivative(later, k)
            later = z + short * self.motion.derivative(later, k)
        return float(np.sign(self.motion.motion(later)[2]))

    def meet(self, x: float) -> _Contact:
        """Begin a contact at x: crater, flattened tip or fresh metal."""
        s = self.spot
        r = (x - s[c.SPOT_CENTRE]) / s[c.SPOT_RADIUS] if s[c.SPOT_RADIUS] > 0.0 else math.inf
        local = s[c.SPOT_FLAT] * max(0.0, 1.0 - r * r) if math.isfinite(r) else 0.0
        k = _Contact(LOADING, 1.0, local + s[c.SPOT_TIP], local)
        if s[c.SPOT_PEAK] > 0.0:
            mo, a = self.motion, self.a
            branch = np.zeros(fo.N_BRANCH)
            fo.set_peak(
                mo.loading,
                mo.unloading,
                mo.residual,
                a.par,
                a.force,
                a.factors,
                s[c.SPOT_PEAK],
                branch,
            )
            k.peak_radius = mo.pressed_radius(float(branch[0]))
            if abs(r) <= 0.5 or branch[1] > branch[2]:
                k.phase, k.branch = UNLOADING, branch
                k.offset -= branch[1] + branch[2]
        k.stretch(self.a.breaks, 0.0)
        return k

    def surface(self, z: Array) -> float:
        """Depth at which the tip meets the flat at its present place."""
        s = self.spot
        if s[c.SPOT_RADIUS] <= 0.0:
            return float(s[c.SPOT_TIP])
        x = self.centre0 + self.motion.place(z)
        r = (x - s[c.SPOT_CENTRE]) / s[c.SPOT_RADIUS]
        return float(s[c.SPOT_TIP] + s[c.SPOT_FLAT] * max(0.0, 1.0 - r * r))

    def events(self, k: _Contact) -> list[tuple[str, Any]]:
        """Active events, each a function that falls through zero."""
        mo = self.motion
        rest = k.branch[1] + k.branch[2]

        def depth(z: Array) -> float:
            return mo.motion(z)[0] - k.offset

        if k.phase == FLIGHT:
            armed = [self.clear]

            def touch(t: float, z: Array) -> float:
                gap = self.surface(z) - mo.motion(z)[0]
                armed[0] = armed[0] or gap > 1e-9 * self.d_ref
                return gap if armed[0] else -1.0

            return [("touch", touch)]
        found: list[tuple[str, Any]] = []
        if k.approaching:
            found.append(("turn", lambda t, z: mo.normal(z, k)[2]))
            if k.phase == UNLOADING:
                found.append(("reload", lambda t, z: k.branch[0] - depth(z)))
            elif math.isfinite(k.high):
                found.append(("jump", lambda t, z: k.high - depth(z)))
        else:
            found.append(("part", lambda t, z: depth(z) - rest))
            found.append(("return", lambda t, z: -mo.normal(z, k)[2]))
        if mo.compliant and k.side != 0.0:
            found.append(("reversal", lambda t, z: k.side * mo.motion(z)[2]))
        if k.sign != 0.0 and mo.compliant:
            found.append(("rest", lambda t, z: k.sign * mo.slip(z, k, 1e-6 * self.t_ref)))
        elif k.sign != 0.0:
            found.append(("rest", lambda t, z: k.sign * mo.motion(z)[2]))
        elif self.rubbing:

            def hold(t: float, z: Array) -> float:
                f, plough, _ = mo.normal(z, k)
                pull = mo.held(z, k) if mo.compliant else mo.tangential(z, k, f)[0]
                gap = float((mo.mu_s + plough) * f - abs(pull))
                if mo.compliant:
                    # over the forces: near the parting friction vanishes before the spring does
                    slack = k.approaching or z[-1] == 0.0
                    return gap / (f + abs(pull)) if f > 0.0 else float(slack) - 1.0
                return gap

            found.append(("slip", hold))
        return found

    def follow(self, z: Array, k: _Contact) -> Array:
        mo = self.motion
        t, touched, flight = 0.0, 0.0, float(self.a.body[c.FLIGHT])
        self.contacts, self.touching, self.first, self.last = 1, 0.0, math.nan, 0.0
        self.p_in = self.p_out = self.w_in = self.w_out = 0.0
        self.force = self.depth = 0.0
        self.stuck, self.clear = False, True
        self.flat = float(self.spot[c.SPOT_FLAT])
        self.low = self.high = self.x_low = self.x_high = 0.0
        self.ending, kept, base = c.DONE, z.copy(), 0.0
        p_mark = w_mark = 0.0
        scale = self.scales(z)
        for _ in range(int(self.settings.max_contacts) * 100):
            self.stuck |= k.sign == 0.0 and self.rubbing and k.phase != FLIGHT
            if mo.compliant:
                # the spring's deformation, or its force
                scale[-1] = self.d_ref if k.receding else mo.m * self.v_n / self.t_ref
            active = self.events(k)
            for _, function in active:
                function.__dict__.update(terminal=True, direction=-1.0)
            end = t + (50.0 * self.t_ref if k.phase != FLIGHT else flight - (t - self.last))
            sol = solve_ivp(
                lambda _t, y, k=k: mo.derivative(y, k),
                (t, end), z, method="DOP853", rtol=1e-11, atol=1e-12 * scale,
                events=[function for _, function in active], dense_output=self.points > 0,
                first_step=min(1e-4 * self.t_ref, 0.5 * (end - t)), max_step=self.longest(k),
            )  # fmt: skip
            if self.points:
                self.record(sol, k)
            if sol.status < 0:
                self.ending = 99
                return z
            begin, before = z, t
            z, t = sol.y[:, -1].copy(), float(sol.t[-1])
            if sol.status == 0:
                if k.phase == FLIGHT:
                    return kept
                if t - touched > 1e4 * self.t_ref:
                    self.ending, self.last = c.STEP_BUDGET, t
                    return z
                continue
            name, found = next(
                item for item, te in zip(active, sol.t_events, strict=True) if len(te)
            )
            if k.phase != FLIGHT:
                if name == "part" and mo.compliant:
                    name, found, t = self.earlier(before, begin, t, k, active, scale)
                z, t = self.polished(before, begin, t, k, found, scale)
            if k.phase != FLIGHT:
                self.extremes(z, base)
            self.force = max(self.force, mo.normal(z, k)[0])
            self.clear = name != "touch" or mo.motion(z)[1] > 0.0
            if not self.clear:
                continue  # the tip brushes the crater's rim on its way out: no contact
            if name in ("turn", "part", "return"):
                gain_p, gain_w = z[_PN] - p_mark, z[_WN] - w_mark
                p_mark, w_mark = z[_PN], z[_WN]
                if k.approaching:
                    self.p_in, self.w_in = self.p_in + gain_p, self.w_in + gain_w
                else:
                    self.p_out, self.w_out = self.p_out + gain_p, self.w_out - gain_w
            if mo.compliant and name in ("turn", "return"):
                stiff, k.receding = mo.stiffness(z, k), name == "turn"
                if stiff > 0.0:
                    z[-1] *= 1.0 / stiff if k.receding else stiff
            if name == "turn":
                k.approaching = False
                self.first = t if math.isnan(self.first) else self.first
                if k.phase == LOADING:
                    self.turn(z, k)
            elif name == "part":
                self.touching, self.last = self.touching + t - touched, t
                kept = z.copy()
                k = _Contact(FLIGHT, 1.0, 0.0, 0.0)
                if flight <= 0.0:
                    return kept
            elif name == "return":
                k.approaching = True
            elif name == "reload":
                k.phase = LOADING
                k.stretch(self.a.breaks, k.branch[0])
                self.regrip(z, k)
            elif name == "jump":
                k.stretch(self.a.breaks, k.high)
                self.force = max(self.force, mo.normal(z, k)[0])
                self.regrip(z, k)
            elif name == "reversal":
                k.side = -k.side
            elif name == "rest" and mo.compliant:
                mo.settle(z, k)
            elif name == "rest":
                k.sign = mo.sign_from_rest(z, k, self.small) if self.rubbing else -k.sign
            elif name == "slip" and mo.compliant:
                force = mo.held(z, k)
                slack = abs(force) <= 1e-6 * self.small
                k.sign = math.copysign(1.0, mo.motion(z)[2] if slack else -force)
            elif name == "slip":
                k.sign = math.copysign(1.0, mo.tangential(z, k, mo.normal(z, k)[0])[1])
            else:
                if self.contacts >= self.settings.max_contacts:
                    self.ending = c.CONTACT_BUDGET
                    return kept
                self.contacts += 1
                touched = t
                k = self.meet(self.centre0 + mo.place(z))
                if mo.compliant:
                    z[-1] = 0.0
                k.sign = self.first_sign(z, k)
                k.side = self.side_of(z, k)
                base += z[_U] - kept[_U]
        self.ending, self.last = c.STEP_BUDGET, t
        return z

    def regrip(self, z: Array, k: _Contact) -> None:
        """Let a yielding contact rest where the friction limit now grows faster than its spring."""
        mo = self.motion
        if mo.compliant and k.sign * mo.slip(z, k, 1e-6 * self.t_ref) < 0.0:
            mo.settle(z, k)

    def earlier(
        self,
        start: float,
        z: Array,
        end: float,
        k: _Contact,
        active: list[tuple[str, Any]],
        scale: Array,
    ) -> tuple[str, Any, float]:
        """Return the event that ends an interval which seems to end by parting.

        A step across the parting hides what the spring does just before it.
        """
        short = end - 1e-7 * self.t_ref
        part = next(item for item in active if item[0] == "part")
        others = [item for item in active if item[0] not in ("part", "return")]
        if short <= start:
            return (*part, end)
        sol = solve_ivp(
            lambda _t, y: self.motion.derivative(y, k),
            (start, short), z, method="DOP853", rtol=1e-11, atol=1e-12 * scale,
            events=[function for _, function in others], max_step=self.longest(k),
            first_step=min(1e-4 * self.t_ref, 0.5 * (short - start)),
        )  # fmt: skip
        for (name, function), te in zip(others, sol.t_events, strict=True):
            if len(te):
                return name, function, float(te[-1])
        return (*part, end)

    def polished(
        self, start: float, z: Array, end: float, k: _Contact, event: Any, scale: Array
    ) -> tuple[Array, float]:
        """Integrate again up to an event, without the step beyond it.

        The library finds the event on the interpolant of a step that crosses it, and the force may
        have a corner there; a step that ends at the event has not. One Newton move closes the gap.
        """
        if end - start < 1e-9 * self.t_ref:
            return z, start
        sol = solve_ivp(
            lambda _t, y: self.motion.derivative(y, k),
            (start, end), z, method="DOP853", rtol=1e-11, atol=1e-12 * scale,
            first_step=min(1e-4 * self.t_ref, 0.5 * (end - start)), max_step=self.longest(k),
        )  # fmt: skip
        z = sol.y[:, -1].copy()
        rate = self.motion.derivative(z, k)
        small = 1e-7 * self.t_ref
        slope = (event(end, z + small * rate) - event(end, z - small * rate)) / (2.0 * small)
        move = -event(end, z) / slope if slope != 0.0 else 0.0
        move = min(max(move, -1e-6 * self.t_ref), 1e-6 * self.t_ref)
        return z + move * rate, end + move

    def longest(self, k: _Contact) -> float:
        """Longest step: short against the contact, against a vibration in flight."""
        if k.phase == FLIGHT:
            return float(self.a.body[c.FLIGHT]) / 100.0
        return 0.2 * self.t_ref if self.motion.n == 0 else math.inf

    def turn(self, z: Array, k: _Contact) -> None:
        """Loading ends: the branch to unload on, and what the metal will remember."""
        mo, a, s = self.motion, self.a, self.spot
        depth = mo.motion(z)[0] - k.offset
        tip = self.tip_flat - k.branch[1]
        local = k.local - k.branch[2]
        k.branch = np.zeros(fo.N_BRANCH)
        fo.set_peak(
            mo.loading, mo.unloading, mo.residual, a.par, a.force, a.factors, depth, k.branch
        )
        k.phase, k.local = UNLOADING, local + k.branch[2]
        k.peak_radius = mo.pressed_radius(depth)
        self.tip_flat = tip + k.branch[1]
        self.flat = max(self.flat, k.local)
        s[c.SPOT_TIP], s[c.SPOT_FLAT], s[c.SPOT_PEAK] = self.tip_flat, k.local, depth
        s[c.SPOT_CENTRE] = self.centre0 + mo.place(z)
        s[c.SPOT_RADIUS] = mo.radius(a.par, k.branch[4], k.branch[4])
        self.depth = max(self.depth, depth + k.offset)

    def extremes(self, z: Array, base: float) -> None:
        u, x = z[_U] - base, self.motion.place(z)
        self.low, self.high = min(self.low, u), max(self.high, u)
        self.x_low, self.x_high = min(self.x_low, x), max(self.x_high, x)

    def scales(self, z: Array) -> Array:
        mo = self.motion
        arm = math.sqrt(mo.inertia / mo.m)
        scale = np.ones_like(z)
        scale[[_X, _Y, _W, _U]] = self.d_ref
        scale[[_VX, _VY, _WR]] = self.v_n
        scale[_TH], scale[_OM] = self.d_ref / arm, self.v_n / arm
        scale[[_PN, _PT]] = mo.m * self.v_n
        scale[[_WN, _WT, _WS, _WD]] = mo.m * self.v_n**2
        root = math.sqrt(mo.m)
        scale[_Q : _Q + mo.n], scale[_Q + mo.n : _Q + 2 * mo.n] = self.d_ref * root, self.v_n * root
        return scale

    def record(self, sol: Any, k: _Contact) -> None:
        """Append history rows of one phase."""
        t = np.linspace(sol.t[0], sol.t[-1], self.points)
        rows = np.empty((len(t), len(HISTORY)))
        for i, z in enumerate(sol.sol(t).T):
            f, ft, _ = self.motion.forces(z, k)
            depth, rate, slide = self.motion.motion(z)
            height = -(depth + z[_W])
            rows[i] = (t[i], depth, f, ft, -rate - z[_WR], slide, height, z[_U],
                       self.motion.theta + z[_TH], z[_OM])  # fmt: skip
        self.rows.append(rows)

    def fill(self, out: Array, start: Array, z: Array, v_t: float) -> None:
        """Write the observables of the state at the last separation."""
        mo = self.motion
        rx, ry = mo.lever(z)
        rebound = z[_VY] + z[_OM] * rx
        q, p = z[_Q : _Q + mo.n], z[_Q + mo.n : _Q + 2 * mo.n]
        modal = 0.5 * float(p @ p + (mo.a.omega * q) @ (mo.a.omega * q)) + z[_WD]

        def kinetic(s: Array) -> float:
            return float(0.5 * mo.m * (s[_VX] ** 2 + s[_VY] ** 2) + 0.5 * mo.inertia * s[_OM] ** 2)

        g = self.a.body[c.GRAVITY]
        given = z[_WN] + z[_WT] + modal + z[_WS]
        fallen = mo.m * g * (start[_Y] - z[_Y])
        balance = (kinetic(start) + fallen - kinetic(z) - given) / kinetic(start)
        drift = math.hypot(
            mo.m * (z[_VX] - start[_VX]) - z[_PT],
            mo.m * (z[_VY] - start[_VY]) + mo.m * g * self.last - z[_PN],
        )
        values = {
            "restitution": rebound / self.v_n,
            "tip_rebound_m_s": rebound,
            "kinetic_restitution": self.p_out / self.p_in if self.p_in > 0.0 else math.nan,
            "energetic_restitution": math.sqrt(max(self.w_out, 0.0) / self.w_in)
            if self.w_in > 0.0
            else math.nan,
            "tangential_restitution": (z[_VX] - z[_OM] * ry) / v_t if v_t != 0.0 else math.nan,
            "residual_sphere_m": self.tip_flat,
            "residual_flat_m": self.flat,
            "peak_depth_m": self.depth,
            "contact_time_s": self.last,
            "touching_time_s": self.touching,
            "loading_time_s": self.first,
            "peak_force_N": self.force,
            "rebound_spin_rad_s": z[_OM],
            "sliding_length_m": self.high - self.low,
            "scar_travel_m": self.x_high - self.x_low,
            "friction_impulse_ratio": abs(z[_PT]) / z[_PN] if z[_PN] > 0.0 else math.nan,
            "normal_impulse_Ns": z[_PN],
            "tangential_impulse_Ns": z[_PT],
            "contact_work_J": z[_WN],
            "friction_work_J": z[_WT],
            "modal_energy_J": modal,
            "support_energy_J": z[_WS],
            "rebound_speed_m_s": z[_VY],
            "tangential_rebound_m_s": z[_VX],
            "energy_residual": balance,
            "momentum_residual": drift / (mo.m * self.v_n),
        }
        for i, name in enumerate(c.OBSERVABLES):
            out[i] = values[name]
        out[c.FIRST_COUNT :] = (self.ending, self.contacts, 0, 0, float(self.stuck))


def fo_reference(walk: _Walk, reduced: float) -> float:
    """Depth that takes up the kinetic energy of the approach; the scale of the tolerances."""
    mo, a = walk.motion, walk.a
    return float(
        reference_depth(mo.loading, a.par, a.force, a.factors, 0.5 * reduced * walk.v_n**2, mo.tip)
    )
