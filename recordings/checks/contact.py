"""Checks of what the contact means: energy of the dent, forces, sizes, durations."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

from ...core.rig import TABOR
from ..recording_set import RecordingSet
from ..rules import RULES
from . import limits
from .findings import Finding, Severity
from .trial_view import TrialReading, TrialView, by_trial, value_of


def check_strength(found: RecordingSet) -> Iterator[Finding]:
    """Hardness against strength of what is struck, where both are stated and no flow curve is."""
    target = found.setup.target
    if target.tabor is None or target.flow_curve or not target.yields:
        return
    ratio, z, text = target.tabor
    severity = Severity.CAUTION if z > 2.0 else Severity.CONSISTENT
    if severity is Severity.CAUTION:
        text += ": one of both is wrong, or the metal hardens; Sy_Pa alone is used"
        text += ", the hardness where Sy_Pa is left out"
    yield Finding("hardness of the target against its strength", severity, text, ratio, TABOR, z)


@by_trial
def check_energy(view: TrialView) -> Iterator[Finding]:
    """Energy that the contact loses, or is brought, against the work of the measured dent."""
    e, depth, pressure = view.measured("restitution"), _depth(view), _pressure(view)
    brought, lost = _energies(view, e)
    if e is not None and lost.value < -RULES.beyond * lost.std and view.touch.c == 0.0:
        text = f"restitution {e.value:.3g} is a gain of {-lost.value:.3g} J"
        z = -lost.value / lost.std
        yield Finding(f"energy of {view.name}", Severity.CONTRADICTION, text, e.value, 1.0, z)
    elif depth is not None and pressure is not None:
        cost = _work(view, depth.value, 2.0 * depth.relative, pressure)
        yield _supply(view.name, cost, brought) if e is None else _budget(view.name, cost, lost)
    elif pressure is not None:
        for cost in _of_circle(view, pressure):
            stated = view.found.setup.target.hardness_Pa is not None
            yield _supply(view.name, cost, brought, None if e is None else lost, stated=stated)


def _work(view: TrialView, depth: float, relative: float, pressure: TrialReading) -> TrialReading:
    """Work of pressing a crater of this depth [J]; `relative` is its error by the depth."""
    work = limits.dent_work(view.R, depth, pressure.value)
    own = math.hypot(relative, view.striker.tip_radius_m.relative, pressure.relative)
    return TrialReading(work, own * work)


def _depth(view: TrialView) -> TrialReading | None:
    depth = view.measured("permanent_depth_m")
    return depth if depth is not None and depth.value > 0.0 else None


def _of_circle(view: TrialView, pressure: TrialReading) -> list[TrialReading]:
    """Work of pressing the circle of a dent, p pi a^4 / 4R, its elastic part included [J].

    None without a diameter, or where sliding widens the dent.
    """
    wide, touch = view.measured("dent_diameter_m"), view.touch
    leans = touch.c > 1e-3 * touch.s or abs(touch.tip[0]) > 1e-3 * abs(touch.tip[1])
    if wide is None or not wide.value > 0.0 or leans:
        return []
    return [_work(view, 0.125 * wide.value**2 / view.R, 4.0 * wide.relative, pressure)]


def _energies(view: TrialView, e: TrialReading | None) -> tuple[TrialReading, TrialReading]:
    """Energy that the contact point brings, v^2 / 2B, and what (1 - e^2) of it loses [J]."""
    mu = view.measured("friction_impulse_ratio")
    touch = view.touch
    brought = 0.5 * touch.impulse(0.0, value_of(mu, 0.0))[1] * abs(touch.tip[1])
    relative = max(
        math.hypot(2.0 * view.speed.relative, view.striker.mass_kg.relative), RULES.rounding
    )
    whole = TrialReading(brought, relative * brought)
    if e is None:
        return whole, whole
    lost = (1.0 - e.value**2) * brought
    std = math.hypot(2.0 * e.value * e.std * brought, relative * lost)
    return whole, TrialReading(lost, max(std, RULES.rounding * brought))


def _supply(
    name: str, work: TrialReading, brought: TrialReading, lost: TrialReading | None = None,
    *, stated: bool = True,
) -> Finding:  # fmt: skip
    """A circle's work against what was brought, and half of what was `lost`.

    The work of what stays is part of it, so that it bounds that from above, in a metal whose
    hardness is not `stated` up to how much it may harden. From below only what was brought does:
    part of a circle's work springs back.
    """
    least, most = RULES.dent_work
    z = (least * work.value - brought.value) / math.hypot(least * work.std, brought.std)
    severity = Severity.CONTRADICTION if z > RULES.beyond else Severity.CONSISTENT
    text = f"the dent takes {work.value:.3g} J of {brought.value:.3g} J brought "
    text += f"({work.value / brought.value:.0%})"
    if lost is not None:
        text += f", of which {max(lost.value, 0.0):.3g} J were lost"
        missing = _unexplained(work, lost, most if stated else RULES.hardened * most)
        if missing > 2.0:
            severity, z = Severity.CAUTION, missing
            text += ": look for a wrong size or mass, or a sink outside the contact"
    title = f"energy of {name} against all that was brought"
    return Finding(title, severity, text, work.value, brought.value, max(z, 0.0))


def _unexplained(work: TrialReading, lost: TrialReading, most: float) -> float:
    """Deviations by which `most` of a dent's work is below what it should explain of the loss."""
    least = RULES.unexplained
    return (least * lost.value - most * work.value) / math.hypot(most * work.std, least * lost.std)


