"""Figures 1.1-1.4: the two ways to press, the published hardness laws; and a paradox drawn."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from ....campaigns import CaseRecord
from ....core.arrays import Array
from ....models.published import hardness
from ...plot import Entry, Picture, finish, sheet
from ..viscous import alpha_for, hunt_crossley, kelvin_voigt, paradox
from . import sketches

_PLACES = (0.1, 0.3, 0.5)  # a/R at which a law's deviation is told
_PLASTIC = 110.0  # w from which a contact counts as fully plastic (2.3.2)


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """The figures; `records` are the stored finite-element cases, possibly none."""
    return [
        *sketches.chapter_1(),
        _hardness(
            "1.2",
            "indentation",
            hardness.INDENTATION,
            records,
            lambda r: r > 1.7,
            "The thesis says that its own points here are not perfectly plastic; ours are.",
        ),
        _hardness(
            "1.3",
            "flattening",
            hardness.FLATTENING,
            records,
            lambda r: r < 0.6,
            "The text calls 1.15 the improved fit. The thesis's points are adjusted for the "
            "radius of curvature, it does not say how; ours are not.",
        ),
        _paradox(),
    ]


def _paradox() -> Picture:
    """Force over depth of an impact on spring and dashpot, and by Hunt and Crossley."""
    mass, stiffness, damping, speed = 0.05, 2e6, 120.0, 1.3
    told = paradox(mass=mass, stiffness=stiffness, damping=damping, speed=speed)
    alpha = alpha_for(told.restitution_at_return, speed=speed)
    # stiff enough to reach about the depth of the linear spring
    deepest = speed * math.sqrt(mass / stiffness)
    hertzian = 1.25 * mass * speed**2 / deepest**2.5
    made, (axis,) = sheet()
    for name, force in (
        ("Kelvin and Voigt", partial(kelvin_voigt, stiffness=stiffness, damping=damping)),
        ("Hunt and Crossley", partial(hunt_crossley, stiffness=hertzian, alpha=alpha)),
    ):
        d, rate = _impact(force, mass=mass, speed=speed)
        axis.plot(1e6 * d, force(d, rate), label=f"{name}, e = {-rate[-1] / speed:.3f}")
    axis.axhline(0.0, color="0.5", lw=0.8)
    axis.plot(0.0, told.force_at_touch, "C0o", label="a force with nothing pressed in")
    axis.plot(1e6 * told.depth_at_zero_force, 0.0, "C0s", label="a depth without any yield")
    finish(axis, x="depth [um]", y="force [N]")
    note = (
        f"{mass:g} kg at {speed:g} m/s. Spring and dashpot push with {told.force_at_touch:.0f} N "
        f"at first touch and hold back with {-told.pull_at_return:.0f} N at the end; let go where "
        f"the force vanishes, a depth of {1e6 * told.depth_at_zero_force:.0f} um stays. Hunt and "
        "Crossley's damping, chosen for the same restitution, has neither, and no dent."
    )
    return Picture("viscous", "The paradox of Kelvin and Voigt", made, note)


def _impact(force: Callable[[Any, Any], Array], *, mass: float, speed: float) -> list[Array]:
    """Depth and rate of an impact from first touch until the depth is zero again."""
    from scipy.integrate import solve_ivp

    def back(_t: float, y: Array) -> float:
        return float(y[0])

    back.terminal, back.direction = True, -1.0  # type: ignore[attr-defined]
    found = solve_ivp(
        lambda _t, y: [y[1], -float(force(y[0], y[1])) / mass],
        (0.0, 1.0), [0.0, speed], events=back, max_step=5e-6, rtol=1e-8, atol=1e-12,
    )  # fmt: skip
    return list(found.y)


def _hardness(
    number: str,
    regime: str,
    published: dict[str, Callable[[Any], Array]],
    records: Sequence[CaseRecord],
    belongs: Callable[[float], bool],
    said: str,
) -> Picture:
    made, (axis,) = sheet()
    x = np.linspace(1e-3, 0.6, 300)
    for name, function in published.items():
        axis.plot(x, function(x), label=name)
    axis.plot(x, hardness.olsson_larsson(x, LD=0.02), ":", color="0.5",
              label="Olsson and Larsson (1.12), L D = 0.02 chosen")  # fmt: skip
    radius, pressure = _plastic(records, belongs)
    note = "No finite-element campaign was found to draw beside them."
    if len(radius):
        axis.plot(radius, pressure, "k.", ms=4, label="our finite elements, w > 110")
        deviations = {
            name: float(np.mean(np.abs(function(radius) / pressure - 1.0)))
            for name, function in published.items()
        }
        best = min(deviations, key=lambda name: deviations[name])
        told = ", ".join(
            f"{name} {value:.1%} ({', '.join(_along(published[name], radius, pressure))})"
            for name, value in deviations.items()
        )
        places = ", ".join(f"{place:g}" for place in _PLACES)
        note = (
            f"Mean deviation from {len(radius)} of our points of full plasticity, in brackets at "
            f"a/R = {places}: {told}; the nearest is {best}."
        )
    axis.set_ylim(1.0, 3.6)
    finish(axis, x="contact radius a/R", y="mean pressure p/Sy")
    note += f" {said}"
    return Picture(number, f"Hardness laws, {regime}", made, note)


def _along(law: Callable[[Any], Array], radius: Array, pressure: Array) -> list[str]:
    """Mean deviation of a law from the points near each of `_PLACES`."""
    off = law(radius) / pressure - 1.0
    near = (np.abs(radius - place) < 0.03 for place in _PLACES)
    return [f"{np.mean(off[here]):+.1%}" for here in near if np.any(here)]


def _plastic(
    records: Sequence[CaseRecord], belongs: Callable[[float], bool]
) -> tuple[Array, Array]:
    from ....models import critical_depth

    xs, ys = [], []
    for record in records:
        pair = record.case.pair
        if not belongs(pair.Sy_ratio):
            continue
        keep = record.curve["delta"] > _PLASTIC * critical_depth(pair)
        xs.append(record.curve["radius"][keep] / pair.R)
        ys.append(record.curve["hardness"][keep] / pair.Sy_min)
    return (np.concatenate(xs), np.concatenate(ys)) if xs else (np.zeros(0), np.zeros(0))
