"""Columns that were worked out from others: one reading that stands in two columns, counted once.

Two instruments differ by their noise. Where a column agrees with what others of the same trial give
to a small part of its stated noise, trial after trial, it was computed from them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.inputs.second_sphere import struck_sphere
from ...recordings import RecordingSet
from ..curves.readings import Readings
from ..rules import RULES


class _Relation(NamedTuple):
    """A column, what it would be by others, and how that is said."""

    column: str
    value: Array
    words: str


def derived_columns(recordings: RecordingSet, readings: Mapping[str, Readings]) -> dict[str, str]:
    """Return the columns that say again what others do, and a note on each.

    `readings`: every observable's values over the trials.
    """
    found = {}
    for relation in _relations(recordings, readings):
        own = readings[relation.column]
        # a value of zero whose noise is a part of itself says nothing of how well two agree
        apart = own.value - relation.value
        told = np.isfinite(apart) & (own.std > 0.0)
        apart = apart[told] / own.std[told]
        if len(apart) < RULES.derived_trials:
            continue
        if float(np.sqrt(np.mean(apart**2))) < RULES.derived:
            found[relation.column] = (
                f"{relation.column} is {relation.words} in {len(apart)} trials, far within its "
                "noise: one reading, counted once"
            )
    return found


def _relations(recordings: RecordingSet, readings: Mapping[str, Readings]) -> Iterator[_Relation]:
    seen = {name: r.value for name, r in readings.items()}
    approach = recordings.approach
    strikers = recordings.strikers()
    ball = np.array([s.shape == "sphere" for s in strikers])
    upright = ball | (approach.angle > 0.5 * np.pi - 1e-6)
    if {"restitution", "rebound_speed_m_s"} <= seen.keys():
        value = np.where(upright, seen["restitution"] * approach.normal, np.nan)
        second = struck_sphere(recordings.setup.target)
        if second is not None:
            both = np.array([second.reduced(s.mass_kg.value) for s in strikers])
            value = second.own_rebound(value, approach.normal, both)
        yield _Relation("rebound_speed_m_s", value, "restitution times the speed of approach")
    if {"dent_diameter_m", "permanent_depth_m"} <= seen.keys():
        own = [s.tip_radius_m.value for s in strikers]
        second = struck_sphere(recordings.setup.target)
        radius = np.array(own if second is None else [second.equivalent(x) for x in own])
        value = seen["dent_diameter_m"] ** 2 / (8.0 * radius)
        yield _Relation("permanent_depth_m", value, "the cap of the dent's diameter")
    speeds = {"restitution", "tangential_rebound_m_s"}
    if "friction_impulse_ratio" in seen and speeds <= seen.keys():
        along = np.abs(seen["tangential_rebound_m_s"] - approach.tangential)
        value = along / ((1.0 + seen["restitution"]) * approach.normal)
        words = "the change of tangential over that of normal speed"
        yield _Relation("friction_impulse_ratio", np.where(ball, value, np.nan), words)
