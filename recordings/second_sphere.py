"""What a set may hold where a sphere is struck: normal impacts, and presses on a held one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..core.errors import InputError, in_file
from ..core.inputs.second_sphere import StruckSphere, second_sphere_mistakes, struck_sphere
from .rules import RULES
from .trials import NORMAL

if TYPE_CHECKING:
    from .recording_set import RecordingSet

_ONLY_NORMAL = "a second sphere is struck along the line of centres"


def mistakes_of(found: RecordingSet) -> Iterator[InputError]:
    """Yield what is wrong with the second sphere of a set, or beside it."""
    source = str(found.folder / "set.toml") if found.folder else ""
    setup = found.setup
    wrong = in_file(second_sphere_mistakes(setup.target, setup.strikers), source)
    yield from wrong
    second = struck_sphere(setup.target)
    if wrong or second is None:
        return
    yield from _narrow(found, second, source)
    if second.free and found.trials.pressed.any():
        yield InputError(
            "of a sphere that is pressed", source=source, key="target.mass_kg",
            allowed="left out: what is pressed is held",
        )  # fmt: skip
    yield from _oblique(found)
    for name in found.profiles:
        yield InputError(
            f"the profile of {name} on a sphere", source=source, key="target.shape",
            allowed="permanent_depth_m in trials.csv: a profile is read against a flat",
        )  # fmt: skip
    for name in found.traces if second.free else ():
        if "tip_height_m" in found.trace(name):
            yield InputError(
                f"the trace of {name} has tip_height_m", source=source, key="target.mass_kg",
                allowed="force_N alone: the height is over a sphere that moves off",
            )  # fmt: skip


def _narrow(found: RecordingSet, second: StruckSphere, source: str) -> Iterator[InputError]:
    """A seat that is no wider than a ball, as stated or within the errors of the two."""
    radius = found.setup.target.radius_m
    for name, table in found.setup.strikers.items():
        own = table.tip_radius_m
        try:
            second.equivalent(own.value)
        except InputError as error:
            yield InputError(
                error.message, source=source, key=error.key, allowed=f"{error.allowed} ({name})"
            )
            continue
        if radius is None or radius.value > 0.0:
            continue
        apart = abs(radius.value) - own.value
        if apart < RULES.beyond * float(np.hypot(radius.std, own.std)):
            yield InputError(
                f"{radius.value:g} within its error and that of {name}", source=source,
                key="target.radius_m", allowed="a seat that is surely wider than the sphere",
            )  # fmt: skip


def _oblique(found: RecordingSet) -> Iterator[InputError]:
    """Trials that do not strike along the line of centres."""
    trials = found.trials
    source = str(found.folder / "trials.csv") if found.folder else ""
    usual = {"angle_deg": NORMAL, "approach_tangential_m_s": 0.0, "approach_spin_rad_s": 0.0}
    for column, value in usual.items():
        given = getattr(trials, column)
        for k in np.flatnonzero(~np.isnan(given) & (given != value)):
            yield InputError(
                f"{given[k]:g}", source=source, key=f"trial {trials.trial[k]}, column {column}",
                allowed=f"{value:g}: {_ONLY_NORMAL}",
            )  # fmt: skip
