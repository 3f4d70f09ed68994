"""What a sound set may hold by mistake: told by `recordings check`, the notes in a verdict too."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..core.inputs.materials import unlisted
from ..core.observables import LOAD, RELATIVE_SUFFIX, RIG_NOISE, TRACE_NOISE

if TYPE_CHECKING:
    from .recording_set import RecordingSet

_NITROGEN = 77.4
"""Boiling point [K] (CRC Handbook)."""

# limit: way in radii at the speed of approach [-]: a soft ball stays for 2.5, a steel one 0.05
_RADII = 5.0
# limit: highest fall that is not asked back [m]: a stairwell
_STAIRWELL = 20.0


def questions_of(found: RecordingSet) -> list[str]:
    """Return a line for each number that is perhaps in another unit, missing, twice or unused."""
    setup = [*_unlisted(found), *_unused_gauges(found), *_gravity(found)]
    return [*setup, *_deep(found), *_twice(found)]


def _unlisted(found: RecordingSet) -> Iterator[str]:
    """Metals whose name gives none of the numbers that are left out."""
    for key, body in found.setup.bodies.items():
        named = {"E_Pa": body.E_Pa, "nu": body.nu}
        if key == "target" and found.setup.target.yields:
            named["Sy_Pa"] = body.strength
        left_out = [name for name, x in named.items() if x is None]
        if left_out and not body.rigid and (told := unlisted(body.material)):
            yield f"{key}: {told}assumed: {', '.join(left_out)}"


def _unused_gauges(found: RecordingSet) -> Iterator[str]:
    measured = {*found.observed, *(["load_N"] if found.trials.pressed.any() else ())}
    for column in found.setup.gauge:
        if column not in measured:
            yield f"gauge.{column} is not used: the set has no values of {column}"


def _gravity(found: RecordingSet) -> Iterator[str]:
    g = found.setup.gravity_m_s2.value
    if math.isclose(g, 981.0, rel_tol=0.01):  # on the ground
        yield f"gravity_m_s2 {g:g}: is it in cm/s^2?"


def _deep(found: RecordingSet) -> Iterator[str]:
    """Craters deeper than the tip is round, contacts in which it would go on by many radii."""
    tip = np.array([body.tip_radius_m.value for body in found.strikers()])
    most = {
        "permanent_depth_m": (tip, "the tip's radius"),
        "contact_time_s": (_RADII * tip / found.approach.normal, f"the time of {_RADII:g} radii"),
    }
    for name, (highest, what) in most.items():
        values = found.values(name) if name in found.observed else np.full(tip.shape, np.nan)
        if (beyond := np.flatnonzero(values > highest)).size:
            k = int(beyond[0])
            yield (
                f"{name} {values[k]:g} of {found.trials.trial[k]} is above {what}, "
                f"{highest[k]:g}: is it in another unit?"
            )


def _twice(found: RecordingSet) -> Iterator[str]:
    """Rows that say the same in two or more numbers measured."""
    trials, first, again = found.trials, dict[tuple[object, ...], str](), []
    conditions = np.stack(
        [trials.angle_deg, trials.impact_speed_m_s, trials.drop_height_m, trials.load_N]
    )
    values = np.stack([found.values(name) for name in found.observed]) if found.observed else None
    for k, name in enumerate(trials.trial):
        if values is None or np.isfinite(values[:, k]).sum() < 2:
            continue
        varied = (column[k] for column in trials.varied.values())
        row = (trials.striker[k], *map(repr, (*conditions[:, k], *values[:, k])), *varied)
        before = first.setdefault(row, name)
        if before != name:
            again.append(f"{name} as {before}")
    if again:
        shown = ", ".join(again[:3]) + (", ..." if len(again) > 3 else "")
        yield f"every number of {len(again)} trials stands in another too ({shown}): entered twice?"


def notes_of(found: RecordingSet) -> list[str]:
    """Return a line for each number that is not used or, as a whole, perhaps in another unit."""
    notes = []
    for key in found.setup.noise:
        column = key.removesuffix(RELATIVE_SUFFIX)
        used = column in found.observed or (key in TRACE_NOISE and bool(found.traces))
        used |= column == LOAD and bool(found.trials.pressed.any())
        if not used and key not in RIG_NOISE:
            notes.append(f"noise.{key} is not used: the set has no values of {column}")
        elif column in found.observed and np.nanmin(found.values(column)) > 0.0:
            noise, most = found.setup.noise[key], np.nanmax(found.values(column))
            if noise > (most if key == column else 1.0):
                notes.append(f"noise.{key} {noise:g} is above every reading: in another unit?")
    columns = found.trials.observables.values()
    empty = (
        np.all([np.isnan(c) for c in columns], axis=0) if columns else np.ones(len(found.trials))
    )
    bare = [
        name for name, none in zip(found.trials.trial, empty, strict=True)
        if none and name not in found.traces
    ]  # fmt: skip
    if bare:
        notes.append(f"nothing measured in {len(bare)} trials: {', '.join(bare[:5])}")
    trials = found.trials
    angles = trials.angle_deg[~trials.pressed]
    if angles.size and np.all(angles <= np.round(np.pi / 2.0, 1)):
        notes.append(f"no angle_deg is above {angles.max():g}: are they in radians?")
    if (high := trials.drop_height_m[trials.drop_height_m > _STAIRWELL]).size:
        notes.append(f"drop_height_m {high[0]:g}: is it in another unit?")
    air = found.setup.environment.temperature_K
    kelvins = (*trials.temperature_K, *([air.value] if air else []))
    if cold := [kelvin for kelvin in kelvins if kelvin < _NITROGEN]:
        notes.append(f"temperature_K {cold[0]:g}: is it in degrees Celsius?")
    return notes
