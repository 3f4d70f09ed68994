"""Places in the vectors that the compiled kernels take and fill: state, body, spot, results."""

from __future__ import annotations

from numba import types

# The kernels take their state as plain vectors; the names stay on few lines.
# fmt: off
MATRIX = types.Array(types.float64, 2, "C", readonly=False)

# The state vector: rise of the centre of mass, rotation, their rates, the support's sinking and
# its rate, slip and the integrals; modal coordinates and their rates follow, then, for a contact
# that gives way sideways, its tangential spring: the force [N] while the contact area grows, the
# deformation [m] while it shrinks.
X, Y, PHI, VX, VY, SPIN, W, W_RATE, SLIP, P_N, P_T, WORK_N, WORK_T, WORK_S, WORK_D, TIME = range(16)
N_RIGID = 16
SPRING = -1

# The body vector.
(MASS, INERTIA, HALF_COS, HALF_SIN, TIP, GRAVITY, MU, MU_STATIC, MU_SPEED, PLOUGH, S_MASS, S_STIFF,
 S_DAMP, S_PLATE, V_X, V_Y, V_SPIN, FLIGHT, LOSS, TOLERANCE, MAX_STEPS,
 MAX_CONTACTS, COMPLIANCE) = range(23)
N_BODY = 23

# The spot vector: memory of crater and tip.
SPOT_PEAK, SPOT_FLAT, SPOT_TIP, SPOT_CENTRE, SPOT_RADIUS = range(5)
N_SPOT = 5

# What a contact evaluation tells besides the derivative.
(DEPTH, RATE, FORCE, TANGENTIAL, SLIDING, MARGIN, M_TT, M_TN, B_T, ARM, RISE, ACCELERATION,
 STIFFNESS, PLOUGHING) = range(14)
N_SEEN = 14

OBSERVABLES = (
    "restitution", "kinetic_restitution", "energetic_restitution", "tangential_restitution",
    "residual_sphere_m", "residual_flat_m", "peak_depth_m", "contact_time_s", "touching_time_s",
    "loading_time_s", "peak_force_N", "rebound_spin_rad_s", "sliding_length_m", "scar_travel_m",
    "friction_impulse_ratio", "normal_impulse_Ns", "tangential_impulse_Ns", "contact_work_J",
    "friction_work_J", "modal_energy_J", "support_energy_J", "rebound_speed_m_s",
    "tangential_rebound_m_s", "energy_residual", "momentum_residual",
    "tip_rebound_m_s",
)
(O_E, O_KINETIC, O_ENERGETIC, O_TANGENTIAL, O_RES_S, O_RES_F, O_PEAK, O_TIME, O_TOUCHING, O_LOADING,
 O_FORCE, O_SPIN, O_SLIDING, O_SCAR, O_RATIO, O_PN, O_PT, O_WORK, O_FRICTION, O_MODAL, O_SUPPORT,
 O_VY, O_VX, O_ENERGY, O_MOMENTUM, O_TIP) = range(26)
COUNTS = ("ending", "contacts", "steps", "evaluations", "stuck")
N_OUT = len(OBSERVABLES) + len(COUNTS)
FIRST_COUNT = len(OBSERVABLES)

DONE, STEP_BUDGET, CONTACT_BUDGET, NOT_FINITE = range(4)
LOAD, UNLOAD, FLY = range(3)

# The independent variable of a step: time; the square root of the time since touch, in which the
# force grows smoothly; the square root of the depth left to separation, in which it fades so; the
# rate of penetration, which ends on the turning point.
BY_TIME, BY_ROOT_TIME, BY_ROOT_DEPTH, BY_RATE = range(4)

# Events: turning point, separation, return of the approach, the old peak, end of sliding, end of
# rest, touch, end of a smooth stretch of the loading curve, reversal of the sliding speed.
TURN, PART, RETURNED, RELOAD, REST, SLIDE, TOUCH, BORDER, REVERSAL = range(9)
N_EVENTS = 9
