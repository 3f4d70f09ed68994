"""Checks of what moved: mass, speed, friction, impulse, and the impulse of a force trace."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import chdtrc

from ...core.arrays import Array
from ...core.rig import Quantity, StrikerTable, TargetTable
from ..recording_set import RecordingSet
from ..rules import RULES
from . import limits, momentum
from .findings import Finding, Severity, critical_interval, judged, two_sided
from .trial_view import TrialView, by_trial, speed_std, value_of


def check_mass(found: RecordingSet) -> list[Finding]:
    """Stated mass against density and volume, of the strikers and of a second sphere that is free.

    How much of the round ends a rod has beyond its length is left open, from plain ends to two
    whole caps, but all rods of a set are taken to have ends of one kind.
    """
    strikers = {name: table for name, table in found.setup.strikers.items() if table.weighed}
    allowed = {name: limits.geometric_mass(striker) for name, striker in strikers.items()}
    known = {name: mass for name, mass in allowed.items() if mass is not None}
    bodies = [(strikers[name], mass) for name, mass in known.items()]
    part = _part_of_the_ends(bodies)
    findings = [
        Finding(f"mass of {name}", Severity.UNCHECKED, "no density is stated")
        for name in strikers
        if name not in known
    ]
    rods = sum(mass.high > mass.low for mass in known.values())
    alone = RULES.false_alarms_mass if len(known) < 2 else RULES.alone * RULES.false_alarms_mass
    for name, mass in known.items():
        stated = strikers[name].mass_kg
        width = (mass.high / mass.low - 1.0) / _mass_relative(stated, mass) if rods == 1 else 0.0
        critical = critical_interval(width, alone / len(known))
        findings.append(_weighed(name, stated, mass, _expected(mass, part), critical))
    if len(known) > 1:
        findings.append(_masses_together(bodies))
    return [*findings, *_second_mass(found.setup.target)]


def _second_mass(target: TargetTable) -> Iterator[Finding]:
    """Yield the finding on the mass of a second sphere, where one is stated."""
    if target.mass_kg is None:
        return
    name, mass = "the second sphere", limits.second_mass(target)
    if mass is None:
        yield Finding(f"mass of {name}", Severity.UNCHECKED, "no density is stated")
    else:
        critical = critical_interval(0.0, RULES.false_alarms_mass)
        yield _weighed(name, target.mass_kg, mass, mass.low, critical)


def _weighed(
    name: str, mass: Quantity, allowed: limits.Range, expected: float, critical: float
) -> Finding:
    stated = mass.value
    z = abs(stated / expected - 1.0) / _mass_relative(mass, allowed)
    span = f"{allowed.low:.4g}" + (f" to {allowed.high:.4g}" if allowed.high > allowed.low else "")
    return Finding(
        f"mass of {name}",
        Severity.CONTRADICTION if z > critical else Severity.CONSISTENT,
        f"{stated:.4g} kg stated, {span} kg from density and size "
        f"({stated / expected - 1.0:+.1%})",
        stated, expected, z,
    )  # fmt: skip


def _masses_together(bodies: list[tuple[StrikerTable, limits.Range]]) -> Finding:
    """All stated masses off by one factor, beside none off."""
    part = _best_part(bodies, lambda p: _misfit(bodies, p, _factor(bodies, p)))
    factor = _factor(bodies, part)
    plain = _misfit(bodies, _part_of_the_ends(bodies))
    gain = max(plain - _misfit(bodies, part, factor), 0.0)
    wrong = float(chdtrc(1, gain)) < (1.0 - RULES.alone) * RULES.false_alarms_mass
    return Finding(
        "mass of all strikers together",
        Severity.CONTRADICTION if wrong else Severity.CONSISTENT,
        f"{factor:.4g} times what density and size give ({factor - 1.0:+.1%})",
        factor, 1.0, float(np.sqrt(gain)),
    )  # fmt: skip


def _expected(m: limits.Range, part: float) -> float:
    return m.low + part * (m.high - m.low)


def _misfit(
    bodies: list[tuple[StrikerTable, limits.Range]], part: float, factor: float = 1.0
) -> float:
    """Sum of squares of the masses' distances, in standard deviations."""
    return sum(
        ((striker.mass_kg.value / (factor * _expected(m, part)) - 1.0)
         / _mass_relative(striker.mass_kg, m)) ** 2
        for striker, m in bodies
    )  # fmt: skip