def _budget(name: str, work: TrialReading, lost: TrialReading) -> Finding:
    title = f"energy of {name}"
    least, most = RULES.dent_work
    beyond = (least * work.value - lost.value) / math.hypot(least * work.std, lost.std)
    missing = _unexplained(work, lost, most)
    share = f" ({work.value / lost.value:.0%})" if lost.value > 0.0 else ""
    text = f"the dent takes {work.value:.3g} J of {lost.value:.3g} J lost{share}"
    if beyond > RULES.beyond:
        return Finding(title, Severity.CONTRADICTION, text, work.value, lost.value, beyond)
    if missing > 2.0:
        text += ": look for a sink outside the contact"
        return Finding(title, Severity.CAUTION, text, work.value, lost.value, missing)
    z = max(beyond, missing, 0.0)
    return Finding(title, Severity.CONSISTENT, text, work.value, lost.value, z)


@by_trial
def check_force(view: TrialView) -> Iterator[Finding]:
    """Peak force, measured or needed by the dent, against yield and waves of the rod."""
    striker = view.striker
    force, word = _force(view)
    if striker.shape != "rod" or force is None:
        return
    bounds = {"wave limit rho c v A": limits.wave_limit(striker, view.speed.value)}
    if striker.Sy_Pa is not None:
        bounds["yield force of the rod"] = striker.Sy_Pa.value * limits.rod_area(striker)
    wrong = Severity.CONTRADICTION if word == "measured" else Severity.CAUTION
    for what, bound in bounds.items():
        if math.isnan(bound):
            continue
        z = (force.value - bound) / math.hypot(force.std, RULES.bound_std * bound)
        yield Finding(
            f"force of {view.name} against {what}",
            wrong if z > RULES.beyond else Severity.CONSISTENT,
            f"{force.value:.4g} N {word}, {bound:.4g} N ({force.value / bound:.2g} times)",
            force.value, bound, max(z, 0.0),
        )  # fmt: skip


@by_trial
def check_contact_size(view: TrialView) -> Iterator[Finding]:
    """Radius of the dent against the radius of the rod."""
    depth, striker = view.measured("permanent_depth_m"), view.striker
    if striker.shape != "rod" or depth is None:
        return
    a, r = limits.open_dent_radius(view.R, depth.value), striker.body_radius
    severity, tail = Severity.CONSISTENT, ""
    if a > r:
        severity, tail = Severity.CAUTION, ": the contact reaches the edge"
    text = (
        f"a dent {depth.value * 1e6:.3g} um deep is {a * 1e3:.3g} mm in radius, the rod "
        f"{r * 1e3:.3g} mm{tail}"
    )
    yield Finding(f"contact size of {view.name}", severity, text, a, r)


@by_trial
def check_duration(view: TrialView) -> Iterator[Finding]:
    """Contact time against wave round trip and bending period of the rod."""
    striker = view.striker
    time, word = _duration(view)
    if striker.shape != "rod" or striker.E_Pa is None or time is None:
        return
    periods = {"wave round trip 2L/c": 2.0 * striker.length / limits.bar_wave_speed(striker)}
    if view.touch.c > 1e-3 * view.touch.s:
        periods["first bending period"] = limits.bending_period(striker)
    for what, period in periods.items():
        severity, tail = Severity.CONSISTENT, ""
        if time < RULES.rigid_periods * period:
            severity, tail = Severity.CAUTION, ": the rod may not act as rigid"
        text = (
            f"{time * 1e3:.3g} ms {word}, {period * 1e3:.3g} ms ({time / period:.2g} times){tail}"
        )
        yield Finding(f"duration of {view.name} against {what}", severity, text, time, period)


def _pressure(view: TrialView) -> TrialReading | None:
    return None if view.parted else _hardness(view.found, view.found.trials.striker[view.i])


@lru_cache(maxsize=16)
def _hardness(found: RecordingSet, striker: str) -> TrialReading | None:
    """What is the same for all trials of a striker."""
    target = found.setup.target
    hard = limits.hardness(target, found.setup.strikers[striker]) if target.yields else None
    return None if hard is None else TrialReading(hard.value, hard.std)


def _force(view: TrialView) -> tuple[TrialReading | None, str]:
    force = view.measured("peak_force_N")
    if force is not None:
        return force, "measured"
    depth, pressure = view.measured("permanent_depth_m"), _pressure(view)
    if depth is None or pressure is None:
        return None, ""
    value = pressure.value * math.pi * limits.dent_radius(view.striker, depth.value) ** 2
    relative = math.hypot(depth.relative, pressure.relative)
    return TrialReading(value, relative * value), "needed by the dent"


def _duration(view: TrialView) -> tuple[float | None, str]:
    time = view.measured("contact_time_s")
    if time is not None:
        return time.value, "measured"
    pressure = _pressure(view)
    if pressure is None:
        return None, ""
    return limits.plastic_duration(view.striker, 1.0 / view.touch.along, pressure.value), "expected"
