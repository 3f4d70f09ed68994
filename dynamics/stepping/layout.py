"""Places in the vectors that the compiled kernels take and fill, and the bundles they travel in."""

from __future__ import annotations

from typing import Any, NamedTuple

from numba import types

from ...models.kernel import BRANCH, LOADING, SPLIT, VECTOR
from .bundle import Bundle

# The kernels take their state as plain vectors; the names stay on few lines.
# fmt: off
MATRIX = types.Array(types.float64, 2, "C", readonly=False)
FLAGS = types.Array(types.boolean, 1, "C", readonly=False)
# The loops over the modes may be summed in vectors. Nothing in the walk
# allocates: _nrt=False leaves out numba's counting of references, which took half of an impact.
# Only kernels call these: wrappers for Python and C would double what is to be compiled, and with a
# signature each would be read from the disk when it is imported, though its caller holds a copy.
PLAIN = {
    "error_model": "numpy", "fastmath": {"reassoc", "contract"}, "_nrt": False,
    "no_cpython_wrapper": True, "no_cfunc_wrapper": True,
}


class Given(NamedTuple):
    """The vectors of a scene, or of several: one row each or one row for all."""

    par: Any
    force: Any
    factors: Any
    body: Any
    surface: Any
    omega: Any
    psi: Any


class Model(NamedTuple):
    """What stays as it is during an impact: the law's kernels and numbers, body, modes, sums."""

    loading: Any
    radius: Any
    unloading: Any
    residual: Any
    par: Any
    force: Any
    factors: Any
    body: Any
    omega: Any
    psi: Any
    sums: Any


class Work(NamedTuple):
    """What changes: states, surface, what is seen of the contact, events, tallies, scratch.

    `z` is the state, `z_new` the next one, `kept` the one at the latest parting; `moved`, `spare`,
    `seen_far` and `mark` are scratch. `stages` holds the derivatives of a step, the first and the
    last row those at its ends. `history` has no rows unless a history is asked for.
    """

    z: Any
    z_new: Any
    kept: Any
    moved: Any
    spare: Any
    scale: Any
    branch: Any
    surface: Any
    seen: Any
    seen_new: Any
    seen_far: Any
    values: Any
    values_new: Any
    now: Any
    scales: Any
    tally: Any
    mark: Any
    out: Any
    sums: Any
    stages: Any
    fast: Any
    history: Any
    active: Any


MODEL = Bundle(types.BaseTuple.from_types(
    (LOADING, BRANCH, BRANCH, SPLIT, *5 * (VECTOR,), MATRIX, VECTOR), Model))
WORK_TUPLE = types.BaseTuple.from_types((*19 * (VECTOR,), *3 * (MATRIX,), FLAGS), Work)
WORK = Bundle(WORK_TUPLE)

# The state vector: rise of the centre of mass, rotation, their rates, slip and the integrals:
# impulses along y, x and about the centre of mass, work given to the contact and to friction.
(X, Y, PHI, VX, VY, SPIN, SLIP, P_N, P_T, P_SPIN, WORK_N, WORK_T, TIME) = range(13)
N_RIGID = 13
# Modal coordinates and their rates follow. Then, behind `tail_of`, unless all of it is at rest: the
# support's sinking and its rate, work given to the support, lost in the structure, and of the
# contact's work what radiation and damping took.
W, W_RATE, WORK_S, WORK_D, WORK_R, WORK_C = range(6)
N_TAIL = 6
# Last, for a contact that gives way sideways, its tangential spring: the force [N] while the
# contact area grows, the deformation [m] while it shrinks.
SPRING = -1

# The sums of a model: over the modes psi_x^2, psi_x psi_y, psi_x psi_place; one over mass and
# inertia; whether the state has a tail, and how much of it is in use.
S_XX, S_XY, S_XP, PER_MASS, PER_INERTIA, HAS_TAIL, SIZE = range(7)
N_SUMS = 7

# The body vector.
(MASS, INERTIA, HALF_COS, HALF_SIN, TIP, GRAVITY, MU, MU_STATIC, MU_SPEED, PLOUGH, S_MASS, S_STIFF,
 S_DAMP, S_PLATE, V_X, V_Y, V_SPIN, FLIGHT, LOSS, TOLERANCE, MAX_STEPS,
 MAX_CONTACTS, COMPLIANCE, SCAN_STEP, SCAN_LEVEL, LONGEST) = range(26)
N_BODY = 26

