"""From scenes to impacts through the compiled integrator, one at a time or in batches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array
from ..core.unstated import unstated_equal
from ..models.base import ContactLaw
from ..models.turned import TurnedLaw
from . import force as fo
from .result import Impact, impact_of, leave_resting
from .rules import RULES
from .scene import Scene
from .stepping import layout as c
from .strength import NODES, strength_table
from .surface import Spot

# limit: rows of a history beside those asked for [-]: memory of a long vibration
_HISTORY_ROWS = 4000

_STILL = np.empty((3, 0))
_FRESH = Spot().row()
_FRESH.flags.writeable = False


@unstated_equal
@dataclass(frozen=True, slots=True)
class Settings:
    """Accuracy and budgets of an integration.

    - `tolerance`: local error over the scale of the impact (speed, depth).
    - `max_steps`, `max_contacts`: budgets; reaching one is an `Outcome`, not an error.
    - `flight`: how long after a separation the tip is followed for a re-contact [s]; nan: until
      nothing that vibrates and no wall of the scar can bring it back.
    """

    tolerance: float = 2e-9
    max_steps: int = 20_000
    max_contacts: int = 50
    flight: float = math.nan


def arrays_of(scene: Scene, settings: Settings = Settings()) -> c.Given:
    """Return the vectors of a scene; the flow-stress seam is applied here."""
    law, pair, striker, approach = scene.law, scene.pair, scene.striker, scene.approach
    par = np.ascontiguousarray(law.parameters(pair), dtype=float)
    force = np.zeros(fo.N_FORCE)
    force[fo.RADIUS], force[fo.MODULUS] = pair.R, pair.E_reduced
    force[fo.FLAT] = striker.tip_flat_radius
    force[fo.EDGE] = force[fo.EDGE_DEPTH] = force[fo.EDGE_LIMIT] = math.inf
    force[fo.SHAPE], force[fo.RETURN] = scene.force.shape, scene.force.given_back
    force[fo.DAMPING], force[fo.RADIATION] = scene.force.damping, scene.force.radiation
    force[fo.DAMPING_EXPONENT] = scene.force.damping_exponent
    factors = _factors(scene)
    if math.isfinite(scene.force.edge):
        force[fo.EDGE] = scene.force.edge
        force[fo.EDGE_DEPTH] = fo.edge_depth(
            law.kernels.radius, par, force, factors, scene.force.edge
        )
        strength = min(fo.PUNCH_PRESSURE * pair.Sy_min, pair.sphere.strength)
        force[fo.EDGE_LIMIT] = strength * math.pi * scene.force.edge**2
    omega = np.asarray(scene.modes.frequencies, dtype=float)
    psi = _STILL
    if len(omega) > 0:
        psi = scene.modes.at_contact(approach.angle, striker.tip_radius)
    upright = math.isclose(approach.angle, math.pi / 2.0, abs_tol=1e-12)
    body = np.zeros(c.N_BODY)
    half = 0.5 * striker.length
    body[c.MASS], body[c.INERTIA], body[c.TIP] = striker.mass, striker.inertia, striker.tip_radius
    body[c.HALF_COS] = 0.0 if upright else half * math.cos(approach.angle)
    body[c.HALF_SIN] = half * math.sin(approach.angle)
    body[c.GRAVITY] = scene.gravity
    body[c.MU], body[c.MU_STATIC] = scene.friction.mu, scene.friction.mu_static
    body[c.MU_SPEED], body[c.PLOUGH] = scene.friction.speed, scene.friction.ploughing
    body[c.S_MASS], body[c.S_STIFF] = scene.support.mass, scene.support.stiffness
    body[c.S_DAMP], body[c.S_PLATE] = scene.support.damping, scene.support.plate_mobility
    body[c.V_X], body[c.V_SPIN] = approach.tangential, approach.spin
    # The stated speed is the contact point's: v_T = v_C - omega c.
    body[c.V_Y] = -approach.speed + approach.spin * body[c.HALF_COS]
    body[c.FLIGHT] = math.inf if math.isnan(settings.flight) else settings.flight
    body[c.LOSS] = scene.modes.loss_factor
    # without friction nothing can load the spring
    slippery = scene.friction.mu_static == 0.0
    body[c.COMPLIANCE] = math.inf if slippery else RULES.partial_slip * scene.friction.stiffness
    body[c.TOLERANCE] = settings.tolerance
    body[c.MAX_STEPS], body[c.MAX_CONTACTS] = settings.max_steps, settings.max_contacts
    body[c.SCAN_STEP] = scene.instrument.scan_step
    body[c.SCAN_LEVEL] = scene.instrument.scan_height
    body[c.LONGEST] = math.inf
    surface = _FRESH if scene.spot == Spot() else scene.spot.row()
    return c.Given(par, force, factors, body, surface, omega, psi)


def _factors(scene: Scene) -> Array:
    """Return the table of factors on what the law says; empty when all is the law's own."""
    loading = np.asarray(scene.force.factors, dtype=float)
    recovery = np.asarray(scene.force.recovery_factors, dtype=float)
    if not scene.flow and len(loading) == len(recovery) == 0:
        return loading
    n = NODES if scene.flow else max(len(loading), len(recovery))
    found = np.ones((fo.N_FACTORS, n))
    for column, given in ((fo.F_FORCE, loading), (fo.F_RECOVERY, recovery)):
        if len(given) == n:
            found[column] = given
        elif len(given) > 0:
            grid = np.linspace(0.0, 1.0, n)
            found[column] = np.interp(grid, np.linspace(0.0, 1.0, len(given)), given)
    if scene.flow:
        table = strength_table(scene.law, scene.pair)
        found *= table.factors(scene.strengths(table))
        if isinstance(scene.law, TurnedLaw):
            found[fo.F_ODDS] **= -1.0
    return found.ravel()


