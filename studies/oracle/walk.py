"""The oracle's way through an impact: scipy's DOP853 with its own event location."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from ...core.arrays import Array
from ...dynamics import force as fo
from ...dynamics import surface as su
from ...dynamics.integrate import Settings, arrays_of
from ...dynamics.result import Impact, impact_of
from ...dynamics.scene import Scene
from ...dynamics.stepping import layout as c
from ...dynamics.surface import Spot
from .motion import (
    FLIGHT,
    LOADING,
    OM,
    PA,
    PN,
    PT,
    TH,
    UNLOADING,
    VX,
    VY,
    WD,
    WN,
    WR,
    WS,
    WT,
    Contact,
    Motion,
    Q,
    U,
    W,
    X,
    Y,
)


def oracle_impact(scene: Scene, *, tolerance: float = 1e-11) -> Impact:
    """Integrate one impact with the library's integrator to a relative `tolerance`."""
    return _Walk(scene, arrays_of(scene, Settings()), tolerance).run()


class _Walk:
    """Goes from event to event."""

    def __init__(self, scene: Scene, a: c.Given, tolerance: float) -> None:
        self.motion, self.a = Motion(scene, a), a
        self.most_contacts = int(Settings().max_contacts)
        self.rtol, self.small_share = tolerance, 0.1 * tolerance
        self.surface = a.surface.copy()

    def run(self) -> Impact:
        mo, b = self.motion, self.a.body
        k = self.meet(0.0)
        z = np.zeros(Q + 2 * mo.n + int(mo.compliant))
        z[Y] = self.motion.clearance(z, self.surface)
        z[Y] = -z[Y]
        z[VX], z[VY], z[OM] = b[c.V_X], b[c.V_Y], b[c.V_SPIN]
        start = z.copy()
        _, self.v_n, v_t = mo.motion(z)
        reduced = 1.0 / (1.0 / mo.m + mo.cos0**2 / mo.inertia)
        self.d_ref = self.reference(reduced)
        self.t_ref = self.d_ref / self.v_n
        self.small = 1e-7 * reduced * self.v_n / self.t_ref
        self.rubbing = mo.mu > 0.0
        k.sign = self.first_sign(z, k)
        k.side = self.side_of(z, k)
        out = np.full(c.N_OUT, np.nan)
        state = self.follow(z, k)
        self.fill(out, start, state, v_t)
        return impact_of(out, self.surface)

    def reference(self, reduced: float) -> float:
        """Depth that takes up the kinetic energy of the approach; the scale of the tolerances."""
        mo, a = self.motion, self.a
        energy, d, taken, last = 0.5 * reduced * self.v_n**2, 1e-12 * mo.tip, 0.0, 0.0
        while taken < energy and d < 10.0 * mo.tip:
            f = float(mo.on_loading(mo.loading, a.par, a.force, a.factors, d))
            taken, last, d = taken + 0.25 * d * (f + last), f, 2.0 * d
        return d

    def first_sign(self, z: Array, k: Contact) -> float:
        """Sign of sliding at a touch; 0 when the point rests and nothing moves it."""
        if self.motion.compliant:
            return self.motion.sign_at_touch(z, k, 1e-6 * self.t_ref)
        slide = self.motion.motion(z)[2]
        if abs(slide) > 1e-14 * self.v_n:
            return math.copysign(1.0, slide)
        return self.motion.sign_from_rest(z, k, self.small)

    def side_of(self, z: Array, k: Contact) -> float:
        """Sign of the tangential motion just after a touch."""
        short = 1e-6 * self.t_ref
        later = z + short * self.motion.derivative(z, k)
        if self.motion.motion(later)[2] == 0.0:
            # a tip that comes straight down is set in motion by the force, which is still zero
            short = 1e-4 * self.t_ref
            later = z + short * self.motion.derivative(later, k)
            later = z + short * self.motion.derivative(later, k)
        return float(np.sign(self.motion.motion(later)[2]))

    def meet(self, x: float) -> Contact:
        """Begin a contact at x: a bed, or fresh metal, where the tip meets the surface."""
        mo, a, s = self.motion, self.a, self.surface
        s[su.STANDING] = s[su.COUNT]
        self.x_touch = x
        k = Contact(LOADING, 1.0, float(s[su.TIP_FLAT]), s)
        here = float(su.bed(s, s[su.BEGIN] + x))
        tip, flat = (
            mo.residual(a.par, max(here, s[su.TIP_PEAK])) if here + s[su.TIP_PEAK] else (0, 0)
        )
        share = tip / (tip + flat) if tip + flat > 0.0 else 0.0
        peak = share * s[su.TIP_PEAK] + (1.0 - share) * here
        if peak > 0.0:
            k.phase = UNLOADING
            k.branch = self.recovery(peak)
            k.peak_radius = mo.pressed_radius(peak)
            k.offset -= k.branch[1] + k.branch[2]
        return k

    def recovery(self, peak: float) -> Array:
        """Return what the recovery from `peak` needs."""
        mo, a, branch = self.motion, self.a, np.zeros(fo.N_BRANCH)
        fo.set_peak(
            mo.loading, mo.unloading, mo.residual, a.par, a.force, a.factors, peak, branch
        )  # fmt: skip
        return branch

    def events(self, k: Contact) -> list[tuple[str, Any]]:
        """Active events, each a function that falls through zero."""
        mo = self.motion
        rest = k.branch[1] + k.branch[2]

        def depth(z: Array) -> float:
            return mo.pressed(z, k)[0]

        if k.phase == FLIGHT:
            return [("touch", lambda t, z: mo.clearance(z, self.surface))]
        found: list[tuple[str, Any]] = []
        if k.approaching:
            found.append(("turn", lambda t, z: mo.normal(z, k)[1]))
            if k.phase == UNLOADING:
                found.append(("reload", lambda t, z: k.branch[0] - depth(z)))
        else:
            found.append(("part", lambda t, z: depth(z) - rest))
            found.append(("return", lambda t, z: -mo.normal(z, k)[1]))
        if mo.compliant and k.side != 0.0:
            found.append(("reversal", lambda t, z: k.side * mo.motion(z)[2]))
        if k.sign != 0.0 and mo.compliant:
            found.append(("rest", lambda t, z: k.sign * mo.slip(z, k, 1e-6 * self.t_ref)))
        elif k.sign != 0.0:
            found.append(("rest", lambda t, z: k.sign * mo.motion(z)[2]))
        elif self.rubbing:

            def hold(t: float, z: Array) -> float:
                f, _ = mo.normal(z, k)
                pull = mo.held(z, k) if mo.compliant else mo.tangential(z, k, f)[0]
                gap = float(mo.mu * f - abs(pull))
                if mo.compliant:
                    # over the forces: near the parting friction vanishes before the spring does
                    slack = k.approaching or z[-1] == 0.0
                    return gap / (f + abs(pull)) if f > 0.0 else float(slack) - 1.0
                return gap

            found.append(("slip", hold))
        return found

    def follow(self, z: Array, k: Contact) -> Array:
        """Go from event to event; return the state at the latest separation."""
        self.now, self.touched = 0.0, 0.0
        self.contacts, self.touching, self.topped, self.last = 1, 0.0, math.nan, 0.0
        self.p_in = self.p_out = self.w_in = self.w_out = self.p_mark = self.w_mark = 0.0
        self.force = self.depth = 0.0
        self.stuck, self.ending = False, c.DONE
        self.low = self.high = self.x_low = self.x_high = 0.0
        scale = self.scales(z)
        for _ in range(self.most_contacts * 100):
            name, z = self.contact_until(z, k, scale)
            if name == "budget":
                return z
            self.extremes(z)
            if (force := self.motion.normal(z, k)[0]) > self.force:
                self.force, self.topped = force, self.now
            if name != "part":
                self.act(name, z, k)
                continue
            self.halve(z, k)
            self.touching, self.last = self.touching + self.now - self.touched, self.now
            su.leave(self.surface, self.surface[su.BEGIN] + self.motion.place(z)[0])
            kept = z.copy()
            touch = self.fly(z, scale)
            if touch is None:
                return kept
            if self.contacts >= self.most_contacts:
                self.ending = c.CONTACT_BUDGET
                return kept
            z, self.touched = touch, self.now
            self.contacts += 1
            k = self.meet(self.motion.place(z)[0])
            if self.motion.compliant:
                z[-1] = 0.0
            k.sign = self.first_sign(z, k)
            k.side = self.side_of(z, k)
        self.ending, self.last = c.STEP_BUDGET, self.now
        return z

    def contact_until(self, z: Array, k: Contact, scale: Array) -> tuple[str, Array]:
        """Integrate a contact to its next event."""
        mo, t = self.motion, self.now
        self.stuck |= k.sign == 0.0 and self.rubbing
        if mo.compliant:
            # the spring's deformation, or its force
            scale[-1] = self.d_ref if k.receding else mo.m * self.v_n / self.t_ref
        active = self.events(k)
        for _, function in active:
            function.__dict__.update(terminal=True, direction=-1.0)
        sol = solve_ivp(
            lambda _t, y: mo.derivative(y, k), (t, t + 1e4 * self.t_ref), z, method="DOP853",
            rtol=self.rtol, atol=self.small_share * scale, max_step=self.longest(),
            events=[function for _, function in active], first_step=1e-4 * self.t_ref,
        )  # fmt: skip
        if sol.status != 1:
            self.ending = c.NOT_FINITE if sol.status < 0 else c.STEP_BUDGET
            return "budget", sol.y[:, -1].copy()
        end = float(sol.t[-1])
        name, found = next(item for item, te in zip(active, sol.t_events, strict=True) if len(te))
        if name == "part" and mo.compliant:
            name, found, end = self.earlier(t, z, end, k, active, scale)
        state, self.now = self.polished(t, z, end, k, found, scale)
        return name, state

    def fly(self, z: Array, scale: Array) -> Array | None:
        """Follow a flight to the next touch, or to where the tip can't come back: None."""
        mo, k, b = self.motion, Contact(FLIGHT, 1.0, 0.0, self.surface), self.a.body
        rates = list(self.a.omega)
        if math.isfinite(b[c.S_MASS]) and b[c.S_STIFF] > 0.0:
            rates.append(math.sqrt(b[c.S_STIFF] / b[c.S_MASS]))
        horizon, t = self.now + float(b[c.FLIGHT]), self.now
        # a rigid tip is looked at often on its way out of a crater
        slow = 2.0 * math.pi / min(rates) if rates else 20.0 * self.t_ref
        quick = 2.0 * math.pi / (24.0 * max(rates)) if rates else 0.05 * self.t_ref
        for mark in Spot.of(self.surface).imprints:
            quick = min(quick, 0.02 * mark.radius / max(abs(mo.place(z)[1]), 1e-12))

        def gap(_t: float, y: Array) -> float:
            return mo.clearance(y, self.surface)

        def free(_t: float, y: Array) -> float:
            return 1.0 if self.is_clear(y) else -1.0

        gap.__dict__.update(terminal=True, direction=-1.0)
        free.__dict__.update(terminal=True, direction=1.0)
        while t < horizon and not self.is_clear(z):
            end = min(t + slow, horizon)
            sol = solve_ivp(
                lambda _t, y: mo.derivative(y, k), (t, end), z, method="DOP853", rtol=self.rtol,
                atol=self.small_share * scale, events=[gap, free], max_step=quick,
                first_step=min(1e-3 * quick, 0.5 * (end - t)),
            )  # fmt: skip
            if len(sol.t_events[1]):
                return None
            if sol.status == 1:
                state, self.now = self.polished(t, z, float(sol.t[-1]), k, gap, scale)
                return state
            z, t = sol.y[:, -1].copy(), float(sol.t[-1])
        return None

    def is_clear(self, z: Array) -> bool:
        """Whether the leaving tip is above all that its and the support's vibration can reach."""
        mo, b = self.motion, self.a.body
        depth, rate, _ = mo.motion(z)
        gap, leaving = float(self.surface[su.TIP_FLAT]) - depth, -rate
        if mo.n:
            q, p = z[Q : Q + mo.n], z[Q + mo.n : Q + 2 * mo.n]
            size = np.sqrt(q**2 + (p / self.a.omega) ** 2)
            gap -= float(self.a.psi[1] @ q + np.abs(self.a.psi[1]) @ size)
            leaving -= float(self.a.psi[1] @ p)
        if math.isfinite(b[c.S_MASS]) and b[c.S_STIFF] > 0.0:
            gap -= z[W] + math.sqrt(z[W] ** 2 + b[c.S_MASS] / b[c.S_STIFF] * z[WR] ** 2)
            leaving -= z[WR]
        elif mo.n == 0 and not math.isfinite(b[c.S_MASS]):
            # nothing but gravity can bring a rigid tip back that no wall is steep enough to hold
            steepest, _ = su.roughest(self.surface, self.surface[su.COUNT])
            aside = abs(z[VX]) + abs(z[OM]) * math.hypot(mo.cos0, mo.sin0)
            gap = math.inf if leaving > steepest * aside else gap
        return leaving > 0.0 and gap > 0.0

    def halve(self, z: Array, k: Contact) -> None:
        """Count impulse and work of the approach or the departure that ends here."""
        gain_p, gain_w = z[PN] - self.p_mark, z[WN] - self.w_mark
        self.p_mark, self.w_mark = z[PN], z[WN]
        if k.approaching:
            self.p_in, self.w_in = self.p_in + gain_p, self.w_in + gain_w
        else:
            self.p_out, self.w_out = self.p_out + gain_p, self.w_out - gain_w

    def act(self, name: str, z: Array, k: Contact) -> None:
        """Change phase or the way of sliding at an event within a contact."""
        mo = self.motion
        if name in ("turn", "return"):
            self.halve(z, k)
            if mo.compliant:
                stiff, k.receding = mo.stiffness(z, k), name == "turn"
                if stiff > 0.0:
                    z[-1] *= 1.0 / stiff if k.receding else stiff
            k.approaching = name == "return"
        if name == "turn":
            if k.phase == LOADING:
                self.turn(z, k)
        elif name == "reload":
            k.phase = LOADING
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

    def regrip(self, z: Array, k: Contact) -> None:
        """Let a yielding contact rest where the friction limit now grows faster than its spring."""
        mo = self.motion
        if mo.compliant and k.sign * mo.slip(z, k, 1e-6 * self.t_ref) < 0.0:
            mo.settle(z, k)

    def earlier(
        self,
        start: float,
        z: Array,
        end: float,
        k: Contact,
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
            (start, short), z, method="DOP853", rtol=self.rtol, atol=self.small_share * scale,
            events=[function for _, function in others], max_step=self.longest(),
            first_step=min(1e-4 * self.t_ref, 0.5 * (short - start)),
        )  # fmt: skip
        for (name, function), te in zip(others, sol.t_events, strict=True):
            if len(te):
                return name, function, float(te[-1])
        return (*part, end)

    def polished(
        self, start: float, z: Array, end: float, k: Contact, event: Any, scale: Array
    ) -> tuple[Array, float]:
        """Integrate again up to an event, without the step beyond it.

        The library finds the event on the interpolant of a step that crosses it, and the force may
        have a corner there; a step that ends at the event has not. One Newton move closes the gap.
        """
        if end - start < 1e-9 * self.t_ref:
            return z, start
        sol = solve_ivp(
            lambda _t, y: self.motion.derivative(y, k),
            (start, end), z, method="DOP853", rtol=self.rtol, atol=self.small_share * scale,
            first_step=min(1e-4 * self.t_ref, 0.5 * (end - start)), max_step=self.longest(),
        )  # fmt: skip
        z = sol.y[:, -1].copy()
        rate = self.motion.derivative(z, k)
        small = 1e-7 * self.t_ref
        slope = (event(end, z + small * rate) - event(end, z - small * rate)) / (2.0 * small)
        move = -event(end, z) / slope if slope != 0.0 else 0.0
        move = min(max(move, -1e-6 * self.t_ref), 1e-6 * self.t_ref)
        return z + move * rate, end + move

    def longest(self) -> float:
        """Longest step of a contact; a later one, on a wall, may be over soon."""
        if self.contacts > 1:
            return 0.005 * self.t_ref
        return 0.2 * self.t_ref if self.motion.n == 0 else math.inf

    def turn(self, z: Array, k: Contact) -> None:
        """Loading ends: the branch to unload on, and what tip and flat will remember."""
        mo, s = self.motion, self.surface
        depth = mo.pressed(z, k)[0]
        x, speed = mo.place(z)
        tip, flat = k.branch[1], k.branch[2]
        short = 1e-7 * self.t_ref
        rate = mo.derivative(z, k)
        slowing = (
            mo.motion(z - short * rate)[1] - mo.motion(z + short * rate)[1]
        ) / (2.0 * short)  # fmt: skip
        k.branch = self.recovery(depth)
        k.phase, k.peak_radius = UNLOADING, mo.pressed_radius(depth)
        s[su.TIP_FLAT] += k.branch[1] - tip
        if k.branch[1] > 0.0:
            s[su.TIP_PEAK] = max(s[su.TIP_PEAK], depth)
        self.depth = max(self.depth, mo.motion(z)[0])
        a = float(mo.radius(self.a.par, k.branch[4], k.branch[4]))
        recovery = depth - k.branch[1] - k.branch[2]
        behind = before = 0.0
        if speed != 0.0 and slowing > 0.0 and a > 0.0:
            less = mo.pressed_radius(depth * (1.0 - 1e-4))
            growth = (k.peak_radius - less) / (1e-4 * depth)
            behind = abs(x - self.x_touch)
            if growth > 0.0:
                behind = min(speed**2 / (2.0 * growth * slowing), behind)
            before = min(
                speed**2 * recovery / (a * slowing), abs(speed) * math.sqrt(2 * recovery / slowing)
            )
        if speed < 0.0:
            behind, before = before, behind
        here = s[su.BEGIN] + x
        mark = np.zeros(su.N_IMPRINT)
        mark[[su.START, su.END, su.DEEPEST]] = here
        mark[su.FIRST], mark[su.LAST] = here - a - behind, here + a + before
        mark[su.TAKEN], mark[su.PEAK], mark[su.RADIUS] = k.branch[2] - flat, depth, a
        mark[su.GIVE] = min(max(mo.tip * recovery / a**2, 0.02), 0.98)
        su.press(s, mark)

    def extremes(self, z: Array) -> None:
        """Count how far the point has come on the flat."""
        u, x = z[U], self.motion.place(z)[0]
        self.low, self.high = min(self.low, u), max(self.high, u)
        self.x_low, self.x_high = min(self.x_low, x), max(self.x_high, x)

    def scales(self, z: Array) -> Array:
        mo = self.motion
        arm = math.sqrt(mo.inertia / mo.m)
        scale = np.ones_like(z)
        scale[[X, Y, W, U]] = self.d_ref
        scale[[VX, VY, WR]] = self.v_n
        scale[TH], scale[OM] = self.d_ref / arm, self.v_n / arm
        scale[[PN, PT]] = mo.m * self.v_n
        scale[PA] = mo.m * self.v_n * arm
        scale[[WN, WT, WS, WD]] = mo.m * self.v_n**2
        root = math.sqrt(mo.m)
        scale[Q : Q + mo.n], scale[Q + mo.n : Q + 2 * mo.n] = self.d_ref * root, self.v_n * root
        return scale

    def fill(self, out: Array, start: Array, z: Array, v_t: float) -> None:
        """Write the observables of the state at the last separation."""
        mo = self.motion
        rx, ry = mo.lever(z)
        rebound = z[VY] + z[OM] * rx
        q, p = z[Q : Q + mo.n], z[Q + mo.n : Q + 2 * mo.n]
        modal = 0.5 * float(p @ p + (mo.a.omega * q) @ (mo.a.omega * q)) + z[WD]

        def kinetic(s: Array) -> float:
            return float(0.5 * mo.m * (s[VX] ** 2 + s[VY] ** 2) + 0.5 * mo.inertia * s[OM] ** 2)

        b = self.a.body
        held = 0.0
        if math.isfinite(b[c.S_MASS]):
            held = 0.5 * (b[c.S_MASS] * z[WR] ** 2 + b[c.S_STIFF] * z[W] ** 2)
        dent, place = su.dent(self.surface)
        length, width, _ = su.scar(self.surface, b[c.SCAN_STEP], b[c.SCAN_LEVEL])
        gap = mo.clearance(z, self.surface)
        _, slope = su.height(
            self.surface, self.surface[su.COUNT], self.surface[su.BEGIN] + mo.place(z)[0]
        )
        leaving = slope * mo.place(z)[1] - mo.motion(z)[1]
        g = b[c.GRAVITY]
        given = z[WN] + z[WT] + modal + z[WS]
        fallen = mo.m * g * (start[Y] - z[Y])
        balance = (kinetic(start) + fallen - kinetic(z) - given) / kinetic(start)
        drift = math.hypot(
            mo.m * (z[VX] - start[VX]) - z[PT],
            mo.m * (z[VY] - start[VY]) + mo.m * g * self.last - z[PN],
        )
        values = {
            "restitution": rebound / self.v_n,
            "tip_rebound_m_s": rebound,
            "kinetic_restitution": self.p_out / self.p_in if self.p_in > 0.0 else math.nan,
            "energetic_restitution": math.sqrt(max(self.w_out, 0.0) / self.w_in)
            if self.w_in > 0.0
            else math.nan,
            "tangential_restitution": (z[VX] - z[OM] * ry) / v_t if v_t != 0.0 else math.nan,
            "residual_sphere_m": float(self.surface[su.TIP_FLAT]),
            "residual_flat_m": dent,
            "scar_length_m": length,
            "scar_width_m": width,
            "scar_excess_m": length - width,
            "peak_depth_m": self.depth,
            "contact_time_s": self.last,
            "touching_time_s": self.touching,
            "loading_time_s": self.topped,
            "peak_force_N": self.force,
            "rebound_spin_rad_s": z[OM],
            "sliding_length_m": self.high - self.low,
            "scar_travel_m": self.x_high - self.x_low,
            "friction_impulse_ratio": abs(z[PT]) / z[PN] if z[PN] > 0.0 else math.nan,
            "normal_impulse_Ns": z[PN],
            "tangential_impulse_Ns": z[PT],
            "contact_work_J": z[WN],
            "friction_work_J": z[WT],
            "modal_energy_J": modal,
            "support_energy_J": z[WS],
            "rebound_speed_m_s": z[VY],
            "tangential_rebound_m_s": z[VX],
            "energy_residual": balance,
            "momentum_residual": drift / (mo.m * self.v_n),
            "kinetic_before_J": kinetic(start),
            "kinetic_after_J": kinetic(z),
            "gravity_work_J": fallen,
            "plastic_work_J": z[WN],
            "damping_work_J": 0.0,
            "radiated_J": 0.0,
            "modal_stored_J": modal - z[WD],
            "structural_loss_J": z[WD],
            "support_stored_J": held,
            "support_loss_J": z[WS] - held,
            "angular_residual": abs(mo.inertia * (z[OM] - start[OM]) - z[PA])
            / (mo.m * self.v_n * math.sqrt(mo.inertia / mo.m)),
            "clearance_m": gap,
            "clearance_rate_m_s": leaving,
        }
        for i, name in enumerate(c.OBSERVABLES):
            out[i] = values[name]
        self.surface[su.BEGIN] = place
        out[c.FIRST_COUNT :] = (self.ending, self.contacts, 0, 0, float(self.stuck))
