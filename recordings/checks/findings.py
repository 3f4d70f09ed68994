"""What an audit says: findings of one line each, and when chance alone may explain them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

from scipy.optimize import brentq
from scipy.special import ndtr, ndtri

from ...core.unstated import unstated_equal


class Severity(Enum):
    """How much a finding matters; the value is the word that is printed."""

    CONTRADICTION = "contradiction"
    CAUTION = "caution"
    CONSISTENT = "consistent"
    UNCHECKED = "not checked"


@unstated_equal
@dataclass(frozen=True, slots=True)
class Finding:
    """One check of a set.

    - `check`: name of the check and what it was made on.
    - `severity`: how much it matters.
    - `message`: what was compared, with numbers and units.
    - `value`, `expected`: the two numbers, in the unit of the message; NaN when there is none.
    - `significance`: distance in standard deviations; NaN when the finding is no statistical one.
    """

    check: str
    severity: Severity
    message: str
    value: float = math.nan
    expected: float = math.nan
    significance: float = math.nan

    def __str__(self) -> str:
        tail = "" if math.isnan(self.significance) else f"; {self.significance:.1f} sd"
        return f"{self.severity.value}: {self.check}: {self.message}{tail}"


def critical_interval(width: float, alpha: float) -> float:
    """Return how many standard deviations outside an interval are a contradiction.

    `width` is that of the interval that is allowed, in standard deviations, `alpha` the chance of a
    false alarm when the truth lies at one of its ends: Phi(-z) + Phi(-z - width) = alpha.

    Examples
    --------
    >>> round(critical_interval(0.0, 0.05), 2), round(critical_interval(9.0, 0.05), 2)
    (1.96, 1.64)
    """

    def excess(z: float) -> float:
        return float(ndtr(-z) + ndtr(-z - width) - alpha)

    return float(brentq(excess, 0.0, 10.0))


def two_sided(p: float) -> float:
    """Return the number of standard deviations of a normal variable with this p value."""
    return float(-ndtri(max(p, 1e-300) / 2.0))


def judged(p: float, alpha: float) -> Severity:
    """Return `CONTRADICTION` below the allowed part of false alarms, else `CONSISTENT`."""
    return Severity.CONTRADICTION if p < alpha else Severity.CONSISTENT


def gathered(findings: list[Finding]) -> list[Finding]:
    """Return the worst finding of each kind, and how many trials share its severity.

    Findings are of one kind when their checks, named `WHAT of TRIAL against BOUND`, differ in the
    trial only.
    """
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        what, _, rest = finding.check.partition(" of ")
        groups.setdefault((what, rest.partition(" against ")[2]), []).append(finding)
    order = list(Severity)

    def rank(finding: Finding) -> tuple[int, float]:
        z = 0.0 if math.isnan(finding.significance) else finding.significance
        return order.index(finding.severity), -z

    worst = []
    for members in groups.values():
        first = min(members, key=rank)
        same = sum(f.severity is first.severity for f in members)
        count = f" ({same} of {len(members)} trials)" if len(members) > 1 else ""
        worst.append(replace(first, check=first.check + count))
    return worst
