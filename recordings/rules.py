"""Tuned numbers of recording sets: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class RecordingRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    unexplained: float = rule(
        0.5, "part of the lost energy that a dent should explain at least [-]"
    )
    dent_work: tuple[float, ...] = rule(
        (0.55, 1.1), "true work of a dent over p pi R d^2, least and most [-]",
        "barely plastic, and hardened",
    )  # fmt: skip
    rigid_periods: float = rule(
        3.0, "periods of a vibration that a contact should last for the body to act as rigid [-]",
        "one spring under a half-sine",
    )  # fmt: skip
    bound_std: float = rule(
        0.05, "relative standard deviation of such a bound [-]", "what its formulas leave out"
    )
    false_alarms_mass: float = rule(
        0.02, "part of clean sets in which a mass may be called wrong, over all strikers [-]",
    )  # fmt: skip
    false_alarms: float = rule(
        0.005, "the same of all other statistical checks of a set together [-]",
    )  # fmt: skip
    unstated_strength: float = rule(
        0.15, "relative standard deviation of a strength stated without one [-]", "a handbook's"
    )
    rounding: float = rule(
        0.003, "relative standard deviation where mass, density and size are all exact [-]",
        "three digits",
    )  # fmt: skip
    frozen_angle: float = rule(
        0.005, "part of the approach speed by which a frozen angle may err [-]"
    )
    pulse: tuple[float, ...] = rule(
        (0.25, 1.0), "impulse over peak force times duration, least and most [-]",
        "a rectangular pulse has 1, a ringing one may have 0.3",
    )  # fmt: skip
    alone: float = rule(0.25, "part of the masses' false alarms that goes to single strikers [-]")
    angles_apart: float = rule(
        2.0, "standard deviations between two readings of an angle [-]", "one in twenty"
    )
    mean_pressure: tuple[float, ...] = rule(
        (0.35, 1.3), "mean pressure of a press over a stated hardness, least and most [-]",
        "from first yield (1.1 S_y of 2.84 S_y) to metals that harden more than the test saw",
    )  # fmt: skip
    hardened: float = rule(
        4.0, "hardness over 2.84 S_y where the strength alone is stated [-]",
        "annealed copper and 304 reach it",
    )  # fmt: skip
    recovery: tuple[float, ...] = rule(
        (0.5, 0.85), "recovered depth over F/(E' a), least and most [-]",
        "1/2 of a flat punch, 3/4 of Hertz's, and a tenth above it",
    )  # fmt: skip
    press_geometry: tuple[float, ...] = rule(
        (0.7, 1.25), "contact radius over sqrt(2 R delta) at the peak, least and most [-]",
        "sunk in elastically, and piled up",
    )  # fmt: skip
    open_ends: float = rule(
        0.05, "level of a trace's ends in its peak above which a part of the impact is missed [-]"
    )
    beyond: float = rule(4.0, "standard deviations that are a mistake [-]", "one in 15 000")
    trace_samples: int = rule(5, "samples of a contact from which an impulse is taken [-]")
    unstated_speed: float = rule(
        0.02, "relative standard deviation of an approach speed stated without one [-]"
    )
    repeats: int = rule(3, "trials at one condition from which a noise may be taken [-]")
    speed_bin: float = rule(
        0.02, "relative width within which speeds are one condition [-]", "a drop's repeats"
    )
    angle_bin: float = rule(
        1.0, "width within which angles are one condition [degrees]", "a protractor's"
    )
    rate_bin: float = rule(
        0.5, "width in ln of a press's rate within which presses are one condition [-]",
        "strengths differ by a few per cent a decade",
    )  # fmt: skip
    restitution_beyond: float = rule(
        3.0, "standard deviations by which a restitution exceeds 1 before it asks for a reason [-]",
        "one in 700",
    )  # fmt: skip
    restitution_slip: float = rule(
        0.1, "excess of a restitution over 1 without a standard deviation that asks for one [-]"
    )


RULES = RecordingRules()
"""Every tuned number of the stage."""
