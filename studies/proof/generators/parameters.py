"""Places of the numbers that describe one impact to the compiled steppers; all SI.

Every place is neutral at 0 unless it says otherwise.
"""

from __future__ import annotations

(
    # striker and approach
    MASS, INERTIA, LENGTH, TIP, THETA, NORMAL_SPEED, TANGENTIAL_SPEED, SPIN, GRAVITY,
    # contact pair
    LAW, MODULUS, STRENGTH, POISSON, MU,
    # flow stress: rate (kind, constant, exponent), hardening, layer, oscillation, jump in speed
    RATE_KIND, RATE_A, RATE_B, HARD_KIND, HARD_A, HARD_B, LAYER_KIND, LAYER_A, LAYER_B,
    WAVE_A, WAVE_B,
    # geometry of the tip
    FLAT,
    # dissipation and layers of the contact
    DAMP_KIND, DAMP, RADIATION, ADHESION, ADHESION_RANGE, FILM_VISCOSITY, FILM_THICKNESS,
    FILM_CLOSED, FILM_EXIT, ROUGH_KIND, ROUGH, ROUGH_FORCE, ROUGH_LOSS,
    # support
    SUPPORT_MASS, SUPPORT_STIFFNESS, SUPPORT_DAMPING, SUPPORT_GAP, PLATE,
    # tangential
    TANGENTIAL_RATIO, FRICTION_KIND, FRICTION_A, FRICTION_B, PLOUGH_KIND, PLOUGH,
    # rod: elements (0 rigid), line stiffnesses, damping time
    BEAM, BEAM_EA, BEAM_EI, BEAM_GA, BEAM_ROTARY, BEAM_LOSS,
    # the metal's distance from elastic-perfect plasticity: loss of unloading modulus and its
    # strain, rise of the flow curve and its strain, weight of another unloading law
    CHORD, CHORD_STRAIN, CURVE, CURVE_STRAIN, OTHER_UNLOADING,
    # numerics
    STEPS, FOLLOW,
) = range(63)  # fmt: skip
CAVITY_LAW, ROW_LAW = 63, 73
"""First places of the constants of the two base laws, 10 and 7."""
N_PARAMETERS = 80

# what an impact returns
(
    RESTITUTION, DEPTH, TIME, PEAK_FORCE, REBOUND_SPIN, IMPULSE_RATIO, SLIDING, REBOUND,
    TANGENTIAL_REBOUND, NORMAL_IMPULSE, TANGENTIAL_IMPULSE, WORK, ENERGY_IN, ENERGY_OUT, CONTACTS,
    PEAK_DEPTH, COMPLETED,
) = range(17)  # fmt: skip
N_RESULTS = 17

CAVITY, FOUNDATION = 0.0, 1.0
"""Values of `LAW`."""
