"""The compiled integrator: one impact after another through the same scalar kernels.

DOP853 (Hairer, Norsett and Wanner) with event location: a step that crosses an event is repeated
with the length that ends on it. `reference.py` holds the integrator that this one must agree with.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit, types

from ..models.kernel import VECTOR
from .events import (
    event_slope,
    event_values,
    first_mode,
    hermite_root,
    mark_active,
    meet,
    reference_depth,
    set_segment,
    sliding_mode,
    slip_speed,
    yielding_mode,
)
from .flight import fly
from .force import (
    BRANCH,
    DAMPING,
    LOADING,
    N_BRANCH,
    PEAK_RADIUS,
    RADIATION,
    RECEDING,
    SEGMENT_HIGH,
    SPLIT,
    set_peak,
)
from .layout import (
    ACCELERATION,
    ARM,
    B_T,
    BORDER,
    BY_RATE,
    BY_ROOT_DEPTH,
    BY_ROOT_TIME,
    BY_TIME,
    COMPLIANCE,
    CONTACT_BUDGET,
    DEPTH,
    DONE,
    FIRST_COUNT,
    FLIGHT,
    FLY,
    FORCE,
    GRAVITY,
    HALF_COS,
    INERTIA,
    LOAD,
    M_TN,
    MASS,
    MATRIX,
    MAX_CONTACTS,
    MAX_STEPS,
    MU,
    MU_STATIC,
    N_EVENTS,
    N_RIGID,
    N_SEEN,
    NOT_FINITE,
    O_E,
    O_ENERGETIC,
    O_ENERGY,
    O_FORCE,
    O_FRICTION,
    O_KINETIC,
    O_LOADING,
    O_MODAL,
    O_MOMENTUM,
    O_PEAK,
    O_PN,
    O_PT,
    O_RATIO,
    O_RES_F,
    O_RES_S,
    O_SCAR,
    O_SLIDING,
    O_SPIN,
    O_SUPPORT,
    O_TANGENTIAL,
    O_TIME,
    O_TIP,
    O_TOUCHING,
    O_VX,
    O_VY,
    O_WORK,
    OBSERVABLES,
    P_N,
    P_T,
    PART,
    PHI,
    PLOUGH,
    PLOUGHING,
    RATE,
    RELOAD,
    REST,
    RETURNED,
    REVERSAL,
    RISE,
    S_MASS,
    S_PLATE,
    SLIDE,
    SLIDING,
    SLIP,
    SPIN,
    SPOT_CENTRE,
    SPOT_FLAT,
    SPOT_PEAK,
    SPOT_RADIUS,
    SPOT_TIP,
    SPRING,
    STEP_BUDGET,
    STIFFNESS,
    TANGENTIAL,
    TIME,
    TIP,
    TOLERANCE,
    TOUCH,
    TURN,
    UNLOAD,
    V_SPIN,
    V_X,
    V_Y,
    VX,
    VY,
    W_RATE,
    WORK_D,
    WORK_N,
    WORK_S,
    WORK_T,
    W,
    X,
    Y,
)
from .motion import (
    STAGES,
    derivative,
    kinematics,
    loading_radius,
    pace_of,
    step,
    tip_x,
)

__all__ = ["OBSERVABLES", "many_impacts", "one_impact"]

# fmt: off
_BITES = 40


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR,
               VECTOR, MATRIX, VECTOR),
    cache=True, error_model="numpy",
)
def one_impact(loading, radius, unloading, residual, par, force, factors, breaks, body, spot, omega,
               psi, out):
    """Integrate one impact; fill `out` with OBSERVABLES and COUNTS and update `spot`.

    Follows the contact through loading, unloading, flight and re-contact, and the contact point
    through sliding, reversal and stick, from event to event.
    """
    n = len(omega)
    compliant = body[COMPLIANCE] < math.inf
    size = N_RIGID + 2 * n + (1 if compliant else 0)
    z, z_new, work, z_err = np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)
    scale, seen, seen_new = np.ones(size), np.zeros(N_SEEN), np.zeros(N_SEEN)
    seen_far = np.zeros(N_SEEN)
    stages, branch, shape = np.zeros((STAGES + 1, size)), np.zeros(N_BRANCH), np.zeros(3)
    values, values_new = np.zeros(N_EVENTS), np.zeros(N_EVENTS)
    active = np.zeros(N_EVENTS, np.bool_)
    for k in range(n):
        shape[0] += psi[0, k] ** 2
        shape[1] += psi[0, k] * psi[1, k]
        shape[2] += psi[1, k] ** 2
    out[:] = np.nan
    m, inertia = body[MASS], body[INERTIA]
    rubbing = body[MU_STATIC] > 0.0 or body[MU] > 0.0 or body[PLOUGH] > 0.0
    centre0 = spot[SPOT_CENTRE] if spot[SPOT_PEAK] > 0.0 else 0.0
    phase_f, offset, local = meet(
        loading, radius, unloading, residual, par, force, factors, spot, centre0, branch)
    phase = int(phase_f)
    set_segment(breaks, 0.0, branch)
    z[Y] = -(offset + (branch[1] + branch[2] if phase == UNLOAD else 0.0))
    y_start = z[Y]
    z[VX], z[VY], z[SPIN] = body[V_X], body[V_Y], body[V_SPIN]
    kinematics(body, z, psi, n, seen)
    v_n, v_t = seen[RATE], seen[SLIDING]
    c0 = body[HALF_COS]
    reduced = 1.0 / (1.0 / m + c0 * c0 / inertia)
    d_ref = reference_depth(loading, par, force, factors, 0.5 * reduced * v_n * v_n, body[TIP])
    t_ref = d_ref / v_n
    small_force = 1e-7 * reduced * v_n / t_ref
    arm = math.sqrt(inertia / m)
    tolerance = body[TOLERANCE]
    # The last move to an event is linear in time; its error is the square of its share of a step.
    bite = 0.1 * math.sqrt(tolerance)
    # Yield begins within the first step: the finer the tolerance, the less may be skipped.
    first_step = 0.15 * math.sqrt(t_ref) * min(1.0, (tolerance / 1e-7) ** 0.25)
    scale[X] = tolerance * (d_ref + abs(body[V_X]) * t_ref)
    scale[SLIP] = tolerance * (d_ref + abs(v_t) * t_ref)
    scale[Y] = scale[W] = tolerance * d_ref
    scale[TIME] = tolerance * t_ref
    scale[PHI] = tolerance * (d_ref / arm + abs(body[V_SPIN]) * t_ref)
    scale[VX] = tolerance * (v_n + abs(body[V_X]))
    scale[VY] = scale[W_RATE] = tolerance * v_n
    scale[SPIN] = tolerance * (v_n / arm + abs(body[V_SPIN]))
    scale[P_N] = scale[P_T] = tolerance * reduced * v_n
    scale[WORK_N:N_RIGID] = tolerance * reduced * v_n * v_n
    scale[WORK_T] = tolerance * reduced * v_n * (v_n + abs(v_t))
    root_mass = math.sqrt(m)
    for k in range(n):
        scale[N_RIGID + k] = tolerance * d_ref * root_mass
        scale[N_RIGID + n + k] = tolerance * v_n * root_mass

    derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape, branch,
                phase, 1.0, offset, BY_TIME, 0.0, z, stages[0], seen)
    ahead, spring_force = 1e-6 * t_ref, tolerance * reduced * v_n / t_ref
    mode = first_mode(seen, body[MU_STATIC] + seen[PLOUGHING], small_force, rubbing, v_n)
    if compliant:
        scale[SPRING] = spring_force
        mode = yielding_mode(
            loading, radius, unloading, par, force, factors, body, psi, branch, phase, offset,
            ahead, z, stages[0], work, z_err, seen_far)
    side = np.sign(v_t)
    approaching, recheck = True, False
    t_touch, touching, first_turn, t_last = 0.0, 0.0, np.nan, 0.0
    p_mark, w_mark, p_in, p_out, w_in, w_out = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    slip_low, slip_high, slip_base, x_low, x_high = 0.0, 0.0, 0.0, 0.0, 0.0
    peak_force, peak_depth, deepest_s, deepest_f = 0.0, 0.0, spot[SPOT_TIP], spot[SPOT_FLAT]
    contacts, steps, evaluations, ending = 1, 0, 0, DONE
    # The state at the latest separation is the outcome; a flight that meets nothing is dropped.
    kept = z.copy()
    simple = n == 0
    turning, to_rate = n == 0 and body[S_PLATE] == 0.0, False
    sprung = body[S_MASS] < math.inf
    # A force that depends on the rate may be largest between events.
    rated = force[DAMPING] != 0.0 or force[RADIATION] != 0.0
    stuck, variable, place = 0.0, BY_ROOT_TIME, 0.0
    h = first_step
    fresh, clear = True, True
    while True:
        if fresh:
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            if recheck and compliant and mode != 0.0:
                slip = slip_speed(
                    loading, radius, unloading, par, force, factors, body, psi, branch, phase,
                    mode, offset, ahead, z, stages[0], work, seen_far)
                if mode * slip < 0.0:
                    z[SPRING], mode = seen[TANGENTIAL], 0.0
                    if branch[RECEDING] > 0.0:
                        z[SPRING] /= seen[STIFFNESS]
            recheck = False
            rest = branch[1] + branch[2]
            if (phase == UNLOAD and simple and not approaching
                    and seen[DEPTH] - rest < 0.6 * (branch[0] - rest)):
                variable, place = BY_ROOT_DEPTH, math.sqrt(max(seen[DEPTH] - rest, 0.0))
                h = -0.4 * place if h > 0.0 else h
            if phase == LOAD and turning and approaching and not to_rate:
                ahead_of_border = branch[SEGMENT_HIGH] < d_ref and seen[RATE] > 0.6 * v_n
                if ahead_of_border and variable < BY_ROOT_DEPTH:
                    span = h if variable == BY_TIME else h * (2.0 * place + h)
                    variable, place = BY_ROOT_DEPTH, math.sqrt(max(seen[DEPTH], 0.0))
                    h = math.sqrt(place * place + seen[RATE] * span) - place
                elif variable == BY_ROOT_DEPTH and not ahead_of_border:
                    variable, h = BY_TIME, h * (2.0 * place + h) / seen[RATE]
                elif variable == BY_ROOT_DEPTH:
                    place = math.sqrt(max(seen[DEPTH], 0.0))
            if to_rate or variable == BY_RATE:
                variable, place, to_rate = BY_RATE, seen[RATE], False
                h = -place
                if not seen[ACCELERATION] < 0.0:
                    variable, turning, h = BY_TIME, False, 1e-3 * t_ref
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, variable, place, z, stages[0], seen)
            evaluations += 2
            fresh = False
            if phase == LOAD:
                peak_force = max(peak_force, seen[FORCE])
            event_values(loading, radius, unloading, par, force, factors, body, spot, omega, psi,
                         shape, branch, phase, mode, approaching, side, offset, ahead, centre0, z,
                         z_err, work, seen, seen_far, values)
            if phase == FLY and clear and values[TOUCH] > -1e-9 * spot[SPOT_PEAK]:
                values[TOUCH] = max(values[TOUCH], 0.0)  # at the parting it is zero to round-off
        if mode == 0.0 and rubbing and phase != FLY:
            stuck = 1.0
        if steps >= body[MAX_STEPS]:
            ending = STEP_BUDGET
            break
        if phase == FLY and n > 0 and not sprung:
            if not fly(body, spot, omega, psi, centre0, z, z_new, work, z_err, seen):
                break
            for j in range(size):
                z[j] = z_new[j]
            if contacts >= body[MAX_CONTACTS]:
                ending = CONTACT_BUDGET
                break
            contacts += 1
            t_touch = z[TIME]
            approaching, fresh = True, True
            phase_f, offset, local = meet(
                loading, radius, unloading, residual, par, force, factors, spot,
                centre0 + tip_x(body, z, psi, n), branch)
            phase = int(phase_f)
            set_segment(breaks, 0.0, branch)
            variable, place, h = BY_ROOT_TIME, 0.0, first_step
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, 1.0, offset, BY_TIME, place, z, stages[0], seen)
            mode = first_mode(
                seen, body[MU_STATIC] + seen[PLOUGHING], small_force, rubbing, v_n)
            side = np.sign(seen[SLIDING])
            if compliant:
                z[SPRING], scale[SPRING] = 0.0, spring_force
                mode = yielding_mode(
                    loading, radius, unloading, par, force, factors, body, psi, branch, phase,
                    offset, ahead, z, stages[0], work, z_err, seen_far)
            continue
        if phase == FLY:
            left = t_last + body[FLIGHT] - z[TIME]
            if left <= 1e-12 * body[FLIGHT]:
                break
            h = min(h, left, body[FLIGHT] / 60.0)
        # On loading by depth a step can end on the border of a stretch.
        pressing, bordering = variable == BY_ROOT_DEPTH and phase == LOAD, False
        if pressing:
            if seen[ACCELERATION] < 0.0:
                room = -0.3 * seen[RATE] ** 2 / seen[ACCELERATION]
                h = min(h, math.sqrt(place * place + room) - place)
            border = math.sqrt(branch[SEGMENT_HIGH])
            bordering = place + 1.02 * h >= border
            h = border - place if bordering else h
        landing = variable >= BY_ROOT_DEPTH and place + h <= 0.02 * place
        if landing:
            h = -place
        error = step(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                      branch, phase, mode, offset, variable, place, h, z, stages, z_new, work,
                      z_err, scale, seen_new)
        evaluations += STAGES
        steps += 1
        if not error <= 1.0:
            h *= max(0.2, 0.9 * error**-0.125) if math.isfinite(error) else 0.1
            if variable == BY_RATE and -h < 1e-4 * place:
                variable, turning, fresh, h = BY_TIME, False, True, 1e-3 * t_ref
            elif pressing and h < 1e-5 * max(place, 1e-3 * math.sqrt(d_ref)):
                variable, turning, fresh, h = BY_TIME, False, True, 1e-3 * t_ref
            elif variable == BY_ROOT_DEPTH and not pressing and -h < 1e-5 * place:
                # The tip no longer leaves: depth cannot carry the motion any further.
                variable, simple, fresh, h = BY_TIME, False, True, 1e-3 * t_ref
            elif variable < BY_ROOT_DEPTH and h < 1e-14 * t_ref:
                ending = NOT_FINITE
                break
            continue
        grown = h * min(6.0, 0.9 * max(error, 1e-12) ** -0.125)
        event_values(loading, radius, unloading, par, force, factors, body, spot, omega, psi, shape,
                     branch, phase, mode, approaching, side, offset, ahead, centre0, z_new, z_err,
                     work, seen_new, seen_far, values_new)
        mark_active(phase, mode, approaching, clear, compliant, variable, active)
        pace, pace_new = pace_of(variable, place, seen), pace_of(variable, place + h, seen_new)
        chosen, where, taken, first = -1, 2.0, h, 1.0
        for event in range(N_EVENTS):
            if active[event] and values[event] >= 0.0 and values_new[event] < 0.0:
                sign = side if event == REVERSAL else mode
                d0 = event_slope(event, body, z, stages[0], psi, n, seen, sign, pace)
                d1 = event_slope(event, body, z_new, stages[STAGES], psi, n, seen_new, sign,
                                 pace_new)
                if event == SLIDE or (event == REST and compliant):
                    d0 = d1 = (values_new[event] - values[event]) / h
                part = hermite_root(values[event], d0, values_new[event], d1, h)
                if part < where:
                    chosen, where, first = event, part, part
        while chosen >= 0:
            low, high, g_low, g_high = 0.0, taken / h, values[chosen], values_new[chosen]
            active[chosen] = False
            secant = (chosen == SLIDE or (chosen == REST and compliant)
                      or (body[S_PLATE] > 0.0 and chosen != PART and chosen != REST
                          and chosen != REVERSAL))
            part, kept_end = where, 0
            for bites in range(_BITES):
                x = part * h
                error = step(loading, radius, unloading, par, force, factors, body, omega, psi,
                      shape, branch, phase, mode, offset, variable, place, x, z, stages, z_new,
                      work, z_err, scale, seen_new)
                evaluations += STAGES
                event_values(loading, radius, unloading, par, force, factors, body, spot, omega,
                             psi, shape, branch, phase, mode, approaching, side, offset, ahead,
                             centre0, z_new, z_err, work, seen_new, seen_far, values_new)
                g = values_new[chosen]
                taken = x
                if g < 0.0:
                    high, g_high = part, g
                    # A chord that keeps its other end is steepened (the Illinois rule).
                    g_low *= 0.5 if kept_end < 0 else 1.0
                    kept_end = -1
                else:
                    low, g_low = part, g
                    g_high *= 0.5 if kept_end > 0 else 1.0
                    kept_end = 1
                pace_new = pace_of(variable, place + x, seen_new)
                slope = h * event_slope(chosen, body, z_new, stages[STAGES], psi, n, seen_new,
                                        side if chosen == REVERSAL else mode, pace_new)
                if secant:
                    slope = (g_high - g_low) / (high - low)
                move = -g / slope if slope < 0.0 else 0.5 * (low + high) - part
                target = part + move
                if not low < target < high or (secant and bites % 3 == 2):
                    target = 0.5 * (low + high)
                    move = target - part
                near = abs(move) <= bite and slope < 0.0
                if near and not (secant and high - low > 10.0 * bite):
                    for j in range(size):
                        z_new[j] += move * h * stages[STAGES, j]
                    taken = x + move * h
                    break
                if high - low <= 1e-15:
                    break
                part = target
            # Another event may hide before the one found.
            earlier = -1
            for event in range(N_EVENTS):
                if active[event] and values[event] >= 0.0:
                    if values_new[event] < -1e-7 * values[event]:
                        earlier = event
            if earlier < 0:
                break
            chosen = earlier
            where = (taken / h) * values[chosen] / (values[chosen] - values_new[chosen])
        if chosen >= 0:
            if not error <= 1.0:
                # The kink beyond the event hid the error of the way to it: come nearer first.
                h = 0.5 * first * h
                continue
        elif bordering:
            chosen = BORDER
            move = (branch[SEGMENT_HIGH] - seen_new[DEPTH]) / (2.0 * border)
            for j in range(size):
                z_new[j] += move * stages[STAGES, j]
        elif landing:
            chosen = PART if variable == BY_ROOT_DEPTH else TURN
        place += taken
        for j in range(size):
            z[j] = z_new[j]
        if side == 0.0:
            side = np.sign(seen_new[SLIDING])
        if phase != FLY and (chosen >= 0 or rated) and seen_new[FORCE] > peak_force:
            peak_force = seen_new[FORCE]
        if chosen == TOUCH and seen_new[RATE] <= 0.0:
            # The tip brushes the crater's rim on its way out: no contact.
            chosen, clear, fresh = -1, False, True
        elif phase == FLY and chosen < 0:
            clear = clear or values_new[TOUCH] >= 0.0
        if chosen < 0:
            h = grown
            for j in range(size):
                stages[0, j] = stages[STAGES, j]
            for j in range(N_SEEN):
                seen[j] = seen_new[j]
            for event in range(N_EVENTS):
                values[event] = values_new[event]
            if phase == UNLOAD and simple and variable == BY_TIME and not approaching:
                fresh = True
            if turning and approaching and phase != FLY and (variable < BY_ROOT_DEPTH or pressing):
                span = grown if variable == BY_TIME else grown * (2.0 * place + grown)
                span = span / seen[RATE] if pressing else span
                near = -1.2 * seen[ACCELERATION] * span
                fresh = seen[RATE] < (0.6 * v_n if pressing else min(0.45 * v_n, near))
                to_rate = fresh
            continue

        # An event: close the interval that ends here, then change phase or mode.
        fresh = True
        if pressing:
            h = grown
        elif variable < BY_ROOT_DEPTH:
            h = min(grown, max(0.5 * taken, 0.05 * h))
        kinematics(body, z, psi, n, seen)
        depth = seen[DEPTH] - offset
        x_tip = centre0 + tip_x(body, z, psi, n)
        if phase != FLY:
            slip_low = min(slip_low, z[SLIP] - slip_base)
            slip_high = max(slip_high, z[SLIP] - slip_base)
            x_low, x_high = min(x_low, x_tip - centre0), max(x_high, x_tip - centre0)
        if chosen <= RETURNED:
            if approaching:
                p_in += z[P_N] - p_mark
                w_in += z[WORK_N] - w_mark
            else:
                p_out += z[P_N] - p_mark
                w_out -= z[WORK_N] - w_mark
            p_mark, w_mark = z[P_N], z[WORK_N]
        if compliant and (chosen == TURN or chosen == RETURNED):
            # The spring keeps its force while the area grows, its deformation while it shrinks.
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                       branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            receding = chosen == TURN
            if seen[STIFFNESS] > 0.0:
                z[SPRING] *= 1.0 / seen[STIFFNESS] if receding else seen[STIFFNESS]
            branch[RECEDING] = 1.0 if receding else 0.0
            scale[SPRING] = scale[SLIP] if receding else spring_force
        if chosen == TURN:
            approaching = False
            if math.isnan(first_turn):
                first_turn = z[TIME]
            variable, h = BY_TIME, 0.15 * t_ref
            if phase == LOAD:
                phase = UNLOAD
                # Metal that was met before stays gone: the residual grows by the difference.
                deepest_s -= branch[1]
                local -= branch[2]
                set_peak(loading, unloading, residual, par, force, factors, depth, branch)
                branch[PEAK_RADIUS] = loading_radius(radius, par, force, depth)
                deepest_s += branch[1]
                local += branch[2]
                deepest_f = max(deepest_f, local)
                spot[SPOT_TIP], spot[SPOT_FLAT] = deepest_s, local
                spot[SPOT_PEAK], spot[SPOT_CENTRE] = depth, x_tip
                spot[SPOT_RADIUS] = radius(par, branch[4], branch[4])
                peak_depth = max(peak_depth, depth + offset)
        elif chosen == PART:
            phase = FLY
            touching += z[TIME] - t_touch
            t_last = z[TIME]
            for j in range(size):
                kept[j] = z[j]
            offset = 0.0
            mode, clear = 1.0, True
            variable, h = BY_TIME, min(0.02 * body[FLIGHT], 0.02 * t_ref)
            if body[FLIGHT] <= 0.0:
                break
        elif chosen == RETURNED:
            approaching = True
        elif chosen == RELOAD:
            phase, variable, h, recheck = LOAD, BY_TIME, 0.02 * t_ref, True
            set_segment(breaks, branch[0], branch)
        elif chosen == BORDER:
            recheck = True
            set_segment(breaks, branch[SEGMENT_HIGH], branch)
        elif chosen == REVERSAL:
            side = -side
        elif chosen == REST:
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            if compliant:
                z[SPRING], mode = seen[TANGENTIAL], 0.0
                if branch[RECEDING] > 0.0:
                    z[SPRING] = z[SPRING] / seen[STIFFNESS] if seen[STIFFNESS] > 0.0 else 0.0
            elif rubbing:
                mode = sliding_mode(seen, body[MU_STATIC] + seen[PLOUGHING], small_force)
            else:
                mode = -mode
        elif chosen == SLIDE:
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            pull = seen[M_TN] * seen[FORCE] + seen[B_T]
            if compliant:
                # At a touch the spring is still slack: the bodies' motion decides.
                slack = abs(seen[TANGENTIAL]) <= 1e-6 * small_force
                pull = seen[SLIDING] if slack else -seen[TANGENTIAL]
            mode = 1.0 if pull > 0.0 else -1.0
        else:
            if contacts >= body[MAX_CONTACTS]:
                ending = CONTACT_BUDGET
                break
            contacts += 1
            t_touch = z[TIME]
            approaching = True
            phase_f, offset, local = meet(
                loading, radius, unloading, residual, par, force, factors, spot, x_tip, branch)
            phase = int(phase_f)
            set_segment(breaks, 0.0, branch)
            slip_base += z[SLIP] - kept[SLIP]
            variable, place, h = BY_ROOT_TIME, 0.0, 0.25 * math.sqrt(t_ref)
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, 1.0, offset, BY_TIME, place, z, stages[0], seen)
            mode = first_mode(
                seen, body[MU_STATIC] + seen[PLOUGHING], small_force, rubbing, v_n)
            side = np.sign(seen[SLIDING])
            if compliant:
                z[SPRING], scale[SPRING] = 0.0, spring_force
                mode = yielding_mode(
                    loading, radius, unloading, par, force, factors, body, psi, branch, phase,
                    offset, ahead, z, stages[0], work, z_err, seen_far)

    if ending == STEP_BUDGET or ending == NOT_FINITE:
        for j in range(size):
            kept[j] = z[j]
        t_last = z[TIME]
    kinematics(body, kept, psi, n, seen)
    c, s = seen[ARM], seen[RISE] + body[TIP]
    rebound = kept[VY] - kept[SPIN] * c
    out[O_E], out[O_TIP] = rebound / v_n, rebound
    out[O_KINETIC] = p_out / p_in if p_in > 0.0 else np.nan
    out[O_ENERGETIC] = math.sqrt(max(w_out, 0.0) / w_in) if w_in > 0.0 else np.nan
    out[O_TANGENTIAL] = (kept[VX] + kept[SPIN] * s) / v_t if v_t != 0.0 else np.nan
    out[O_RES_S], out[O_RES_F], out[O_PEAK] = deepest_s, deepest_f, peak_depth
    out[O_TIME], out[O_TOUCHING], out[O_LOADING] = t_last, touching, first_turn
    out[O_FORCE], out[O_SPIN] = peak_force, kept[SPIN]
    out[O_SLIDING], out[O_SCAR] = slip_high - slip_low, x_high - x_low
    out[O_PN], out[O_PT] = kept[P_N], kept[P_T]
    out[O_RATIO] = abs(kept[P_T]) / kept[P_N] if kept[P_N] > 0.0 else np.nan
    out[O_WORK], out[O_FRICTION] = kept[WORK_N], kept[WORK_T]
    modal = 0.0
    for k in range(n):
        q, p = kept[N_RIGID + k], kept[N_RIGID + n + k]
        modal += 0.5 * (p * p + (omega[k] * q) ** 2)
    out[O_MODAL] = modal + kept[WORK_D]
    out[O_SUPPORT] = kept[WORK_S]
    out[O_VY], out[O_VX] = kept[VY], kept[VX]
    before = 0.5 * (m * (body[V_X] ** 2 + body[V_Y] ** 2) + inertia * body[V_SPIN] ** 2)
    after = 0.5 * (m * (kept[VX] ** 2 + kept[VY] ** 2) + inertia * kept[SPIN] ** 2)
    fallen = -m * body[GRAVITY] * (kept[Y] - y_start)
    given = out[O_WORK] + out[O_FRICTION] + out[O_MODAL] + out[O_SUPPORT]
    out[O_ENERGY] = (before + fallen - after - given) / before
    drift_y = m * (kept[VY] - body[V_Y]) + m * body[GRAVITY] * t_last - kept[P_N]
    drift_x = m * (kept[VX] - body[V_X]) - kept[P_T]
    out[O_MOMENTUM] = math.hypot(drift_x, drift_y) / (m * v_n)
    out[FIRST_COUNT], out[FIRST_COUNT + 1], out[FIRST_COUNT + 2] = ending, contacts, steps
    out[FIRST_COUNT + 3], out[FIRST_COUNT + 4] = evaluations, stuck


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, MATRIX, MATRIX, MATRIX, VECTOR, MATRIX, MATRIX,
               MATRIX,
               types.Array(types.float64, 3, "C"), MATRIX),
    cache=True, nogil=True,
)
def many_impacts(loading, radius, unloading, residual, par, force, factors, breaks, body, spot,
                 omega, psi, out):
    """Integrate row after row; all but `breaks` and `body` hold one row or one per impact."""
    for i in range(len(body)):
        one_impact(loading, radius, unloading, residual, par[min(i, len(par) - 1)],
                   force[min(i, len(force) - 1)], factors[min(i, len(factors) - 1)], breaks,
                   body[i], spot[i],
                   omega[min(i, len(omega) - 1)], psi[min(i, len(psi) - 1)], out[i])