def _factor(bodies: list[tuple[StrikerTable, limits.Range]], part: float) -> float:
    """Common factor on all masses that fits best."""
    ratio = [striker.mass_kg.value / _expected(m, part) for striker, m in bodies]
    weight = [_mass_relative(striker.mass_kg, m) ** -2 for striker, m in bodies]
    return float(np.average(ratio, weights=weight))


def _mass_relative(stated: Quantity, mass: limits.Range) -> float:
    return math.hypot(stated.relative, mass.relative) or RULES.rounding


def _part_of_the_ends(rods: list[tuple[StrikerTable, limits.Range]]) -> float:
    """Return the part of the end caps, 0 to 1, with which all stated masses agree best."""
    return _best_part(rods, lambda part: _misfit(rods, part))


def _best_part(
    bodies: list[tuple[StrikerTable, limits.Range]], misfit: Callable[[float], float]
) -> float:
    if not any(m.high > m.low for _, m in bodies):
        return 0.0
    inside = float(minimize_scalar(misfit, bounds=(0.0, 1.0), method="bounded").x)
    return min((0.0, inside, 1.0), key=misfit)


def check_speed(found: RecordingSet) -> list[Finding]:
    """Impact speed against the height of fall, where a trial gives both."""
    trials, g = found.trials, found.setup.gravity_m_s2.value
    both = ~np.isnan(trials.impact_speed_m_s) & ~np.isnan(trials.drop_height_m)
    if not both.any():
        return []
    speed = trials.impact_speed_m_s[both]
    rod = np.array([s.shape == "rod" for s in found.strikers()])[both]
    share = np.where(rod, 1.0, np.sin(np.radians(trials.angle_deg[both])))
    fall = np.sqrt(2.0 * g * trials.drop_height_m[both]) * share
    std = speed_std(found)[both]
    z = (speed - fall) / np.where(std > 0.0, std, RULES.rounding * speed)
    p = float(chdtrc(z.size, np.sum(z**2)))
    worst = int(np.argmax(np.abs(z)))
    mean = float(np.mean(speed / fall))
    return [
        Finding(
            "speed against height of fall",
            judged(p, RULES.false_alarms - momentum.SHARE),
            f"on average {mean - 1.0:+.1%} of sqrt(2 g H), at most {speed[worst]:.4g} against "
            f"{fall[worst]:.4g} m/s, {z.size} trials",
            mean, 1.0, two_sided(p),
        )
    ]  # fmt: skip


@by_trial
def check_friction(view: TrialView) -> Iterator[Finding]:
    """Impulse ratio against the ratio at which a rigid tip would stick."""
    ratio, touch = view.measured("friction_impulse_ratio"), view.touch
    if ratio is None or touch.c == 0.0 or touch.vx or touch.spin:
        return
    leaning = max(view.angle.value - RULES.angles_apart * view.angle.std, 0.0)
    limit = max(touch.stick_ratio, view.touch_at(leaning).stick_ratio)
    z = (ratio.value - limit) / ratio.std
    severity = Severity.CAUTION if z > RULES.beyond else Severity.CONSISTENT
    text = f"impulse ratio {ratio.value:.3g}, a rigid tip sticks at {limit:.3g}"
    yield Finding(f"friction of {view.name}", severity, text, ratio.value, limit, max(z, 0.0))


