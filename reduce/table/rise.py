"""The elastic rise of a tension test: where it is straight, its slope, and how sure that is."""

from __future__ import annotations

import math
from itertools import zip_longest
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr, stdtrit

from ...core.arrays import Array
from ...core.errors import InputError
from ..measured import Measured
from ..rules import RULES


class ElasticRise(NamedTuple):
    """The modulus [Pa] and the strain at which its line meets zero stress."""

    modulus: Measured
    zero: float


class _Line(NamedTuple):
    """Strain over stress of some rows: compliance and its deviation [1/Pa], their middle.

    `reverse` is what the slope of the stress over the strain says beyond it, `bend` what the halves
    of the rows differ by beyond their scatter, `straight` their slopes, the smaller in the larger,
    `slack` whether the lower half is the softer one.
    """

    compliance: float
    noise: float
    reverse: float
    bend: float
    straight: float
    slack: bool
    middle: tuple[float, float]

    def shows_yield_of(self, other: _Line) -> bool:
        """Return whether this one rises so much more steeply that the other has yielded."""
        chance = RULES.no_chance * math.hypot(self.noise, other.noise)
        yielded = self.compliance < RULES.elastic_straight * other.compliance
        return yielded and 0.0 < self.compliance < other.compliance - chance


def elastic_rise(strain: Array, stress: Array, source: str) -> ElasticRise:
    """Return the highest straight rise that no much steeper one below shows to have yielded.

    The strain is fitted over the stress, for load cells scatter less than extensometers; the slope
    of the stress over the strain is the other bound where both do (R. Frisch, 1934), and belongs to
    the error, as does what halves of the rise and the next lower one say differently. Refuses fewer
    than three rows, and a stress that does not rise.
    """
    peak = float(stress.max())
    each = (_up_to(high * peak, strain, stress) for high in RULES.elastic_parts)
    lines = [line for line in each if line is not None]
    best: tuple[_Line, _Line | None] | None = None
    for line, lower in zip_longest(lines, lines[1:]):
        if line.straight >= RULES.elastic_straight and (
            best is None or line.shows_yield_of(best[0])
        ):
            best = line, lower
    if best is not None and best[0].compliance > 0.0:
        return _told(*best)
    if not lines:
        high = RULES.elastic_parts[0]
        first = stress[: int(np.argmax(stress > high * peak)) + 1]
        rows = np.flatnonzero(first > RULES.elastic_from[0] * high * peak)
        if rows.size < 3 or np.ptp(strain[rows]) <= 0.0:
            raise InputError(
                f"{rows.size} rows of the elastic rise", source=source,
                allowed="three or more between a tenth and four tenths of the largest stress",
            )  # fmt: skip
        lines = [_of_few(_line(strain[rows], stress[rows]), rows.size)]
    line = max(lines, key=lambda line: line.straight)
    if not line.compliance > 0.0:
        raise InputError("the stress does not rise", source=source, allowed="a loading curve")
    return _told(line, None)


def _up_to(top: float, strain: Array, stress: Array) -> _Line | None:
    """Return the line up to a stress [Pa], from where slack no longer bends it."""
    found = None
    for least in RULES.elastic_from:
        rows = np.flatnonzero(stress[: int(np.argmax(stress > top))] > least * top)
        if rows.size < RULES.fewest:
            break
        found = _line(strain[rows], stress[rows])
        if found.straight >= RULES.elastic_straight or not found.slack:
            break
    return found


def _of_few(line: _Line, rows: int) -> _Line:
    """Return the line through a handful of rows: they hardly tell their own scatter.

    Its error is such that what chance seldom makes of many rows it seldom makes of these (Student).
    """
    student = float(stdtrit(rows - 2, ndtr(RULES.by_chance)))
    return line._replace(noise=line.noise * student / RULES.by_chance)


def _told(line: _Line, lower: _Line | None) -> ElasticRise:
    """Return the modulus with all that it may be off by."""
    bend = line.bend
    if lower is not None:
        apart = line.compliance - lower.compliance
        bend = max(bend, math.sqrt(max(apart**2 - lower.noise**2, 0.0)))
    E = 1.0 / line.compliance
    error = math.sqrt(line.noise**2 + line.reverse**2 + bend**2)
    strain, stress = line.middle
    return ElasticRise(Measured(E, error * E**2), strain - stress * line.compliance)


def _line(strain: Array, stress: Array) -> _Line:
    """Return the line through rows, and what its halves say of it."""
    middle = np.median(stress)
    compliance, noise = _slope(stress, strain)
    reverse = _slope(strain, stress)[0]
    low, up = (
        _slope(stress[part], strain[part])[0] for part in (stress <= middle, stress >= middle)
    )
    # each half has half of the rows and of the span: half of what they differ by scatters twice
    # as much as the whole; a handful of rows tells no scatter
    chance = 2.0 * noise if stress.size >= RULES.fewest else 0.0
    return _Line(
        compliance, noise, (1.0 / reverse if reverse else math.inf) - compliance,
        math.sqrt(max(0.25 * (up - low) ** 2 - chance**2, 0.0)),
        min(low / up, up / low) if low * up > 0.0 else 0.0, low > up,
        (float(strain.mean()), float(stress.mean())),
    )  # fmt: skip


def _slope(x: Array, y: Array) -> tuple[float, float]:
    """Return the slope of y over x and its standard deviation by scatter; zeros where x stands."""
    x, y = x - x.mean(), y - y.mean()
    span = float(x @ x)
    if span == 0.0:
        return 0.0, 0.0
    slope = float(x @ y) / span
    left = y - slope * x
    return slope, math.sqrt(float(left @ left) / max(x.size - 2, 1) / span)
