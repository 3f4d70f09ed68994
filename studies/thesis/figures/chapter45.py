"""Chapters 4 and 5: the oblique rod with nine laws, and what its scar tells."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....core.material import Material
from ....core.toml_input import read_toml
from ....impact.integrate import Trace, strike, traced
from ....impact.inverse import alpha_curve
from ....impact.result import Impact
from ....impact.scene import Approach, Friction, Scene, scene_of
from ....models.base import ContactLaw
from ...plot import Entry, Picture, finish, laws, look, sheet
from .. import chapter5
from ..chapter3 import REFERENCE
from . import scars, sketches, tables

NINE = ("jackson-green-2007", "ghaednia", "kogut-etsion", "kogut-komvopoulos", "ye-komvopoulos",
        "brake-2015", "brake-2012", "stronge", "thornton", "fitted")  # fmt: skip
_SPEEDS = np.linspace(0.5, 4.0, 8)
_PANELS = (
    ("tip_height_m", "tip height [um]", 1e6, "4.4"),
    ("slip_m", "tangential displacement [um]", 1e6, "4.5"),
    ("normal_velocity_m_s", "normal velocity [m/s]", 1.0, "4.6"),
    ("sliding_velocity_m_s", "tangential velocity [m/s]", 1.0, "4.7"),
    ("spin_rad_s", "spin [rad/s]", 1.0, "4.8"),
)
Histories = list[tuple[ContactLaw, Trace]]
_NOT_PRINTED = "The thesis prints no measured value in its text; only our curves are drawn."


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """Redraw figures and tables; nothing here needs finite elements."""
    histories = [(law, traced(_scene(law, 45.0, 1.0, 0.13), points=200))
                 for law in laws(*NINE)]  # fmt: skip
    steep = {law.name: _sweep(law, 45.0, 0.13) for law in laws(*NINE)}
    flat = {law.name: _sweep(law, 17.2, 0.20) for law in laws(*NINE)}
    return [
        *sketches.chapters_4_and_5(),
        tables.properties("4.1"),
        tables.legend(NINE),
        *(_history(panel, histories) for panel in _PANELS),
        _over_speed("4.9", "Residual depth, 45 degrees", steep, "residual_m", 1e6, "[um]", None),
        _over_speed("4.10", "Restitution, 45 degrees", steep, "restitution", 1.0, "", 0.43),
        _over_speed("4.11", "Rebound spin, 45 degrees", steep, "rebound_spin_rad_s", 1.0,
                    "[rad/s]", None),
        _over_speed("4.12", "Restitution, 17.2 degrees", flat, "restitution", 1.0, "", 0.55),
        _over_speed("4.13", "Rebound spin, 17.2 degrees", flat, "rebound_spin_rad_s", 1.0,
                    "[rad/s]", None),
        _over_speed("4.14", "Dent in the flat, 45 degrees", steep, "residual_flat_m", 1e6, "[um]",
                    None),
        _over_speed("4.15", "Dent in the flat, 17.2 degrees", flat, "residual_flat_m", 1e6, "[um]",
                    None),
        tables.properties("5.1"),
        _alpha(),
        *scars.pictures(_experiments(), chapter5.thesis_rod().tip_radius),
        _pattern(),
        *(tables.comparison(f"5.{k}", angle) for k, angle in ((2, 20.0), (3, 45.0), (4, 70.0))),
    ]  # fmt: skip


def _scene(law: ContactLaw, degrees: float, speed: float, mu: float) -> Scene:
    data = read_toml(REFERENCE / "chapter45.toml")
    rod, flat = (
        Material(b["E_Pa"], b["nu"], b["Sy_Pa"], density=b["density_kg_m3"])
        for b in (data["rod"], data["flat"])
    )
    return scene_of(
        law, sphere=rod, flat=flat, striker=chapter5.thesis_rod(),
        approach=Approach(speed, math.radians(degrees)), friction=Friction(mu),
    )  # fmt: skip


def _experiments() -> dict[float, Histories]:
    """Chapter 5's three impacts with the laws whose scars are drawn."""
    found = {}
    for e in read_toml(REFERENCE / "chapter45.toml")["experiment"]:
        angle = float(e["angle_deg"])
        found[angle] = [
            (law, traced(_scene(law, angle, -e["approach_m_s"], e["friction"]),
                                   points=300))
            for law in laws("ghaednia", "kogut-komvopoulos", "brake-2015", "fitted")
        ]  # fmt: skip
    return found


def _sweep(law: ContactLaw, degrees: float, mu: float) -> list[Impact]:
    return [strike(_scene(law, degrees, float(v), mu)) for v in _SPEEDS]


def _history(
    panel: tuple[str, str, float, str], histories: list[tuple[ContactLaw, Trace]]
) -> Picture:
    name, label, factor, number = panel
    made, (axis,) = sheet()
    for law, trace in histories:
        axis.plot(1e3 * trace.column("time_s"), factor * trace.column(name), **look(law))
    finish(axis, x="time [ms]", y=label)
    note = f"45 degrees, 1 m/s, friction 0.13. {_LAST[name](histories)}"
    return Picture(number, f"History: {label}", made, note)


def _told(histories: Histories, read: Callable[[Impact], float], form: str) -> str:
    return ", ".join(f"{law.name} {read(trace.impact):{form}}" for law, trace in histories)


def _held(found: dict[str, float], *, largest: str = "", smallest: str = "") -> str:
    """Say what the text claims of the thesis's nine laws, and whether it is so here."""
    nine = {name: value for name, value in found.items() if name != "fitted"}
    claims = [
        (claimed, kind, pick(nine, key=lambda name: nine[name]))
        for claimed, kind, pick in ((largest, "largest", max), (smallest, "smallest", min))
        if claimed
    ]
    return (
        "".join(
            f"; the text: {claimed} is {kind}, "
            + ("as here" if one == claimed else f"here {one} ({nine[one]:.3g})")
            for claimed, kind, one in claims
        )
        + "."
    )


