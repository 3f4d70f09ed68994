"""The gates between a reduction and its numbers: what is looked at, and what follows from it.

Every check that a reduction makes passes, widens the stated error by what it means, or refuses with
the reason and a picture of the record. None is only a note.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from ..core.errors import InputError
from .measured import Measured
from .rules import RULES


class Gate(NamedTuple):
    """One gate.

    Parameters
    ----------
    kind
        What is reduced.
    looks_at
        What is checked.
    limit
        Name in `rules.RULES` of the number that decides; empty where none does.
    effect
        What follows beyond it.
    """

    kind: str
    looks_at: str
    limit: str
    effect: str


GATES = {
    "hole": Gate("pulse, press", "cells without a number, or missing rows, in or beside it",
                 "hole", "refuses"),
    "noise": Gate("pulse, press", "its peak over the noise before it", "pulse_over_noise",
                  "refuses"),
    "clipped": Gate("pulse", "equal samples at its top", "flat_samples", "refuses"),
    "plateau": Gate("pulse", "width near its top, in its width at half of the peak", "plateau",
                    "refuses"),
    "spike": Gate("pulse", "samples above half of its peak", "fewest_above_half", "refuses"),
    "edge": Gate("pulse", "a flank without samples on a pulse that has many", "whole_flank",
                 "refuses"),
    "lopsided": Gate("pulse", "time of one flank in that of the other", "lopsided", "refuses"),
    "ends": Gate("pulse", "both of its ends within the record", "", "refuses"),
    "duration": Gate("pulse", "standard deviation of the contact time, in itself",
                     "own_error", "refuses"),
    "step": Gate("pulse", "level afterwards, in its peak", "swing", "refuses"),
    "level": Gate("pulse", "level just after it, in its peak", "", "widens area, peak, ends"),
    "swings": Gate("pulse", "half-waves beside it above a third of the peak", "swings", "refuses"),
    "train": Gate("pulse", "other pulses of half its peak or more that do not fade as bounces do",
                  "train", "refuses"),
    "ringing": Gate("pulse", "largest half-wave of the other sign, in its peak", "ringing",
                    "is taken off, widens peak and ends; the area is the mean over the swings"),
    "foot": Gate("pulse", "area before its flank, in its own", "foot_part",
                 "is part of the area, widens the beginning"),
    "restitution": Gate("every kind", "standard deviations of the restitution beyond 0 to 1",
                        "by_chance", "refuses the impact"),
    "telling": Gate("track", "standard deviation of the restitution, in itself", "own_error",
                    "leaves the contact out"),
    "fall": Gate("track, markers", "acceleration in flight off gravity, in gravity", "fall_off",
                 "refuses; below it widens the speeds"),
    "shape": Gate("markers", "distance of the markers from one rigid shape, in its extent",
                  "not_rigid", "refuses; below it widens all numbers"),
    "spin": Gate("markers", "change of spin less that by the momentum at the tip, in its error", "",
                 "widens the spin afterwards"),
    "plane": Gate("markers", "impulse out of the plane of motion, in the normal one", "",
                  "widens the friction"),
    "contact": Gate("track", "contact time that the samples near it allow", "longest_contact",
                    "widens speeds and restitution"),
    "course": Gate("times, sound", "scatter of the intervals about their smooth course, in them",
                   "", "widens speeds and restitution"),
    "fades": Gate("times, sound", "shortening from the first interval to the last, in its error",
                  "by_chance", "refuses below"),
    "scale": Gate("track, video", "unit or size of a pixel as stated and by the fall", "",
                  "widens the speeds by the difference; see the fall"),
    "stamps": Gate("video", "gaps between time stamps of a clip that plays as it was filmed", "",
                   "the stamps tell the time"),
    "full-scale": Gate("sound", "part of the samples at full scale", "full_scale", "refuses"),
    "apex": Gate("tip", "distance of the apex from the circle", "", "widens the radius"),
    "depth": Gate("scan", "standard deviation of the depth, in itself", "own_error", "refuses"),
    "rows": Gate("press", "rows with a load and a depth", "table_rows", "refuses"),
    "cell": Gate("press", "depth that grows under equal loads, in the whole", "clipped_depth",
                 "refuses"),
    "unloaded": Gate("press", "load to which it falls again, in the largest", "least_unloaded",
                     "refuses; what is not unloaded widens depths"),
    "preload": Gate("press", "depth before the first load that is seen, in itself", "preload_part",
                    "widens the zero of contact"),
    "compliance": Gate("press", "the machine's own compliance, stated or seen in cycles",
                       "fewest_cycles", "keeps depths under load out of the row"),
    "modulus": Gate("tension", "strain at yield, by the slope of the first rise", "elastic_strain",
                    "refuses without a stated modulus, as it does a slope that no metal has"),
    "straight": Gate("tension", "slopes of the halves of the first rise", "elastic_straight",
                     "reads a lower part of it; widens the modulus"),
    "slip": Gate("tension", "fall without unloading, and elastic rise or half of the load lost, "
                 "in the largest", "cycle_depth", "refuses"),
    "stated": Gate("tension", "slope of the first rise and the stated modulus", "",
                   "counts plastic strain from the slope, widens the modulus; refuses one in MPa "
                   "or GPa"),
}  # fmt: skip


def is_restitution(value: Measured) -> bool:
    """Whether a value and its error tell a part of the speed that a contact can give back.

    One of which nothing is known but that it lies between 0 and 1 has a deviation of 1/12^(1/2).
    """
    off = max(-value.value, value.value - 1.0, 0.0)
    most = min(RULES.own_error * abs(value.value), 12.0**-0.5)
    return off <= RULES.by_chance * value.std and value.std < most


class Refused(InputError):
    """A record that gives no number: the gate that it did not pass, and how it is drawn."""

    def __init__(
        self, gate: str, found: str, *, source: str, allowed: str, key: str = "value"
    ) -> None:
        super().__init__(found, source=source, key=key, allowed=allowed)
        self.gate = GATES[gate]
        self.draw: Callable[[Path], None] | None = None


@contextmanager
def drawn(draw: Callable[[Path, str], None]) -> Iterator[None]:
    """Give a refusal from within the picture of what was refused; `draw` takes path and reason."""
    try:
        yield
    except Refused as refused:
        reason = refused.message
        if refused.draw is None:
            refused.draw = lambda to: draw(to, reason)
        raise