# What a contact evaluation tells besides the derivative. SLOPE is that of the remembered surface
# below the tip, TRAVEL the speed of the contact's place, STATIC the law's own force and RADIATED
# what waves add to it.
(DEPTH, RATE, FORCE, TANGENTIAL, SLIDING, MARGIN, M_TT, M_TN, B_T, ARM, RISE, ACCELERATION,
 STIFFNESS, PLOUGHING, SLOPE, TRAVEL, STATIC, RADIATED) = range(18)
N_SEEN = 18

# Where the walk stands: the phase, the sign of sliding, from where the law's depth is counted, the
# independent variable, its value, the next step and what was taken of it, the sign of the
# tangential speed; the rest are flags.
(PHASE, MODE, OFFSET, VARIABLE, AT, STEP, TAKEN, SIDE, APPROACHING, RECHECK, FRESH, TURNING,
 TO_RATE, SIMPLE, LANDING) = range(15)
N_NOW = 15

# Scales of the impact.
(SPEED, SPEED_T, D_REF, T_REF, SMALL_FORCE, AHEAD, SPRING_FORCE, BITE, FIRST_STEP,
 START_Y, ORIGIN, LEAP) = range(12)
N_SCALES = 12

# What is counted on the way.
(T_TOUCH, TOUCHING, T_LAST, P_MARK, W_MARK, P_IN, P_OUT, W_IN, W_OUT, SLIP_LOW,
 SLIP_HIGH, X_LOW, X_HIGH, TOP_FORCE, TOP_TIME, TOP_DEPTH, CONTACTS, STEPS, EVALUATIONS, ENDING,
 STUCK, X_TOUCH, ROWS) = range(23)
N_TALLY = 23

OBSERVABLES = (
    "restitution", "kinetic_restitution", "energetic_restitution", "tangential_restitution",
    "residual_sphere_m", "residual_flat_m", "peak_depth_m", "contact_time_s", "touching_time_s",
    "loading_time_s", "peak_force_N", "rebound_spin_rad_s", "sliding_length_m", "scar_travel_m",
    "scar_length_m", "scar_width_m", "scar_excess_m",
    "friction_impulse_ratio", "normal_impulse_Ns", "tangential_impulse_Ns", "contact_work_J",
    "friction_work_J", "modal_energy_J", "support_energy_J", "rebound_speed_m_s",
    "tangential_rebound_m_s", "energy_residual", "momentum_residual",
    "tip_rebound_m_s",
    "kinetic_before_J", "kinetic_after_J", "gravity_work_J", "plastic_work_J", "damping_work_J",
    "radiated_J", "modal_stored_J", "structural_loss_J", "support_stored_J", "support_loss_J",
    "angular_residual", "clearance_m", "clearance_rate_m_s",
)
(O_E, O_KINETIC, O_ENERGETIC, O_TANGENTIAL, O_RES_S, O_RES_F, O_PEAK, O_TIME, O_TOUCHING, O_LOADING,
 O_FORCE, O_SPIN, O_SLIDING, O_TRAVEL, O_LENGTH, O_WIDTH, O_EXCESS, O_RATIO, O_PN, O_PT, O_WORK,
 O_FRICTION, O_MODAL, O_SUPPORT, O_VY, O_VX, O_ENERGY, O_MOMENTUM, O_TIP, O_BEFORE, O_AFTER,
 O_FALLEN, O_PLASTIC, O_DAMPING, O_RADIATED, O_RINGING, O_LOSS, O_HELD, O_DASHPOT, O_ANGULAR,
 O_CLEAR, O_LEAVING) = range(42)
COUNTS = ("ending", "contacts", "steps", "evaluations", "stuck")
N_OUT = len(OBSERVABLES) + len(COUNTS)
FIRST_COUNT = len(OBSERVABLES)

DONE, STEP_BUDGET, CONTACT_BUDGET, NOT_FINITE, FLIGHT_BUDGET, RESTS, GOING = range(7)
LOAD, UNLOAD = range(2)

# The independent variable of a step: time; the square root of the time since touch, in which the
# force grows smoothly; the square root of the depth left to separation, in which it fades so; the
# rate of penetration, which ends on the turning point.
BY_TIME, BY_ROOT_TIME, BY_ROOT_DEPTH, BY_RATE = range(4)

# Events: turning point, separation, return of the approach, the old peak, end of sliding, end of
# rest, reversal of the sliding speed.
TURN, PART, RETURNED, RELOAD, REST, SLIDE, REVERSAL = range(7)
N_EVENTS = 7

HISTORY = (
    "time_s", "penetration_m", "normal_force_N", "tangential_force_N", "normal_velocity_m_s",
    "sliding_velocity_m_s", "tip_height_m", "slip_m", "angle_rad", "spin_rad_s", "place_m",
    "clearance_m",
)