def _ends(histories: Histories, read: Callable[[Impact], float]) -> dict[str, float]:
    return {law.name: read(trace.impact) for law, trace in histories}


def _loading(histories: Histories) -> str:
    found = _ends(histories, lambda i: 1e3 * i.loading_time_s)
    longer = [name for name, value in found.items() if value > 1.08 * found["ghaednia"]]
    return (
        f"Loading lasts [ms]: {_told(histories, lambda i: 1e3 * i.loading_time_s, '.3f')}. The "
        "text: 0.11 for six laws, longer for Brake's two and Thornton's; here longer by more than "
        f"8 % for {', '.join(longer)}"
        + _held(
            _ends(histories, lambda i: i.residual_flat_m), largest="thornton", smallest="stronge"
        )
        .replace("is largest", "leaves most")
        .replace("is smallest", "leaves least")
    )


_LAST: dict[str, Callable[[Histories], str]] = {
    "tip_height_m": _loading,
    "slip_m": lambda h: "Slid at the end [um]: "
    + _told(h, lambda i: 1e6 * i.sliding_length_m, ".0f")
    + _held(_ends(h, lambda i: 1e6 * i.sliding_length_m), largest="brake-2012"),
    "normal_velocity_m_s": lambda h: "Rebound [m/s]: " + _told(h, lambda i: i.restitution, ".2f")
    + _held(_ends(h, lambda i: i.restitution), largest="stronge", smallest="thornton"),
    "sliding_velocity_m_s": lambda h: "Tangential velocity of the centre at the end [m/s]: "
    + _told(h, lambda i: i.tangential_rebound_m_s, ".3f")
    + _held(_ends(h, lambda i: abs(i.tangential_rebound_m_s)), largest="stronge",
            smallest="thornton"),
    "spin_rad_s": lambda h: "Spin at the end [rad/s]: "
    + _told(h, lambda i: i.rebound_spin_rad_s, ".2f")
    + _held(_ends(h, lambda i: abs(i.rebound_spin_rad_s)), largest="stronge",
            smallest="thornton"),
}  # fmt: skip
_CLAIMS = {
    "4.9": {"largest": "thornton", "smallest": "stronge"},
    "4.10": {"largest": "stronge", "smallest": "thornton"},
}
"""Which laws the text calls extreme over the speed."""


def _over_speed(
    number: str, title: str, impacts: dict[str, list[Impact]], name: str, factor: float,
    unit: str, measured: float | None,
) -> Picture:  # fmt: skip
    made, (axis,) = sheet()
    for law in laws(*NINE):
        values = [factor * getattr(i, name) for i in impacts[law.name]]
        axis.plot(_SPEEDS, values, **look(law))
    middle = {k: factor * getattr(v[2], name) for k, v in impacts.items()}
    note = _NOT_PRINTED
    if number in _CLAIMS:
        note += f" At 1.5 m/s{_held(middle, **_CLAIMS[number])}"
    if measured is not None:
        axis.axhline(measured, color="k", ls="--", lw=1.0, label=f"measured, about {measured:g}")
        told = ", ".join(f"{k} {v:.2f}" for k, v in middle.items())
        claimed = _held(middle, **_CLAIMS[number]) if number in _CLAIMS else "."
        note = f"Measured about {measured:g} throughout; at 1.5 m/s: {told}{claimed}"
    finish(axis, x="approach speed [m/s]", y=f"{title.split(',')[0].lower()} {unit}".strip())
    return Picture(number, title, made, note)


def _alpha() -> Picture:
    made, (axis,) = sheet()
    angles = np.radians(np.linspace(0.2, 89.8, 400))
    rod = chapter5.thesis_rod()
    for mu in (0.0, 0.1, 0.2, 0.5, 1.0):
        values = alpha_curve(rod, angles, mu=mu)
        jam = np.abs(np.diff(values, append=values[-1])) > 5.0
        axis.plot(np.degrees(angles), np.where(jam, np.nan, values), label=f"friction {mu:g}")
    axis.axhline(0.0, color="k", lw=0.8)
    axis.set_ylim(-1.5, 1.5)
    finish(axis, x="angle [degrees]", y="alpha (below zero: sliding)")
    note = (
        "Drawn with the corrected 5.12. No change of sign without friction, one at 82 degrees for "
        "0.1, two for 0.2 and 0.5, always sticking for 1: as the text describes."
    )
    return Picture("5.3", "Sliding per normal travel", made, note)


def _pattern() -> Picture:
    """Depth of the tip along its path on the flat: the predicted scar at 20 degrees."""
    made, (axis,) = sheet()
    told = []
    for law in laws("ghaednia", "kogut-komvopoulos", "brake-2015", "fitted"):
        trace = traced(_scene(law, 20.0, 1.41, 0.20), points=300)
        x, y = trace.column("slip_m"), trace.column("tip_height_m")
        axis.plot(1e6 * x, 1e6 * np.minimum(y, 0.0), **look(law))
        told.append(f"{law.name} {1e6 * trace.impact.sliding_length_m:.0f}")
    finish(axis, x="path of the tip [um]", y="height of the tip [um]")
    note = (
        f"Sliding length in one contact [um]: {', '.join(told)}; measured 1400. One contact of a "
        "rigid rod is an order of magnitude too short: the rod vibrates and touches several times."
    )
    return Picture("5.7", "Predicted path of the tip, 20 degrees", made, note)