def strike(scene: Scene, settings: Settings = Settings()) -> Impact:
    """Integrate one impact."""
    return strike_many([scene], settings)[0]


def strike_many(scenes: Sequence[Scene], settings: Settings = Settings()) -> list[Impact]:
    """Integrate scenes that may differ in everything; each gives what `strike` gives."""
    return [_struck(scene, arrays_of(scene, settings))[0] for scene in scenes]


def _struck(scene: Scene, a: c.Given, history: Array | None = None) -> tuple[Impact, int]:
    """Integrate one impact; return it and how many rows of `history` were filled."""
    out, left = np.zeros((1, c.N_OUT)), np.zeros((1, len(a.surface)))
    rows = _walked(scene.law, _given([a]), out, left=left, history=history)
    leave_resting(out)
    return impact_of(out[0], left[0]), rows


def _walked(law: ContactLaw, given: c.Given, out: Array, **more: Array | None) -> int:
    """Integrate the rows of `given` into those of `out`, as `many_impacts` does.

    A turned law walks as it was made: its sphere, the smaller one, takes its dent along as it
    slides, whichever strikes. Then what stays goes to the bodies of the pair.
    """
    # importing it compiles: a file that is refused and the list of keys do without
    from .stepping.compiled import many_impacts

    own = law.law if isinstance(law, TurnedLaw) else law
    rows = many_impacts(tuple(own.kernels), given, out, **more)
    if own is not law:
        out[:, [c.O_RES_S, c.O_RES_F]] = out[:, [c.O_RES_F, c.O_RES_S]]
    return rows


def _given(rows: Sequence[c.Given]) -> c.Given:
    """Return scenes of one law as the compiled integrator takes them.

    Factors and modes have to be of one length; fresh metal is one row for all.
    """
    columns = c.Given(*zip(*rows, strict=True))
    if all(surface is _FRESH for surface in columns.surface):
        columns = columns._replace(surface=[_FRESH])
    return c.Given(*map(np.stack, columns))


@dataclass(frozen=True, slots=True)
class Trace:
    """An impact with its history: (n, len(HISTORY)) rows, the columns of HISTORY."""

    impact: Impact
    history: Array

    def column(self, name: str) -> Array:
        """Return one column of the history by its name in `layout.HISTORY`."""
        return np.asarray(self.history[:, c.HISTORY.index(name)])


def traced(scene: Scene, settings: Settings = Settings(), *, points: int = 200) -> Trace:
    """Integrate one impact and keep its history: each row a state of the motion, none in between.

    `points`: at least so many rows during the first contact; flights between contacts are written
    with the same distance, the flight after the last one is not.

    Returned: `penetration_m` is the law's depth, `clearance_m` the tip's distance from the
    remembered surface (negative while it is pressed in), `place_m` the tip's centre along the flat.
    """
    a = arrays_of(scene, settings)
    first, _ = _struck(scene, a)
    span = first.touching_time_s / max(first.contacts, 1)
    if first.contacts > 1:
        span = min(span, first.loading_time_s)
    if span > 0.0:
        a.body[c.LONGEST] = span / max(points, 1)
        a.body[c.MAX_STEPS] += 100.0 * points
    history = np.empty((_HISTORY_ROWS + 40 * points, len(c.HISTORY)))
    impact, rows = _struck(scene, a, history)
    return Trace(impact, history[:rows].copy())


def strike_rows(scene: Scene, body: Array, settings: Settings = Settings()) -> Array:
    """Integrate impacts that share law, pair and modes: rows of the body vector in, rows out.

    The fast path of inference: `body` starts from `arrays_of(scene).body` repeated, with the
    columns of `layout` (MASS, MU, V_Y, ...) overwritten.

    Returned: (n, N_OUT) the columns `layout.OBSERVABLES + layout.COUNTS`.
    """
    a = arrays_of(scene, settings)
    rows = np.ascontiguousarray(body, dtype=float)
    out = np.zeros((len(rows), c.N_OUT))
    _walked(scene.law, _given([a])._replace(body=rows), out)
    return out


def strike_batch(scenes: Sequence[Scene], settings: Settings = Settings()) -> Array:
    """Integrate scenes of one law that may differ in all else; the fast path of a comparison.

    Returned: (n, N_OUT) the columns `layout.OBSERVABLES + layout.COUNTS`.
    """
    out = np.full((len(scenes), c.N_OUT), np.nan)
    rows = [arrays_of(scene, settings) for scene in scenes]
    groups: dict[tuple[int, int], list[int]] = {}
    for i, a in enumerate(rows):
        groups.setdefault((len(a.factors), len(a.omega)), []).append(i)
    for members in groups.values():
        found = np.zeros((len(members), c.N_OUT))
        _walked(scenes[0].law, _given([rows[i] for i in members]), found)
        out[members] = found
    return out
