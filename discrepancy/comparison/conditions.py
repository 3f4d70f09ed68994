"""Conditions: nominal impacts, each with the trials that repeat it and what struck there before."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Indices
from ...dynamics import Approach, Press
from ...dynamics.mechanisms.around import surroundings_of, weaker_table
from ...dynamics.mechanisms.base import Surroundings
from ...recordings import RecordingSet
from ...recordings.noise import bins
from ...recordings.rules import RULES as RECORDINGS
from ..rules import RULES


@dataclass(frozen=True, slots=True)
class Condition:
    """One nominal impact, or one quasi-static press.

    - `speed`, `angle`, `tangential`, `spin`: mean motion just before touch [m/s, rad, m/s, rad/s].
      The speed of a press is that at which its striker's impact goes as deep: where conditions lie
      beside each other.
    - `speed_spread`, `angle_spread`: standard error of the mean speed, or of a press's mean load,
      (fraction) and angle [rad].
    - `trials`: rows of trials.csv.
    - `around`: what mechanisms may know.
    - `after`: the condition that struck the same place before; -1 on fresh metal.
    - `press`: load and rate of a press; none of an impact.
    - `setting`, `setting_spread`: what was set once for all its trials, a height of fall, and the
      relative error of the speed that follows from it: shared by all conditions of that setting.
    """

    striker: str
    speed: float
    angle: float
    tangential: float
    spin: float
    speed_spread: float
    angle_spread: float
    trials: tuple[int, ...]
    around: Surroundings
    after: int = -1
    press: Press | None = None
    setting: str = ""
    setting_spread: float = 0.0

    @property
    def told(self) -> str:
        """The condition in words, for notes and proposals."""
        if self.press is not None:
            return f"pressed to {self.press.load:.3g} N"
        return f"at {self.speed:.3g} m/s"

    @property
    def incidence(self) -> float:
        """Angle to the flat [rad]: a rod's lean, and where nothing leans that of the path."""
        return self._approach.incidence

    def inclined(self, incidence: float) -> Condition:
        """Return the impact at another incidence [rad], of the same normal speed."""
        there = self._approach.inclined(incidence)
        return replace(self, angle=there.angle, tangential=there.tangential)

    @property
    def _approach(self) -> Approach:
        return Approach(self.speed, self.angle, self.tangential, self.spin)


def conditions_of(recordings: RecordingSet) -> tuple[Condition, ...]:
    """Return the conditions of a set, in the order in which they were first tested."""
    setup, trials, approach = recordings.setup, recordings.trials, recordings.approach
    numbers, before = _nominal(recordings)
    # a load is measured, as a speed is
    timed = ~np.isnan(trials.impact_speed_m_s) | trials.pressed
    heights = np.where(timed, np.nan, trials.drop_height_m)
    highest = np.nanmax(heights) if np.isfinite(heights).any() else 1.0
    found = []
    for number in np.unique(numbers):
        rows = np.flatnonzero(numbers == number)
        first, n = rows[0], len(rows)
        name = trials.striker[first]
        v = float(np.mean(approach.normal[rows]))
        relative = approach.normal_std[rows] / approach.normal[rows]
        unknown = RULES.speed_measured if timed[first] else RULES.speed_from_height
        press = None
        if trials.pressed[first]:
            relative, unknown = recordings.load_std[rows] / trials.load_N[rows], RULES.load_repeats
            rate = float(np.nan_to_num(trials.press_rate_per_s[first]))
            press = Press(float(np.mean(trials.load_N[rows])), rate)
        relative = np.where(np.isnan(relative), unknown, relative)
        height = float(heights[first])
        set_once = float(np.nan_to_num(0.5 * trials.drop_height_m_std[first] / height))
        lean = np.radians(np.nan_to_num(trials.angle_deg_std[rows], nan=0.0))
        flow = recordings.flows.get(weaker_table(setup, name))
        around = surroundings_of(
            setup, name, temperature=float(trials.temperature_K[first]),
            from_height=not timed[first],
            height_share=1.0 if timed[first] else float(height / highest),
            rises=() if flow is None else flow.rises,
        )  # fmt: skip
        found.append(
            Condition(
                name, v, float(np.mean(approach.angle[rows])),
                float(np.mean(approach.tangential[rows])), float(np.mean(approach.spin[rows])),
                float(np.sqrt(np.mean(relative**2) / n)), float(np.sqrt(np.mean(lean**2) / n)),
                tuple(int(r) for r in rows), around, int(before[first]), press,
                setting="" if timed[first] else f"{height:g} m", setting_spread=set_once,
            )
        )  # fmt: skip
    return tuple(found)


def _nominal(recordings: RecordingSet) -> tuple[Indices, Indices]:
    """Number of each trial's nominal condition, and of the one that struck its place before.

    Repeats share one simulation. Their speeds may differ by 5 %: the mean of the repeats is
    compared with a simulation at their mean speed; what is left of second order is below 0.1 %.
    """
    approach, trials = recordings.approach, recordings.trials
    rows = list(
        zip(
            trials.striker,
            bins(np.asarray(trials.angle_deg), width=1.0),
            bins(np.log(approach.normal), width=RULES.same_speed),
            bins(approach.tangential / approach.normal, width=RULES.same_speed),
            bins(approach.spin / approach.normal, width=RULES.same_speed),
            bins(trials.temperature_K, width=1.0),
            bins(np.log(trials.load_N), width=RULES.same_speed),
            bins(np.log(trials.press_rate_per_s), width=RECORDINGS.rate_bin),
            strict=True,
        )
    )
    numbers = np.zeros(len(rows), dtype=np.intp)
    before = np.full(len(rows), -1, dtype=np.intp)
    places: dict[object, int] = {}
    latest: dict[str, int] = {}
    # in the order of testing, so that a place's history is known when it is struck again
    for i in np.argsort(np.nan_to_num(trials.order), kind="stable"):
        spot = trials.spot[i]
        before[i] = latest.get(spot, -1) if spot else -1
        numbers[i] = places.setdefault((rows[i], int(before[i])), len(places))
        if spot:
            latest[spot] = int(numbers[i])
    return numbers, before
