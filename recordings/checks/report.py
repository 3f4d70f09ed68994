"""Audit of a recording set before any comparison: whether its numbers agree with each other.

Masses, speeds, momentum, energy, forces, sizes and durations are compared with what geometry and
mechanics allow. A contradiction is a finding that chance explains in fewer than 5 of 100 clean
sets; a caution says that an assumption of the rigid baseline is not safe.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..recording_set import RecordingSet
from .contact import check_contact_size, check_duration, check_energy, check_force, check_strength
from .findings import Finding, Severity
from .momentum import check_momentum
from .motion import check_friction, check_impulse, check_mass, check_speed, check_trace
from .press import check_press_depths, check_press_load, check_press_recovery
from .trial_view import Check

CHECKS: tuple[Check, ...] = (
    check_speed,
    check_momentum,
    check_friction,
    check_impulse,
    check_trace,
    check_energy,
    check_force,
    check_contact_size,
    check_duration,
)
"""The checks of impacts in the order in which they are made: what moved, what it means."""

PRESS_CHECKS: tuple[Check, ...] = (check_press_load, check_press_recovery, check_press_depths)
"""The checks of quasi-static presses."""


@dataclass(frozen=True, slots=True)
class Audit:
    """All findings of a set, in the order of the checks."""

    name: str
    findings: tuple[Finding, ...]

    @property
    def flagged(self) -> bool:
        """Whether anything contradicts."""
        return bool(self.of(Severity.CONTRADICTION))

    def of(self, severity: Severity) -> tuple[Finding, ...]:
        """Return the findings of one severity."""
        return tuple(f for f in self.findings if f.severity is severity)


def audit(found: RecordingSet) -> Audit:
    """Check a set against itself: a finding for each check that it allows, also when it passes.

    Of checks made trial by trial the worst, with the number of trials that share its severity.
    """
    findings = [*check_mass(found), *check_strength(found)]
    for rows, checks in ((found.impacts, CHECKS), (found.presses, PRESS_CHECKS)):
        if len(rows.trials):
            findings += [finding for check in checks for finding in check(rows)]
    return Audit(found.name, tuple(findings))
