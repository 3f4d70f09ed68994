"""Check of what was recorded against time: the impulse of a force trace and the momentum change."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from ...core.arrays import Array
from ..rules import RULES
from .findings import Finding, Severity
from .trial_view import TrialView, by_trial, value_of

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
