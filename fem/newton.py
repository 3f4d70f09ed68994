"""Newton's method for the equilibrium of the two bodies in contact at a given approach.

The line search looks for a zero of the work of the residual along the Newton direction,
s(alpha) = x . R(u + alpha x): in plasticity the norm of the residual misleads, the energy does not.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field

import numpy as np

from ..core.arrays import Array, Mask
from .assemble import DISTORTED, bulk_forces
from .contact import ContactState, Grip, Triplets, contact_forces, take_hold
from .discretise import Discretisation
from .elements import State
from .linear import LinearSystem
from .rules import RULES

# limit: secant steps of a line search [-]
_SECANTS = 3

# limit: halvings of a correction [-]
_BACKTRACKS = 5

# limit: most iterations of a step [-]
_ITERATIONS = 18

_SMALL = 5.0 * RULES.residual  # up to it the corrections may decide instead


@dataclass
class Timers:
    """Processor seconds and a count of `Counters`, added up over a solve."""

    cpu_assembly_s: float = 0.0
    cpu_contact_s: float = 0.0
    cpu_linear_s: float = 0.0
    iterations: int = 0


@dataclass(frozen=True)
class Equilibrium:
    """A converged state: displacements, contact and reaction."""

    u: Array
    contact: ContactState
    reaction: float
    iterations: int


@dataclass
class Evaluation:
    """Residual at one displacement."""

    residual: Array
    bulk: Array
    contact: ContactState
    n_triplets: int


@dataclass
class Solver:
    """Newton's method on one discretisation; holds working arrays, no state of the material."""

    grid: Discretisation
    rule: int
    timers: Timers = field(default_factory=Timers)

    def __post_init__(self) -> None:
        self.elements = self.grid.elements
        self.surfaces = self.grid.surfaces
        n = len(self.grid.elements.conn)
        dofs = np.empty((n, 8), dtype=np.int64)
        dofs[:, 0::2] = 2 * self.grid.elements.conn
        dofs[:, 1::2] = dofs[:, 0::2] + 1
        self.free = self.grid.free
        self.system = LinearSystem(dofs, free=self.free, n_dofs=self.grid.n_dofs)
        self._tangent = np.empty((n, 8, 8))
        self._triplets = Triplets.for_surfaces(self.grid.surfaces)
        self._seconds = math.inf
        self._grip: Grip | None = None
        self._closed: Mask | None = None

    def grip(self, u: Array, traction: Array) -> Grip:
        """Return how the surfaces hold at displacements `u` and nodal tractions (n_slave,)."""
        return take_hold(self.surfaces, self.grid.mesh.points + u.reshape(-1, 2), traction)

    def equilibrium(
        self,
        guess: Array,
        *,
        state: State,
        delta: float,
        seconds: float = math.inf,
        grip: Grip | None = None,
        closed: Mask | None = None,
    ) -> Equilibrium | None:
        """Equilibrium at approach `delta`, starting from displacements `guess`; none: failed.

        `state` and `grip` are those of the last accepted step, `seconds` ago. Slave nodes that are
        `closed` stay so until forces balance; only where that takes a pull may they open. A guess
        lifts or overlaps the surfaces by more than the penalty does: on the way to it nodes would
        open and close.
        """
        self._seconds, self._grip, self._closed = seconds, grip, closed
        u = guess.copy()
        u[self.grid.driven] = -delta
        now = self._evaluate(u, state)
        moved, next_move, first = np.inf, np.inf, np.inf
        for iteration in range(_ITERATIONS):
            if now is None:
                return None
            if iteration and self._converged(now, next_move, delta):
                if now.contact.pressure.min() >= 0.0:
                    return Equilibrium(u, now.contact, self._reaction(now), iteration)
                self._closed = None
                now = self._evaluate(u, state)
                continue
            if iteration == 0:
                first = self._unbalanced(now)
            elif iteration == RULES.hopeless_after and self._unbalanced(now) > 0.5 * first:
                return None
            direction = self._direction(now)
            u, now, alpha = self._search(u, now, direction, state)
            before, moved = moved, alpha * float(np.abs(direction).max())
            next_move = moved * min(moved / before, 1.0) if np.isfinite(before) else moved
        return None

    def _evaluate(self, u: Array, state: State) -> Evaluation | None:
        start = time.process_time()
        force = np.zeros(self.grid.n_dofs)
        code = bulk_forces(
            self.elements, u, state=state, rule=self.rule, force=force, tangent=self._tangent,
            seconds=self._seconds,
        )  # fmt: skip
        middle = time.process_time()
        self.timers.cpu_assembly_s += middle - start
        if code == DISTORTED:
            return None
        bulk = force.copy()
        x = self.grid.mesh.points + u.reshape(-1, 2)
        contact, n = contact_forces(
            self.surfaces, x, force=force, tangent=self._triplets, grip=self._grip,
            closed=self._closed,
        )  # fmt: skip
        self.timers.cpu_contact_s += time.process_time() - middle
        if contact is None:
            return None
        return Evaluation(force, bulk, contact, n)

    def _reaction(self, now: Evaluation) -> float:
        if len(self.grid.reaction) == 0:
            return now.contact.force
        return -float(now.bulk[self.grid.reaction].sum())

    def _unbalanced(self, now: Evaluation) -> float:
        return float(np.abs(now.residual[self.free]).sum())

    def _converged(self, now: Evaluation, next_move: float, delta: float) -> bool:
        force = abs(now.contact.force)
        unbalanced = self._unbalanced(now)
        if unbalanced < RULES.residual * force:
            return True
        return next_move < RULES.still_correction * abs(delta) and unbalanced < max(
            _SMALL * force, self.grid.round_off
        )

    def _direction(self, now: Evaluation) -> Array:
        start = time.process_time()
        self.system.fill(
            self._tangent,
            triplets=self._triplets,
            n_triplets=now.n_triplets,
            surfaces=self.grid.surfaces,
            contact=now.contact,
        )
        direction = np.zeros(self.grid.n_dofs)
        direction[self.free] = self.system.solve(-now.residual[self.free])
        self.timers.cpu_linear_s += time.process_time() - start
        self.timers.iterations += 1
        return direction

    def _search(
        self, u: Array, now: Evaluation, direction: Array, state: State
    ) -> tuple[Array, Evaluation | None, float]:
        for halvings in range(1 + _BACKTRACKS):
            alpha = 0.5**halvings
            new = self._evaluate(u + alpha * direction, state)
            if new is not None:
                break
        if new is None:
            return u, None, alpha
        s0 = float(direction @ now.residual)
        s = float(direction @ new.residual)
        low, s_low, high, s_high = 0.0, s0, alpha, s
        for _ in range(_SECANTS):
            if abs(s_high) < 0.7 * abs(s0) or s_low * s_high > 0.0:
                break
            alpha = high - s_high * (high - low) / (s_high - s_low)
            trial = self._evaluate(u + alpha * direction, state)
            if trial is None:
                break
            new = trial
            s = float(direction @ new.residual)
            if s * s_high < 0.0:
                low, s_low = high, s_high
            else:
                s_low *= 0.5  # Illinois: keeps both ends moving
            high, s_high = alpha, s
        return u + alpha * direction, new, alpha
