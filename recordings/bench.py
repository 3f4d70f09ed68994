"""`[rig]` of set.toml: what can be done next, within which ranges, in how many minutes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

from pydantic import AfterValidator, Field

from ..core.inputs.csv_table import Problems
from ..core.inputs.toml_input import InputTable
from ..core.observables import OBSERVABLES
from .trials import NORMAL

if TYPE_CHECKING:
    from .recording_set import RecordingSet

# limit: repeats of one trial [-], and a session [minutes]: a week's work
_REPEATS, _SESSION = 100, 10080.0

# limit: how far beyond its range a row may lie [-]: as far as trials of one setting differ
SETTING = 1.05


def _increasing(given: tuple[float, float]) -> tuple[float, float]:
    if not 0.0 < given[0] < given[1]:
        raise ValueError("two increasing numbers above 0")
    return given


def _upright(given: tuple[float, float]) -> tuple[float, float]:
    if given[1] > NORMAL:
        raise ValueError(f"two increasing angles up to {NORMAL:g}, a normal impact")
    return given


def _measured(given: tuple[str, ...]) -> tuple[str, ...]:
    for name in given:
        if name not in OBSERVABLES or not OBSERVABLES[name].usual_noise:
            known = ", ".join(k for k, row in OBSERVABLES.items() if row.usual_noise)
            raise ValueError(f"{name!r} is none of {known}")
    return given


Number = Annotated[float, Field(strict=True)]
Range = Annotated[tuple[Number, Number], Field(strict=False), AfterValidator(_increasing)]
Took = Annotated[float, Field(strict=True, gt=0.0, le=_SESSION)]


class Minutes(InputTable):
    """`[rig.minutes]`: how long each takes; what has no entry the laboratory cannot do."""

    strike: Took | None = None
    """One impact, read."""
    press: Took | None = None
    """One quasi-static press, read."""
    change: Took | None = None
    """To change from one striker to another."""
    hardness: Took | None = None
    """A hardness test of what is struck."""
    weigh: Took | None = None
    """A striker on a scale."""
    calliper: Took | None = None
    """A tip's radius, or a plate's thickness, by a calliper or in a picture."""
    instrument: Took | None = None
    """To set up an instrument that the set has not had."""
    build: Took | None = None
    """A striker of another size."""


class Bench(InputTable):
    """What the rig can do; what is left out is as it was in the trials so far."""

    speeds_m_s: Range | None = None
    """Normal speeds of approach."""
    angles_deg: Annotated[Range, AfterValidator(_upright)] | None = None
    """Angles, as in trials.csv."""
    loads_N: Range | None = None
    """Loads of its press."""
    reads: Annotated[tuple[str, ...], Field(strict=False), AfterValidator(_measured)] = ()
    """Columns of trials.csv that can be read as well."""
    repeats: Annotated[int, Field(strict=True, ge=1, le=_REPEATS)] | None = None
    """Repeats of a trial; as many as there were if left out."""
    session_minutes: Took | None = None
    """How long a session is."""
    minutes: Minutes | None = None
    """How long each takes."""


def refuse_beyond(added: RecordingSet, rows: tuple[int, ...], problems: Problems) -> None:
    """Note in `problems` the rows of new trials whose speed, angle or load the rig cannot do."""
    bench, trials = added.setup.rig, added.trials
    known = {
        "impact_speed_m_s": (bench.speeds_m_s, added.approach.normal, "m/s"),
        "angle_deg": (bench.angles_deg, trials.angle_deg, "degrees"),
        "load_N": (bench.loads_N, trials.load_N, "N"),
    }
    for column, (span, values, unit) in known.items():
        low, high = span or (0.0, math.inf)
        for row, value, pressed in zip(rows, values, trials.pressed, strict=True):
            inside = low / SETTING <= value <= high * SETTING
            if not (inside or math.isnan(value) or (pressed and column != "load_N")):
                problems.add(
                    f"{value:.4g} {unit} beyond the rig", row=row, column=column,
                    allowed=f"{low:g} to {high:g}, [rig] of set.toml",
                )  # fmt: skip
