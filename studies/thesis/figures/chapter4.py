"""Chapter 4: the oblique rod with nine laws over time and over speed, beside what the text says."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ....core.inputs.toml_input import read_toml
from ....dynamics.integrate import Trace, strike, traced
from ....dynamics.inverse import mobility
from ....dynamics.result import Impact
from ....models.base import ContactLaw
from ...plot import Entry, Picture, finish, laws, look, sheet
from .. import chapter5
from ..chapter3 import REFERENCE
from ..chapter5 import scene_at
from .chapter4_said import HISTORY_SAID, SWEEP_SAID, Swept, Values

NINE = ("jackson-green-2007", "ghaednia", "kogut-etsion-continued", "kogut-komvopoulos",
        "ye-komvopoulos", "brake-2015", "brake-2012", "stronge", "thornton", "fitted")  # fmt: skip
"""The thesis's nine, Kogut and Etsion as it must have been used, and ours."""

_SPEEDS = np.linspace(0.5, 4.0, 8)
_PANELS = (
    ("tip_height_m", "tip height [um]", 1e6, "4.4"),
    ("slip_m", "tangential displacement [um]", 1e6, "4.5"),
    ("normal_velocity_m_s", "normal velocity [m/s]", 1.0, "4.6"),
    ("sliding_velocity_m_s", "tangential velocity [m/s]", 1.0, "4.7"),
    ("spin_rad_s", "spin [rad/s]", 1.0, "4.8"),
)
_OVER_SPEED = (
    ("4.9", "Residual depth", 45.0, "residual_m", 1e6, "residual depth [um]"),
    ("4.10", "Restitution", 45.0, "restitution", 1.0, "restitution"),
    ("4.11", "Rebound spin", 45.0, "rebound_spin_rad_s", 1.0, "rebound spin [rad/s]"),
    ("4.12", "Restitution", 17.2, "restitution", 1.0, "restitution"),
    ("4.13", "Rebound spin", 17.2, "rebound_spin_rad_s", 1.0, "rebound spin [rad/s]"),
    ("4.14", "Dent in the flat", 45.0, "residual_flat_m", 1e6, "dent in the flat [um]"),
    ("4.15", "Dent in the flat", 17.2, "residual_flat_m", 1e6, "dent in the flat [um]"),
)
_NEAREST = {45.0: 45.0, 17.2: 20.0}
"""Angle of chapter 5's experiment that lies beside an angle of chapter 4."""


def pictures() -> list[Entry]:
    """Figures 4.4-4.15."""
    data = read_toml(REFERENCE / "chapter45.toml")
    measured = {float(s["angle_deg"]): s for s in data["sweep"]}
    scars = {float(e["angle_deg"]): e for e in data["experiment"]}
    histories = [
        (law, traced(scene_at(law, 45.0, 1.0, measured[45.0]["friction"]), points=200))
        for law in laws(*NINE)
    ]
    swept = {
        angle: {law.name: _sweep(law, angle, sweep["friction"]) for law in laws(*NINE)}
        for angle, sweep in measured.items()
    }
    return [
        *(_history(panel, histories) for panel in _PANELS),
        *(
            _over_speed(one, swept[one[2]], measured[one[2]], scars[_NEAREST[one[2]]])
            for one in _OVER_SPEED
        ),
    ]


def _sweep(law: ContactLaw, degrees: float, mu: float) -> list[Impact]:
    return [strike(scene_at(law, degrees, float(v), mu)) for v in _SPEEDS]


def _history(
    panel: tuple[str, str, float, str], histories: list[tuple[ContactLaw, Trace]]
) -> Picture:
    name, label, factor, number = panel
    made, (axis,) = sheet()
    for law, trace in histories:
        axis.plot(1e3 * trace.column("time_s"), factor * trace.column(name), **look(law))
    finish(axis, x="time [ms]", y=label)
    ends = {law.name: trace.impact for law, trace in histories}
    return Picture(number, f"History: {label}", made, HISTORY_SAID[number](ends))


def _over_speed(
    one: tuple[str, str, float, str, float, str], swept: Swept, sweep: Mapping[str, Any],
    scar: Mapping[str, Any],
) -> Picture:  # fmt: skip
    number, title, angle, name, factor, label = one
    made, (axis,) = sheet()
    values: Values = {
        law: np.array([factor * getattr(i, name) for i in impacts])
        for law, impacts in swept.items()
    }
    for law in laws(*NINE):
        axis.plot(_SPEEDS, values[law.name], **look(law))
    note = _measured(axis, name, sweep, scar)
    finish(axis, x="approach speed [m/s]", y=label)
    note += f" {SWEEP_SAID[number](values, sweep)}{_again(swept) if number == '4.9' else ''}"
    return Picture(number, f"{title}, {angle:g} degrees", made, note.strip())


def _again(swept: Swept) -> str:
    """Which laws let the tip touch twice, and from which speed on."""
    found = {
        law: min(v for v, i in zip(_SPEEDS, impacts, strict=True) if i.contacts > 1)
        for law, impacts in swept.items()
        if any(i.contacts > 1 for i in impacts)
    }
    if not found:
        return ""
    told = ", ".join(f"{law} from {v:g} m/s" for law, v in found.items())
    return f" The tip touches the wall of its own dent again with {told}."


def _measured(axis: Any, name: str, sweep: Mapping[str, Any], scar: Mapping[str, Any]) -> str:
    """Draw what was measured, or follows from it; return what it is."""
    angle, e = float(sweep["angle_deg"]), sweep["restitution"]
    cross = f"chapter 5, {scar['angle_deg']:g} degrees"
    if name == "restitution":
        axis.axhline(e, color="k", lw=1.0, label=f"measured, about {e:g}")
        axis.plot(-scar["approach_m_s"], scar["restitution"], "kx", ms=9, mew=2, label=cross)
        return f"Measured about {e:g} throughout; chapter 5 has {scar['restitution']:g} (cross)."
    if name == "rebound_spin_rad_s":
        axis.plot(_SPEEDS, [_rigid_spin(angle, v, sweep) for v in _SPEEDS], "k", lw=1.0,
                  label=f"rigid rod with e = {e:g}")  # fmt: skip
        return ""
    if name == "residual_flat_m":
        axis.plot(-scar["approach_m_s"], -1e6 * scar["depth_m"], "kx", ms=9, mew=2, label=cross)
        return f"Chapter 5's dent: {-1e6 * scar['depth_m']:.0f} um."
    return ""


def _rigid_spin(angle: float, speed: float, sweep: Mapping[str, Any]) -> float:
    """Spin after a rigid rod's impact, by 5.2 with P_x = mu P_y and P_y = (1 + e) v/B [rad/s]."""
    rod, theta, mu = chapter5.thesis_rod(), math.radians(angle), sweep["friction"]
    impulse = (1.0 + sweep["restitution"]) * speed / mobility(rod, theta).normal(mu)
    c, s = rod.arm(theta)
    return float((s * mu - c) * impulse / rod.inertia)