@by_trial
def check_impulse(view: TrialView) -> Iterator[Finding]:
    """Impulse that reverses the motion against peak force times duration."""
    e, mu = view.measured("restitution"), view.measured("friction_impulse_ratio")
    force, time = view.measured("peak_force_N"), view.measured("contact_time_s")
    if e is None or force is None or time is None:
        return
    impulse = view.touch.impulse(e.value, value_of(mu, 0.0))[1]
    pulse = force.value * time.value
    ratio = impulse / pulse
    relative = math.hypot(
        force.relative, time.relative, view.speed.relative, view.striker.mass_kg.relative
    )
    z = (ratio - RULES.pulse[1]) / (max(relative, RULES.rounding) * ratio)
    severity = Severity.CONSISTENT if ratio > RULES.pulse[0] else Severity.CAUTION
    yield Finding(
        f"impulse of {view.name}",
        Severity.CONTRADICTION if z > RULES.beyond else severity,
        f"{impulse:.4g} N s from the motion, {pulse:.4g} N s peak force times duration "
        f"(ratio {ratio:.2g}, usually {RULES.pulse[0]:g} to {RULES.pulse[1]:g})",
        impulse, pulse, max(z, 0.0) if severity is Severity.CONSISTENT else math.nan,
    )  # fmt: skip


_ELASTIC, _PLASTIC = 1.0, 0.0


@by_trial
def check_trace(view: TrialView) -> Iterator[Finding]:
    """Impulse of a force trace against the momentum that the impact changed.

    With a measured restitution the two must agree; without one the impulse must lie between that
    of a body that stays and of one that rebounds without loss.
    """
    if view.name in view.found.traces:
        trace = view.found.trace(view.name)
        if "force_N" in trace:
            yield _compared(view, trace)


def _compared(view: TrialView, trace: Mapping[str, Array]) -> Finding:
    name = f"impulse of {view.name} against its force trace"
    known = np.isfinite(trace["force_N"])
    time, force = trace["time_s"][known], trace["force_N"][known]
    if time.size < RULES.trace_samples:
        return Finding(name, Severity.UNCHECKED, f"the trace has {time.size} forces")
    peak, lasts = float(np.max(force)), float(time[-1] - time[0])
    ends = max(abs(float(force[0])), abs(float(force[-1])))
    if ends > RULES.open_ends * peak:
        message = f"the trace begins or ends at {ends / peak:.0%} of its peak of {peak:.4g} N"
        return Finding(name, Severity.UNCHECKED, message)
    traced = float(np.trapezoid(force, time))
    e, mu = view.measured("restitution"), view.measured("friction_impulse_ratio")
    # While the contact lasts gravity adds g T to the velocity that the impulse has to turn.
    drop = view.found.setup.gravity_m_s2.value * _duration(time, force) / view.speed.value

    def moved(restitution: float) -> float:
        return float(view.touch.impulse(restitution + drop, value_of(mu, 0.0))[1])

    noise = view.found.setup.noise
    ragged = noise.get("force_N", 0.0) * lasts / math.sqrt(time.size)
    gain = max(noise.get("force_N_relative", 0.0), RULES.rounding)
    relative = math.hypot(
        gain, ragged / traced if traced > 0.0 else 0.0, view.speed.relative,
        view.striker.mass_kg.relative, e.std / (1.0 + e.value) if e else 0.0,
    )  # fmt: skip
    low, high = (moved(e.value),) * 2 if e else (moved(_PLASTIC), moved(_ELASTIC))
    expected = min(max(traced, low), high)
    z = abs(traced - expected) / (relative * expected)
    span = f"{low:.4g}" + (f" to {high:.4g}" if high > low else "")
    return Finding(
        name,
        Severity.CONTRADICTION if z > RULES.beyond else Severity.CONSISTENT,
        f"{traced:.4g} N s under the trace, {span} N s from the motion "
        f"({traced / expected - 1.0:+.1%})",
        traced, expected, z,
    )  # fmt: skip


def _duration(time: Array, force: Array) -> float:
    """How long the force is above the share of the peak that counts as open [s]."""
    pressed = np.flatnonzero(force > RULES.open_ends * np.max(force))
    return float(time[pressed[-1]] - time[pressed[0]])
